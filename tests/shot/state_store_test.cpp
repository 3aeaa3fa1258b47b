#include "shot/state_store.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace ebru {
namespace {

class StateStoreTest : public testing::Test {
 protected:
  StateStoreTest() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / ("ebru_" + std::to_string(getpid()) + "_" + test->name());
  }
  ~StateStoreTest() override { std::filesystem::remove_all(folder_); }

  StateStore open(bool useExisting, bool keepAll, const std::string& fingerprint = "shot") {
    return StateStore(folder_, "dam", {useExisting, keepAll},
                      [fingerprint](int frame) { return fingerprint + std::to_string(frame); });
  }
  static void save(StateStore& store, int frame) {
    StateWriter writer;
    writer.value("frame", frame);
    store.save(frame, writer);
  }
  bool onDisk(int frame) { return std::filesystem::exists(open(true, true).pathOf(frame)); }

  std::filesystem::path folder_;
};

TEST_F(StateStoreTest, LeavesTheNewestTwo) {
  StateStore store = open(false, false);
  for (int f = 1; f <= 5; ++f) save(store, f);
  EXPECT_FALSE(onDisk(3));
  EXPECT_TRUE(onDisk(4));
  EXPECT_TRUE(onDisk(5));
}

TEST_F(StateStoreTest, NeverRemovesWhatWasKeptOnPurpose) {
  StateStore synth = open(false, true);
  for (int f = 1; f <= 5; ++f) save(synth, f);
  StateStore render = open(true, false);
  for (int f = 6; f <= 9; ++f) save(render, f);
  for (int f = 1; f <= 5; ++f) EXPECT_TRUE(onDisk(f)) << f;
  EXPECT_FALSE(onDisk(6));
  EXPECT_TRUE(onDisk(9));
}

TEST_F(StateStoreTest, ResumedRunTakesOverTheTwoOfTheStoppedOne) {
  StateStore stopped = open(false, false);
  for (int f = 1; f <= 4; ++f) save(stopped, f);
  StateStore resumed = open(true, false);
  for (int f = 5; f <= 6; ++f) save(resumed, f);
  for (int f = 1; f <= 4; ++f) EXPECT_FALSE(onDisk(f)) << f;
}

// The shot was changed after a whole run: what that left at the end is in nobody's way.
TEST_F(StateStoreTest, StatesOfAnotherFingerprintDoNotCount) {
  StateStore before = open(false, false, "before");
  for (int f = 1; f <= 8; ++f) save(before, f);
  StateStore changed = open(true, false);
  for (int f = 1; f <= 4; ++f) save(changed, f);
  EXPECT_FALSE(onDisk(2));
  EXPECT_TRUE(changed.valid(3));
  EXPECT_TRUE(changed.valid(4));
  StateStore again = open(true, false);
  EXPECT_EQ(again.newest(0, 9)->frame, 4);
  for (int f = 5; f <= 6; ++f) save(again, f);
  EXPECT_FALSE(onDisk(3)) << "the shot's own two are taken over, however many others there are";
  EXPECT_FALSE(onDisk(4));
  EXPECT_TRUE(again.valid(6));
}

TEST_F(StateStoreTest, TheOneWrittenLastStays) {
  StateStore stopped = open(false, false);
  for (int f = 1; f <= 8; ++f) save(stopped, f);
  StateStore gap = open(true, false);
  for (int f = 1; f <= 4; ++f) {
    save(gap, f);
    EXPECT_TRUE(onDisk(f)) << f;
  }
  EXPECT_FALSE(onDisk(3));
  EXPECT_TRUE(onDisk(8)) << "what comes after the gap goes on from there";
}

TEST_F(StateStoreTest, FindsTheNewestThatIsWholeAndOfThisShot) {
  StateStore synth = open(false, true);
  for (int f = 1; f <= 5; ++f) save(synth, f);
  std::ofstream(synth.pathOf(5), std::ios::trunc) << "not a state";
  StateStore render = open(true, false);
  const auto found = render.newest(0, 9);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->frame, 4);
  EXPECT_EQ(found->reader.value<int>("frame"), 4);
  EXPECT_EQ(render.newest(0, 2)->frame, 2);
  EXPECT_FALSE(render.newest(4, 9));
  EXPECT_FALSE(render.valid(5));
  EXPECT_TRUE(render.valid(4));

  StateStore other = open(true, false, "other shot");
  EXPECT_FALSE(other.newest(0, 9));
  StateStore fresh = open(false, false);
  EXPECT_FALSE(fresh.newest(0, 9));
}

}  // namespace
}  // namespace ebru
