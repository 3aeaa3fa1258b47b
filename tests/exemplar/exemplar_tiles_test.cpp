/// Several images in one coordinate space.

#include <gtest/gtest.h>

#include "maps.h"

namespace ebru {
namespace {

using test::colourWaves;
using test::plainMaps;

const Vec2i sizes[] = {{101, 130}, {203, 97}, {120, 120}};

ExemplarMaps image(int k) {
  return plainMaps(sizes[k], [k](int x, int y) { return colourWaves(x, y, static_cast<std::uint64_t>(k)); });
}

Exemplar three() { return Exemplar({image(0), image(1), image(2)}); }

// 97 texels halve twice before they are under 24.
TEST(ExemplarTiles, LieApartAtEveryLevelsScale) {
  const Exemplar e = three();
  ASSERT_EQ(e.tileCount(), 3);
  EXPECT_EQ(e.levelCount(), 3);
  EXPECT_EQ(e.tileOrigin(0), Vec2i(0, 0));
  EXPECT_EQ(e.smallestSize(), Vec2i(101, 97));
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(e.tileSize(k), sizes[k]);
    for (int level = 0; level < 3; ++level) {
      EXPECT_EQ(e.tileOrigin(k, level) * (1 << level), e.tileOrigin(k)) << k << " " << level;
      EXPECT_EQ(e.tileSize(k, level), Vec2i(sizes[k].x() >> level, sizes[k].y() >> level));
    }
    if (k > 0) {
      EXPECT_GE(e.tileOrigin(k).x() - e.tileOrigin(k - 1).x() - sizes[k - 1].x(), 128);
    }
  }
}

// Beyond the borders too: each tile is clamped to itself, bit for bit as if it were alone.
TEST(ExemplarTiles, EachTileIsSampledAsIfItWereAlone) {
  const Exemplar together = three();
  for (int k = 0; k < 3; ++k) {
    const Exemplar alone({image(k)});
    for (int level = 0; level < together.levelCount(); ++level)
      for (std::uint64_t i = 0; i < 300; ++i) {
        Random random(2, static_cast<std::uint64_t>(level), i);
        // Eighths of texels: the sum with the origin is exact. 60 texels of level 0 beyond the border are nearest to it.
        const float reach = 60.0f / static_cast<float>(1 << level);
        const Vec2f size = alone.tileSize(0, level).cast<float>();
        Vec2f uv(random.uniform() * (size.x() + 2.0f * reach) - reach, random.uniform() * (size.y() + 2.0f * reach) - reach);
        uv = (uv * 8.0f).array().round().matrix() / 8.0f;
        const Vec2f shifted = uv + together.tileOrigin(k, level).cast<float>();
        Texel du, dv, expectedDu, expectedDv;
        ASSERT_TRUE((together.sample(level, shifted) == alone.sample(level, uv)).all()) << k << " " << level << " " << uv;
        together.sample(level, shifted, du, dv);
        alone.sample(level, uv, expectedDu, expectedDv);
        ASSERT_TRUE((du == expectedDu).all() && (dv == expectedDv).all());
        if (level == 0) {
          ASSERT_TRUE((together.sampleFiltered(shifted, 3.0f) == alone.sampleFiltered(uv, 3.0f)).all());
        }
      }
  }
}

// Two tiles of one colour each: anything in between would be the other's.
TEST(ExemplarTiles, NothingBleedsOverTheGap) {
  const Vec3f colours[] = {{0.2f, 0.3f, 0.4f}, {0.9f, 0.8f, 0.7f}};
  std::vector<ExemplarMaps> images;
  for (const Vec3f& colour : colours) images.push_back(plainMaps({96, 96}, [&](int, int) { return colour; }));
  const Exemplar e(images);
  const float middle = 0.5f * static_cast<float>(96 + e.tileOrigin(1).x());
  const float end = static_cast<float>(e.tileOrigin(1).x() + 96 + 50);
  for (float u = -50.0f; u < end; u += 0.25f) {
    const int tile = u < middle ? 0 : 1;
    const Vec2f uv(u, 40.0f);
    ASSERT_EQ(e.tileAt(uv), tile);
    for (int level = 0; level < e.levelCount(); ++level)
      ASSERT_LT((e.sample(level, uv / static_cast<float>(1 << level)).head<3>().matrix() - colours[tile]).norm(), 1e-5f)
          << u << " on level " << level;
    for (const float width : {1.0f, 3.0f, 1000.0f})
      ASSERT_LT((e.sampleFiltered(uv, width).head<3>().matrix() - colours[tile]).norm(), 1e-5f) << u << " " << width;
  }
}

TEST(ExemplarTiles, HoldsAndNormalises) {
  const Exemplar e = three();
  for (int k = 0; k < 3; ++k) {
    const Vec2f origin = e.tileOrigin(k).cast<float>(), size = sizes[k].cast<float>();
    for (const Vec2f& inside : {Vec2f(0.0f, 0.0f), Vec2f(1.0f, 1.0f), Vec2f(0.25f, 0.75f)}) {
      const Vec2f uv = origin + inside.cwiseProduct(size);
      EXPECT_TRUE(e.holds(uv));
      EXPECT_EQ(e.normalised(uv).tile, k);
      EXPECT_LT((e.normalised(uv).st - inside).norm(), 1e-5f);
    }
    for (const Vec2f& outside : {Vec2f(-1.0f, 5.0f), Vec2f(5.0f, -1.0f), Vec2f(size.x() + 1.0f, 5.0f), Vec2f(5.0f, size.y() + 1.0f)}) {
      EXPECT_FALSE(e.holds(origin + outside));
      EXPECT_EQ(e.normalised(origin + outside).tile, k);
      EXPECT_TRUE((e.normalised(origin + outside).st.array() >= 0.0f).all());
      EXPECT_TRUE((e.normalised(origin + outside).st.array() <= 1.0f).all());
    }
  }
}

}  // namespace
}  // namespace ebru
