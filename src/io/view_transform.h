#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "io/output_options.h"

namespace ebru {

/// From scene-linear colour of Rec. 709 primaries to what a display is sent. Immutable, safe from any thread.
class ViewTransform {
 public:
  virtual ~ViewTransform() = default;
  /// In place. @param rgb  3 values per pixel, without exposure; afterwards encoded for the display, 1 the
  /// brightest it shows (not clamped: a configuration may say more)
  virtual void apply(float* rgb, std::size_t pixels) const = 0;
};

/// The OpenColorIO configuration that previews go through: output.ocio_config, or what the environment
/// variable OCIO names. Empty where the options choose a curve of ebru's own, or nothing is named and they
/// leave the choice.
std::filesystem::path ocioConfigInUse(const OutputOptions& options);

/// What output.view chooses: the filmic curve (io/filmic_curve.h) or clipping, both then encoded as sRGB, or
/// OpenColorIO.
/// @throw UsageError if ocio is asked for and no configuration is named, or the configuration lacks the
/// display, view or colour space (it says what there is); InputError if it cannot be read
std::unique_ptr<ViewTransform> makeViewTransform(const OutputOptions& options);

}  // namespace ebru
