#include "exemplar/neighbourhood_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "core/random.h"
#include "maps.h"

namespace ebru {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Smooth noise: waves of 6 to 25 texels in random directions, different in every channel, with no two places
/// alike.
Exemplar waves(int width, int height) {
  std::vector<Texel> texels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Texel sum = Texel::Constant(0.5f);
      for (std::uint64_t k = 0; k < 24; ++k) {
        Random random(4, 0, k);
        const float angle = 6.2831853f * random.uniform(), frequency = 0.25f + 0.75f * random.uniform();
        const float phase = 6.2831853f * random.uniform();
        const float value = std::cos(
            frequency * (std::cos(angle) * static_cast<float>(x) + std::sin(angle) * static_cast<float>(y)) +
            phase);
        sum[static_cast<Eigen::Index>(k % 4)] += 0.08f * value;
      }
      texels.push_back(sum);
    }
  return Exemplar(width, height, std::move(texels));
}

/// The raster of a window at a place. Pixels of a wide window are means of 2 x 2 positions.
NeighbourhoodSearch::Window windowAt(const Exemplar& e, const NeighbourhoodSearch& search, const Vec2f& uv) {
  NeighbourhoodSearch::Window window;
  const float spacing = search.pixelSpacing();
  for (int j = 0; j < NeighbourhoodSearch::raster; ++j)
    for (int i = 0; i < NeighbourhoodSearch::raster; ++i) {
      const Vec2f p = uv + spacing * Vec2f(static_cast<float>(i - 4), static_cast<float>(j - 4));
      Texel& pixel = window[static_cast<std::size_t>(j * NeighbourhoodSearch::raster + i)];
      pixel = Texel::Zero();
      for (const float dx : {-0.25f, 0.25f})
        for (const float dy : {-0.25f, 0.25f}) {
          const float reach = search.window() == 17 ? 2.0f : 0.0f;
          pixel += 0.25f * e.sample(search.level(), p + reach * Vec2f(dx, dy));
        }
    }
  return window;
}

Vec2f centreOf(const Vec2i& texel) {
  return texel.cast<float>() + Vec2f::Constant(0.5f);
}

class Search : public ::testing::TestWithParam<int> {
 protected:
  Search() : exemplar(waves(72, 60)), search(exemplar, 0, GetParam()), half(GetParam() / 2) {}
  Vec2i randomTexel(std::uint64_t id) const {
    Random random(9, 0, id);
    const auto x = random.below(static_cast<std::uint32_t>(72 - 2 * half));
    return {half + static_cast<int>(x),
            half + static_cast<int>(random.below(static_cast<std::uint32_t>(60 - 2 * half)))};
  }
  /// Mean over random pairs of windows.
  float usualDistance() const {
    float sum = 0.0f;
    for (std::uint64_t i = 0; i < 100; ++i)
      sum +=
          search
              .at(randomTexel(i), search.describe(windowAt(exemplar, search, centreOf(randomTexel(500 + i)))))
              .distanceSquared /
          100.0f;
    return sum;
  }
  const Exemplar exemplar;
  const NeighbourhoodSearch search;
  const int half;
};

TEST_P(Search, SaysWhatItComparesAndHow) {
  EXPECT_EQ(search.window(), GetParam());
  EXPECT_EQ(search.level(), 0);
  // 9 pixels span the window: 8 spacings from the first texel's centre to the last one's.
  EXPECT_EQ(8.0f * search.pixelSpacing(), static_cast<float>(GetParam() - 1));
  const auto& w = search.weights();
  EXPECT_NEAR(std::accumulate(w.begin(), w.end(), 0.0), 1.0, 1e-5);
  EXPECT_EQ(std::max_element(w.begin(), w.end()) - w.begin(), NeighbourhoodSearch::pixels / 2);
  EXPECT_NEAR(w[0], w[NeighbourhoodSearch::pixels - 1], 1e-7f);
  EXPECT_GT(w[0], 0.0f);
}

NeighbourhoodSearch::Match nearestAnywhere(const NeighbourhoodSearch& search,
                                           const NeighbourhoodSearch::Descriptor& query) {
  return search.nearest(query, {{0, 0}, infinity});
}

// Every second window of every second row is in the tree: of a block of 2 x 2 places one finds itself, and
// the others find one near them.
TEST_P(Search, AWindowOfTheExemplarFindsItsOwnPlace) {
  const float usual = usualDistance();
  for (std::uint64_t i = 0; i < 30; ++i) {
    const Vec2i corner = randomTexel(i).cwiseMin(Vec2i(70 - half, 58 - half));
    int themselves = 0;
    for (const Vec2i& offset : {Vec2i(0, 0), Vec2i(1, 0), Vec2i(0, 1), Vec2i(1, 1)}) {
      const Vec2i texel = corner + offset;
      const NeighbourhoodSearch::Match match =
          nearestAnywhere(search, search.describe(windowAt(exemplar, search, centreOf(texel))));
      EXPECT_LE((match.texel - texel).cwiseAbs().maxCoeff(), 2);
      EXPECT_LT(match.distanceSquared, 0.5f * usual);
      if (match.texel != texel) continue;
      ++themselves;
      EXPECT_LT(match.distanceSquared, 0.005f * usual);
    }
    EXPECT_GE(themselves, 1);
  }
}

// The corners: the first and last window that fit.
TEST_P(Search, FindsTheFirstAndTheLastWindow) {
  for (const Vec2i& texel : {Vec2i(half, half), Vec2i(71 - half, 59 - half)}) {
    const NeighbourhoodSearch::Match match =
        nearestAnywhere(search, search.describe(windowAt(exemplar, search, centreOf(texel))));
    EXPECT_LE((match.texel - texel).cwiseAbs().maxCoeff(), 2);
  }
}

// The tree leaves out branches that are not nearer by a factor of 2.5 in squared distance.
TEST_P(Search, IsNearlyAsNearAsBruteForce) {
  double excess = 0.0;
  constexpr int queries = 40;
  for (std::uint64_t i = 0; i < queries; ++i) {
    NeighbourhoodSearch::Window query = windowAt(exemplar, search, centreOf(randomTexel(100 + i)));
    const NeighbourhoodSearch::Window other = windowAt(exemplar, search, centreOf(randomTexel(200 + i)));
    for (std::size_t p = 0; p < query.size(); ++p) query[p] = 0.6f * query[p] + 0.4f * other[p];
    const NeighbourhoodSearch::Descriptor descriptor = search.describe(query);
    const NeighbourhoodSearch::Match found = nearestAnywhere(search, descriptor);
    float least = infinity;
    for (int y = half; y < 60 - half; y += 2)
      for (int x = half; x < 72 - half; x += 2)
        least = std::min(least, search.at({x, y}, descriptor).distanceSquared);
    EXPECT_GE(found.distanceSquared, least * 0.9999f);
    EXPECT_LE(found.distanceSquared, 2.6f * least);
    EXPECT_NEAR(search.at(found.texel, descriptor).distanceSquared, found.distanceSquared,
                1e-4f * found.distanceSquared);
    excess += found.distanceSquared / least - 1.0f;
  }
  EXPECT_LT(excess / queries, 0.2) << "and mostly it is the nearest";
}

TEST_P(Search, NothingFartherThanTheBound) {
  const Vec2i texel = randomTexel(3);
  const NeighbourhoodSearch::Descriptor query =
      search.describe(windowAt(exemplar, search, centreOf(texel) + Vec2f(0.3f, 0.2f)));
  const NeighbourhoodSearch::Match best = nearestAnywhere(search, query);
  ASSERT_GT(best.distanceSquared, 0.0f);
  const NeighbourhoodSearch::Match bound{{-5, -6}, 0.2f * best.distanceSquared};
  const NeighbourhoodSearch::Match none = search.nearest(query, bound);
  EXPECT_EQ(none.texel, bound.texel) << "the bound itself";
  EXPECT_EQ(none.distanceSquared, bound.distanceSquared);
  for (const float factor : {1.01f, 2.0f, 50.0f})
    EXPECT_LE(search.nearest(query, {{0, 0}, factor * best.distanceSquared}).distanceSquared,
              factor * best.distanceSquared);
}

TEST_P(Search, AtMovesAWindowInsideFirst) {
  const NeighbourhoodSearch::Descriptor query =
      search.describe(windowAt(exemplar, search, centreOf(randomTexel(8))));
  const NeighbourhoodSearch::Match corner = search.at({half, 59 - half}, query);
  for (const Vec2i& outside : {Vec2i(-40, 1000), Vec2i(half - 1, 59), Vec2i(0, 60 - half)}) {
    const NeighbourhoodSearch::Match match = search.at(outside, query);
    EXPECT_EQ(match.texel, Vec2i(half, 59 - half));
    EXPECT_EQ(match.distanceSquared, corner.distanceSquared);
  }
}

// A window of 2 half + 1 texels around a texel's centre fits when the centre is half + 0.5 from the border.
TEST_P(Search, ClampInsideMovesACentreAsLittleAsNeeded) {
  const float margin = static_cast<float>(half) + 0.5f;
  EXPECT_EQ(search.clampInside({36.0f, 30.0f}), Vec2f(36.0f, 30.0f));
  EXPECT_EQ(search.clampInside({-3.0f, 30.0f}), Vec2f(margin, 30.0f));
  EXPECT_EQ(search.clampInside({1e9f, 1e9f}), Vec2f(72.0f - margin, 60.0f - margin));
  EXPECT_EQ(search.clampInside({margin, 60.0f - margin}), Vec2f(margin, 60.0f - margin));
}

TEST_P(Search, WorksOnAConstantExemplar) {
  const Exemplar constant(24, 24, std::vector<Texel>(24 * 24, Texel(0.2f, 0.4f, 0.6f, 0.0f)));
  const NeighbourhoodSearch flat(constant, 0, GetParam());
  NeighbourhoodSearch::Window window;
  window.fill(Texel(0.2f, 0.4f, 0.6f, 0.0f));
  const NeighbourhoodSearch::Match match = nearestAnywhere(flat, flat.describe(window));
  EXPECT_NEAR(match.distanceSquared, 0.0f, 1e-6f);
  EXPECT_EQ(match.texel, Vec2i(half, half)) << "all equal: the first";
}

// A match of level 1 is a texel of level 1.
TEST_P(Search, OnACoarserLevel) {
  const NeighbourhoodSearch coarse(exemplar, 1, GetParam());
  EXPECT_EQ(coarse.level(), 1);
  // The exemplar's level 1 is 36 x 30 texels.
  EXPECT_EQ(coarse.clampInside({100.0f, 100.0f}),
            Vec2f(35.5f - static_cast<float>(half), 29.5f - static_cast<float>(half)));
  const Vec2i texel(18, 15);
  const NeighbourhoodSearch::Match match =
      nearestAnywhere(coarse, coarse.describe(windowAt(exemplar, coarse, centreOf(texel))));
  EXPECT_LE((match.texel - texel).cwiseAbs().maxCoeff(), 2);
}

/// Two images of different sizes and looks.
class SearchOfTwo : public ::testing::TestWithParam<int> {
 protected:
  static ExemplarMaps image(const Vec2i& size, std::uint64_t kind) {
    return test::plainMaps(size, [kind](int x, int y) { return test::colourWaves(x, y, kind); });
  }
  const Exemplar exemplar{{image({72, 60}, 1), image({90, 80}, 2)}};
};

TEST_P(SearchOfTwo, AWindowIsFoundInTheImageItWasCutFrom) {
  for (const int level : {0, 1}) {
    const NeighbourhoodSearch search(exemplar, level, GetParam());
    const int half = GetParam() / 2;
    for (int tile = 0; tile < 2; ++tile)
      for (std::uint64_t i = 0; i < 20; ++i) {
        Random random(5, static_cast<std::uint64_t>(tile), i);
        // Places of the tree: every second one.
        const Vec2i room = (exemplar.tileSize(tile, level) - Vec2i::Constant(2 * half + 1)) / 2;
        const Vec2i step(static_cast<int>(random.below(static_cast<std::uint32_t>(room.x()))),
                         static_cast<int>(random.below(static_cast<std::uint32_t>(room.y()))));
        const Vec2i texel = exemplar.tileOrigin(tile, level) + Vec2i::Constant(half) + 2 * step;
        const NeighbourhoodSearch::Descriptor query = search.describe(windowAt(exemplar, search, centreOf(texel)));
        const NeighbourhoodSearch::Match match = nearestAnywhere(search, query);
        EXPECT_LE((match.texel - texel).cwiseAbs().maxCoeff(), 2) << "tile " << tile << " level " << level;
        EXPECT_EQ(search.at(texel, query).texel, texel);
        EXPECT_NEAR(search.at(match.texel, query).distanceSquared, match.distanceSquared, 1e-3f * match.distanceSquared);
      }
  }
}

// The images are 72 and 90 wide, the gap's middle is half way between them.
TEST_P(SearchOfTwo, ACentreIsMovedIntoTheImageItIsNearestTo) {
  const NeighbourhoodSearch search(exemplar, 0, GetParam());
  const int half = GetParam() / 2;
  const float margin = static_cast<float>(half) + 0.5f;
  const int origin = exemplar.tileOrigin(1).x();
  const float middle = 0.5f * static_cast<float>(72 + origin);
  EXPECT_EQ(search.clampInside({middle - 0.5f, 30.0f}), Vec2f(72.0f - margin, 30.0f));
  EXPECT_EQ(search.clampInside({middle + 0.5f, 30.0f}), Vec2f(static_cast<float>(origin) + margin, 30.0f));
  EXPECT_EQ(search.clampInside({1e9f, 1e9f}), Vec2f(static_cast<float>(origin) + 90.0f - margin, 80.0f - margin));
  const Vec2f inside(static_cast<float>(origin) + 40.0f, 41.0f);
  EXPECT_EQ(search.clampInside(inside), inside);
  const NeighbourhoodSearch::Descriptor query = search.describe(windowAt(exemplar, search, {36.5f, 30.5f}));
  EXPECT_EQ(search.at({static_cast<int>(middle) - 2, 30}, query).texel, Vec2i(71 - half, 30));
  EXPECT_EQ(search.at({static_cast<int>(middle) + 2, 30}, query).texel, Vec2i(origin + half, 30));
}

// Of the same image twice the first is found.
TEST_P(SearchOfTwo, TiesGoToTheFirstImage) {
  const Exemplar twins{{image({60, 60}, 3), image({60, 60}, 3)}};
  const NeighbourhoodSearch search(twins, 0, GetParam());
  for (int i = 0; i < 20; ++i) {
    const Vec2i texel(10 + 2 * i, 50 - 2 * i);
    const Vec2i second = texel + twins.tileOrigin(1);
    const NeighbourhoodSearch::Match match =
        nearestAnywhere(search, search.describe(windowAt(twins, search, centreOf(second))));
    EXPECT_LT(match.texel.x(), 60);
  }
}

// Two halves of one colour pattern, smooth and rough: only a search that counts roughness tells them apart.
TEST_P(SearchOfTwo, WeightsSayWhatCounts) {
  ExemplarMaps maps = test::plainMaps({96, 48}, [](int x, int y) { return test::colourWaves(x % 48, y, 4); });
  maps.roughness = test::valuesOf(maps.size, [](int x, int y) {
    return (x < 48 ? 0.1f : 0.5f) + 0.4f * test::waves(x % 48, y, 77);
  });
  ChannelWeights weights;
  for (const float counts : {0.0f, 1.0f}) {
    weights.roughness = counts;
    const Exemplar e({maps}, weights);
    const NeighbourhoodSearch search(e, 0, GetParam());
    for (const int y : {16, 24, 30}) {
      const Vec2i rough(72, y), smooth(24, y);
      const NeighbourhoodSearch::Descriptor query = search.describe(windowAt(e, search, centreOf(rough)));
      const float own = search.at(rough, query).distanceSquared, other = search.at(smooth, query).distanceSquared;
      if (counts == 0.0f)
        EXPECT_NEAR(other, own, 1e-6f);
      else
        EXPECT_GT(other, own + 0.02f) << "differs by 0.4 in one channel";
      if (counts > 0.0f) {
        EXPECT_LE((nearestAnywhere(search, query).texel - rough).cwiseAbs().maxCoeff(), 2);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Windows, SearchOfTwo, ::testing::Values(9, 17),
                         [](const auto& info) { return "Of" + std::to_string(info.param); });
INSTANTIATE_TEST_SUITE_P(Windows, Search, ::testing::Values(9, 17),
                         [](const auto& info) { return "Of" + std::to_string(info.param); });

}  // namespace
}  // namespace ebru
