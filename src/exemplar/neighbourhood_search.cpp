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

/// The windows in the tree, numbered row by row.
struct DescriptorCloud {
  const std::vector<NeighbourhoodSearch::Descriptor>* descriptors;
  int columns, rows;  ///< of all windows

  int treeColumns() const { return (columns + treeStride - 1) / treeStride; }
  int treeRows() const { return (rows + treeStride - 1) / treeStride; }
  Vec2i place(std::size_t i) const {
    return treeStride * Vec2i(static_cast<int>(i) % treeColumns(), static_cast<int>(i) / treeColumns());
  }
  std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(treeColumns() * treeRows()); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    const Vec2i at = place(i);
    return (*descriptors)[static_cast<std::size_t>(at.y() * columns + at.x())][static_cast<Eigen::Index>(axis)];
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
  int columns, rows;  ///< of window centres
  std::array<float, pixels> weights;
  Raw mean = Raw::Zero();
  Projection projection = Projection::Zero();
  std::vector<Descriptor> descriptors;  ///< rows * columns
  DescriptorCloud cloud{};
  std::unique_ptr<Tree> tree;

  Impl(const Exemplar& e, int l, int w) : exemplar(e), level(l), window(w), spacing(w / 8), half(w / 2) {
    columns = exemplar.width(level) - 2 * half;
    rows = exemplar.height(level) - 2 * half;
    computeWeights();
    analyse();
    descriptors.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    parallelFor(static_cast<std::size_t>(rows), 1, [&](std::size_t y) {
      for (int x = 0; x < columns; ++x)
        descriptors[y * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)] =
            projection * (weighted(windowAt(x + half, static_cast<int>(y) + half)) - mean);
    });
    cloud = {&descriptors, columns, rows};
    tree = std::make_unique<Tree>(dimensions, cloud,
                                  nanoflann::KDTreeSingleIndexAdaptorParams(8));
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

  Window windowAt(int x, int y) const {
    Window result;
    for (int j = 0; j < raster; ++j)
      for (int i = 0; i < raster; ++i) {
        const int cx = x + (i - raster / 2) * spacing, cy = y + (j - raster / 2) * spacing;
        Texel value = exemplar.texel(level, cx, cy);
        if (spacing == 2) {
          // The tent of width 2 that the same raster sees on a surface.
          const auto at = [&](int dx, int dy) {
            return exemplar.texel(level, std::clamp(cx + dx, 0, exemplar.width(level) - 1),
                                  std::clamp(cy + dy, 0, exemplar.height(level) - 1));
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
    const std::size_t total = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    const std::size_t count = std::min<std::size_t>(total, wanted);
    Eigen::MatrixXf samples(pixels * channels, static_cast<Eigen::Index>(count));
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = total <= wanted ? k : Random(17, 0, k).below(static_cast<std::uint32_t>(total));
      samples.col(static_cast<Eigen::Index>(k)) =
          weighted(windowAt(static_cast<int>(i % static_cast<std::size_t>(columns)) + half,
                            static_cast<int>(i / static_cast<std::size_t>(columns)) + half));
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
  return {impl_->cloud.place(best.index()) + Vec2i::Constant(impl_->half), best.distance()};
}

NeighbourhoodSearch::Match NeighbourhoodSearch::at(const Vec2i& texel, const Descriptor& query) const {
  const int x = std::clamp(texel.x() - impl_->half, 0, impl_->columns - 1);
  const int y = std::clamp(texel.y() - impl_->half, 0, impl_->rows - 1);
  const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(impl_->columns) + static_cast<std::size_t>(x);
  return {{x + impl_->half, y + impl_->half}, (impl_->descriptors[i] - query).squaredNorm()};
}

Vec2f NeighbourhoodSearch::clampInside(const Vec2f& uv) const {
  const float margin = static_cast<float>(impl_->half) + 0.5f;
  const float w = static_cast<float>(impl_->exemplar.width(impl_->level));
  const float h = static_cast<float>(impl_->exemplar.height(impl_->level));
  return {std::clamp(uv.x(), margin, w - margin), std::clamp(uv.y(), margin, h - margin)};
}

}  // namespace ebru
