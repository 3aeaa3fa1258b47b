#include "texturing/quilt/piece_search.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "textures.h"

namespace ebru {
namespace {

constexpr float radius = 14.0f;

/// Discs, no two places of which are alike.
Texel gradedDiscs(int x, int y) {
  Texel t = test::discs(x, y);
  t[0] += 0.004f * static_cast<float>(x);
  t[1] += 0.004f * static_cast<float>(y);
  return t;
}

class PieceSearchTest : public ::testing::Test {
 protected:
  /// What a disc shows at a placement; of a rim: the part farther out than `inner`.
  std::vector<FitSample> samplesAt(const Placement& placement, float inner = 0.0f) const {
    std::vector<FitSample> samples;
    for (float y = -radius; y <= radius; y += 3.0f)
      for (float x = -radius; x <= radius; x += 3.0f)
        if (const Vec2f d(x, y); d.norm() <= radius && d.norm() >= inner)
          samples.push_back({d, exemplar.sample(0, placement.at(d)), 1.0f});
    return samples;
  }
  std::vector<Placement> search(const std::vector<FitSample>& samples, const std::vector<float>& penalty, float noise = 0.0f,
                                std::uint32_t seed = 1) const {
    std::vector<Placement> found;
    pieces.search(samples, penalty, radius, seed, noise, found);
    return found;
  }
  static Mat2f turned(int sixteenths) {
    return Eigen::Rotation2Df(2.0f * std::numbers::pi_v<float> * static_cast<float>(sixteenths) / 16.0f).toRotationMatrix();
  }

  const Exemplar exemplar{128, 128, test::texelsOf(128, gradedDiscs)};
  const PieceSearch pieces{exemplar};
  const ExemplarUsage usage{exemplar, 1.0f};
  const std::vector<float> free = pieces.penalties(usage, 1.0f);
};

TEST_F(PieceSearchTest, FindsWhereSamplesComeFromAndHowTheyAreTurned) {
  for (const float inner : {0.0f, 0.6f * radius})
    for (const int turn : {0, 3, 9}) {
      const Placement right{Vec2f(66.0f, 58.0f), turned(turn)};
      const Placement best = search(samplesAt(right, inner), free).front();
      EXPECT_LT((best.uv - right.uv).norm(), 6.0f) << inner << ' ' << turn;  // a diagonal of the coarse level's texels
      EXPECT_LT((best.rotation - right.rotation).norm(), 1e-3f) << inner << ' ' << turn;
    }
}

TEST_F(PieceSearchTest, PiecesStayInsideTheExemplar) {
  for (const Placement& p : search(samplesAt({Vec2f(20.0f, 110.0f), turned(5)}), free, 0.1f)) {
    EXPECT_GE(p.uv.minCoeff(), radius);
    EXPECT_LE(p.uv.maxCoeff(), 128.0f - radius);
  }
}

TEST_F(PieceSearchTest, OverusedPlacesAreAvoided) {
  ExemplarUsage worn(exemplar, 1.0f);
  const Placement right{Vec2f(66.0f, 58.0f)};
  for (int y = 40; y < 80; ++y)
    for (int x = 46; x < 86; ++x)
      for (int k = 0; k < 5; ++k) worn.add(Vec2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
  const Placement best = search(samplesAt(right), pieces.penalties(worn, 10.0f)).front();
  EXPECT_GT((best.uv - right.uv).norm(), 10.0f);
}

// With nothing known the noise decides, by its seed alone.
TEST_F(PieceSearchTest, WithoutSamplesPlacesAreRandomAndRepeatable) {
  const std::vector<FitSample> nothing;
  const Vec2f first = search(nothing, free, 1.0f, 1).front().uv;
  EXPECT_EQ(first, search(nothing, free, 1.0f, 1).front().uv);
  int different = 0;
  for (std::uint32_t seed = 2; seed < 12; ++seed) different += (search(nothing, free, 1.0f, seed).front().uv - first).norm() > 8.0f;
  EXPECT_GE(different, 7);
}

}  // namespace
}  // namespace ebru
