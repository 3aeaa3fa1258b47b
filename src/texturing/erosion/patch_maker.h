#pragma once

#include <memory>
#include <vector>

#include "core/parallel.h"
#include "exemplar/exemplar.h"
#include "fluid/fluid_frame.h"
#include "surface/surface_piece.h"
#include "texturing/erosion/patch_erosion.h"

namespace ebru {

/// A place of the surface.
struct SurfacePlace {
  Vec3f position, normal;
  std::uint32_t triangle;
};

/// What all patches of a run have in common.
struct PatchPlan {
  float texelWorld;
  float radiusWorld;
  float maxDistortion;
  bool randomOrientation;
  std::uint64_t seed;
};

/// Copies patches from the surface of one frame [Gagnon 2021, sec. 4]. Refers to its arguments. `make` may be
/// called concurrently.
class PatchMaker {
 public:
  /// @param mesh  the frame's, or finer; @param rim  where it ends
  PatchMaker(const FluidFrame& frame, const TriangleMesh& mesh, const SurfaceRim& rim,
             const Exemplar& exemplar, const PatchErosion& erosion, const PatchPlan& plan);

  /// A patch around `centre`, a place of the mesh: flattened by a least squares conformal map, the centre at
  /// 0, showing a random place of the exemplar that has the patch inside where that is possible. Measured.
  DeformablePatch make(const SurfacePlace& centre, std::uint32_t id) const;

 private:
  void flatten(const SurfacePlace& centre, float angle, DeformablePatch& patch) const;

  const FluidFrame& frame_;
  const TriangleMesh& mesh_;
  const Exemplar& exemplar_;
  const PatchErosion& erosion_;
  PatchPlan plan_;
  PieceCutter cutter_;
  const SurfaceRim& rim_;
  mutable PerThread<PieceCutter::Scratch> scratch_;
};

}  // namespace ebru
