/// Several exemplars and maps beyond colour, from the options to the hit.

#include <gtest/gtest.h>

#include "maps.h"
#include "textures.h"
#include "texturing/charts/chart_field.h"
#include "texturing/open_exemplar.h"

namespace ebru {
namespace {

constexpr float texelWorld = 0.04f;
constexpr int side = 47;  ///< one level: its windows are smaller than the pieces the exemplars start with

float disc(int x, int y, std::uint64_t kind) { return test::discs(x + 5 * static_cast<int>(kind), y)[0]; }

/// Discs of another tint for every kind, encoded.
Vec3f tinted(int x, int y, std::uint64_t kind) {
  const float d = disc(x, y, kind), w = test::waves(x, y, kind);
  return kind == 0 ? Vec3f(0.3f + 0.7f * d, 0.5f * d, 0.2f * w) : Vec3f(0.2f * w, 0.4f * d, 0.3f + 0.7f * d);
}

/// Two exemplars whose other maps are functions of the colour of the same place.
TextureOptions nineChannels(const test::Folder& folder, int texels = side) {
  TextureOptions options;
  options.method = "synthesis";
  options.texel_size = texelWorld;
  const Vec2i size(texels, texels);
  for (const std::uint64_t kind : {0, 1}) {
    const auto colour = [=](int x, int y) { return tinted(x, y, kind); };
    const auto write = [&](const char* name, const test::Vec3Function& f) {
      return test::writeMap(folder / (name + std::to_string(kind) + ".exr"), size, f);
    };
    options.exemplar.push_back(write("colour", [&](int x, int y) {
      const Vec3f c = colour(x, y);
      return linearColour(Texel(c.x(), c.y(), c.z(), 0.0f));
    }));
    const auto grey = [](float value) { return Vec3f(Vec3f::Constant(value)); };
    options.height.push_back(write("height", [&](int x, int y) { return grey(1.0f - colour(x, y).x()); }));
    options.roughness.push_back(write("roughness", [&](int x, int y) { return grey(0.1f + 0.8f * colour(x, y).x()); }));
    options.alpha.push_back(write("alpha", [&](int x, int y) { return grey(0.1f + 0.8f * colour(x, y).y()); }));
    options.emission.push_back(write("emission", [&](int x, int y) { return Vec3f(5.0f * colour(x, y)); }));
  }
  return options;
}

std::shared_ptr<const FluidFrame> shearedSlab(int frame) {
  return test::slab(frame, [](const Vec3f& p) { return Vec3f(0.18f * p.y(), 0.0f, 0.0f); });
}

// However charts are blended and whatever was synthesised, the maps are blended alike.
TEST(ExemplarChannels, AHitShowsAllMapsOfOnePlace) {
  const test::Folder folder;
  const std::unique_ptr<TextureMethod> method = makeTextureMethod(nineChannels(folder), 1, nullptr);
  const auto frame = shearedSlab(1);
  method->start(*frame);
  float brightest = 0.0f, darkest = 1.0f;
  int checked = 0;
  for (SurfacePoint point : test::surfacePoints(frame->mesh)) {
    point.footprintWorld = checked % 2 ? 0.0f : 2.5f * texelWorld;
    const TextureSample s = method->field()->lookup(point);
    ASSERT_TRUE(s.valid);
    const Texel encoded = encodedTexel(s.colour, 0.0f);
    // Encoded colours below 0 are cut off, as roughness and alpha are at 0.
    if (encoded.head<3>().minCoeff() < 0.005f) continue;
    ++checked;
    ASSERT_NEAR(s.displacement, 1.0f - encoded[0], 2e-3f);
    ASSERT_NEAR(s.roughness, 0.1f + 0.8f * encoded[0], 2e-3f);
    ASSERT_NEAR(s.alpha, 0.1f + 0.8f * encoded[1], 2e-3f);
    ASSERT_LT((s.emission - 5.0f * encoded.head<3>().matrix()).norm(), 2e-2f);
    brightest = std::max(brightest, s.roughness);
    darkest = std::min(darkest, s.roughness);
  }
  EXPECT_GT(checked, 1000);
  EXPECT_GT(brightest - darkest, 0.4f);
}

// Each hit has the colours of the exemplar it says, at the coordinate it says, and both exemplars are there.
TEST(ExemplarChannels, SynthesisUsesBothExemplars) {
  const test::Folder folder;
  TextureOptions options = nineChannels(folder, 128);  // the first pieces, half as large, hold the widest windows
  options.texel_size = 0.012;
  options.height = options.roughness = options.alpha = options.emission = {};
  const std::unique_ptr<TextureMethod> method = makeTextureMethod(options, 1, nullptr);
  auto from = shearedSlab(1);
  method->start(*from);
  for (int f = 2; f <= 5; ++f) {
    auto to = shearedSlab(f);
    method->advance(*from, *to);
    from = std::move(to);
  }
  double count[2] = {0.0, 0.0};
  int wrong = 0;
  for (const SurfacePoint& point : test::surfacePoints(from->mesh)) {
    const TextureSample s = method->field()->lookup(point);
    ASSERT_TRUE(s.exemplar == 0 || s.exemplar == 1);
    ++count[s.exemplar];
    // The first exemplar is more red than blue everywhere, the second more blue.
    wrong += (s.colour.x() > s.colour.z()) != (s.exemplar == 0);
    ASSERT_TRUE(s.st.minCoeff() >= 0.0f && s.st.maxCoeff() <= 1.0f);
  }
  const double all = count[0] + count[1];
  EXPECT_GT(count[0], 0.1 * all);
  EXPECT_GT(count[1], 0.1 * all);
  EXPECT_LT(wrong, 0.1 * all) << "blends along seams apart";
}

TEST(ExemplarChannels, GoesOnFromASavedState) {
  const test::Folder folder;
  const TextureOptions options = nineChannels(folder);
  const auto straight = makeTextureMethod(options, 1, nullptr), resumed = makeTextureMethod(options, 1, nullptr);
  auto from = shearedSlab(1);
  straight->start(*from);
  for (int f = 2; f <= 5; ++f) {
    test::stateOf(*straight, folder / "cut");
    resumed->load(StateReader(folder / "cut", "test"));
    auto to = shearedSlab(f);
    straight->advance(*from, *to);
    resumed->advance(*from, *to);
    ASSERT_EQ(test::stateOf(*straight, folder / "a"), test::stateOf(*resumed, folder / "b")) << "frame " << f;
    from = std::move(to);
    for (const SurfacePoint& point : test::surfacePoints(from->mesh)) {
      const TextureSample a = straight->field()->lookup(point), b = resumed->field()->lookup(point);
      ASSERT_TRUE(test::identical(a, b));
      ASSERT_TRUE(a.roughness == b.roughness && a.emission == b.emission && a.exemplar == b.exemplar);
    }
  }
}

// Four channels lose nothing on the way to texels and back: what synthesis made of the particles is shown just as where the
// texels are the colours.
TEST(ExemplarChannels, WhatSynthesisMadeIsShownThoughTexelsAreNoColours) {
  ExemplarMaps maps = test::plainMaps({side, side}, [](int x, int y) { return tinted(x, y, 0); });
  maps.height = test::valuesOf(maps.size, [](int x, int y) { return disc(x, y, 0); });
  const auto fieldOf = [&](float heightWeight, bool moved) {
    ChannelWeights weights;
    weights.height = heightWeight;
    const auto exemplar = std::make_shared<const Exemplar>(std::vector<ExemplarMaps>{maps}, weights);
    EXPECT_EQ(exemplar->space().isPlain(), heightWeight == 1.0f);
    TextureParticles particles = test::particlesOnTop(texelWorld);
    for (std::size_t i = 0; i < particles.size(); ++i)
      particles.colour[i] = exemplar->sample(0, particles.st[i] + Vec2f(moved ? 6.0f : 0.0f, 0.0f));
    return ChartField(std::make_shared<const TextureParticles>(particles), exemplar, texelWorld);
  };
  const ChartField plain = fieldOf(1.0f, true), reduced = fieldOf(2.0f, true), charts = fieldOf(2.0f, false);
  float most = 0.0f;
  for (int k = 0; k < 200; ++k) {
    SurfacePoint point;
    Random random(1, 2, static_cast<std::uint64_t>(k));
    point.position = Vec3f(0.5f * (random.uniform() - 0.5f), 0.5f * (random.uniform() - 0.5f), test::slabTopWorld);
    const TextureSample expected = plain.lookup(point), got = reduced.lookup(point);
    ASSERT_LT((encodedTexel(got.colour, got.displacement) - encodedTexel(expected.colour, expected.displacement)).abs().maxCoeff(), 1e-3f);
    most = std::max(most, std::abs(got.displacement - charts.lookup(point).displacement));
  }
  EXPECT_GT(most, 0.2f) << "what was made differs from what the charts say";
}

}  // namespace
}  // namespace ebru
