#pragma once

#include <vector>

#include "exemplar/exemplar_maps.h"
#include "exemplar/texel_pyramid.h"

namespace ebru {

/// How much differences of a map count in synthesis: factors on its channels, not negative.
struct ChannelWeights {
  float colour = 1.0f, height = 1.0f, roughness = 1.0f, alpha = 1.0f, emission = 1.0f;
};

/// What synthesis compares: all maps of the exemplar reduced to the four channels of a texel.
///
/// A place's feature vector holds its weighted maps: R, G, B encoded, height, roughness, alpha, and the emission, x / (1 + x)
/// of it encoded with the sRGB curve, so that brightness is bounded. The vectors of all images together are projected onto
/// their four principal components [Lefebvre and Hoppe 2006, "Appearance-Space Texture Synthesis", sec. 3; there the
/// vectors are neighbourhoods, here single places, since windows of texels are compared later], so that synthesis costs
/// the same for any number of maps. Distances of texels are those of weighted feature vectors as far as four components
/// reach.
///
/// Where only colour and height count, and count 1, the texel is R, G, B, height itself: `isPlain`.
/// Const members are safe to call concurrently.
class AppearanceSpace {
 public:
  /// The plain one.
  AppearanceSpace() = default;
  /// @param images  with the same maps each. @throw UsageError if no map there is counts
  AppearanceSpace(const std::vector<ExemplarMaps>& images, const ChannelWeights& weights);

  bool isPlain() const { return plain_; }
  /// Part of the feature vectors' variance that the texels have, 0 to 1.
  float varianceKept() const { return varianceKept_; }

  /// The texel of a place. @param pixel  index into the maps
  Texel project(const ExemplarMaps& maps, std::size_t pixel) const;
  /// R, G, B encoded and height of a texel, by the transposed projection: the nearest that the components can say. A map
  /// that does not count comes out as its mean.
  Texel unproject(const Texel& texel) const;
  /// The same for a difference of texels.
  Texel unprojectDifference(const Texel& difference) const;

 private:
  static constexpr int channels = 9;
  using Features = Eigen::Matrix<float, channels, 1>;
  static Features featuresOf(const ExemplarMaps& maps, std::size_t pixel);
  void analyse(const std::vector<ExemplarMaps>& images);

  bool plain_ = true;
  float varianceKept_ = 1.0f;
  Features weights_ = Features::Zero();  ///< 0 for a map that is not there
  Features mean_ = Features::Zero();     ///< of the features before weighting
  Eigen::Matrix<float, 4, channels> projection_ = Eigen::Matrix<float, 4, channels>::Zero();  ///< of weighted features
  Eigen::Matrix4f back_ = Eigen::Matrix4f::Zero();  ///< texel to R, G, B, height, without the mean
};

}  // namespace ebru
