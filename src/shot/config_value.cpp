#include "shot/config_value.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <fstream>
#include <sstream>

#include "core/error.h"

namespace ebru {
namespace {

ConfigValue fromNode(const toml::node& node, const std::string& file) {
  ConfigValue value;
  value.where = fmt::format("{}:{}", file, node.source().begin.line);
  if (const auto* table = node.as_table()) {
    value.kind = ConfigValue::Kind::table;
    for (const auto& [key, child] : *table) {
      ConfigValue item = fromNode(child, file);
      item.key = std::string(key.str());
      // A table's own line is that of its header, which is what the reader looks for.
      if (!child.is_table() && key.source().begin.line > 0)
        item.where = fmt::format("{}:{}", file, key.source().begin.line);
      value.items.push_back(std::move(item));
    }
  } else if (const auto* array = node.as_array()) {
    value.kind = ConfigValue::Kind::array;
    for (const toml::node& child : *array) value.items.push_back(fromNode(child, file));
  } else if (const auto* boolean = node.as_boolean()) {
    value.kind = ConfigValue::Kind::boolean;
    value.boolean = boolean->get();
  } else if (const auto* integer = node.as_integer()) {
    value.kind = ConfigValue::Kind::integer;
    value.integer = integer->get();
  } else if (const auto* floating = node.as_floating_point()) {
    value.kind = ConfigValue::Kind::floating;
    value.floating = floating->get();
  } else if (const auto* string = node.as_string()) {
    value.kind = ConfigValue::Kind::string;
    value.text = string->get();
  } else {
    std::ostringstream printed;
    printed << toml::node_view<const toml::node>(node);
    value.text = printed.str();
  }
  return value;
}

}  // namespace

const ConfigValue* ConfigValue::find(const std::string& name) const {
  for (const ConfigValue& item : items)
    if (kind == Kind::table && item.key == name) return &item;
  return nullptr;
}

ConfigValue* ConfigValue::find(const std::string& name) {
  return const_cast<ConfigValue*>(std::as_const(*this).find(name));
}

std::string ConfigValue::kindName() const {
  switch (kind) {
    case Kind::boolean: return "boolean";
    case Kind::integer: return "integer";
    case Kind::floating: return "float";
    case Kind::string: return "string";
    case Kind::array: return "array";
    case Kind::table: return "table";
    case Kind::other: return "date or time";
  }
  return {};
}

std::string ConfigValue::print() const {
  switch (kind) {
    case Kind::boolean: return boolean ? "true" : "false";
    case Kind::integer: return fmt::format("{}", integer);
    case Kind::floating: return fmt::format("{}", floating);
    case Kind::string: return fmt::format("\"{}\"", text);
    case Kind::table: return "a table";
    case Kind::other: return text;
    case Kind::array: break;
  }
  std::string printed;
  for (const ConfigValue& item : items) printed += (printed.empty() ? "" : ", ") + item.print();
  return "[" + printed + "]";
}

ConfigValue readConfig(const std::filesystem::path& file) {
  std::error_code failed;
  if (!std::filesystem::exists(file, failed))
    throw UsageError(fmt::format("{}: no such shot file", file.string()));
  if (std::filesystem::is_directory(file, failed))
    throw UsageError(fmt::format("{}: got a folder, expected a shot file (.toml)", file.string()));
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  if (!stream) throw UsageError(fmt::format("{}: the shot file cannot be read", file.string()));
  try {
    return fromNode(toml::parse(content.str(), file.string()), file.string());
  } catch (const toml::parse_error& error) {
    throw UsageError(fmt::format("{}:{}: not TOML: {}", file.string(), error.source().begin.line,
                                 error.description()));
  }
}

ConfigValue parseOverrideValue(const std::string& text) {
  ConfigValue value;
  try {
    const toml::table parsed = toml::parse("value = " + text);
    if (parsed.size() == 1) value = fromNode(*parsed.get("value"), "");
  } catch (const toml::parse_error&) {
    // Not TOML: the shell has eaten the quotes of a string.
  }
  if (value.kind == ConfigValue::Kind::other) {
    value.kind = ConfigValue::Kind::string;
    value.text = text;
  }
  value.override = text;
  return value;
}

}  // namespace ebru
