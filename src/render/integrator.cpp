#include "render/integrator.h"

namespace ebru {
namespace {

class DirectLightIntegrator : public Integrator {
 public:
  explicit DirectLightIntegrator(const IntegratorInput& input) : in_(input) {}

  RaySample trace(const CameraRay& ray, PixelSampler& sampler) const override {
    SurfaceHit hit;
    if (!in_.scene.intersect(ray.ray, hit)) {
      if (!in_.showBackground) return {};
      return {in_.lights.background(ray.ray.direction), 1.0f};
    }
    const Appearance appearance = in_.materials.at(hit, ray.ray.direction, ray.widthAt(hit.distanceWorld));
    const Bsdf bsdf(appearance.material, hit.facing, -ray.ray.direction);
    const Vec3f reflected = sunLight(hit, bsdf, sampler) + environmentLight(hit, bsdf, sampler);
    return {reflected + appearance.texture.emission, 1.0f};
  }

 private:
  bool visible(const SurfaceHit& hit, const Vec3f& towards) const {
    Ray shadow;
    shadow.origin = hit.shadowOrigin;
    shadow.direction = towards;
    return !in_.scene.occluded(shadow);
  }

  Vec3f sunLight(const SurfaceHit& hit, const Bsdf& bsdf, PixelSampler& sampler) const {
    Vec3f sum = Vec3f::Zero();
    for (const SunLight& sun : in_.lights.suns) {
      const Vec3f towards = sun.sample(sampler.next());
      const Vec3f reflected = bsdf.evaluate(towards).cwiseProduct(sun.radianceOverPdf());
      if (reflected.maxCoeff() > 0.0f && visible(hit, towards)) sum += reflected;
    }
    return sum;
  }

  Vec3f environmentLight(const SurfaceHit& hit, const Bsdf& bsdf, PixelSampler& sampler) const {
    const std::vector<Environment>& environments = in_.lights.environments;
    if (environments.empty()) return Vec3f::Zero();
    const Vec2f u = sampler.next();
    const float choice = sampler.next().x();
    const Vec3f towards = bsdf.sample(u, choice);
    const Vec3f reflected = bsdf.evaluate(towards);
    const float pdf = bsdf.pdf(towards);
    Vec3f light = Vec3f::Zero();
    if (reflected.maxCoeff() > 0.0f && pdf > 0.0f)
      for (const Environment& environment : environments) {
        const Environment::Arriving arriving = environment.from(towards);
        light += arriving.radiance / (pdf + arriving.pdf);
      }
    Vec3f sum = reflected.cwiseProduct(light);
    if (sum.maxCoeff() > 0.0f && !visible(hit, towards)) sum.setZero();

    for (const Environment& environment : environments) {
      if (!environment.importanceSampled()) continue;
      const Environment::Sample sample = environment.sample(sampler.next());
      if (!(sample.light.pdf > 0.0f)) continue;
      const Vec3f value = bsdf.evaluate(sample.towards).cwiseProduct(sample.light.radiance) /
                          (sample.light.pdf + bsdf.pdf(sample.towards));
      if (value.maxCoeff() > 0.0f && visible(hit, sample.towards)) sum += value;
    }
    return sum;
  }

  IntegratorInput in_;
};

}  // namespace

std::unique_ptr<Integrator> makeDirectLightIntegrator(const IntegratorInput& input) {
  return std::make_unique<DirectLightIntegrator>(input);
}

}  // namespace ebru
