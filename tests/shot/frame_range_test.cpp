#include "shot/frame_range.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace ebru {
namespace {

using Frames = std::vector<int>;

TEST(FrameRange, ReadsTheWordsOfFileseq) {
  EXPECT_EQ(parseFrames("7"), Frames({7}));
  EXPECT_EQ(parseFrames("1-5"), Frames({1, 2, 3, 4, 5}));
  EXPECT_EQ(parseFrames("1-8x3"), Frames({1, 4, 7}));
  EXPECT_EQ(parseFrames("1,5,7-9"), Frames({1, 5, 7, 8, 9}));
  EXPECT_EQ(parseFrames("-2-1"), Frames({-2, -1, 0, 1}));
  EXPECT_EQ(parseFrames("-4--2"), Frames({-4, -3, -2}));
  EXPECT_EQ(parseFrames("5-2"), Frames({5, 4, 3, 2}));
}

TEST(FrameRange, InvertedStepsAreWhatTheStepLeavesOut) {
  EXPECT_EQ(parseFrames("1-10y3"), Frames({2, 3, 5, 6, 8, 9}));
  Frames both = parseFrames("1-10x3,1-10y3");
  std::sort(both.begin(), both.end());
  EXPECT_EQ(both, parseFrames("1-10"));
}

TEST(FrameRange, StaggeredFramesComeInTheOrderOfEverFinerSteps) {
  EXPECT_EQ(parseFrames("1-9:4"), Frames({1, 5, 9, 4, 7, 3, 2, 6, 8}));
}

TEST(FrameRange, AFrameCountsOnce) { EXPECT_EQ(parseFrames("3,1-4"), Frames({3, 1, 2, 4})); }

TEST(FrameRange, RefusesWhatItCannotRead) {
  for (const char* text : {"", "a", "1-", "1-5x", "1-5x0", "1-5x0.25", "1,,2", "1-5z2", "1 - 5", "99999999999"})
    EXPECT_THROW(parseFrames(text), UsageError) << text;
}

TEST(FrameRange, RefusesToLeaveNothing) {
  for (const char* text : {"1-4y1", "7-7y1,3-1y1", "5-5y2"}) EXPECT_THROW(parseFrames(text), UsageError) << text;
  EXPECT_EQ(parseFrames("1-4y1,7"), Frames({7}));
}

TEST(FrameRange, PrintsTheShortestText) {
  EXPECT_EQ(printFrames({1, 2, 3, 4}), "1-4");
  EXPECT_EQ(printFrames({9, 1, 5, 7}), "1,5-9x2");
  EXPECT_EQ(printFrames({1, 2}), "1-2");
  EXPECT_EQ(printFrames({1, 4}), "1,4");
  EXPECT_EQ(printFrames({}), "");
  for (const char* text : {"1-47x2", "1-3,7,10-20x5"}) EXPECT_EQ(printFrames(parseFrames(text)), text);
}

TEST(FrameRange, ChunksCoverEveryFrameOnce) {
  const Frames frames = parseFrames("1-10");
  for (int chunks = 1; chunks <= 13; ++chunks) {
    Frames all;
    for (int i = 1; i <= chunks; ++i)
      for (const int f : chunkOf(frames, i, chunks)) all.push_back(f);
    EXPECT_EQ(all, frames) << chunks;
  }
  EXPECT_EQ(parseChunk("3/10"), std::make_pair(3, 10));
  for (const char* text : {"0/3", "4/3", "3", "a/b", "1/0"}) EXPECT_THROW(parseChunk(text), UsageError) << text;
}

}  // namespace
}  // namespace ebru
