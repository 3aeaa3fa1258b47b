#include "likeness/window_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "core/parallel.h"

namespace ebru::likeness {
namespace {

constexpr int angleCount = 72;
constexpr int tileSize = 8;        // coarse positions a side
constexpr int refinedTiles = 48;   // to a texel and 4 degrees
constexpr int finishedTiles = 8;   // to half a texel and 2 degrees
constexpr int maxRefineSteps = 16;
constexpr float degree = std::numbers::pi_v<float> / 180.0f;
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Binomial filter of 3 x 3, clamped to the border.
GreyImage blurred(const GreyImage& image) {
  constexpr float weights[3] = {0.25f, 0.5f, 0.25f};
  GreyImage result(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i)
          result.at(x, y) += weights[j + 1] * weights[i + 1] *
                             image.at(std::clamp(x + i, 0, image.width - 1), std::clamp(y + j, 0, image.height - 1));
  return result;
}

/// sums[k] += the squared differences of row[k + i] from wanted[i]. Four at a time: the loop is bound by the memory of sums.
void addSquares(const float* row, const float* wanted, int taps, int count, float* sums) {
  const auto square = [](float x) { return x * x; };
  int i = 0;
  for (; i + 4 <= taps; i += 4) {
    const float a = wanted[i], b = wanted[i + 1], c = wanted[i + 2], d = wanted[i + 3];
    const float* r = row + i;
    for (int k = 0; k < count; ++k)
      sums[k] += (square(r[k] - a) + square(r[k + 1] - b)) + (square(r[k + 2] - c) + square(r[k + 3] - d));
  }
  for (; i < taps; ++i)
    for (int k = 0; k < count; ++k) sums[k] += square(row[i + k] - wanted[i]);
}

}  // namespace

WindowSearch::WindowSearch(const GreyImage& exemplar, int side)
    : exemplar_(exemplar), side_(side), coarseReach_((side / 2 - 1) / 2), turned_(angleCount) {
  const GreyImage soft = blurred(exemplar);
  parallelFor(turned_.size(), 1, [&](std::size_t i) {
    turned_[i] = turned(soft, static_cast<float>(i) * 2.0f * std::numbers::pi_v<float> / angleCount);
  });
}

Vec2f WindowSearch::exemplarPoint(const Turned& turned, int x, int y) const {
  const float dx = 2.0f * static_cast<float>(x) - static_cast<float>(turned.image.width);
  const float dy = 2.0f * static_cast<float>(y) - static_cast<float>(turned.image.height);
  return {0.5f * static_cast<float>(exemplar_.width) + turned.cosine * dx - turned.sine * dy,
          0.5f * static_cast<float>(exemplar_.height) + turned.sine * dx + turned.cosine * dy};
}

bool WindowSearch::inside(const Vec2f& centre, float cosine, float sine) const {
  const float reach = 0.5f + static_cast<float>(side_ / 2) * (std::abs(cosine) + std::abs(sine));
  return centre.x() >= reach && centre.y() >= reach && centre.x() <= static_cast<float>(exemplar_.width) - reach &&
         centre.y() <= static_cast<float>(exemplar_.height) - reach;
}

WindowSearch::Turned WindowSearch::turned(const GreyImage& soft, float angle) const {
  Turned result;
  result.angle = angle;
  result.cosine = std::cos(angle);
  result.sine = std::sin(angle);
  const float w = static_cast<float>(soft.width), h = static_cast<float>(soft.height);
  const float c = std::abs(result.cosine), s = std::abs(result.sine);
  result.image = GreyImage(static_cast<int>(std::ceil(0.5f * (c * w + s * h))) + 1,
                           static_cast<int>(std::ceil(0.5f * (s * w + c * h))) + 1);
  result.first.assign(static_cast<std::size_t>(result.image.height), 0);
  result.last.assign(static_cast<std::size_t>(result.image.height), -1);
  for (int y = 0; y < result.image.height; ++y) {
    int &first = result.first[static_cast<std::size_t>(y)], &last = result.last[static_cast<std::size_t>(y)];
    for (int x = 0; x < result.image.width; ++x) {
      const Vec2f point = exemplarPoint(result, x, y);
      result.image.at(x, y) = soft.sample(point.x(), point.y());
      if (!inside(point, result.cosine, result.sine)) continue;
      if (last < 0) first = x;
      last = x;
    }
  }
  return result;
}

void WindowSearch::searchCoarsely(const Turned& turned, const std::vector<float>& query,
                                  std::vector<Candidate>& tiles) const {
  const GreyImage& image = turned.image;
  const int tilesAcross = image.width / tileSize + 1;
  struct Tile {
    float distance = infinity;
    int x = 0, y = 0;
  };
  std::vector<Tile> best;
  std::vector<float> sums(static_cast<std::size_t>(image.width));
  const auto keepTiles = [&] {
    for (const Tile& tile : best)
      if (tile.distance < infinity) {
        const Vec2f centre = exemplarPoint(turned, tile.x, tile.y);
        tiles.push_back({tile.distance, centre.x(), centre.y(), turned.angle});
      }
    best.assign(static_cast<std::size_t>(tilesAcross), {});
  };
  for (int y = 0; y < image.height; ++y) {
    if (y % tileSize == 0) keepTiles();
    const int first = turned.first[static_cast<std::size_t>(y)];
    const int count = turned.last[static_cast<std::size_t>(y)] - first + 1;
    if (count <= 0) continue;
    std::fill_n(sums.begin(), count, 0.0f);
    const int taps = 2 * coarseReach_ + 1;
    for (int j = 0; j < taps; ++j)
      addSquares(&image.data[image.index(first - coarseReach_, y + j - coarseReach_)], &query[static_cast<std::size_t>(j * taps)],
                 taps, count, sums.data());
    for (int k = 0; k < count; ++k) {
      Tile& tile = best[static_cast<std::size_t>((first + k) / tileSize)];
      if (sums[static_cast<std::size_t>(k)] < tile.distance)
        tile = {sums[static_cast<std::size_t>(k)], first + k, y};
    }
  }
  keepTiles();
}

float WindowSearch::distance(const Window& window, const Candidate& at, float bound) const {
  const float cosine = std::cos(at.angle), sine = std::sin(at.angle);
  if (!inside(Vec2f(at.x, at.y), cosine, sine)) return infinity;
  const int reach = side_ / 2;
  const float* value = window.data();
  float sum = 0.0f;
  for (int j = -reach; j <= reach && sum < bound; ++j)
    for (int i = -reach; i <= reach; ++i, ++value) {
      const float u = static_cast<float>(i), v = static_cast<float>(j);
      const float difference = exemplar_.sample(at.x + cosine * u - sine * v, at.y + sine * u + cosine * v) - *value;
      sum += difference * difference;
    }
  return sum;
}

void WindowSearch::refine(const Window& window, float step, float angleStep, Candidate& at) const {
  for (int i = 0; i < maxRefineSteps; ++i) {
    const Candidate centre = at;
    for (int axis = 0; axis < 3; ++axis)
      for (const float sign : {-1.0f, 1.0f}) {
        Candidate next = centre;
        (axis == 0 ? next.x : axis == 1 ? next.y : next.angle) += sign * (axis == 2 ? angleStep : step);
        next.distance = distance(window, next, at.distance);
        if (next.distance < at.distance) at = next;
      }
    if (at.distance == centre.distance) return;
  }
}

WindowSearch::Match WindowSearch::best(const Window& window) const {
  GreyImage image(side_, side_);
  image.data = window;
  const GreyImage soft = blurred(image);
  std::vector<float> query;
  for (int j = -coarseReach_; j <= coarseReach_; ++j)
    for (int i = -coarseReach_; i <= coarseReach_; ++i)
      query.push_back(soft.at(side_ / 2 + 2 * i, side_ / 2 + 2 * j));

  std::vector<Candidate> tiles;
  for (const Turned& turned : turned_) searchCoarsely(turned, query, tiles);
  const auto nearer = [](const Candidate& a, const Candidate& b) {
    return std::tie(a.distance, a.angle, a.y, a.x) < std::tie(b.distance, b.angle, b.y, b.x);
  };
  const auto keep = [&](std::size_t count) {
    count = std::min(count, tiles.size());
    std::partial_sort(tiles.begin(), tiles.begin() + static_cast<std::ptrdiff_t>(count), tiles.end(), nearer);
    tiles.resize(count);
  };
  keep(refinedTiles);
  for (Candidate& tile : tiles) {
    tile.distance = distance(window, tile, infinity);
    refine(window, 1.0f, 4.0f * degree, tile);
  }
  keep(finishedTiles);
  for (Candidate& tile : tiles) refine(window, 0.5f, 2.0f * degree, tile);
  keep(1);
  if (tiles.empty()) return {infinity, 0.0f, 0.0f, 0.0f};
  const Candidate& found = tiles.front();
  return {std::sqrt(found.distance / static_cast<float>(window.size())), found.x, found.y, found.angle};
}

}  // namespace ebru::likeness
