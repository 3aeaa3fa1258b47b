#include "render/embree_scene.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <cstring>

#include "core/error.h"

namespace ebru {
namespace {

// The calls that differ between versions 3 and 4 of Embree.
void intersectOne(RTCScene scene, RTCRayHit& rayHit) {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene, &rayHit, nullptr);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &rayHit);
#endif
}

void occludedOne(RTCScene scene, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(scene, &ray, nullptr);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

void setRay(const Ray& ray, RTCRay& out) {
  out.org_x = ray.origin.x();
  out.org_y = ray.origin.y();
  out.org_z = ray.origin.z();
  out.tnear = 0.0f;
  out.dir_x = ray.direction.x();
  out.dir_y = ray.direction.y();
  out.dir_z = ray.direction.z();
  out.time = 0.0f;
  out.tfar = ray.farWorld;
  out.mask = 0xffffffffu;
  out.id = 0;
  out.flags = 0;
}

template <class T>
void copyBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<T>& values) {
  static_assert(sizeof(T) == 12);
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), values.size());
  if (buffer) std::memcpy(buffer, static_cast<const void*>(values.data()), values.size() * sizeof(T));
}

}  // namespace

struct EmbreeScene::Impl {
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

  void add(const TriangleMesh& mesh, unsigned id) const {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    copyBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.positions);
    copyBuffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }
};

EmbreeScene::EmbreeScene(const std::vector<const TriangleMesh*>& meshes) : impl_(std::make_unique<Impl>()) {
  impl_->device = rtcNewDevice("isa=avx2");
  if (!impl_->device) throw BugError("Embree: no device; expected a CPU with AVX2");
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if (meshes[i] && !meshes[i]->empty()) impl_->add(*meshes[i], static_cast<unsigned>(i));
  // Embree partitions by the number of threads of the arena it builds in; which of two equally near triangles
  // is reported depends on that order.
  tbb::task_arena one(1);
  one.execute([&] { rtcJoinCommitScene(impl_->scene); });
  impl_->check("building the hierarchy");
}

EmbreeScene::~EmbreeScene() = default;

bool EmbreeScene::intersect(const Ray& ray, Hit& hit) const {
  RTCRayHit rayHit;
  setRay(ray, rayHit.ray);
  rayHit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  intersectOne(impl_->scene, rayHit);
  if (rayHit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit.mesh = rayHit.hit.geomID;
  hit.triangle = rayHit.hit.primID;
  hit.barycentric = Vec2f(rayHit.hit.u, rayHit.hit.v);
  hit.distanceWorld = rayHit.ray.tfar;
  return true;
}

bool EmbreeScene::occluded(const Ray& ray) const {
  RTCRay query;
  setRay(ray, query);
  occludedOne(impl_->scene, query);
  return query.tfar < 0.0f;
}

}  // namespace ebru
