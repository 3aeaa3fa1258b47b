/// The first frame of `synthesis` looks like its exemplar: a coarse check, not a quality measure.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "core/random.h"
#include "exemplar/neighbourhood_search.h"
#include "surface/orientation_field.h"
#include "textures.h"

namespace ebru {
namespace {

constexpr int side = 9;
constexpr int exemplarSize = 64;
using Window = std::array<Texel, side * side>;

Window exemplarWindow(const std::vector<Texel>& texels, int x, int y) {
  Window window;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i)
      window[static_cast<std::size_t>(side * j + i)] =
          texels[static_cast<std::size_t>(exemplarSize * (y + j) + x + i)];
  return window;
}

/// Root mean square difference per channel to the nearest of all windows of the exemplar.
double distanceToExemplar(const std::vector<Texel>& texels, const std::vector<Window>& windows) {
  double sum = 0.0;
  for (const Window& window : windows) {
    float least = std::numeric_limits<float>::max();
    for (int y = 0; y + side <= exemplarSize; ++y)
      for (int x = 0; x + side <= exemplarSize; ++x) {
        float distance = 0.0f;
        for (int j = 0; j < side && distance < least; ++j)
          for (int i = 0; i < side; ++i)
            distance += (window[static_cast<std::size_t>(side * j + i)] -
                         texels[static_cast<std::size_t>(exemplarSize * (y + j) + x + i)])
                            .square()
                            .head<3>()
                            .sum();
        least = std::min(least, distance);
      }
    sum += least;
  }
  return std::sqrt(sum / static_cast<double>(windows.size() * side * side * 3));
}

/// Windows of the texture on the slab's top, one texel apart, in the frames of the particles at their
/// centres.
std::vector<Window> windowsOfTop(const TextureMethod& method, const test::Folder& folder, float texelWorld) {
  test::stateOf(method, folder / "state");
  TextureParticles particles;
  particles.load(StateReader(folder / "state", "test"));
  std::map<std::uint32_t, std::size_t> indexOf;
  for (std::size_t i = 0; i < particles.size(); ++i) indexOf[particles.id[i]] = i;
  std::vector<Window> windows;
  for (std::uint64_t k = 0; k < 60; ++k) {
    Random random(3, 0, k);
    SurfacePoint centre;
    centre.position.x() = 1.2f * (random.uniform() - 0.5f);
    centre.position.y() = 1.2f * (random.uniform() - 0.5f);
    centre.position.z() = test::slabTopWorld;
    const std::size_t i = indexOf.at(static_cast<std::uint32_t>(method.field()->lookup(centre).id));
    const Vec3f right = texelWorld * particles.orientation[i];
    const Vec3f down = texelWorld * secondAxis(particles.normal[i], particles.orientation[i]);
    Window window;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        SurfacePoint p = centre;
        p.position += static_cast<float>(x - side / 2) * right + static_cast<float>(y - side / 2) * down;
        window[static_cast<std::size_t>(side * y + x)] = encodedTexel(method.field()->lookup(p).colour, 0.0f);
      }
    windows.push_back(window);
  }
  return windows;
}

// Compared with windows of the exemplar's own texels in random order, which have its colours and nothing else
// of it; an exact piece of exemplar between them gives nearly zero.
TEST(Synthesis, FirstFrameIsMadeOfTheExemplarsWindows) {
  const test::Folder folder;
  TextureOptions options;
  options.method = "synthesis";
  options.texel_size = 0.04;
  options.exemplar = {test::writeExemplar(folder / "discs.png", exemplarSize, test::discs).string()};
  const auto frame = test::slab(1, [](const Vec3f&) -> Vec3f { return Vec3f::Zero(); });
  const std::unique_ptr<TextureMethod> method = makeTextureMethod(options, 1, nullptr);
  method->start(*frame);

  const std::vector<Texel> texels = test::texelsOf(exemplarSize, test::discs);
  std::vector<Window> shuffled;
  for (std::uint64_t k = 0; k < 20; ++k) {
    Random random(5, 0, k);
    Window window;
    for (Texel& texel : window) texel = texels[random.below(static_cast<std::uint32_t>(texels.size()))];
    shuffled.push_back(window);
  }
  const double synthesised = distanceToExemplar(texels, windowsOfTop(*method, folder, 0.04f));
  const double random = distanceToExemplar(texels, shuffled);
  RecordProperty("synthesised", std::to_string(synthesised));
  RecordProperty("random", std::to_string(random));
  EXPECT_LT(distanceToExemplar(texels, {exemplarWindow(texels, 7, 30)}), 1e-6) << "the measure itself";
  EXPECT_LT(synthesised, 0.35 * random) << "random order: " << random;
}

/// Ages of the particles in the middle of a slab's top after seven frames of shear, which stretch by 1.8.
std::vector<float> agesInShear(int iterations) {
  const test::Folder folder;
  TextureOptions options;
  options.method = "synthesis";
  options.texel_size = 0.04;
  options.iterations = iterations;
  options.exemplar = {test::writeExemplar(folder / "discs.png", exemplarSize, test::discs).string()};
  const auto shear = [](const Vec3f& p) { return Vec3f(0.18f * p.y(), 0.0f, 0.0f); };
  const std::unique_ptr<TextureMethod> method = makeTextureMethod(options, 1, nullptr);
  auto from = test::slab(1, shear);
  method->start(*from);
  for (int f = 2; f <= 8; ++f) {
    auto to = test::slab(f, shear);
    method->advance(*from, *to);
    from = std::move(to);
  }
  test::stateOf(*method, folder / "state");
  TextureParticles particles;
  particles.load(StateReader(folder / "state", "test"));
  std::vector<float> ages;
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (particles.normal[i].z() > 0.9f && particles.position[i].head<2>().cwiseAbs().maxCoeff() < 0.5f)
      ages.push_back(particles.age[i]);
  return ages;
}

TEST(Synthesis, ReplacesWhatShearWearsOutUnlessItOnlyTransports) {
  const auto fresh = [](const std::vector<float>& ages) {
    return static_cast<double>(std::count(ages.begin(), ages.end(), 0.0f)) / static_cast<double>(ages.size());
  };
  const std::vector<float> replaced = agesInShear(2), transported = agesInShear(0);
  EXPECT_GT(fresh(replaced), 0.02);
  EXPECT_LT(fresh(replaced), 0.7) << "what still looks right is left alone";
  EXPECT_EQ(fresh(transported), 0.0);
}

}  // namespace
}  // namespace ebru
