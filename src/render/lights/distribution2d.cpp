#include "render/lights/distribution2d.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace ebru {
namespace {

constexpr double steps = 0x1p24;
constexpr float step = 0x1p-24f;

/// Running sums of `weights` in steps of their total, which is returned; all 0 if that is.
double accumulate(const std::vector<double>& weights, std::uint32_t* sums) {
  double total = 0.0, sum = 0.0;
  for (const double weight : weights) total += weight;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    sums[i] = total > 0.0 ? static_cast<std::uint32_t>(std::lround(steps * (sum / total))) : 0;
  }
  return total;
}

std::uint32_t size(const std::uint32_t* sums, int i) {
  return sums[i] - (i > 0 ? sums[i - 1] : 0);
}

/// The cell into which `u` falls, and how far into it: the middle of its step.
int find(const std::uint32_t* sums, int count, float u, float& within) {
  const auto target = static_cast<std::uint32_t>(u / step);
  const auto cell = static_cast<int>(std::upper_bound(sums, sums + count, target) - sums);
  const std::uint32_t before = cell > 0 ? sums[cell - 1] : 0;
  within = (static_cast<float>(target - before) + 0.5f) / static_cast<float>(sums[cell] - before);
  return cell;
}

}  // namespace

Distribution2d::Distribution2d(int width, int height, const RowWeights& rowWeights)
    : width_(width), height_(height) {
  const auto cells = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  conditional_.resize(cells * rows);
  marginal_.resize(rows);
  std::vector<double> totals(rows);
  parallelFor(rows, 8, [&](std::size_t y) {
    std::vector<double> weights(cells);
    rowWeights(static_cast<int>(y), weights);
    totals[y] = accumulate(weights, conditional_.data() + y * cells);
  });
  if (accumulate(totals, marginal_.data()) > 0.0) return;
  marginal_.clear();
  conditional_.clear();
}

Distribution2d::Place Distribution2d::sample(const Vec2f& u) const {
  Place place;
  place.y = find(marginal_.data(), height_, u.y(), place.within.y());
  place.x = find(row(place.y), width_, u.x(), place.within.x());
  place.probability = probability(place.x, place.y);
  return place;
}

float Distribution2d::probability(int x, int y) const {
  return (static_cast<float>(size(marginal_.data(), y)) * step) *
         (static_cast<float>(size(row(y), x)) * step);
}

}  // namespace ebru
