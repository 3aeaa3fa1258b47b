#include "texturing/quilt/piece_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace ebru {
namespace {

constexpr int searchLevel = 2;
constexpr int turns = 16;
constexpr int stride = 4;         ///< of the first look, in places of a row; every second angle is looked at
constexpr std::size_t batch = 8;  ///< samples between two looks at the bound

}  // namespace

/// Samples turned, and what else a place costs.
struct PieceSearch::Query {
  std::span<const FitSample> samples;
  std::span<const float> penalty;
  std::vector<Vec2i> steps;  ///< of the samples from the centre, texels of the coarse level
  Mat2f rotation;
  int margin;  ///< of the centre from a tile's border
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
  std::vector<Query> queries;
  for (int turn = 0; turn < turns; ++turn) {
    const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(turn) / turns;
    Query& q = queries.emplace_back();
    q = {samples, penalty, std::vector<Vec2i>(samples.size()), Eigen::Rotation2Df(angle).toRotationMatrix(),
         static_cast<int>(std::ceil(radius / scale_)),
         static_cast<std::uint32_t>(hashCombine(seed, static_cast<std::uint32_t>(turn))), noise};
    for (std::size_t k = 0; k < samples.size(); ++k) {
      q.steps[k] = (q.rotation * samples[k].displacement / scale_).array().round().cast<int>().matrix();
      q.margin = std::max(q.margin, q.steps[k].cwiseAbs().maxCoeff());
    }
  }
  std::vector<Best> best;
  for (std::size_t turn = 0; turn < turns; turn += 2) {
    Best b{&tiles_.front(), tiles_.front().size / 2};
    for (const Tile& tile : tiles_) compare(tile, queries[turn], Vec2i::Zero(), tile.size, stride, b);
    const Vec2i place = b.place, reach = Vec2i::Constant(stride / 2);
    for (const std::size_t near : {turn + turns - 1, turn, turn + 1})
      compare(*b.tile, queries[near % turns], place - reach, place + reach + Vec2i::Ones(), 1, b);
    best.push_back(b);
  }
  std::stable_sort(best.begin(), best.end(), [](const Best& p, const Best& q) { return p.cost < q.cost; });
  found.clear();
  for (const Best& b : best) found.push_back({scale_ * b.tile->centre(b.place.x(), b.place.y()), b.rotation});
}

void PieceSearch::compare(const Tile& tile, const Query& query, const Vec2i& from, const Vec2i& to, int every, Best& best) const {
  const Vec2i border = ((tile.size.array() - 1) / 2).min(query.margin).matrix();
  const Vec2i first = from.cwiseMax(border), end = to.cwiseMin(tile.size - border);
  std::vector<std::ptrdiff_t> offsets(query.steps.size());
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    const Vec2i step = query.steps[k].cwiseMin(border).cwiseMax(-border);
    offsets[k] = step.y() * tile.size.x() + step.x();
  }
  const float share = 1.0f / static_cast<float>(std::max<std::size_t>(1, query.samples.size()));
  // Places of a row lie between those of the row before, if it is long enough.
  const int shift = first.x() + every / 2 < end.x() ? every / 2 : 0;
  for (int y = first.y(); y < end.y(); ++y)
    for (int x = first.x() + shift * (y & 1); x < end.x(); x += every) {
      const std::size_t at = tile.at(x, y);
      const std::uint32_t random = hashCombine(query.seed, static_cast<std::uint32_t>(at)) & 0xffffu;
      float cost = query.penalty[at] + query.noise * static_cast<float>(random) / 65536.0f;
      for (std::size_t k = 0; k < offsets.size() && cost < best.cost;) {
        Texel squares = Texel::Zero();
        for (const std::size_t stop = std::min(offsets.size(), k + batch); k < stop; ++k) {
          const Texel& there = texels_[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + offsets[k])];
          squares += query.samples[k].weight * (query.samples[k].colour - there).square();
        }
        cost += share * squares.sum();
      }
      if (cost < best.cost) best = {&tile, {x, y}, query.rotation, cost};
    }
}

}  // namespace ebru
