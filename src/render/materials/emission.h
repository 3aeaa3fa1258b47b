#pragma once

#include <vector>

#include "render/materials/material_options.h"
#include "texturing/texture_field.h"

namespace ebru {

/// The light that the fluid gives off, as its texture says: the emission map's own radiance, or the glow of a
/// body that is as hot as one of the texture's maps says. Const members are safe to call concurrently.
class Emission {
 public:
  /// @param texture  of the fluid; null: nothing glows. A map that it does not have gives off nothing
  Emission(const MaterialOptions& options, const TextureField* texture);

  /// Whether anything may glow.
  bool any() const { return kind_ != Kind::none; }
  /// Radiance, scene-linear. @param sample  valid
  Vec3f at(const TextureSample& sample) const;

 private:
  enum class Kind { none, texture, blackBody };
  enum class Source { emission, height, colour };
  /// How far the temperature is from the first of the two to the second, in [0, 1].
  float heat(const TextureSample& sample) const;

  Kind kind_ = Kind::none;
  Source source_ = Source::emission;
  float strength_ = 1.0f;
  std::vector<Vec3f> glow_;  ///< of a black body, at even steps of the temperature
};

}  // namespace ebru
