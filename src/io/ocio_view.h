#pragma once

#include <filesystem>
#include <memory>

#include "io/output_options.h"
#include "io/view_transform.h"

namespace ebru {

/// The view `ocio_view` on `ocio_display` of an OpenColorIO configuration, through OpenImageIO.
/// Throws as makeViewTransform.
std::unique_ptr<ViewTransform> makeOcioView(const OutputOptions& options,
                                            const std::filesystem::path& config);

}  // namespace ebru
