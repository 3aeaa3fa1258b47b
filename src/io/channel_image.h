#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/vec.h"

namespace ebru {

enum class ChannelType { half, float32 };

/// A picture as named planes plus header attributes: what an EXR file holds.
struct ChannelImage {
  struct Channel {
    std::string name;  ///< as in the file: "R", "forward.u"
    ChannelType type = ChannelType::half;
    std::vector<float> data;  ///< width * height, row-major, row 0 at the top
  };
  struct Rational {
    int numerator = 0;
    unsigned denominator = 1;
  };
  using Attribute =
      std::variant<std::string, int, float, Rational, Mat4d>;  ///< Mat4d is written as m44f, row vectors

  int width = 0, height = 0;
  std::vector<Channel> channels;
  std::vector<std::pair<std::string, Attribute>> attributes;

  /// Adds a plane of width * height zeros. References to other channels are invalidated. @throw BugError on a
  /// name that is there already
  Channel& add(std::string name, ChannelType type);
  /// Null if there is none.
  const Channel* find(std::string_view name) const;
  const Attribute* attribute(std::string_view name) const;
};

}  // namespace ebru
