/// The data channels of the default shot's frame, one thread, beside what they cannot do without: a ray and a
/// nearest point each. `of_raw` is the time that the two take alone divided by that of the channels.

#include <ctime>

#include "render/film/data_channels.h"
#include "stage.h"
#include "surface/point_index.h"

namespace ebru::bench {
namespace {

/// The view of scenes/dam_break.toml and everything its data channels are computed from.
class View {
 public:
  explicit View(const TextureField* texture)
      : path_(options().camera),
        exposure_(path_, {0.0, 0.0}, 12),
        geometry_{&from().mesh},
        scene_(geometry_, {}, {}, "frame 12"),
        materials_(options(), texture),
        motion_(path_, 0.0, &from(), from(), &to()) {
    for (std::size_t i = 0; i < pixelCount(); ++i) rays_.push_back(ray(i).ray);
    SurfaceHit hit;
    for (const Ray& r : rays_)
      if (scene_.intersect(r, hit)) hits_.push_back(hit);
  }

  static SceneOptions options() {
    SceneOptions result;
    result.camera.position = {1.75, -2.75, 1.75};
    result.camera.target = {0.0, 0.0, 0.2};
    result.camera.vertical_fov_deg = 25.0;
    result.camera.size = {320, 180};
    return result;
  }
  std::size_t pixelCount() const { return static_cast<std::size_t>(exposure_.camera().width() * exposure_.camera().height()); }
  const std::vector<SurfaceHit>& hits() const { return hits_; }
  std::vector<RayMesh> meshes() const { return {{&from().mesh}}; }
  const std::vector<Ray>& rays() const { return rays_; }

  void writeAll(FrameBuffer& buffer) const {
    const DataScene data{exposure_, from(), scene_, materials_, motion_};
    const int width = exposure_.camera().width();
    for (std::size_t i = 0; i < pixelCount(); ++i)
      writeDataChannels(data, static_cast<int>(i) % width, static_cast<int>(i) / width, i, buffer);
  }

 private:
  CameraRay ray(std::size_t i) const {
    const auto width = static_cast<std::size_t>(exposure_.camera().width());
    return exposure_.dataRay(Vec2d(static_cast<double>(i % width) + 0.5, static_cast<double>(i / width) + 0.5));
  }

  CameraPath path_;
  Exposure exposure_;
  FluidGeometry geometry_;
  Scene scene_;
  Materials materials_;
  MotionVectors motion_;
  std::vector<Ray> rays_;
  std::vector<SurfaceHit> hits_;
};

const View& plainView() {
  static const View view(nullptr);
  return view;
}

double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double traceAll(const EmbreeScene& scene, const View& view) {
  const double start = cpuSeconds();
  MeshHit hit;
  for (const Ray& ray : view.rays()) benchmark::DoNotOptimize(scene.intersect(ray, hit));
  return cpuSeconds() - start;
}

double findAll(const PointIndex& index, const View& view) {
  const double start = cpuSeconds();
  PointIndex::Neighbour nearest;
  for (const SurfaceHit& hit : view.hits())
    benchmark::DoNotOptimize(index.nearest(hit.position, hit.normal, 0.5f, 4.0f * texelWorld, {&nearest, 1}));
  return cpuSeconds() - start;
}

void RawPrimaryRays(benchmark::State& state) {
  const View& view = plainView();
  const EmbreeScene scene(view.meshes());
  for (auto _ : state) traceAll(scene, view);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(view.rays().size()));
}

void RawNearestPoints(benchmark::State& state) {
  const View& view = plainView();
  const PointIndex index(particles().position, particles().normal);
  for (auto _ : state) findAll(index, view);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(view.hits().size()));
}

void DataChannels(benchmark::State& state, const char* method) {
  const auto texture = field(method);
  const View view(texture.get());
  const EmbreeScene scene(view.meshes());
  const PointIndex index(particles().position, particles().normal);
  FrameBuffer buffer(view.options().camera.size[0], view.options().camera.size[1]);
  double raw = 0.0, channels = 0.0;
  for (auto _ : state) {
    raw += traceAll(scene, view) + findAll(index, view);
    const double start = cpuSeconds();
    view.writeAll(buffer);
    channels += cpuSeconds() - start;
    state.SetIterationTime(cpuSeconds() - start);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(view.pixelCount()));
  state.counters["of_raw"] = raw / channels;
}

BENCHMARK(RawPrimaryRays)->Unit(benchmark::kMillisecond);
BENCHMARK(RawNearestPoints)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(DataChannels, particles, "particles")->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK_CAPTURE(DataChannels, synthesis, "synthesis")->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK_CAPTURE(DataChannels, plain, "plain")->Unit(benchmark::kMillisecond)->UseManualTime();

}  // namespace
}  // namespace ebru::bench
