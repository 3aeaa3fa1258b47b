#include "shot/option_binding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "shot/spelling.h"

namespace ebru {
namespace {

using Kind = ConfigValue::Kind;

std::string printNumber(int value) { return fmt::format("{}", value); }
std::string printNumber(double value) {
  const std::string shortest = fmt::format("{}", value);
  const bool integral = shortest.find_first_not_of("-0123456789") == std::string::npos;
  return integral ? shortest + ".0" : shortest;
}
std::string printString(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    else
      quoted += c;
  }
  return quoted + "\"";
}

std::string withUnit(std::string text, const std::string& unit) {
  return unit.empty() ? text : std::move(text) + " " + unit;
}

/// Binds one value to one field; `problem` is set to what is wrong, without the place.
class FieldBinder {
 public:
  FieldBinder(const OptionField& field, const ConfigValue& value, const std::filesystem::path& folder)
      : field_(field), value_(value), folder_(folder) {}

  std::optional<std::string> bind() {
    std::visit([this](auto* target) { set(*target); }, field_.target);
    return problem_;
  }

 private:
  void typeProblem() {
    problem_ = fmt::format("got {} ({}), expected {}", value_.print(), value_.kindName(),
                           optionTypeName(field_.target));
  }

  void set(bool& target) {
    if (value_.kind != Kind::boolean) return typeProblem();
    target = value_.boolean;
  }
  void set(int& target) {
    if (const auto number = readInt(value_)) target = *number;
  }
  void set(double& target) {
    if (const auto number = readDouble(value_)) target = *number;
  }
  void set(std::string& target) {
    if (const auto text = readString(value_)) target = *text;
  }
  template <std::size_t N>
  void set(std::array<int, N>& target) {
    setArray(target, [this](const ConfigValue& item) { return readInt(item); });
  }
  template <std::size_t N>
  void set(std::array<double, N>& target) {
    setArray(target, [this](const ConfigValue& item) { return readDouble(item); });
  }
  /// A string alone is a list of one, or of none if it is empty.
  void set(std::vector<std::string>& target) {
    std::vector<std::string> texts;
    const auto read = [&](const ConfigValue& value) {
      const auto text = readString(value);
      if (text && (!text->empty() || value_.kind == Kind::array)) texts.push_back(*text);
      return text.has_value();
    };
    if (value_.kind != Kind::array) {
      if (!read(value_)) return;
    } else if (!std::all_of(value_.items.begin(), value_.items.end(), read)) {
      return;
    }
    if (texts.empty() && field_.required)
      problem_ = fmt::format("got {}, expected at least one", value_.print());
    else
      target = texts;
  }

  template <class Array, class Read>
  void setArray(Array& target, const Read& read) {
    if (value_.kind != Kind::array || value_.items.size() != target.size()) return typeProblem();
    Array numbers;
    for (std::size_t i = 0; i < target.size(); ++i) {
      const auto number = read(value_.items[i]);
      if (!number) return;
      numbers[i] = *number;
    }
    target = numbers;
  }

  std::optional<int> readInt(const ConfigValue& value) {
    if (value.kind != Kind::integer) {
      typeProblem();
      return {};
    }
    if (!inRange(static_cast<double>(value.integer))) return {};
    if (value.integer < std::numeric_limits<int>::min() || value.integer > std::numeric_limits<int>::max()) {
      problem_ = fmt::format("got {}, expected an integer of 32 bits", value.integer);
      return {};
    }
    return static_cast<int>(value.integer);
  }

  std::optional<double> readDouble(const ConfigValue& value) {
    if (value.kind != Kind::integer && value.kind != Kind::floating) {
      typeProblem();
      return {};
    }
    const double number = value.kind == Kind::integer ? static_cast<double>(value.integer) : value.floating;
    if (!std::isfinite(number)) {
      problem_ = fmt::format("got {}, expected a finite number", value.print());
      return {};
    }
    if (!inRange(number)) return {};
    return number;
  }

  bool inRange(double number) {
    if (number >= field_.lower && number <= field_.upper) return true;
    problem_ = fmt::format("got {}, expected {}", withUnit(fmt::format("{}", number), field_.unit),
                           optionRange(field_));
    return false;
  }

  std::optional<std::string> readString(const ConfigValue& value) {
    if (value.kind != Kind::string && value.override.empty()) {
      typeProblem();
      return {};
    }
    const std::string& text = value.kind == Kind::string ? value.text : value.override;
    const auto& choices = field_.choices;
    if (!choices.empty() && std::find(choices.begin(), choices.end(), text) == choices.end()) {
      problem_ = fmt::format("got \"{}\", expected one of {}{}", text, fmt::join(choices, ", "),
                             didYouMean(text, choices));
      return {};
    }
    if (!field_.path || text.empty()) return text;
    return (folder_ / text).lexically_normal().string();
  }

  const OptionField& field_;
  const ConfigValue& value_;
  const std::filesystem::path& folder_;
  std::optional<std::string> problem_;
};

struct Printer {
  std::string operator()(const bool* v) const { return *v ? "true" : "false"; }
  std::string operator()(const int* v) const { return printNumber(*v); }
  std::string operator()(const double* v) const { return printNumber(*v); }
  std::string operator()(const std::string* v) const { return printString(*v); }
  template <class T, std::size_t N>
  std::string operator()(const std::array<T, N>* v) const {
    std::vector<std::string> parts;
    for (const T number : *v) parts.push_back(printNumber(number));
    return fmt::format("[{}]", fmt::join(parts, ", "));
  }
  std::string operator()(const std::vector<std::string>* v) const {
    std::vector<std::string> parts;
    for (const std::string& text : *v) parts.push_back(printString(text));
    return fmt::format("[{}]", fmt::join(parts, ", "));
  }
};

}  // namespace

void bindTable(const OptionFields& fields, const ConfigValue* table, const std::string& name,
               const std::filesystem::path& file, const std::filesystem::path& folder,
               std::vector<std::string>& problems) {
  std::vector<std::string> keys;
  for (const OptionField& field : fields) keys.push_back(field.key);
  if (table) {
    for (const ConfigValue& item : table->items)
      if (std::find(keys.begin(), keys.end(), item.key) == keys.end())
        problems.push_back(
            fmt::format("{}: unknown key {}.{}{}", item.where, name, item.key, didYouMean(item.key, keys)));
  }
  for (const OptionField& field : fields) {
    const ConfigValue* value = table ? table->find(field.key) : nullptr;
    if (value) {
      if (const auto problem = FieldBinder(field, *value, folder).bind())
        problems.push_back(fmt::format("{}: {}.{}: {}", value->where, name, field.key, *problem));
    } else if (field.required) {
      problems.push_back(fmt::format("{}: {}.{} is missing: {}", table ? table->where : file.string(), name,
                                     field.key, field.help));
    }
  }
}

std::string printOption(const OptionTarget& target) {
  return std::visit(Printer(), target);
}

std::string optionTypeName(const OptionTarget& target) {
  struct Name {
    std::string operator()(const bool*) const { return "true or false"; }
    std::string operator()(const int*) const { return "integer"; }
    std::string operator()(const double*) const { return "float"; }
    std::string operator()(const std::string*) const { return "string"; }
    std::string operator()(const std::array<int, 2>*) const { return "2 integers"; }
    std::string operator()(const std::array<double, 2>*) const { return "2 floats"; }
    std::string operator()(const std::array<double, 3>*) const { return "3 floats"; }
    std::string operator()(const std::vector<std::string>*) const { return "string or list of strings"; }
  };
  return std::visit(Name(), target);
}

std::string optionRange(const OptionField& field) {
  const bool hasLower = std::isfinite(field.lower), hasUpper = std::isfinite(field.upper);
  if (hasLower && hasUpper) return withUnit(fmt::format("{} to {}", field.lower, field.upper), field.unit);
  if (hasLower) return withUnit(fmt::format("at least {}", field.lower), field.unit);
  if (hasUpper) return withUnit(fmt::format("at most {}", field.upper), field.unit);
  return {};
}

}  // namespace ebru
