#include "shot/input_identity.h"

#include <gtest/gtest.h>

#include <fstream>

#include "folder.h"

namespace ebru {
namespace {

/// A cache whose files differ in nothing but their sizes.
class GrowingCache : public testing::Test {
 protected:
  GrowingCache() {
    shot_.fluid.source = "vdb";
    shot_.fluid.path = (folder_ / "dam.####.vdb").string();
    shot_.shot.first_frame = 1;
    for (int f = 1; f <= 6; ++f) write(f, f);
  }
  void write(int frame, int size) const {
    std::ofstream(folder_ / ("dam.000" + std::to_string(frame) + ".vdb")) << std::string(static_cast<std::size_t>(size), 'x');
  }
  struct Prints {
    std::vector<std::string> states, pictures;
  };
  /// Of frames 1 to 6 while the cache has those to `last`.
  Prints prints(int last = 6) const {
    InputIdentity identity(shot_, last);
    Prints result;
    for (int f = 1; f <= 6; ++f) {
      result.states.push_back(identity.state(f));
      result.pictures.push_back(identity.picture(f));
    }
    return result;
  }
  /// The first frame whose fingerprints differ.
  static int firstChange(const std::vector<std::string>& a, const std::vector<std::string>& b) {
    return 1 + static_cast<int>(std::mismatch(a.begin(), a.end(), b.begin()).first - a.begin());
  }

  const test::Folder folder_;
  Shot shot_;
};

TEST_F(GrowingCache, ChangesTheFramesThatLookAhead) {
  for (const int ahead : {0, 2}) {
    shot_.texture.method = "quilt";
    shot_.texture.look_ahead = ahead;
    const Prints young = prints(4), grown = prints();
    EXPECT_EQ(firstChange(young.states, grown.states), 5 - ahead);
    // Motion vectors know one frame more.
    EXPECT_EQ(firstChange(young.pictures, grown.pictures), 5 - std::max(ahead, 1));
    write(6, 100);
    const Prints other = prints();
    EXPECT_EQ(firstChange(grown.states, other.states), 6 - ahead);
    EXPECT_EQ(firstChange(grown.pictures, other.pictures), 6 - std::max(ahead, 1));
    write(6, 6);
  }
}

TEST_F(GrowingCache, IsNothingToMethodsThatDoNotLookAhead) {
  for (const char* method : {"particles", "synthesis", "erosion", "plain"}) {
    shot_.texture.method = method;
    shot_.texture.look_ahead = 3;
    const Prints young = prints(4), grown = prints();
    EXPECT_EQ(firstChange(young.states, grown.states), 5) << method;
    EXPECT_EQ(firstChange(young.pictures, grown.pictures), 4) << method;
  }
}

TEST_F(GrowingCache, FilesThatAppearDuringARunDecideNothing) {
  InputIdentity identity(shot_, 4);
  const std::string before = InputIdentity(shot_, 4).picture(4);
  write(5, 70);
  EXPECT_EQ(identity.picture(4), before);
}

TEST_F(GrowingCache, AnyOrderOfQuestionsGivesTheSame) {
  shot_.texture.method = "quilt";
  shot_.texture.look_ahead = 2;
  const Prints expected = prints();
  InputIdentity identity(shot_, 6);
  for (const int f : {4, 2, 6, 1, 5, 3}) {
    EXPECT_EQ(identity.picture(f), expected.pictures[static_cast<std::size_t>(f - 1)]) << f;
    EXPECT_EQ(identity.state(f), expected.states[static_cast<std::size_t>(f - 1)]) << f;
  }
}

}  // namespace
}  // namespace ebru
