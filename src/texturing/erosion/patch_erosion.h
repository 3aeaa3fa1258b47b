#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "exemplar/feature_cells.h"
#include "texturing/erosion/deformable_patch.h"

namespace ebru {

/// Which places of a patch are eroded [Gagnon 2021, sec. 5.2]: those where
///     sqrt(F + D) / max sqrt(F + D) - epsilon < 1 - w,
/// F the feature map, D the place's nearness to the centre, w the weight of eq. 3.
/// With cells, whole features are: F is a feature's importance, D is taken at its middle and w is the mean
/// quality on it, by area. One that the rim of the patch cuts is eroded, but for large ones, of which a patch does not
/// hold many, and the one in the middle: their places are judged one by one, as are those of cells smaller
/// than the triangles. A feature that was hidden in the frame before comes out only while it is hardly
/// distorted: else it would go again soon. What lies beyond the exemplar's image is eroded. Texture fades
/// over the last part of its margin, so that what takes its place does not jump at the eye. This fade follows
/// the distortion: where the fluid stops it stops. Whole features that were seen fade over some frames
/// besides, however fast they are being distorted: their opacity falls by a share of 1 per frame at most. Refers to the maps.
/// Const members are safe to call concurrently.
class PatchErosion {
 public:
  /// @param cells  null: places are eroded one by one, as in the paper
  /// @param softness  width of the margin over which texture fades before it is eroded; 0 in the paper
  /// @param fadeFrames  frames over which a whole feature that goes fades; up to 1: at once, as in the paper
  PatchErosion(const FeatureMap& features, const FeatureCells* cells, float radiusWorld, float texelWorld,
               float epsilon, float softness, float fadeFrames)
      : features_(features),
        cells_(cells),
        radiusWorld_(radiusWorld),
        texelWorld_(texelWorld),
        epsilon_(epsilon),
        softness_(softness),
        fadeStep_(1.0f / std::max(1.0f, fadeFrames)) {}

  /// Whether the exemplar has something for a place. @param rest  as in DeformablePatch
  bool inImage(const PatchIdentity& patch, const Vec2f& rest) const {
    return features_.holds(patch.tile, placeOf(patch, rest));
  }

  /// Which of the judged cells of a patch a place lies in; their number if in none.
  std::size_t judgedCell(const PatchIdentity& patch, std::span<const KeptCell> judged,
                         const Vec2f& rest) const {
    return judged.empty() ? 0 : indexOf(judged, cells_->at(patch.tile, placeOf(patch, rest)));
  }

  /// How a place is kept. @param cell  of `judgedCell`
  Keeping keeping(const PatchIdentity& patch, std::span<const KeptCell> judged, std::size_t cell,
                  const Vec2f& rest, float weight) const {
    if (!inImage(patch, rest)) return {outside, 0.0f};
    if (cell < judged.size() && !std::isnan(judged[cell].margin)) return judged[cell];
    const float nearness = nearnessOf(rest),
                least = std::sqrt(nearness) / patch.largestTerm - epsilon_ - (1.0f - weight);
    // Most places are kept whatever the feature map says.
    if (least >= softness_) return {least, 1.0f};
    return keeping(features_.at(patch.tile, placeOf(patch, rest)) + nearness, patch, weight);
  }
  Keeping keeping(const PatchIdentity& patch, std::span<const KeptCell> judged, const Vec2f& rest,
                  float weight) const {
    return keeping(patch, judged, judgedCell(patch, judged, rest), rest, weight);
  }
  /// The same between the four texels around a place, bilinearly: the border of a feature that is kept is no staircase.
  Keeping smoothKeeping(const PatchIdentity& patch, std::span<const KeptCell> judged, const Vec2f& rest,
                        float weight) const;

  /// Fills `cells` of a measured patch.
  /// @param framesLater  than the frame of `seen`: 0 or 1
  void judge(DeformablePatch& patch, int framesLater) const;

  /// Where a patch's centre best lies in the exemplar, near `st`: in the middle of a feature.
  Vec2f centreNear(int tile, const Vec2f& st) const {
    return cells_ ? cells_->centre(cells_->at(tile, st)) : st;
  }

  /// The cells that a new patch is to show: that of its centre, however hard it is to flatten there.
  std::vector<SeenCell> cellsToShow(const PatchIdentity& patch) const {
    if (!cells_) return {};
    return {{cells_->at(patch.tile, patch.centreSt), 0.0f}};
  }

  /// The maximum of sqrt(F + D) over a patch with that centre.
  float largestTerm(const PatchIdentity& patch) const;

 private:
  static constexpr float outside = -2.0f;  ///< the least margin of all

  float nearnessOf(const Vec2f& rest) const { return std::max(0.0f, 1.0f - rest.norm() / radiusWorld_); }
  Vec2f placeOf(const PatchIdentity& patch, const Vec2f& rest) const {
    return patch.centreSt + rest / texelWorld_;
  }
  static std::size_t indexOf(std::span<const KeptCell> judged, std::uint32_t cell) {
    const auto found =
        std::lower_bound(judged.begin(), judged.end(), cell,
                         [](const KeptCell& c, std::uint32_t wanted) { return c.cell < wanted; });
    return found != judged.end() && found->cell == cell ? static_cast<std::size_t>(found - judged.begin())
                                                        : judged.size();
  }
  /// @param squaredTerm  F + D
  Keeping keeping(float squaredTerm, const PatchIdentity& patch, float weight) const {
    const float fresh = std::sqrt(squaredTerm) / patch.largestTerm - epsilon_,
                margin = fresh - (1.0f - weight);
    if (margin < 0.0f) return {margin, 0.0f};
    // What is hardly kept even when it is fresh has less to fade over.
    const float softness = std::min(softness_, 0.5f * fresh);
    return {margin, margin < softness ? margin / softness : 1.0f};
  }
  /// F + D of a cell.
  float cellTerm(const PatchIdentity& patch, std::uint32_t cell) const {
    return cells_->importance(cell) + nearnessOf((cells_->centre(cell) - patch.centreSt) * texelWorld_);
  }
  /// The least opacity of a feature that had one before.
  float faded(float opacity, int framesLater) const;
  /// Whether a cell that the rim cuts may be eroded in part.
  bool divisible(const PatchIdentity& patch, std::uint32_t cell) const;

  const FeatureMap& features_;
  const FeatureCells* cells_;
  float radiusWorld_, texelWorld_, epsilon_, softness_, fadeStep_;
};

}  // namespace ebru
