#include <gtest/gtest.h>

#include <set>

#include "core/parallel.h"
#include "core/random.h"
#include "core/vec.h"

namespace ebru {
namespace {

TEST(Random, IsAFunctionOfItsArgumentsAlone) {
  Random a(1, 2, 3), b(1, 2, 3);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(a.bits(), b.bits());
  EXPECT_NE(Random(1, 2, 3).bits(), Random(1, 3, 2).bits());
  EXPECT_NE(Random(1, 2, 3).bits(), Random(2, 2, 3).bits());
}

TEST(Random, UniformHasTheMomentsOfTheUniformDistribution) {
  // Mean 1/2, variance 1/12; the standard error of the mean of n is sqrt(1/12/n).
  const int n = 100000;
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double u = Random(7, 0, i).uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / n, 0.5, 5 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(squares / n, 1.0 / 3, 0.005);
}

TEST(Random, BelowReachesEveryValueAndNoOther) {
  std::set<std::uint32_t> seen;
  Random random(1, 1, 1);
  for (int i = 0; i < 1000; ++i) seen.insert(random.below(7));
  EXPECT_EQ(seen.size(), 7u);
  EXPECT_EQ(*seen.rbegin(), 6u);
}

TEST(Parallel, SumDoesNotDependOnThreads) {
  const auto term = [](std::size_t i) { return 1.0 / (1.0 + static_cast<double>(i)); };
  const double all = parallelSum(100001, term);
  const ThreadLimit one(1);
  EXPECT_EQ(all, parallelSum(100001, term));
}

TEST(Vec, CompleteFrameIsRightHandedAndOrthonormal) {
  for (int i = 0; i < 200; ++i) {
    Random random(3, 0, i);
    const Vec3f n = Vec3f(random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f).normalized();
    Vec3f t, b;
    completeFrame(n, t, b);
    EXPECT_NEAR(t.norm(), 1.0f, 1e-5f);
    EXPECT_NEAR(t.dot(n), 0.0f, 1e-5f);
    EXPECT_LT((t.cross(b) - n).norm(), 1e-5f);
  }
}

}  // namespace
}  // namespace ebru
