#include "render/materials/emission.h"

#include <algorithm>

#include "render/colorimetry.h"
#include "render/materials/black_body.h"

namespace ebru {
namespace {

/// Fine enough to interpolate what grows like exp(-1 / T).
constexpr std::size_t glowSteps = 256;

/// Relative to the luminance at the higher temperature, which becomes `strength`.
std::vector<Vec3f> makeGlow(const std::array<double, 2>& kelvin, double strength) {
  const double scale = strength / blackBodyXyz(std::max(kelvin[0], kelvin[1])).y();
  std::vector<Vec3f> result;
  for (std::size_t i = 0; i <= glowSteps; ++i) {
    const double heat = static_cast<double>(i) / glowSteps;
    const Vec3d colour = blackBodyRec709(kelvin[0] + heat * (kelvin[1] - kelvin[0]));
    result.push_back((scale * colour).cast<float>());
  }
  return result;
}

}  // namespace

Emission::Emission(const MaterialOptions& options, const TextureField* texture)
    : source_(options.emission_source == "height"   ? Source::height
              : options.emission_source == "colour" ? Source::colour
                                                    : Source::emission),
      strength_(static_cast<float>(options.emission_strength)) {
  if (!texture || options.emission == "none" || !(strength_ > 0.0f)) return;
  const TextureMaps maps = texture->maps();
  const bool blackBody = options.emission == "blackbody";
  const bool hasMap = !blackBody || source_ == Source::emission ? maps.emission
                      : source_ == Source::height               ? maps.height
                                                                : true;
  if (!hasMap) return;
  kind_ = blackBody ? Kind::blackBody : Kind::texture;
  if (blackBody) glow_ = makeGlow(options.emission_temperature, options.emission_strength);
}

Vec3f Emission::at(const TextureSample& sample) const {
  if (kind_ == Kind::none) return Vec3f::Zero();
  if (kind_ == Kind::texture) return strength_ * sample.emission;
  const float x = heat(sample) * static_cast<float>(glowSteps);
  const std::size_t i = std::min(static_cast<std::size_t>(x), glowSteps - 1);
  return glow_[i] + (x - static_cast<float>(i)) * (glow_[i + 1] - glow_[i]);
}

float Emission::heat(const TextureSample& sample) const {
  const float value = source_ == Source::height   ? 1.0f - sample.displacement
                      : source_ == Source::colour ? luminanceRec709(sample.colour)
                                                  : sample.emission.mean();
  return std::clamp(value, 0.0f, 1.0f);
}

}  // namespace ebru
