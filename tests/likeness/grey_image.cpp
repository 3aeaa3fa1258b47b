#include "likeness/grey_image.h"

#include <algorithm>

namespace ebru::likeness {
namespace {

void cubicWeights(float t, float w[4]) {
  const float t2 = t * t, t3 = t2 * t;
  w[0] = 0.5f * (-t3 + 2.0f * t2 - t);
  w[1] = 0.5f * (3.0f * t3 - 5.0f * t2 + 2.0f);
  w[2] = 0.5f * (-3.0f * t3 + 4.0f * t2 + t);
  w[3] = 0.5f * (t3 - t2);
}

}  // namespace

float GreyImage::sample(float x, float y) const {
  float tx, ty, wx[4], wy[4];
  const int x0 = pixelBefore(x, tx) - 1, y0 = pixelBefore(y, ty) - 1;
  cubicWeights(tx, wx);
  cubicWeights(ty, wy);
  float sum = 0.0f;
  if (x0 >= 0 && y0 >= 0 && x0 + 3 < width && y0 + 3 < height) {
    const float* row = &data[index(x0, y0)];
    for (int j = 0; j < 4; ++j, row += width)
      sum += wy[j] * (wx[0] * row[0] + wx[1] * row[1] + wx[2] * row[2] + wx[3] * row[3]);
    return sum;
  }
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      sum += wy[j] * wx[i] * at(std::clamp(x0 + i, 0, width - 1), std::clamp(y0 + j, 0, height - 1));
  return sum;
}

double meanOf(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float v : values) sum += v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double deviationOf(const std::vector<float>& values) {
  const double mean = meanOf(values);
  double sum = 0.0;
  for (const float v : values) sum += (v - mean) * (v - mean);
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace ebru::likeness
