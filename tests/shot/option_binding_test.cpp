#include "shot/option_binding.h"

#include <gtest/gtest.h>

#include "shot/options_reference.h"
#include "shot/shot_tables.h"

namespace ebru {
namespace {

TEST(OptionBinding, PrintsWhatReadsBackToTheSameBits) {
  for (double number : {0.1, 1.0, -3.0, 1e-9, 1e300, 123456789.123456789}) {
    const std::string text = printOption(&number);
    const ConfigValue value = parseOverrideValue(text);
    ASSERT_EQ(value.kind, ConfigValue::Kind::floating) << text;
    EXPECT_EQ(value.floating, number) << text;
  }
  std::string quoted = "a \"b\" \\ c\n";
  EXPECT_EQ(parseOverrideValue(printOption(&quoted)).text, quoted);
  std::array<int, 2> size{640, 360};
  EXPECT_EQ(printOption(&size), "[640, 360]");
}

/// What texture.exemplar = `text` gives, or the problem.
std::vector<std::string> boundList(const std::string& text, bool required = true) {
  std::vector<std::string> files = {"default"}, problems;
  ConfigValue table;
  table.kind = ConfigValue::Kind::table;
  table.where = "dam.toml:1";
  table.items.push_back(parseOverrideValue(text));
  table.items.back().key = "files";
  table.items.back().where = "dam.toml:2";
  bindTable({{.key = "files", .target = &files, .required = required, .path = true}}, &table, "texture", "dam.toml", "/shots",
            problems);
  return problems.empty() ? files : problems;
}

TEST(OptionBinding, AStringAloneIsAListOfOne) {
  using Files = std::vector<std::string>;
  EXPECT_EQ(boundList("\"a.png\""), Files{"/shots/a.png"});
  EXPECT_EQ(boundList("a.png"), Files{"/shots/a.png"}) << "the shell has eaten the quotes";
  EXPECT_EQ(boundList("[\"a.png\", \"../b.png\"]"), (Files{"/shots/a.png", "/b.png"}));
  EXPECT_EQ(boundList("\"\"", false), Files{});
  EXPECT_EQ(boundList("[]", false), Files{});
  EXPECT_EQ(boundList("[]"), Files{"dam.toml:2: texture.files: got [], expected at least one"});
  EXPECT_EQ(boundList("[1]"), Files{"dam.toml:2: texture.files: got [1] (array), expected string or list of strings"});
  std::vector<std::string> files = {"/shots/a \"b\".png", "/c.png"};
  EXPECT_EQ(boundList(printOption(&files)), files) << "printed and read back";
}

TEST(OptionBinding, DefaultsOfEveryOptionLieInTheirRange) {
  Shot shot;
  for (const ShotTable& table : shotTables()) {
    table.resize(shot, 1);
    for (const OptionField& field : table.fields(shot, 0)) {
      EXPECT_FALSE(field.help.empty()) << table.name << "." << field.key;
      if (const auto* number = std::get_if<double*>(&field.target)) {
        EXPECT_GE(**number, field.lower) << table.name << "." << field.key;
        EXPECT_LE(**number, field.upper) << table.name << "." << field.key;
      }
      const auto* text = std::get_if<std::string*>(&field.target);
      if (text && !field.choices.empty()) {
        EXPECT_NE(std::find(field.choices.begin(), field.choices.end(), **text), field.choices.end())
            << table.name << "." << field.key;
      }
    }
  }
}

TEST(OptionBinding, ReferenceNamesEveryTable) {
  const std::string reference = optionsReference();
  for (const char* header : {"`[shot]`", "`[fluid]`", "`[texture]`", "`[camera]`", "`[render]`", "`[[light]]`",
                             "`[ground]`", "`[[obstacle]]`"})
    EXPECT_NE(reference.find(header), std::string::npos) << header;
}

}  // namespace
}  // namespace ebru
