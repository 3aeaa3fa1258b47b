#pragma once

/// One options struct per stage is the only home of its defaults. Each offers
///     OptionFields fields(SomeOptions&);
/// from which the shot file is read and checked, `ebru options` prints its reference, and the EXR header and the
/// fingerprint are written: none of them can drift from the struct.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>
#include <vector>

namespace ebru {

/// What a field is stored in; the type decides what the shot file may say.
using OptionTarget = std::variant<bool*, int*, double*, std::string*, std::array<int, 2>*, std::array<double, 2>*,
                                  std::array<double, 3>*, std::vector<std::string>*>;

struct OptionField {
  std::string key;     ///< name in the shot file, without its table
  OptionTarget target;
  std::string unit = {};  ///< "m", "px", "1/s", ...; empty for none
  std::string help = {};  ///< one sentence, with its citation where it has one
  double lower = -std::numeric_limits<double>::infinity();  ///< inclusive, per component
  double upper = std::numeric_limits<double>::infinity();   ///< inclusive, per component
  std::vector<std::string> choices = {};  ///< if not empty, the strings allowed
  bool required = false;             ///< the shot file has to say it
  bool path = false;                 ///< a file name, relative to the shot file
};

using OptionFields = std::vector<OptionField>;

}  // namespace ebru
