#include "render/geometry/embree_scene.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <cstring>

#include "core/error.h"
#include "core/floating_point_traps.h"

namespace ebru {
namespace {

#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
#else
using QueryContext = RTCIntersectContext;
#endif

/// What Embree hands through to `filterHit`; the query's own context has to come first.
struct FilterContext {
  QueryContext context;
  const HitFilter* filter;
  const Ray* ray;
};

// The calls that differ between versions 3 and 4 of Embree.
#if RTC_VERSION_MAJOR >= 4
void intersectOne(RTCScene scene, FilterContext& context, RTCRayHit& rayHit) {
  rtcInitRayQueryContext(&context.context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context.context;
  rtcIntersect1(scene, &rayHit, &arguments);
}

void occludedOne(RTCScene scene, FilterContext& context, RTCRay& ray) {
  rtcInitRayQueryContext(&context.context);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context.context;
  rtcOccluded1(scene, &ray, &arguments);
}
#else
void intersectOne(RTCScene scene, FilterContext& context, RTCRayHit& rayHit) {
  rtcInitIntersectContext(&context.context);
  rtcIntersect1(scene, &context.context, &rayHit);
}

void occludedOne(RTCScene scene, FilterContext& context, RTCRay& ray) {
  rtcInitIntersectContext(&context.context);
  rtcOccluded1(scene, &context.context, &ray);
}
#endif

/// Embree's callback: asks the filter of the ray's context.
void filterHit(const RTCFilterFunctionNArguments* arguments) {
  if (arguments->valid[0] != -1) return;
  const auto* context = reinterpret_cast<const FilterContext*>(arguments->context);
  MeshHit hit;
  hit.mesh = RTCHitN_geomID(arguments->hit, arguments->N, 0);
  hit.triangle = RTCHitN_primID(arguments->hit, arguments->N, 0);
  hit.barycentric = Vec2f(RTCHitN_u(arguments->hit, arguments->N, 0), RTCHitN_v(arguments->hit, arguments->N, 0));
  hit.distanceWorld = RTCRayN_tfar(arguments->ray, arguments->N, 0);
  const FloatingPointTraps trapped(true);
  if (!context->filter->counts(*context->ray, hit)) arguments->valid[0] = 0;
}

void setRay(const Ray& ray, RTCRay& out) {
  out.org_x = ray.origin.x();
  out.org_y = ray.origin.y();
  out.org_z = ray.origin.z();
  out.tnear = 0.0f;
  out.dir_x = ray.direction.x();
  out.dir_y = ray.direction.y();
  out.dir_z = ray.direction.z();
  out.time = ray.time;
  out.tfar = ray.farWorld;
  out.mask = 0xffffffffu;
  out.id = 0;
  out.flags = 0;
}

template <class T>
void copyBuffer(RTCGeometry geometry, RTCBufferType type, unsigned slot, RTCFormat format, const std::vector<T>& values) {
  static_assert(sizeof(T) == 12);
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, slot, format, sizeof(T), values.size());
  if (buffer) std::memcpy(buffer, static_cast<const void*>(values.data()), values.size() * sizeof(T));
}

}  // namespace

struct EmbreeScene::Impl {
  const HitFilter* filter = nullptr;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void check(const char* what) const {
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
      throw BugError(fmt::format("Embree: {}: got error {}, expected none", what, static_cast<int>(error)));
  }

  void add(const RayMesh& part, unsigned id) const {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (part.atOpen) {
      const std::vector<Vec3f>& middle = part.atCentre ? *part.atCentre : part.mesh->positions;
      rtcSetGeometryTimeStepCount(geometry, 3);
      copyBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, *part.atOpen);
      copyBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 1, RTC_FORMAT_FLOAT3, middle);
      copyBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 2, RTC_FORMAT_FLOAT3, *part.atClose);
    } else {
      copyBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, part.mesh->positions);
    }
    copyBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, part.mesh->triangles);
    if (filter && part.filtered) {
      rtcSetGeometryIntersectFilterFunction(geometry, filterHit);
      rtcSetGeometryOccludedFilterFunction(geometry, filterHit);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }
};

EmbreeScene::EmbreeScene(const std::vector<RayMesh>& meshes, const HitFilter* filter)
    : impl_(std::make_unique<Impl>()) {
  impl_->filter = filter;
  impl_->device = rtcNewDevice("isa=avx2");
  if (!impl_->device) throw BugError("Embree: no device; expected a CPU with AVX2");
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if (meshes[i].mesh && !meshes[i].mesh->empty()) impl_->add(meshes[i], static_cast<unsigned>(i));
  // Embree partitions by the number of threads of the arena it builds in; which of two equally near triangles
  // is reported depends on that order.
  tbb::task_arena one(1);
  one.execute([&] { rtcJoinCommitScene(impl_->scene); });
  impl_->check("building the hierarchy");
}

EmbreeScene::~EmbreeScene() = default;

bool EmbreeScene::intersect(const Ray& ray, MeshHit& hit) const {
  FilterContext context{{}, impl_->filter, &ray};
  const FloatingPointTraps untrapped(false);
  RTCRayHit rayHit;
  setRay(ray, rayHit.ray);
  rayHit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  intersectOne(impl_->scene, context, rayHit);
  if (rayHit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit.mesh = rayHit.hit.geomID;
  hit.triangle = rayHit.hit.primID;
  hit.barycentric = Vec2f(rayHit.hit.u, rayHit.hit.v);
  hit.distanceWorld = rayHit.ray.tfar;
  return true;
}

bool EmbreeScene::occluded(const Ray& ray) const {
  FilterContext context{{}, impl_->filter, &ray};
  const FloatingPointTraps untrapped(false);
  RTCRay query;
  setRay(ray, query);
  occludedOne(impl_->scene, context, query);
  return query.tfar < 0.0f;
}

}  // namespace ebru
