#pragma once

/// What a shot file says, before it is matched with the option structs. Keeps the TOML library in one .cpp file.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace ebru {

struct ConfigValue {
  enum class Kind { boolean, integer, floating, string, array, table, other };

  Kind kind = Kind::other;
  bool boolean = false;
  std::int64_t integer = 0;
  double floating = 0.0;
  std::string text;                ///< of a string; of `other`, its printed form
  std::vector<ConfigValue> items;  ///< of an array in order; of a table in the order of the file

  std::string key;       ///< in its table; empty for elements of an array
  std::string where;     ///< "shot.toml:12" or "--set render.spp=4", for messages
  std::string override;  ///< what stood behind the "=" of --set, verbatim; empty for a value of the file

  /// The entry of a table, or null.
  const ConfigValue* find(const std::string& name) const;
  ConfigValue* find(const std::string& name);
  /// "integer", "array", ...; for messages.
  std::string kindName() const;
  /// The value as one would type it; arrays in brackets, tables as "a table".
  std::string print() const;
};

/// @throw UsageError "file:line: ..." if it cannot be read or is not TOML
ConfigValue readConfig(const std::filesystem::path& file);

/// The text behind the "=" of an override as a TOML value; a text that is none becomes a string.
ConfigValue parseOverrideValue(const std::string& text);

}  // namespace ebru
