#pragma once

/// The one list of the tables of a shot file. Reading, fingerprints and the reference walk over it.

#include <functional>
#include <string>
#include <vector>

#include "core/options.h"
#include "shot/shot.h"

namespace ebru {

struct ShotTable {
  std::string name;           ///< "texture", "texture.erosion" for a table in it, or "light" for [[light]]
  std::string help;           ///< one sentence for the reference
  bool isArray = false;       ///< [[name]]: any number of them
  enum class Decides {
    states,    ///< the texture's, and the pictures
    view,      ///< pictures, and states of texture that knows what is seen
    pictures,
  };
  Decides decides = Decides::pictures;
  std::vector<std::string> undecided;  ///< keys of it that decide no bit of states and pictures
  /// Makes the array as long as the file's; does nothing for a single table.
  std::function<void(Shot&, std::size_t)> resize;
  std::function<std::size_t(const Shot&)> size;  ///< 1 for a single table
  /// Fields of the element `index`; they point into the shot.
  std::function<OptionFields(Shot&, std::size_t index)> fields;
};

const std::vector<ShotTable>& shotTables();

}  // namespace ebru
