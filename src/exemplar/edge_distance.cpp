#include "exemplar/edge_distance.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace ebru {
namespace {

/// Derivatives of the channel whose gradient is longest, as Canny takes them.
void strongestDerivatives(const cv::Mat& lab, cv::Mat& dx, cv::Mat& dy, std::vector<float>& magnitudes) {
  cv::Mat allX, allY;
  cv::Scharr(lab, allX, CV_32F, 1, 0);
  cv::Scharr(lab, allY, CV_32F, 0, 1);
  dx.create(lab.size(), CV_16S);
  dy.create(lab.size(), CV_16S);
  for (int y = 0; y < lab.rows; ++y)
    for (int x = 0; x < lab.cols; ++x) {
      const auto gx = allX.at<cv::Vec3f>(y, x), gy = allY.at<cv::Vec3f>(y, x);
      int strongest = 0;
      float most = -1.0f;
      for (int c = 0; c < 3; ++c) {
        const float squared = gx[c] * gx[c] + gy[c] * gy[c];
        if (squared > most) {
          most = squared;
          strongest = c;
        }
      }
      // Scharr's kernel weighs 16 per side: Lab differences of up to 100 per texel fit the 16 bits that Canny takes.
      dx.at<short>(y, x) = cv::saturate_cast<short>(gx[strongest] * 4.0f);
      dy.at<short>(y, x) = cv::saturate_cast<short>(gy[strongest] * 4.0f);
      magnitudes.push_back(4.0f * std::sqrt(most));
    }
}

}  // namespace

std::vector<float> edgeDistance(const Vec2i& size, const std::vector<Vec3f>& colour, float blurTexels) {
  cv::Mat picture(size.y(), size.x(), CV_32FC3);
  for (int y = 0; y < size.y(); ++y)
    for (int x = 0; x < size.x(); ++x) {
      const Vec3f& c = colour[static_cast<std::size_t>(y * size.x() + x)];
      picture.at<cv::Vec3f>(y, x) = {c.x(), c.y(), c.z()};
    }
  cv::Mat lab, dx, dy, edges, distance;
  cv::cvtColor(picture, lab, cv::COLOR_RGB2Lab);
  cv::GaussianBlur(lab, lab, cv::Size(), blurTexels, blurTexels, cv::BORDER_REFLECT);
  std::vector<float> magnitudes;
  magnitudes.reserve(colour.size());
  strongestDerivatives(lab, dx, dy, magnitudes);
  const auto upper = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() * 4 / 5);
  std::nth_element(magnitudes.begin(), upper, magnitudes.end());
  const double threshold = std::max(1.0f, *upper);
  cv::Canny(dx, dy, edges, 0.4 * threshold, threshold, true);
  if (cv::countNonZero(edges) == 0) return std::vector<float>(colour.size(), 1.0f);
  cv::distanceTransform(255 - edges, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  std::vector<float> result;
  result.reserve(colour.size());
  for (int y = 0; y < size.y(); ++y) result.insert(result.end(), distance.ptr<float>(y), distance.ptr<float>(y) + size.x());
  return result;
}

}  // namespace ebru
