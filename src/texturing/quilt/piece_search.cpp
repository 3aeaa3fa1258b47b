#include "texturing/quilt/piece_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace ebru {
namespace {

constexpr int searchLevel = 2;
constexpr int angles = 16;
constexpr std::size_t batch = 8;  ///< samples between two looks at the bound

}  // namespace

struct PieceSearch::Query {
  std::span<const FitSample> samples;
  std::span<const float> penalty;
  std::vector<Vec2i> steps;  ///< of the samples from the centre, texels of the coarse level
  Mat2f rotation;
  std::uint32_t seed;
  float noise;
};

PieceSearch::PieceSearch(const Exemplar& exemplar) {
  const int level = std::min(searchLevel, exemplar.levelCount() - 1);
  const int scale = 1 << level;
  scale_ = static_cast<float>(scale);
  for (int t = 0; t < exemplar.tileCount(); ++t) {
    const Tile tile{exemplar.tileOrigin(t) / scale, exemplar.tileSize(t) / scale, texels_.size()};
    for (int y = 0; y < tile.size.y(); ++y)
      for (int x = 0; x < tile.size.x(); ++x) texels_.push_back(exemplar.sample(level, tile.centre(x, y)));
    tiles_.push_back(tile);
  }
}

std::vector<float> PieceSearch::penalties(const ExemplarUsage& usage, float perExcess) const {
  std::vector<float> penalty(texels_.size());
  for (const Tile& tile : tiles_)
    for (int y = 0; y < tile.size.y(); ++y)
      for (int x = 0; x < tile.size.x(); ++x)
        penalty[tile.at(x, y)] = perExcess * usage.excess(scale_ * tile.centre(x, y));
  return penalty;
}

void PieceSearch::search(std::span<const FitSample> samples, std::span<const float> penalty, float radius,
                         std::uint32_t seed, float noise, std::vector<Placement>& found) const {
  std::vector<Best> best;
  Query query{samples, penalty, std::vector<Vec2i>(samples.size()), Mat2f::Identity(), seed, noise};
  for (int a = 0; a < angles; ++a) {
    const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(a) / angles;
    query.rotation = Eigen::Rotation2Df(angle).toRotationMatrix();
    query.seed = hashCombine(seed, static_cast<std::uint32_t>(a));
    int margin = static_cast<int>(std::ceil(radius / scale_));
    for (std::size_t k = 0; k < samples.size(); ++k) {
      query.steps[k] = (query.rotation * samples[k].displacement / scale_).array().round().cast<int>().matrix();
      margin = std::max(margin, query.steps[k].cwiseAbs().maxCoeff());
    }
    best.push_back({{Vec2f::Zero(), query.rotation}, std::numeric_limits<float>::max()});
    for (const Tile& tile : tiles_) searchTile(tile, query, margin, best.back());
  }
  std::stable_sort(best.begin(), best.end(), [](const Best& p, const Best& q) { return p.cost < q.cost; });
  found.clear();
  for (const Best& b : best) found.push_back(b.placement);
}

void PieceSearch::searchTile(const Tile& tile, const Query& query, int margin, Best& best) const {
  const Vec2i border = ((tile.size.array() - 1) / 2).min(margin).matrix();
  std::vector<std::ptrdiff_t> offsets(query.steps.size());
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    const Vec2i step = query.steps[k].cwiseMin(border).cwiseMax(-border);
    offsets[k] = step.y() * tile.size.x() + step.x();
  }
  const float share = 1.0f / static_cast<float>(std::max<std::size_t>(1, query.samples.size()));
  // Every second place, like the black squares of a chess board: what is refined later need not be met exactly.
  for (int y = border.y(); y < tile.size.y() - border.y(); ++y)
    for (int x = border.x() + (y & 1); x < tile.size.x() - border.x(); x += 2) {
      const std::size_t at = tile.at(x, y);
      const std::uint32_t random = hashCombine(query.seed, static_cast<std::uint32_t>(at)) & 0xffffu;
      float cost = query.penalty[at] + query.noise * static_cast<float>(random) / 65536.0f;
      for (std::size_t k = 0; k < offsets.size() && cost < best.cost;) {
        Texel squares = Texel::Zero();
        for (const std::size_t end = std::min(offsets.size(), k + batch); k < end; ++k) {
          const Texel& there = texels_[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + offsets[k])];
          squares += query.samples[k].weight * (query.samples[k].colour - there).square();
        }
        cost += share * squares.sum();
      }
      if (cost < best.cost) best = {{scale_ * tile.centre(x, y), query.rotation}, cost};
    }
}

}  // namespace ebru
