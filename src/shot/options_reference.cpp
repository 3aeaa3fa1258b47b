#include "shot/options_reference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "shot/option_binding.h"
#include "shot/shot.h"
#include "shot/shot_tables.h"

namespace ebru {
namespace {

std::string allowed(const OptionField& field) {
  if (!field.choices.empty()) return fmt::format("`{}`", fmt::join(field.choices, "`, `"));
  if (field.path && std::holds_alternative<std::vector<std::string>*>(field.target))
    return "file name or list of them, relative to the shot file";
  if (field.path) return "file name, relative to the shot file";
  const std::string range = optionRange(field), type = optionTypeName(field.target);
  if (!range.empty()) return fmt::format("{}, {}", type, range);
  return field.unit.empty() ? type : fmt::format("{}, {}", type, field.unit);
}

/// A bar inside a cell would end it.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

}  // namespace

std::string optionsReference() {
  Shot defaults;
  std::string text;
  for (const ShotTable& table : shotTables()) {
    if (!text.empty()) text += "\n";
    const std::string header = fmt::format(fmt::runtime(table.isArray ? "[[{}]]" : "[{}]"), table.name);
    text += fmt::format("### `{}`\n\n{}\n\n| key | value | default | meaning |\n|---|---|---|---|\n", header,
                        table.help);
    table.resize(defaults, 1);
    for (const OptionField& field : table.fields(defaults, 0))
      text += fmt::format("| `{}` | {} | {} | {} |\n", field.key, cell(allowed(field)),
                          field.required ? "required" : fmt::format("`{}`", printOption(field.target)), cell(field.help));
  }
  return text;
}

}  // namespace ebru
