#include "exemplar/neighbourhood_search.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

#include "core/parallel.h"
#include "core/random.h"

namespace ebru {
namespace {

constexpr int raster = NeighbourhoodSearch::raster;
constexpr int pixels = NeighbourhoodSearch::pixels;
constexpr int dimensions = NeighbourhoodSearch::dimensions;
constexpr int channels = 4;
constexpr float kdTreeEps = 1.5f;
/// The tree holds every second window of every second row: matches are refined to fractions of a texel afterwards.
constexpr int treeStride = 2;
using Raw = Eigen::Matrix<float, pixels * channels, 1>;
using Projection = Eigen::Matrix<float, dimensions, pixels * channels>;

/// The windows of one tile, numbered row by row.
struct TileWindows {
  int tile;
  Vec2i origin;       ///< of the tile on the level
  int columns, rows;  ///< of window centres
  std::size_t first;  ///< number of its first window

  std::size_t end() const { return first + static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::size_t index(int x, int y) const {
    return first + static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x);
  }
  Vec2i corner(std::size_t i) const {
    const auto width = static_cast<std::size_t>(columns);
    return {static_cast<int>((i - first) % width), static_cast<int>((i - first) / width)};
  }
};

/// The windows in the tree, in the order of their positions: tile by tile and row by row.
struct DescriptorCloud {
  const NeighbourhoodSearch::Descriptor* descriptors = nullptr;  ///< of all windows
  std::vector<std::uint32_t> windows;                            ///< their numbers

  std::size_t kdtree_get_point_count() const { return windows.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return descriptors[windows[i]][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Adaptor<float, DescriptorCloud>, DescriptorCloud,
                                                 dimensions, std::uint32_t>;

/// The single nearest below a bound, ties by index.
class NearestOne {
 public:
  using DistanceType = float;
  explicit NearestOne(float bound) : limit_(bound) {}
  bool full() const { return true; }
  std::size_t size() const { return found_; }
  float worstDist() const { return limit_; }
  bool addPoint(float distance, std::uint32_t index) {
    // The tree compares a whole leaf with the limit it had before the leaf.
    if (found_ && (distance > distance_ || (distance == distance_ && index > index_))) return true;
    found_ = true;
    distance_ = distance;
    index_ = index;
    // One ulp of room, so that an equally distant window of a lower index still comes in.
    limit_ = std::nextafter(distance, std::numeric_limits<float>::infinity());
    return true;
  }
  std::uint32_t index() const { return index_; }
  float distance() const { return distance_; }

 private:
  bool found_ = false;
  float limit_;
  float distance_ = 0.0f;
  std::uint32_t index_ = 0;
};

}  // namespace

struct NeighbourhoodSearch::Impl {
  const Exemplar& exemplar;
  int level, window, spacing, half;
  std::array<float, pixels> weights;
  Raw mean = Raw::Zero();
  Projection projection = Projection::Zero();
  std::vector<Descriptor> descriptors;  ///< of all windows, tile by tile and row by row; none for the gaps
  std::vector<TileWindows> tiles;
  DescriptorCloud cloud;
  std::unique_ptr<Tree> tree;

  Impl(const Exemplar& e, int l, int w) : exemplar(e), level(l), window(w), spacing(w / 8), half(w / 2) {
    numberWindows();
    computeWeights();
    analyse();
    descriptors.resize(tiles.back().end());
    cloud.descriptors = descriptors.data();
    for (const TileWindows& tile : tiles)
      parallelFor(static_cast<std::size_t>(tile.rows), 1, [&](std::size_t y) {
        for (int x = 0; x < tile.columns; ++x)
          descriptors[tile.index(x, static_cast<int>(y))] =
              projection * (weighted(windowAt(tile.tile, x + half, static_cast<int>(y) + half)) - mean);
      });
    tree = std::make_unique<Tree>(dimensions, cloud,
                                  nanoflann::KDTreeSingleIndexAdaptorParams(8));
  }

  void numberWindows() {
    std::size_t first = 0;
    for (int t = 0; t < exemplar.tileCount(); ++t) {
      const Vec2i& size = exemplar.tileSize(t, level);
      const TileWindows tile{t, exemplar.tileOrigin(t, level), size.x() - 2 * half, size.y() - 2 * half, first};
      for (int y = 0; y < tile.rows; y += treeStride)
        for (int x = 0; x < tile.columns; x += treeStride)
          cloud.windows.push_back(static_cast<std::uint32_t>(tile.index(x, y)));
      first = tile.end();
      tiles.push_back(tile);
    }
  }

  /// @param i  of the cloud
  Match match(std::size_t i, float distance) const {
    const std::size_t window = cloud.windows[i];
    const TileWindows& tile = tileOf(window);
    return {tile.origin + tile.corner(window) + Vec2i::Constant(half), distance};
  }

  const TileWindows& tileOf(std::size_t window) const {
    return *std::find_if(tiles.begin(), tiles.end(), [&](const TileWindows& tile) { return window < tile.end(); });
  }
  /// The tile that a coordinate of the level belongs to.
  const TileWindows& tileAt(const Vec2f& uv) const {
    return tiles[static_cast<std::size_t>(exemplar.tileAt(uv * static_cast<float>(1 << level)))];
  }

  void computeWeights() {
    float sum = 0.0f;
    for (int j = 0; j < raster; ++j)
      for (int i = 0; i < raster; ++i) {
        const float dx = static_cast<float>(i - raster / 2), dy = static_cast<float>(j - raster / 2);
        sum += weights[static_cast<std::size_t>(j * raster + i)] = std::exp(-(dx * dx + dy * dy) / (2.0f * 9.0f));
      }
    for (float& w : weights) w /= sum;
  }

  /// @param x, y  centre, in texels of the tile
  Window windowAt(int tile, int x, int y) const {
    const TexelPyramid& texels = exemplar.texels(tile);
    const Vec2i& size = texels.size(level);
    Window result;
    for (int j = 0; j < raster; ++j)
      for (int i = 0; i < raster; ++i) {
        const int cx = x + (i - raster / 2) * spacing, cy = y + (j - raster / 2) * spacing;
        Texel value = texels.texel(level, cx, cy);
        if (spacing == 2) {
          // The tent of width 2 that the same raster sees on a surface.
          const auto at = [&](int dx, int dy) {
            return texels.texel(level, std::clamp(cx + dx, 0, size.x() - 1), std::clamp(cy + dy, 0, size.y() - 1));
          };
          value = 0.25f * value + 0.125f * (at(-1, 0) + at(1, 0) + at(0, -1) + at(0, 1)) +
                  0.0625f * (at(-1, -1) + at(1, -1) + at(-1, 1) + at(1, 1));
        }
        result[static_cast<std::size_t>(j * raster + i)] = value;
      }
    return result;
  }

  Raw weighted(const Window& w) const {
    Raw raw;
    for (std::size_t p = 0; p < pixels; ++p)
      raw.segment<channels>(static_cast<Eigen::Index>(p) * channels) = (w[p] * std::sqrt(weights[p])).matrix();
    return raw;
  }

  /// Principal components of a fixed sample of the windows.
  void analyse() {
    constexpr int wanted = 3000;
    const std::size_t total = tiles.back().end();
    const std::size_t count = std::min<std::size_t>(total, wanted);
    Eigen::MatrixXf samples(pixels * channels, static_cast<Eigen::Index>(count));
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = total <= wanted ? k : Random(17, 0, k).below(static_cast<std::uint32_t>(total));
      const TileWindows& tile = tileOf(i);
      const Vec2i centre = tile.corner(i) + Vec2i::Constant(half);
      samples.col(static_cast<Eigen::Index>(k)) = weighted(windowAt(tile.tile, centre.x(), centre.y()));
    }
    mean = samples.rowwise().mean();
    samples.colwise() -= mean;
    const Eigen::MatrixXf covariance = samples * samples.transpose() / static_cast<float>(count);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> solver(covariance);
    projection = solver.eigenvectors().rightCols<dimensions>().rowwise().reverse().transpose();
  }
};

NeighbourhoodSearch::NeighbourhoodSearch(const Exemplar& exemplar, int level, int window)
    : impl_(std::make_unique<Impl>(exemplar, level, window)) {}
NeighbourhoodSearch::~NeighbourhoodSearch() = default;
NeighbourhoodSearch::NeighbourhoodSearch(NeighbourhoodSearch&&) noexcept = default;

int NeighbourhoodSearch::window() const { return impl_->window; }
int NeighbourhoodSearch::level() const { return impl_->level; }
float NeighbourhoodSearch::pixelSpacing() const { return static_cast<float>(impl_->spacing); }
const std::array<float, pixels>& NeighbourhoodSearch::weights() const { return impl_->weights; }

NeighbourhoodSearch::Descriptor NeighbourhoodSearch::describe(const Window& window) const {
  return impl_->projection * (impl_->weighted(window) - impl_->mean);
}

NeighbourhoodSearch::Match NeighbourhoodSearch::nearest(const Descriptor& query, const Match& bound) const {
  NearestOne best(bound.distanceSquared);
  nanoflann::SearchParams parameters;
  parameters.eps = kdTreeEps;
  impl_->tree->findNeighbors(best, query.data(), parameters);
  if (best.size() == 0) return bound;
  return impl_->match(best.index(), best.distance());
}

std::size_t NeighbourhoodSearch::nearestFew(const Descriptor& query, std::span<Match> found) const {
  std::vector<std::uint32_t> indices(found.size());
  std::vector<float> distances(found.size());
  nanoflann::KNNResultSet<float, std::uint32_t> result(found.size());
  result.init(indices.data(), distances.data());
  nanoflann::SearchParams parameters;
  parameters.eps = kdTreeEps;
  impl_->tree->findNeighbors(result, query.data(), parameters);
  for (std::size_t k = 0; k < result.size(); ++k)
    found[k] = impl_->match(indices[k], distances[k]);
  return result.size();
}

NeighbourhoodSearch::Match NeighbourhoodSearch::at(const Vec2i& texel, const Descriptor& query) const {
  const TileWindows& tile = impl_->tileAt(texel.cast<float>() + Vec2f::Constant(0.5f));
  const Vec2i corner = texel - tile.origin - Vec2i::Constant(impl_->half);
  const int x = std::clamp(corner.x(), 0, tile.columns - 1);
  const int y = std::clamp(corner.y(), 0, tile.rows - 1);
  const Vec2i centre = tile.origin + Vec2i(x + impl_->half, y + impl_->half);
  return {centre, (impl_->descriptors[tile.index(x, y)] - query).squaredNorm()};
}

Vec2f NeighbourhoodSearch::clampInside(const Vec2f& uv) const {
  const TileWindows& tile = impl_->tileAt(uv);
  const Vec2f margin = Vec2f::Constant(static_cast<float>(impl_->half) + 0.5f);
  const Vec2f first = tile.origin.cast<float>() + margin;
  const Vec2f last = (tile.origin + impl_->exemplar.tileSize(tile.tile, impl_->level)).cast<float>() - margin;
  return uv.cwiseMax(first).cwiseMin(last);
}

}  // namespace ebru
