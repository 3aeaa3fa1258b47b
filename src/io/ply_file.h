#pragma once

/// Reading PLY files [Turk 1994]: ascii, binary little- and big-endian; any elements, any properties.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace ebru {

/// One property of an element: a column of numbers. Every scalar type of the format fits a double exactly.
struct PlyProperty {
  std::string name;
  bool isList = false;
  std::vector<double> values;  ///< one per record; of lists, those of all records one after another
  std::vector<std::size_t>
      first;  ///< lists only, records + 1: values[first[i]] to values[first[i + 1]] are record i's
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;  ///< of records
  std::vector<PlyProperty> properties;

  /// Null if there is none of that name.
  const PlyProperty* find(const std::string& property) const;
  /// `x y z`, for messages.
  std::string propertyNames() const;
};

struct PlyFile {
  std::string format;  ///< `ascii`, `binary_little_endian` or `binary_big_endian`
  std::vector<PlyElement> elements;

  const PlyElement* find(const std::string& element) const;
  /// `vertex (40000: x y z), face (39601: vertex_indices)`, for messages.
  std::string description() const;
};

/// Whether the values of a property are to be kept; those of others are passed over and stay empty.
using PlyWanted = std::function<bool(const std::string& element, const std::string& property)>;

/// Reads a whole file. What follows the last record is left alone. Safe to call concurrently.
/// @param wanted  empty: everything
/// @throw InputError if it is missing, no PLY file, of another version, ends early, or holds something that
/// is no number
PlyFile readPly(const std::filesystem::path& path, const PlyWanted& wanted = {});

/// The header alone: elements and properties without values. @throw InputError as readPly, of the header
PlyFile readPlyHeader(const std::filesystem::path& path);

}  // namespace ebru
