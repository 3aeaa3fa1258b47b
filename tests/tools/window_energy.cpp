/// Measures how much the texture of a picture looks like its exemplar (tests/likeness/window_energy.h).
///
///     window_energy PICTURE.exr EXEMPLAR.png TEXEL_SIZE [--windows N] [--window SIDE] [--seed N]
///
/// TEXEL_SIZE: width of an exemplar texel on the surface, metres. Prints JSON. Ends with 1 if the picture has no place for
/// a window, 2 if a file cannot be read.

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "io/exr_file.h"
#include "likeness/window_energy.h"

namespace {

int usage() {
  std::fprintf(stderr,
               "usage: window_energy PICTURE.exr EXEMPLAR.png TEXEL_SIZE [--windows N] [--window SIDE] [--seed N]\n");
  return 2;
}

void print(const ebru::likeness::WindowEnergy& e, const ebru::likeness::EnergyOptions& options) {
  fmt::print(
      "{{\n  \"energy\": {:.4f},\n  \"energy_floor\": {:.4f},\n  \"energy_ratio\": {:.4f},\n  \"contrast\": {:.4f},\n"
      "  \"windows\": {},\n  \"window_texels\": {},\n  \"pixel_texels\": {:.3f},\n  \"mirrored\": {},\n"
      "  \"definition\": \"mean RMS distance of tangent-plane windows to their nearest exemplar window, over the standard "
      "deviation of the exemplar; floor: of the exemplar itself on a plane; luma is the mean of albedo's channels, encoded "
      "sRGB; windows where texture.mask is 1, the surface faces the camera and one pixel is at most 1.25 texels\"\n}}\n",
      e.energy, e.floor, e.ratio, e.contrast, e.windows, options.side, e.pixelTexels, e.mirrored);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4 || argc % 2 != 0) return usage();
  ebru::likeness::EnergyOptions options;
  for (int i = 4; i < argc; i += 2) {
    const std::string name = argv[i];
    const int value = std::atoi(argv[i + 1]);
    if (name == "--windows" && value > 0)
      options.windows = value;
    else if (name == "--window" && value >= 5 && value % 2 == 1)
      options.side = value;
    else if (name == "--seed" && value >= 0)
      options.seed = static_cast<std::uint64_t>(value);
    else
      return usage();
  }
  const double texelSize = std::atof(argv[3]);
  if (!(texelSize > 0.0)) return usage();
  try {
    const ebru::Exemplar exemplar(argv[2], {});
    const auto energy = ebru::likeness::windowEnergy(ebru::readExr(argv[1]), exemplar, texelSize, options);
    print(energy, options);
    if (energy.windows > 0) return 0;
    std::fprintf(stderr, "%s: no place for a window of %d texels\n", argv[1], options.side);
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[1], error.what());
    return 2;
  }
}
