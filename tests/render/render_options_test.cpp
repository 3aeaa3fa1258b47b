#include "render/render_options.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace ebru {
namespace {

std::vector<double> numbers(const OptionTarget& target) {
  if (const auto* v = std::get_if<int*>(&target)) return {double(**v)};
  if (const auto* v = std::get_if<double*>(&target)) return {**v};
  if (const auto* v = std::get_if<std::array<int, 2>*>(&target)) return {double((**v)[0]), double((**v)[1])};
  if (const auto* v = std::get_if<std::array<double, 2>*>(&target)) return {(**v)[0], (**v)[1]};
  if (const auto* v = std::get_if<std::array<double, 3>*>(&target)) return {(**v)[0], (**v)[1], (**v)[2]};
  return {};
}

template <class Options>
void checkTable() {
  Options options;
  std::set<std::string> keys;
  for (const OptionField& field : fields(options)) {
    EXPECT_TRUE(keys.insert(field.key).second) << field.key;
    EXPECT_FALSE(field.help.empty()) << field.key;
    for (const double value : numbers(field.target)) {
      EXPECT_GE(value, field.lower) << field.key;
      EXPECT_LE(value, field.upper) << field.key;
    }
    if (field.choices.empty()) continue;
    const auto* text = std::get_if<std::string*>(&field.target);
    ASSERT_TRUE(text) << field.key;
    EXPECT_EQ(std::count(field.choices.begin(), field.choices.end(), **text), 1) << field.key;
  }
}

TEST(RenderOptions, EveryFieldHasHelpAndADefaultInItsRange) {
  checkTable<CameraOptions>();
  checkTable<CameraKeyOptions>();
  checkTable<RenderOptions>();
  checkTable<MaterialOptions>();
  checkTable<LightOptions>();
  checkTable<GroundOptions>();
  checkTable<ObstacleOptions>();
}

}  // namespace
}  // namespace ebru
