#include "exemplar/local_variance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace ebru {
namespace {

constexpr int cellTexels = 4;

/// Summed-area table of the means over cells.
cv::Mat integralOfCells(const cv::Mat& texels, const cv::Size& cells) {
  cv::Mat means, sums;
  cv::resize(texels, means, cells, 0.0, 0.0, cv::INTER_AREA);
  cv::integral(means, sums, CV_64F);
  return sums;
}

}  // namespace

LocalVariance::LocalVariance(const Exemplar& exemplar) : exemplar_(exemplar) {
  Sums all;
  double count = 0.0;
  for (int t = 0; t < exemplar.tileCount(); ++t) {
    const Vec2i size = exemplar.tileSize(t), cells = size / cellTexels;
    // OpenCV takes no constant data, and only reads this.
    const cv::Mat texels(size.y(), size.x(), CV_32FC4, const_cast<Texel*>(exemplar.texels(t).texels(0).data()));
    cv::Mat squares;
    cv::transform(texels.mul(texels), squares, cv::Mat::ones(1, 4, CV_32F));
    const cv::Mat texelSums = integralOfCells(texels, {cells.x(), cells.y()}),
                  squareSums = integralOfCells(squares, {cells.x(), cells.y()});
    Tile& tile = tiles_.emplace_back(Tile{cells, size.cast<float>().cwiseQuotient(cells.cast<float>()), {}});
    for (int y = 0; y <= cells.y(); ++y)
      for (int x = 0; x <= cells.x(); ++x) {
        const cv::Vec4d& s = texelSums.at<cv::Vec4d>(y, x);
        tile.sums.push_back({{s[0], s[1], s[2], s[3]}, squareSums.at<double>(y, x)});
      }
    const double area = cells.prod();
    all.texels += tile.sums.back().texels;
    all.squares += tile.sums.back().squares;
    count += area;
  }
  whole_ = variance(all, count);
}

double LocalVariance::variance(const Sums& sums, double count) {
  return std::max(0.0, sums.squares / count - (sums.texels / count).square().sum());
}

float LocalVariance::relative(const Vec2f& uv, float radius) const {
  if (whole_ < 1e-8) return 1.0f;
  const int t = exemplar_.tileAt(uv);
  const Tile& tile = tiles_[static_cast<std::size_t>(t)];
  const Vec2f local = uv - exemplar_.tileOrigin(t).cast<float>();
  const float half = 0.5f * std::sqrt(std::numbers::pi_v<float>) * radius;
  const Eigen::Array2i most = tile.cells.array();
  const Eigen::Array2i from = ((local.array() - half) / tile.cell.array()).round().cast<int>().max(0).min(most - 1);
  const Eigen::Array2i to = ((local.array() + half) / tile.cell.array()).round().cast<int>().min(most).max(from + 1);
  const auto at = [&](int x, int y) -> const Sums& {
    return tile.sums[static_cast<std::size_t>(y * (tile.cells.x() + 1) + x)];
  };
  const Sums &a = at(from.x(), from.y()), &b = at(to.x(), from.y()), &c = at(from.x(), to.y()), &d = at(to.x(), to.y());
  const Sums sums{d.texels - b.texels - c.texels + a.texels, d.squares - b.squares - c.squares + a.squares};
  return static_cast<float>(variance(sums, (to - from).prod()) / whole_);
}

}  // namespace ebru
