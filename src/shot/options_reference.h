#pragma once

#include <string>

namespace ebru {

/// The reference of the shot file in Markdown, one table per table, printed from the option structs.
std::string optionsReference();

}  // namespace ebru
