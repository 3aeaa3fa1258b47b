#include "render/film/aovs.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace ebru {
namespace {

/// Rows "| `channel` | type | unit | meaning |" of the page's first table of that shape.
std::vector<std::array<std::string, 4>> documentedChannels() {
  const auto page = std::filesystem::path(EBRU_SOURCE_FOLDER) / "docs/aovs.md";
  std::ifstream file(page);
  std::vector<std::array<std::string, 4>> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("| `", 0) != 0) continue;
    std::istringstream cells(line.substr(1));
    std::array<std::string, 4> row;
    for (std::string& cell : row) {
      std::getline(cells, cell, '|');
      const std::size_t first = cell.find_first_not_of(" `");
      cell = first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(" `") - first + 1);
    }
    rows.push_back(row);
  }
  return rows;
}

TEST(Aovs, ThePageAndTheTableSayTheSame) {
  const auto rows = documentedChannels();
  ASSERT_EQ(rows.size(), aovCount);
  for (std::size_t i = 0; i < aovCount; ++i) {
    const AovInfo& aov = aovTable()[i];
    EXPECT_EQ(rows[i][0], aov.channel);
    EXPECT_EQ(rows[i][1], aov.type == ChannelType::half ? "half" : "float") << aov.channel;
    EXPECT_EQ(rows[i][2], aov.unit) << aov.channel;
    EXPECT_EQ(rows[i][3], aov.meaning) << aov.channel;
  }
}

TEST(Aovs, FrameBufferIsLaidOutAsTheTable) {
  FrameBuffer buffer(2, 1);
  buffer.set(Aov::textureMask, 1, 1.0f);
  buffer.set(Aov::positionX, 0, Vec3f(1.0f, 2.0f, 3.0f));
  buffer.set(Aov::backwardU, 1, Vec2f(4.0f, 5.0f));
  const ChannelImage image = buffer.take();
  ASSERT_EQ(image.channels.size(), aovCount);
  EXPECT_EQ(image.find("texture.mask")->data[1], 1.0f);
  EXPECT_EQ(image.find("P.Z")->data[0], 3.0f);
  EXPECT_EQ(image.find("backward.v")->data[1], 5.0f);
  EXPECT_EQ(image.find("Z")->type, ChannelType::float32);
  EXPECT_EQ(image.find("albedo.R")->type, ChannelType::half);
}

}  // namespace
}  // namespace ebru
