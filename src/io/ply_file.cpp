#include "io/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "core/error.h"

namespace ebru {
namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct TypeName {
  const char* name;
  Type type;
};

constexpr std::array typeNames{
    TypeName{"char", Type::int8},      TypeName{"int8", Type::int8},       TypeName{"uchar", Type::uint8},
    TypeName{"uint8", Type::uint8},    TypeName{"short", Type::int16},     TypeName{"int16", Type::int16},
    TypeName{"ushort", Type::uint16},  TypeName{"uint16", Type::uint16},   TypeName{"int", Type::int32},
    TypeName{"int32", Type::int32},    TypeName{"uint", Type::uint32},     TypeName{"uint32", Type::uint32},
    TypeName{"float", Type::float32},  TypeName{"float32", Type::float32}, TypeName{"double", Type::float64},
    TypeName{"float64", Type::float64}};

std::size_t bytesOf(Type type) {
  switch (type) {
    case Type::int8:
    case Type::uint8:
      return 1;
    case Type::int16:
    case Type::uint16:
      return 2;
    case Type::float64:
      return 8;
    default:
      return 4;
  }
}

/// How a property is stored in the file.
struct Layout {
  Type type = Type::float32;
  Type countType = Type::uint8;  ///< lists only
  bool kept = true;
};

/// A file being read: what the header says, and the place where reading stands.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path.string()) {
    std::ifstream stream(path, std::ios::binary);
    std::error_code failed;
    if (!stream || std::filesystem::is_directory(path, failed))
      refuse("file", stream ? "a folder" : std::strerror(errno), "a PLY file", "check the path");
    std::ostringstream content;
    content << stream.rdbuf();
    data_ = std::move(content).str();
  }

  PlyFile header() {
    PlyFile file;
    std::string line;
    if (!nextLine(line) || line != "ply")
      refuse("magic", "no \"ply\" in the first line", "a PLY file", "check the path");
    for (;;) {
      if (!nextLine(line)) refuse("header", "the end of the file", "end_header", "write the file again");
      if (line == "end_header") break;
      readHeaderLine(line, file);
    }
    if (file.format.empty()) refuse("header", "no line \"format\"", "one", "write the file again");
    ascii_ = file.format == "ascii";
    swapped_ = (file.format == "binary_big_endian") != (std::endian::native == std::endian::big);
    return file;
  }

  void records(PlyFile& file, const PlyWanted& wanted) {
    for (std::size_t e = 0; e < file.elements.size(); ++e) {
      PlyElement& element = file.elements[e];
      std::size_t smallest = 0;  // bytes of a record
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        Layout& layout = layouts_[e][p];
        PlyProperty& property = element.properties[p];
        layout.kept = !wanted || wanted(element.name, property.name);
        smallest += ascii_ ? 1 : bytesOf(property.isList ? layout.countType : layout.type);
      }
      // Before anything is reserved: a damaged count must not ask for more memory than the file explains.
      if (smallest > 0 && element.count > (data_.size() - at_) / smallest)
        refuse(fmt::format("element \"{}\"", element.name),
               fmt::format("{} bytes to the end of the file", data_.size() - at_),
               fmt::format("{} records of at least {}", element.count, smallest),
               "it is cut off: write it again");
      if (element.properties.empty()) continue;
      reserve(element, layouts_[e]);
      for (record_ = 0; record_ < element.count; ++record_)
        for (std::size_t p = 0; p < element.properties.size(); ++p)
          readProperty(element, element.properties[p], layouts_[e][p]);
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& what, const std::string& got, const std::string& expected,
                           const std::string& next) const {
    throw InputError(fmt::format("{}: {}: got {}, expected {}; {}", path_, what, got, expected, next));
  }

  [[noreturn]] void refuseRecord(const PlyElement& element, const PlyProperty& property,
                                 const std::string& got, const std::string& expected) const {
    refuse(fmt::format("{} {} of {}, property \"{}\"", element.name, record_, element.count, property.name),
           got, expected, "write the file again");
  }

  /// Without its end, which may be of Windows. @return false at the end of the file
  bool nextLine(std::string& line) {
    const std::size_t end = data_.find('\n', at_);
    if (end == std::string::npos) return false;
    line = data_.substr(at_, end - at_);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    at_ = end + 1;
    return true;
  }

  Type typeOf(const std::string& name, const std::string& line) const {
    for (const TypeName& known : typeNames)
      if (name == known.name) return known.type;
    refuse("header", fmt::format("type \"{}\" in \"{}\"", name, line),
           "char, uchar, short, ushort, int, uint, float or double", "write the file again");
  }

  void readHeaderLine(const std::string& line, PlyFile& file) {
    std::istringstream words(line);
    std::string keyword, first, second, third, fourth;
    words >> keyword >> first >> second >> third >> fourth;
    if (keyword.empty() || keyword == "comment" || keyword == "obj_info") return;
    if (keyword == "format") {
      if ((first != "ascii" && first != "binary_little_endian" && first != "binary_big_endian") ||
          second != "1.0")
        refuse("header", fmt::format("\"{}\"", line), "ascii, binary_little_endian or binary_big_endian 1.0",
               "write the file in one of these");
      file.format = first;
    } else if (keyword == "element") {
      PlyElement element{first, 0, {}};
      const auto [end, error] = std::from_chars(second.data(), second.data() + second.size(), element.count);
      if (error != std::errc() || end != second.data() + second.size())
        refuse("header", fmt::format("\"{}\"", line), "element NAME COUNT", "write the file again");
      file.elements.push_back(std::move(element));
      layouts_.emplace_back();
    } else if (keyword == "property" && !file.elements.empty()) {
      const bool isList = first == "list";
      const std::string& name = isList ? fourth : second;
      if (name.empty())
        refuse("header", fmt::format("\"{}\"", line), "property TYPE NAME or property list TYPE TYPE NAME",
               "write the file again");
      Layout layout;
      layout.type = typeOf(isList ? third : first, line);
      if (isList) layout.countType = typeOf(second, line);
      file.elements.back().properties.push_back({name, isList, {}, {}});
      layouts_.back().push_back(layout);
    } else {
      refuse("header", fmt::format("\"{}\"", line), "format, element, property or comment",
             "write the file again");
    }
  }

  void reserve(PlyElement& element, const std::vector<Layout>& layouts) const {
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      if (!layouts[p].kept) continue;
      PlyProperty& property = element.properties[p];
      property.values.reserve(property.isList ? 3 * element.count : element.count);
      if (!property.isList) continue;
      property.first.reserve(element.count + 1);
      property.first.push_back(0);
    }
  }

  void readProperty(const PlyElement& element, PlyProperty& property, const Layout& layout) {
    if (!property.isList) {
      const double value = number(element, property, layout.type);
      if (layout.kept) property.values.push_back(value);
      return;
    }
    const double count = number(element, property, layout.countType);
    if (!(count >= 0.0) || count != std::floor(count) || count > static_cast<double>(data_.size() - at_))
      refuseRecord(element, property, fmt::format("a list of {} values", count),
                   "as many as the rest of the file holds");
    for (double i = 0.0; i < count; ++i) {
      const double value = number(element, property, layout.type);
      if (layout.kept) property.values.push_back(value);
    }
    if (layout.kept) property.first.push_back(property.values.size());
  }

  double number(const PlyElement& element, const PlyProperty& property, Type type) {
    return ascii_ ? written(element, property) : stored(element, property, type);
  }

  double written(const PlyElement& element, const PlyProperty& property) {
    constexpr const char* blanks = " \t\r\n\v\f";
    const std::size_t begin = std::min(data_.find_first_not_of(blanks, at_), data_.size());
    const std::size_t end = std::min(data_.find_first_of(blanks, begin), data_.size());
    if (begin == end) refuseRecord(element, property, "the end of the file", "a number");
    at_ = end;
    double value = 0.0;
    // from_chars knows no sign but minus.
    const char* text = data_.data() + begin + (data_[begin] == '+');
    const auto [stop, error] = std::from_chars(text, data_.data() + end, value);
    if (error != std::errc() || stop != data_.data() + end)
      refuseRecord(element, property,
                   fmt::format("\"{}\"", data_.substr(begin, std::min<std::size_t>(end - begin, 40))),
                   "a number");
    return value;
  }

  double stored(const PlyElement& element, const PlyProperty& property, Type type) {
    const std::size_t bytes = bytesOf(type);
    if (data_.size() - at_ < bytes) refuseRecord(element, property, "the end of the file", "a number");
    std::array<char, 8> raw{};
    std::memcpy(raw.data(), data_.data() + at_, bytes);
    if (swapped_) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(bytes));
    at_ += bytes;
    const auto as = [&](auto value) {
      std::memcpy(&value, raw.data(), sizeof(value));
      return static_cast<double>(value);
    };
    switch (type) {
      case Type::int8:
        return as(std::int8_t{});
      case Type::uint8:
        return as(std::uint8_t{});
      case Type::int16:
        return as(std::int16_t{});
      case Type::uint16:
        return as(std::uint16_t{});
      case Type::int32:
        return as(std::int32_t{});
      case Type::uint32:
        return as(std::uint32_t{});
      case Type::float32:
        return as(float{});
      case Type::float64:
        break;
    }
    return as(double{});
  }

  std::string path_;
  std::string data_;
  std::size_t at_ = 0;
  std::size_t record_ = 0;
  std::vector<std::vector<Layout>> layouts_;  ///< [element][property]
  bool ascii_ = false, swapped_ = false;
};

/// Null if there is none of that name.
template <class Item>
const Item* named(const std::vector<Item>& items, const std::string& name) {
  const auto found = std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
  return found == items.end() ? nullptr : &*found;
}

}  // namespace

const PlyProperty* PlyElement::find(const std::string& property) const { return named(properties, property); }

std::string PlyElement::propertyNames() const {
  std::string names;
  for (const PlyProperty& p : properties) names += (names.empty() ? "" : " ") + p.name;
  return names;
}

const PlyElement* PlyFile::find(const std::string& element) const { return named(elements, element); }

std::string PlyFile::description() const {
  std::string text;
  for (const PlyElement& e : elements)
    text += fmt::format("{}{} ({}: {})", text.empty() ? "" : ", ", e.name, e.count, e.propertyNames());
  return text.empty() ? "no elements" : text;
}

PlyFile readPly(const std::filesystem::path& path, const PlyWanted& wanted) {
  Reader reader(path);
  PlyFile file = reader.header();
  reader.records(file, wanted);
  return file;
}

PlyFile readPlyHeader(const std::filesystem::path& path) {
  return Reader(path).header();
}

}  // namespace ebru
