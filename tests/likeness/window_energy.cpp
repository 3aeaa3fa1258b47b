#include "likeness/window_energy.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "core/parallel.h"
#include "core/random.h"
#include "likeness/grey_image.h"
#include "likeness/picture_windows.h"
#include "likeness/plane_picture.h"
#include "likeness/window_search.h"

namespace ebru::likeness {
namespace {

constexpr int floorPictures = 8;

GreyImage lumaOf(const Exemplar& exemplar) {
  GreyImage luma(exemplar.width(), exemplar.height());
  for (int y = 0; y < luma.height; ++y)
    for (int x = 0; x < luma.width; ++x) luma.at(x, y) = exemplar.texel(0, x, y).head<3>().mean();
  return luma;
}

double meanDistance(const WindowSearch& search, const std::vector<Window>& windows) {
  std::vector<float> distances(windows.size());
  parallelFor(windows.size(), 1, [&](std::size_t i) { distances[i] = search.best(windows[i]).distance; });
  return meanOf(distances);
}

std::vector<Window> mirrored(std::vector<Window> windows, int side) {
  for (Window& window : windows)
    for (int row = 0; row < side; ++row) std::reverse(window.begin() + row * side, window.begin() + (row + 1) * side);
  return windows;
}

/// Which handedness is nearer to the exemplar, judged by some of the windows.
bool looksMirrored(const WindowSearch& search, std::vector<Window> windows, int side) {
  windows.resize(std::min(windows.size(), std::size_t{40}));
  const double straight = meanDistance(search, windows);
  return meanDistance(search, mirrored(std::move(windows), side)) < straight;
}

/// Windows of pictures of the exemplar that differ from those of a perfect picture in nothing.
std::vector<Window> floorWindows(const Exemplar& exemplar, double pixelTexels, const EnergyOptions& options) {
  std::vector<Window> all;
  PlaneView view;
  view.pixelTexels = pixelTexels;
  view.width = view.height =
      static_cast<int>(std::ceil(std::hypot(exemplar.width(), exemplar.height()) / pixelTexels)) + 2;
  Random random(options.seed, 1, 0);
  for (int i = 0; i < floorPictures; ++i) {
    const float angle = 2.0f * std::numbers::pi_v<float> * random.uniform();
    const float shiftX = random.uniform(), shiftY = random.uniform();
    const ChannelImage picture = exemplarPicture(view, exemplar, angle, Vec2f(shiftX, shiftY));
    WindowSet set = cutWindows(picture, view.texelSizeWorld, options.side,
                               (options.windows + floorPictures - 1) / floorPictures, random.bits());
    std::move(set.windows.begin(), set.windows.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace

WindowEnergy windowEnergy(const ChannelImage& picture, const Exemplar& exemplar, double texelSizeWorld,
                          const EnergyOptions& options) {
  const WindowSet set = cutWindows(picture, texelSizeWorld, options.side, options.windows, options.seed);
  WindowEnergy result;
  result.windows = static_cast<int>(set.windows.size());
  if (set.windows.empty()) return result;

  const GreyImage luma = lumaOf(exemplar);
  const WindowSearch search(luma, options.side);
  const double sigma = deviationOf(luma.data);
  result.mirrored = looksMirrored(search, set.windows, options.side);
  result.energy =
      meanDistance(search, result.mirrored ? mirrored(set.windows, options.side) : set.windows) / sigma;
  result.pixelTexels = meanOf(set.pixelTexels);
  result.floor = meanDistance(search, floorWindows(exemplar, result.pixelTexels, options)) / sigma;
  result.ratio = result.energy / result.floor;
  result.contrast = deviationOf(set.usableLuma) / sigma;
  return result;
}

}  // namespace ebru::likeness
