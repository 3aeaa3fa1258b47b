#include "fluid/procedural_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace ebru {

namespace {

constexpr double pi = std::numbers::pi;

double sphereDistance(const Vec3d& p, double radius) {
  return p.norm() - radius;
}

double roundedBoxDistance(const Vec3d& p, const Vec3d& halfExtent, double rounding) {
  const Vec3d q = p.cwiseAbs() - (halfExtent - Vec3d::Constant(rounding));
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - rounding;
}

Bounds3f around(const Vec3d& centre, const Vec3d& halfExtent) {
  Bounds3f bounds;
  bounds.include((centre - halfExtent).cast<float>());
  bounds.include((centre + halfExtent).cast<float>());
  return bounds;
}

/// A solid: a sphere of radius `size` or a flat rounded box.
struct Shape {
  bool box = false;
  double size = 0.5;
  double distance(const Vec3d& p) const {
    return box ? roundedBoxDistance(p, halfExtent(), 0.1 * size) : sphereDistance(p, size);
  }
  Vec3d halfExtent() const { return size * (box ? Vec3d(1.0, 0.6, 0.3) : Vec3d(1.0, 1.0, 1.0)); }
};

class Translation : public ProceduralScene {
 public:
  Translation(const Shape& shape, const Vec3d& velocity) : shape_(shape), velocity_(velocity) {}
  double distance(const Vec3d& p, double t) const override { return shape_.distance(p - t * velocity_); }
  Bounds3f bounds(double t) const override { return around(t * velocity_, shape_.halfExtent()); }
  Vec3d velocity(const Vec3d&, double) const override { return velocity_; }
  Vec3d position(const Vec3d& p, double from, double to) const override {
    return p + (to - from) * velocity_;
  }

 private:
  Shape shape_;
  Vec3d velocity_;
};

class RigidRotation : public ProceduralScene {
 public:
  RigidRotation(const Shape& shape, double omega) : shape_(shape), omega_(omega) {}
  double distance(const Vec3d& p, double t) const override { return shape_.distance(turn(p, -omega_ * t)); }
  Bounds3f bounds(double) const override {
    const Vec3d h = shape_.halfExtent();
    const double reach = shape_.box ? h.head<2>().norm() : h.x();
    return around(Vec3d::Zero(), Vec3d(reach, reach, h.z()));
  }
  Vec3d velocity(const Vec3d& p, double) const override { return omega_ * Vec3d(-p.y(), p.x(), 0.0); }
  Vec3d position(const Vec3d& p, double from, double to) const override {
    return turn(p, omega_ * (to - from));
  }

 private:
  static Vec3d turn(const Vec3d& p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return Vec3d(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z());
  }
  Shape shape_;
  double omega_;
};

class Shear : public ProceduralScene {
 public:
  Shear(double size, double rate) : size_(size), rate_(rate) {}
  double distance(const Vec3d& p, double) const override {
    return roundedBoxDistance(p, halfExtent(), 0.06 * size_);
  }
  Bounds3f bounds(double) const override { return around(Vec3d::Zero(), halfExtent()); }
  Vec3d velocity(const Vec3d& p, double) const override { return Vec3d(rate_ * p.y(), 0.0, 0.0); }
  Vec3d position(const Vec3d& p, double from, double to) const override {
    return p + (to - from) * Vec3d(rate_ * p.y(), 0.0, 0.0);
  }

 private:
  Vec3d halfExtent() const { return size_ * Vec3d(1.0, 1.0, 0.12); }
  double size_;
  double rate_;
};

/// The field is a steady one times a function of time: paths depend on the integral of that function only,
/// here called warp, and the flow back to time 0 costs no more late in the period than early.
class VortexSphere : public ProceduralScene {
 public:
  VortexSphere(double edge, double periodSeconds, double speed)
      : edge_(edge), periodSeconds_(periodSeconds), amplitude_(1.5 * speed) {}
  double distance(const Vec3d& p, double t) const override {
    return edge_ * sphereDistance(flow(p / edge_, -warp(t)) - centre(), radius);
  }
  bool exactDistance() const override { return false; }
  Bounds3f bounds(double t) const override {
    Bounds3f bounds;
    for (const Vec3f& p : surfacePoints(t, 0.02 * edge_)) bounds.include(p);
    return bounds;
  }
  std::vector<Vec3f> surfacePoints(double t, double spacing) const override {
    // A Fibonacci lattice on the first sphere, four times denser per direction to allow for the stretch.
    const double cell = 0.25 * spacing / edge_;
    const int count = std::clamp(static_cast<int>(4.0 * pi * radius * radius / (cell * cell)), 64, 2000000);
    std::vector<Vec3f> points(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const double z = 1.0 - (2.0 * i + 1.0) / count, angle = i * pi * (3.0 - std::sqrt(5.0));
      const double r = std::sqrt(1.0 - z * z);
      const Vec3d onSphere = centre() + radius * Vec3d(r * std::cos(angle), r * std::sin(angle), z);
      points[i] = (edge_ * flow(onSphere, warp(t))).cast<float>();
    }
    return points;
  }
  Vec3d velocity(const Vec3d& p, double t) const override {
    const double rate = amplitude_ / periodSeconds_ * std::cos(pi * t / periodSeconds_);
    return edge_ * rate * steady(p / edge_);
  }
  Vec3d position(const Vec3d& p, double from, double to) const override {
    return edge_ * flow(p / edge_, warp(to) - warp(from));
  }

 private:
  static constexpr double radius = 0.15;
  static Vec3d centre() { return Vec3d::Constant(0.35); }
  double warp(double t) const { return amplitude_ / pi * std::sin(pi * t / periodSeconds_); }

  static Vec3d steady(const Vec3d& p) {
    const double sx = std::sin(pi * p.x()), sy = std::sin(pi * p.y()), sz = std::sin(pi * p.z());
    const double x2 = std::sin(2.0 * pi * p.x()), y2 = std::sin(2.0 * pi * p.y()),
                 z2 = std::sin(2.0 * pi * p.z());
    return Vec3d(2.0 * sx * sx * y2 * z2, -x2 * sy * sy * z2, -x2 * y2 * sz * sz);
  }

  static Vec3d flow(Vec3d p, double duration) {
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(duration) / 0.02)));
    const double h = duration / steps;
    for (int i = 0; i < steps; ++i) {
      const Vec3d k1 = steady(p), k2 = steady(p + 0.5 * h * k1);
      const Vec3d k3 = steady(p + 0.5 * h * k2), k4 = steady(p + h * k3);
      p += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    return p;
  }

  double edge_;
  double periodSeconds_;
  double amplitude_;
};

class MergeSplit : public ProceduralScene {
 public:
  MergeSplit(double size, double periodSeconds) : size_(size), periodSeconds_(periodSeconds) {}
  double distance(const Vec3d& p, double t) const override { return blend(p, t).distance; }
  bool exactDistance() const override { return false; }
  Bounds3f bounds(double t) const override {
    // The smooth union swells by blend * ln 2 at most.
    return around(Vec3d::Zero(), Vec3d::Constant(0.44 * size_) + offset(t) * Vec3d::UnitX());
  }
  Vec3d velocity(const Vec3d& p, double t) const override {
    const Blend b = blend(p, t);
    const double speed = offsetRate(t);
    // Sphere 0 is at +offset, sphere 1 at -offset.
    const Vec3d blended = (b.weight[0] - b.weight[1]) * speed * Vec3d::UnitX();
    const Vec3d gradient = b.weight[0] * b.normal[0] + b.weight[1] * b.normal[1];
    const double normalFlow = speed * (b.weight[0] * b.normal[0].x() - b.weight[1] * b.normal[1].x());
    const double squared = std::max(gradient.squaredNorm(), 1e-4);
    return blended + (normalFlow - blended.dot(gradient)) / squared * gradient;
  }
  Vec3d position(const Vec3d& pWorld, double from, double to) const override {
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(to - from) / periodSeconds_ * 2000.0)));
    const double h = (to - from) / steps;
    Vec3d p = pWorld;
    for (int i = 0; i < steps; ++i) {
      const double t = from + i * h;
      const Vec3d k1 = velocity(p, t), k2 = velocity(p + 0.5 * h * k1, t + 0.5 * h);
      const Vec3d k3 = velocity(p + 0.5 * h * k2, t + 0.5 * h), k4 = velocity(p + h * k3, t + h);
      p += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    return p;
  }

 private:
  struct Blend {
    double distance;
    double weight[2];
    Vec3d normal[2];
  };
  double offset(double t) const { return size_ * (0.425 + 0.175 * std::cos(2.0 * pi * t / periodSeconds_)); }
  double offsetRate(double t) const {
    const double omega = 2.0 * pi / periodSeconds_;
    return -size_ * 0.175 * omega * std::sin(omega * t);
  }
  Blend blend(const Vec3d& p, double t) const {
    const double k = 0.04 * size_;
    Blend b;
    double d[2];
    for (int i = 0; i < 2; ++i) {
      const Vec3d r = p - (i == 0 ? 1.0 : -1.0) * offset(t) * Vec3d::UnitX();
      const double length = r.norm();
      d[i] = length - 0.4 * size_;
      b.normal[i] = length > 0.0 ? (r / length).eval() : Vec3d::Zero().eval();
    }
    const double nearest = std::min(d[0], d[1]);
    const double e[2] = {std::exp((nearest - d[0]) / k), std::exp((nearest - d[1]) / k)};
    b.distance = nearest - k * std::log(e[0] + e[1]);
    for (int i = 0; i < 2; ++i) b.weight[i] = e[i] / (e[0] + e[1]);
    return b;
  }

  double size_;
  double periodSeconds_;
};

}  // namespace

std::vector<Vec3f> ProceduralScene::surfacePoints(double, double) const {
  return {};
}

std::shared_ptr<const ProceduralScene> makeProceduralScene(const FluidOptions& o, double framesPerSecond) {
  if (o.shape != "sphere" && o.shape != "box")
    throw UsageError(fmt::format("fluid.shape: got \"{}\", expected sphere or box", o.shape));
  const Shape shape{o.shape == "box", o.size};
  const double period = o.period_frames / framesPerSecond;
  if (o.scene == "static_sphere") return std::make_shared<Translation>(Shape{false, o.size}, Vec3d::Zero());
  if (o.scene == "translation")
    return std::make_shared<Translation>(shape, framesPerSecond * Vec3d(o.shift[0], o.shift[1], o.shift[2]));
  if (o.scene == "rigid_rotation") return std::make_shared<RigidRotation>(shape, o.speed);
  if (o.scene == "shear") return std::make_shared<Shear>(o.size, o.speed);
  if (o.scene == "vortex_sphere") return std::make_shared<VortexSphere>(2.0 * o.size, period, o.speed);
  if (o.scene == "merge_split") return std::make_shared<MergeSplit>(o.size, period);
  throw UsageError(
      fmt::format("fluid.scene: got \"{}\", expected static_sphere, translation, rigid_rotation, shear, "
                  "vortex_sphere or merge_split",
                  o.scene));
}

Vec3d exactPosition(const ProceduralScene& scene, const Vec3d& pWorld, double fromFrame, double toFrame,
                    double framesPerSecond) {
  return scene.position(pWorld, secondsOfFrame(fromFrame, framesPerSecond),
                        secondsOfFrame(toFrame, framesPerSecond));
}

}  // namespace ebru
