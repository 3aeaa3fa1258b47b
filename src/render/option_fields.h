#pragma once

/// Short ways to write the `fields` tables of the renderer's options.

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/options.h"

namespace ebru {

/// Lengths (metres) and amounts of light (radiance) beyond these are mistakes; up to them the squares of what
/// is computed, and sums of them, stay within what floats can hold.
constexpr double mostWorld = 1e9, mostLight = 1e9;

inline OptionField optionField(std::string key, OptionTarget target, std::string unit, std::string help,
                               double lower = -std::numeric_limits<double>::infinity(),
                               double upper = std::numeric_limits<double>::infinity()) {
  OptionField result;
  result.key = std::move(key);
  result.target = target;
  result.unit = std::move(unit);
  result.help = std::move(help);
  result.lower = lower;
  result.upper = upper;
  return result;
}

inline OptionField optionChoice(std::string key, std::string* target, std::string help,
                                std::vector<std::string> choices) {
  OptionField result = optionField(std::move(key), target, "", std::move(help));
  result.choices = std::move(choices);
  return result;
}

}  // namespace ebru
