#include "io/view_transform.h"

#include <algorithm>
#include <cstdlib>

#include "core/error.h"
#include "io/filmic_curve.h"
#include "io/ocio_view.h"
#include "io/srgb.h"

namespace ebru {
namespace {

class FilmicView : public ViewTransform {
 public:
  void apply(float* rgb, std::size_t pixels) const override {
    for (std::size_t i = 0; i < pixels; ++i) {
      const Vec3f colour = filmicColour(curve_, {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]});
      for (std::size_t c = 0; c < 3; ++c) rgb[3 * i + c] = srgbFromLinear(colour[static_cast<int>(c)]);
    }
  }

 private:
  FilmicCurve curve_;
};

class ClippedView : public ViewTransform {
 public:
  void apply(float* rgb, std::size_t pixels) const override {
    for (std::size_t i = 0; i < 3 * pixels; ++i)
      rgb[i] = rgb[i] > 0.0f ? srgbFromLinear(std::min(rgb[i], 1.0f)) : 0.0f;
  }
};

}  // namespace

std::filesystem::path ocioConfigInUse(const OutputOptions& options) {
  if (options.view != "auto" && options.view != "ocio") return {};
  if (!options.ocio_config.empty()) return options.ocio_config;
  const char* named = std::getenv("OCIO");
  return named ? named : "";
}

std::unique_ptr<ViewTransform> makeViewTransform(const OutputOptions& options) {
  const std::filesystem::path config = ocioConfigInUse(options);
  if (!config.empty()) return makeOcioView(options, config);
  if (options.view == "ocio")
    throw UsageError(
        "output.view: got \"ocio\" and no configuration, expected one; name it with output.ocio_config or "
        "the "
        "environment variable OCIO");
  if (options.view == "srgb") return std::make_unique<ClippedView>();
  return std::make_unique<FilmicView>();
}

}  // namespace ebru
