#pragma once

/// Between the option structs (core/options.h) and the text of a shot file.

#include <filesystem>
#include <string>
#include <vector>

#include "core/options.h"
#include "shot/config_value.h"

namespace ebru {

/// Sets the fields of one table from what the file says, and appends one message per problem: unknown key (with the
/// nearest spelling), wrong type, out of range (with the unit), missing. Paths are resolved against `folder`.
/// @param table   null if the file does not have the table
/// @param name    of the table, for messages: "texture", "light.0"
/// @param file    for messages about what is missing
void bindTable(const OptionFields& fields, const ConfigValue* table, const std::string& name,
               const std::filesystem::path& file, const std::filesystem::path& folder,
               std::vector<std::string>& problems);

/// A field's present value in TOML. Reading it back gives the same bits.
std::string printOption(const OptionTarget& target);

/// "float", "3 floats", "string", ...: what the shot file has to say.
std::string optionTypeName(const OptionTarget& target);

/// "0 to 1 m", "at least 1", or empty if every value of the type is allowed.
std::string optionRange(const OptionField& field);

}  // namespace ebru
