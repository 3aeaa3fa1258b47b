#include "shot/spelling.h"

#include <gtest/gtest.h>

namespace ebru {
namespace {

TEST(Spelling, CountsEdits) {
  EXPECT_EQ(spellingDistance("", "abc"), 3);
  EXPECT_EQ(spellingDistance("abc", "abc"), 0);
  EXPECT_EQ(spellingDistance("texel_sise", "texel_size"), 1);
  EXPECT_EQ(spellingDistance("siez", "size"), 1);  // two neighbours swapped
  EXPECT_EQ(spellingDistance("kitten", "sitting"), 3);
}

TEST(Spelling, SuggestsOnlyWhatCanBeMeant) {
  const std::vector<std::string> keys = {"method", "exemplar", "texel_size"};
  EXPECT_EQ(nearestSpelling("texel_sise", keys), "texel_size");
  EXPECT_EQ(nearestSpelling("exampler", keys), "exemplar");
  EXPECT_EQ(nearestSpelling("size", keys), "texel_size");
  EXPECT_EQ(nearestSpelling("wavelength", keys), "");
  EXPECT_EQ(didYouMean("metod", keys), ", did you mean method");
  EXPECT_EQ(didYouMean("wavelength", keys), "");
}

}  // namespace
}  // namespace ebru
