#pragma once

#include <array>
#include <optional>
#include <vector>

#include "exemplar/appearance_space.h"
#include "exemplar/colour_encoding.h"
#include "exemplar/exemplar_maps.h"
#include "exemplar/texel_pyramid.h"

namespace ebru {

/// What an exemplar shows at a place.
struct ExemplarSample {
  Vec3f colour = Vec3f::Zero();    ///< scene-linear
  float height = 0.0f;             ///< 0 without such a map
  float roughness = -1.0f;         ///< in [0, 1]; -1 without such a map
  float alpha = 1.0f;              ///< in [0, 1]
  Vec3f emission = Vec3f::Zero();  ///< scene-linear
};

/// Means of an exemplar's maps beyond colour and height; what they are is the exemplar's to say.
using OtherMaps = std::array<Texel, 2>;
inline const OtherMaps noOtherMaps = {Texel::Zero(), Texel::Zero()};

/// Example images with their pyramids: texels, which synthesis compares, averages and transports, and the maps, which
/// the picture shows. In the plain case of AppearanceSpace, colour with or without height, they are the same data.
///
/// Exemplar coordinates are in texels of level 0: u to the right, v down the image, the centre of the first texel at
/// (0.5, 0.5). Several images, the tiles, lie in one coordinate space side by side along u, the first at 0, at least
/// `gap` texels apart, so that a chart (coordinate and Jacobian) says which it means. A coordinate belongs to the tile
/// nearest in u, and everything is clamped to that tile's own border on every level: nothing bleeds from one to
/// another. Every level has the tiles at exactly its scale. Const members are safe to call concurrently.
class Exemplar {
 public:
  /// @param images  at least one, with the same maps each
  /// @throw UsageError if all weights of the maps there are are 0
  explicit Exemplar(const std::vector<ExemplarMaps>& images, const ChannelWeights& weights = {});
  /// Plain images from texels in memory, row-major, row 0 at the top: R, G, B encoded and height.
  Exemplar(int width, int height, std::vector<Texel> texels);

  static constexpr int minimumSize = 24;  ///< texels a side
  static constexpr int gap = 128;         ///< texels of level 0 between two tiles, at least

  int tileCount() const { return static_cast<int>(tiles_.size()); }
  /// The tile a coordinate of level 0 belongs to.
  int tileAt(const Vec2f& uv) const {
    int tile = 0;
    while (tile + 1 < tileCount() && uv.x() >= tiles_[static_cast<std::size_t>(tile) + 1].from) ++tile;
    return tile;
  }
  const Vec2i& tileSize(int tile, int level = 0) const { return tileOf(tile).texels.size(level); }
  /// Where a tile's first texel begins, in texels of the level.
  Vec2i tileOrigin(int tile, int level = 0) const { return {tileOf(tile).origin >> level, 0}; }
  /// The smaller of all widths, and of all heights.
  const Vec2i& smallestSize() const { return smallestSize_; }

  /// Whether a coordinate of level 0 lies in the image of its tile.
  bool holds(const Vec2f& uv) const {
    const int tile = tileAt(uv);
    const Vec2f p = uv - tileOrigin(tile).cast<float>();
    return p.minCoeff() >= 0.0f && (p.array() <= tileSize(tile).cast<float>().array()).all();
  }
  /// Moves a coordinate of level 0 so that it is at least `margin` texels inside the image of its tile, or in its
  /// middle where that is smaller.
  Vec2f clampInside(const Vec2f& uv, float margin) const {
    const int tile = tileAt(uv);
    const Vec2f origin = tileOrigin(tile).cast<float>(), size = tileSize(tile).cast<float>();
    const Vec2f inset = (0.5f * size).cwiseMin(margin);
    return origin + (uv - origin).cwiseMax(inset).cwiseMin(size - inset);
  }
  struct Place {
    int tile;
    Vec2f st;  ///< in [0, 1]^2 of the tile's image, t down; clamped
  };
  Place normalised(const Vec2f& uv) const;

  bool hasHeight() const { return hasHeight_; }
  bool hasAlpha() const { return alphaSlot_ >= 0; }
  bool hasEmission() const { return emissionSlot_ >= 0; }
  /// Whether `addOtherMaps` adds anything.
  bool hasOtherMaps() const { return otherChannels_ > 0; }
  /// How maps become texels.
  const AppearanceSpace& space() const { return space_; }

  /// Pyramid levels: as many as the smallest tile has until a side is under twice `minimumSize`.
  int levelCount() const { return tiles_[0].texels.levelCount(); }
  /// Texels of one tile, in coordinates of its own.
  const TexelPyramid& texels(int tile) const { return tileOf(tile).texels; }

  /// Texel at a place by Catmull-Rom interpolation; coordinates in texels of that level.
  Texel sample(int level, const Vec2f& uv) const {
    Vec2f local;
    return tileUnder(level, uv, local).texels.sample(level, local);
  }
  /// The same, with the derivatives per texel of that level.
  Texel sample(int level, const Vec2f& uv, Texel& du, Texel& dv) const {
    Vec2f local;
    return tileUnder(level, uv, local).texels.sample(level, local, du, dv);
  }

  /// The mean of the colour (encoded R, G, B) and the height under a footprint `width` texels wide; see
  /// TexelPyramid::sampleFiltered. @param uv  texels of level 0
  Texel sampleFiltered(const Vec2f& uv, float width) const {
    Vec2f local;
    const Tile& tile = tileUnder(0, uv, local);
    return (tile.colour ? *tile.colour : tile.texels).sampleFiltered(local, width);
  }
  /// The mean of the same over all images, and the least and greatest of each channel.
  const Texel& meanShown() const { return meanShown_; }
  const Texel& leastShown() const { return leastShown_; }
  const Texel& greatestShown() const { return greatestShown_; }
  /// Adds `weight` times the means of the other maps under that footprint.
  void addOtherMaps(const Vec2f& uv, float width, float weight, OtherMaps& sum) const;
  /// What means of maps stand for. @param colour  as of `sampleFiltered`
  ExemplarSample decode(const Texel& colour, const OtherMaps& others) const;
  /// Scene-linear colour of a texel: exact in the plain case, else the nearest that the texel's components can say.
  Vec3f linearColour(const Texel& texel) const { return ebru::linearColour(space_.unproject(texel)); }

  /// Standard deviation over the images, which errors are relative to. Plain: root mean square of the channels R, G, B;
  /// else root of a third of the summed variance of the four components.
  float contrast() const { return contrast_; }

 private:
  struct Tile {
    int origin;                          ///< u of its first texel, level 0
    float from;                          ///< u where the coordinates begin that belong to it, level 0
    TexelPyramid texels;
    std::optional<TexelPyramid> colour;  ///< encoded R, G, B and height, where the texels are something else
    std::vector<TexelPyramid> others;    ///< four channels each, in the order of the slots
  };
  const Tile& tileOf(int tile) const { return tiles_[static_cast<std::size_t>(tile)]; }
  /// The tile a coordinate of a level belongs to. @param local  the coordinate from its origin on
  const Tile& tileUnder(int level, const Vec2f& uv, Vec2f& local) const {
    if (tiles_.size() == 1) {
      local = uv;
      return tiles_[0];
    }
    const Tile& tile = tileOf(tileAt(uv * static_cast<float>(1 << level)));
    local = {uv.x() - static_cast<float>(tile.origin >> level), uv.y()};
    return tile;
  }
  void assignSlots(const ExemplarMaps& maps);
  std::vector<Texel> otherMaps(const ExemplarMaps& maps, std::size_t plane) const;
  float channel(const OtherMaps& others, int slot) const {
    return others[static_cast<std::size_t>(slot / 4)][slot % 4];
  }
  void placeTiles();
  void measure();

  std::vector<Tile> tiles_;
  AppearanceSpace space_;
  Vec2i smallestSize_ = Vec2i::Zero();
  bool hasHeight_ = false;
  int otherChannels_ = 0;
  int roughnessSlot_ = -1, alphaSlot_ = -1, emissionSlot_ = -1;  ///< channels of OtherMaps; -1 without such a map
  float contrast_ = 0.0f;
  Texel meanShown_ = Texel::Zero(), leastShown_ = Texel::Zero(), greatestShown_ = Texel::Zero();
};

}  // namespace ebru
