#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "fluid/flow.h"
#include "io/state_file.h"
#include "surface/surface_piece.h"

namespace ebru {

/// What is the same for all of a patch.
struct PatchIdentity {
  std::uint32_t id = 0;            ///< in the order of birth; unique over the run
  float age = 0.0f;                ///< frames it has been carried; still frames do not count
  float presence = 1.0f;           ///< how far it has faded in
  Vec2f centreSt = Vec2f::Zero();  ///< what the exemplar shows at its centre, texels (see Exemplar)
  std::int32_t tile = 0;           ///< of the exemplar
  float largestTerm = 1.0f;        ///< maximum of sqrt(F + D) over the patch, see PatchErosion
};

/// How a place of a patch, or a whole feature of the exemplar on it, is kept; see PatchErosion.
struct Keeping {
  float margin;   ///< negative: eroded; not a number, of a feature: its places are judged one by one
  float opacity;  ///< 0 where it is eroded, 1 where it hides what is below
};
struct KeptCell : Keeping {
  std::uint32_t cell;  ///< of FeatureCells
};

/// A feature on a patch that was seen in the last frame, of a new patch one that is to be.
struct SeenCell {
  std::uint32_t cell;
  float opacity;  ///< it had
  bool operator==(const SeenCell&) const = default;
};

/// A deformable lapped patch [Gagnon 2021, sec. 4]: an open triangle mesh that was copied from the surface,
/// flattened once, and rides on the flow vertex by vertex. A place of it shows the exemplar at centreSt +
/// rest / texelWorld.
struct DeformablePatch : PatchIdentity {
  std::vector<Vec3f> position;       ///< world, metres
  std::vector<Vec2f> rest;           ///< flattened, metres from the centre, in the exemplar's axes (v down)
  std::vector<Vec3i> triangles;      ///< counter-clockwise from outside
  std::vector<unsigned char> atEnd;  ///< per vertex, 1 where the surface itself ends: no rim of the patch
  std::vector<SeenCell> seen;        ///< ascending by cell

  /// Of the present shape; see `measure`.
  std::vector<float> area;     ///< per vertex, square metres, twice those of the triangles around
  std::vector<float> quality;  ///< per vertex, Q_V of eq. 1, in [0, 1]
  std::vector<unsigned char>
      rim;  ///< per vertex, 1 on the rim, but for what is within r/4 of the centre or at the surface's end
  std::vector<float> weight;  ///< per vertex, w_V of eq. 3, in [0, 1]
  std::vector<float>
      distortion;  ///< per triangle, max(s1, 1/s2) of d(rest)/d(position); infinite where it is turned over
  std::vector<KeptCell> cells;  ///< of features, ascending by cell; empty where places are eroded one by one
};

/// Distortion of the triangles, and weights from eq. 1 to 3: the vertices' mean quality, by area, times what
/// falls from 1 to 0 over the last third of a radius before the rim, except within r/4 of the centre. (In the
/// paper it falls over the last triangle, which is as wide there; here the rim does not show how fine the
/// surface is.)
void measure(float radiusWorld, float maxDistortion, DeformablePatch& patch);

/// Moves the vertices with the flow and onto the surface of `to`. Vertices farther than r/4 from it go, and
/// their triangles, and triangles that lie on it upside down. Where flow and surface rest, nothing is
/// written. The measures are not brought along. @return whether anything changed
bool carry(const Flow& flow, const FluidFrame& to, float radiusWorld, DeformablePatch& patch);

/// Notes which vertices lie where the surface ends. @return whether that changed
bool noteEnds(const SurfaceRim& rim, DeformablePatch& patch);

/// All patches as flat arrays, without their measures.
void savePatches(const std::vector<DeformablePatch>& patches, StateWriter& writer);
std::vector<DeformablePatch> loadPatches(const StateReader& reader);

}  // namespace ebru
