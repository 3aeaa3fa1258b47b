#pragma once

#include <memory>

#include "exemplar/exemplar.h"
#include "texturing/texture_options.h"

namespace ebru {

/// The exemplar that the options name, with its maps and weights.
/// @throw UsageError, InputError as readExemplarMaps and Exemplar
std::shared_ptr<const Exemplar> openExemplar(const TextureOptions& options);

}  // namespace ebru
