#include "fluid/velocity_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace ebru {

namespace {

constexpr double farthestVoxels = 3.0;
constexpr double stillVoxels = 0.5;
constexpr double movingShare = 0.05;  ///< of a surface's points, for its pair to say something
constexpr std::size_t pointsPerPair = 20000, coarsePoints = 2000;
constexpr double tolerance = 0.1;
constexpr double largestScale = 64.0;

/// Voxels between the surface of `to` and a point carried for a frame by s times the velocity.
double pointResidual(const FramePair& pair, const Vec3f& p, double s) {
  const float h = static_cast<float>(s / pair.from->framesPerSecond);
  Vec3f a = Vec3f::Zero();
  if (!pair.from->velocity->sample(p, a)) return farthestVoxels;
  Vec3f b = a;
  pair.to->velocity->sample(p + h * a, b);
  SampledGrid<1>::Value distance;
  if (!pair.to->signedDistance.sample(p + 0.5f * h * (a + b), distance)) return farthestVoxels;
  if (std::isnan(distance[0])) return farthestVoxels;  // beyond the rim of an open surface
  return std::min<double>(std::abs(distance[0]) / pair.to->voxelSizeWorld, farthestVoxels);
}

/// Points of a frame's surface, and the pair they are judged by.
struct JudgedPoints {
  const FramePair* pair;
  std::vector<Vec3f> positions;
};

/// Every so many vertices.
JudgedPoints spreadPoints(const FramePair& pair) {
  const std::vector<Vec3f>& all = pair.from->mesh.positions;
  JudgedPoints points{&pair, {}};
  for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(1, all.size() / pointsPerPair))
    points.positions.push_back(all[i]);
  return points;
}

/// Of these, the ones that the next surface has moved away from: where it slides within itself, every s fits.
JudgedPoints movingPoints(const JudgedPoints& points) {
  std::vector<std::uint8_t> moves(points.positions.size());
  parallelFor(moves.size(), 512,
              [&](std::size_t i) { moves[i] = pointResidual(*points.pair, points.positions[i], 0.0) >= stillVoxels; });
  JudgedPoints moving{points.pair, {}};
  for (std::size_t i = 0; i < moves.size(); ++i)
    if (moves[i]) moving.positions.push_back(points.positions[i]);
  return moving;
}

/// The mean of the points' residuals.
double residual(const std::vector<JudgedPoints>& sets, double s, std::size_t pointsPerSet) {
  double sum = 0.0, count = 0.0;
  for (const JudgedPoints& set : sets) {
    const std::size_t stride = std::max<std::size_t>(1, set.positions.size() / pointsPerSet);
    const std::size_t points = (set.positions.size() + stride - 1) / stride;
    sum += parallelSum(points, [&](std::size_t i) { return pointResidual(*set.pair, set.positions[i * stride], s); });
    count += static_cast<double>(points);
  }
  return count > 0.0 ? sum / count : 0.0;
}

/// Golden-section search; the residual has one valley between neighbours of the coarse search.
double refine(const std::vector<JudgedPoints>& points, double lower, double upper) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = lower, b = upper;
  double x = b - golden * (b - a), y = a + golden * (b - a);
  double fx = residual(points, x, pointsPerPair), fy = residual(points, y, pointsPerPair);
  for (int step = 0; step < 16; ++step) {
    if (fx <= fy) {
      b = y;
      y = x;
      fy = fx;
      x = b - golden * (b - a);
      fx = residual(points, x, pointsPerPair);
    } else {
      a = x;
      x = y;
      fx = fy;
      y = a + golden * (b - a);
      fy = residual(points, y, pointsPerPair);
    }
  }
  return 0.5 * (a + b);
}

double bestScale(const std::vector<JudgedPoints>& points) {
  constexpr double ratio = 1.15;
  double best = 1.0;
  double bestResidual = residual(points, best, coarsePoints);
  // From 1 outwards, so that of equal ones the most likely wins.
  for (double size = ratio; size <= largestScale; size *= ratio)
    for (double s : {size, 1.0 / size, -size, -1.0 / size}) {
      const double r = residual(points, s, coarsePoints);
      if (r < bestResidual) {
        bestResidual = r;
        best = s;
      }
    }
  if (residual(points, -1.0, coarsePoints) < bestResidual) best = -1.0;
  return refine(points, std::min(best / ratio, best * ratio), std::max(best / ratio, best * ratio));
}

std::string cause(const VelocityCheck& check) {
  const double s = check.scale, fps = check.framesPerSecond;
  const auto near = [&](double value) { return std::abs(s / value - 1.0) < 0.15; };
  if (near(fps)) return "the velocity looks like world units per frame";
  if (near(1.0 / fps)) return "the velocity looks multiplied by the frame rate already";
  if (s < 0.0) return "its sign looks turned round";
  return "usual causes are another frame rate (24, 25, 30), velocity per frame, a turned sign, solver units";
}

}  // namespace

VelocityCheck checkVelocity(const std::vector<FramePair>& allPairs) {
  VelocityCheck check;
  std::vector<JudgedPoints> all, moving;
  for (const FramePair& pair : allPairs) {
    if (pair.from->mesh.empty() || pair.to->mesh.empty()) continue;
    all.push_back(spreadPoints(pair));
    JudgedPoints points = movingPoints(all.back());
    if (static_cast<double>(points.positions.size()) >= movingShare * static_cast<double>(all.back().positions.size()))
      moving.push_back(std::move(points));
  }
  const std::vector<JudgedPoints>& used = moving.empty() ? all : moving;
  check.pairs = static_cast<int>(used.size());
  if (used.empty()) return check;
  check.firstFrame = used.front().pair->from->frame;
  check.lastFrame = used.back().pair->to->frame;
  check.framesPerSecond = used.front().pair->from->framesPerSecond;
  check.residualAtZeroVoxels = residual(used, 0.0, pointsPerPair);
  check.residualAtOneVoxels = residual(used, 1.0, pointsPerPair);
  check.residualVoxels = check.residualAtOneVoxels;
  if (moving.empty()) return check;
  check.scale = bestScale(used);
  check.residualVoxels = residual(used, check.scale, pointsPerPair);
  if (check.residualVoxels > 0.75 * check.residualAtZeroVoxels)
    check.verdict = VelocityCheck::Verdict::unexplained;
  else if (std::abs(check.scale - 1.0) > tolerance)
    check.verdict = VelocityCheck::Verdict::disagrees;
  else
    check.verdict = VelocityCheck::Verdict::agrees;
  return check;
}

VelocityCheck checkVelocity(const FluidSequence& sequence, int first, int last, int pairCount) {
  std::vector<FramePair> pairs;
  const int available = last - first;
  const int count = std::min(pairCount, available);
  for (int i = 0; i < count; ++i) {
    // The middle of each of `count` equal parts.
    const int frame = first + static_cast<int>((2LL * i + 1) * available / (2 * count));
    pairs.push_back({sequence.load(frame), sequence.load(frame + 1)});
  }
  return checkVelocity(pairs);
}

std::string describe(const VelocityCheck& check) {
  if (check.pairs == 0) return "velocity check: no two consecutive frames with fluid; undetermined";
  const std::string where = fmt::format("velocity check, frames {} to {}", check.firstFrame, check.lastFrame);
  const std::string zero = fmt::format("{:.2f} voxel at s = 0", check.residualAtZeroVoxels);
  switch (check.verdict) {
    case VelocityCheck::Verdict::undetermined:
      return fmt::format(
          "{}: undetermined, the surface hardly leaves itself: residual {:.2f} voxel at s = 1, {}", where,
          check.residualAtOneVoxels, zero);
    case VelocityCheck::Verdict::agrees:
      return fmt::format("{}: s = {:.3f}, residual {:.2f} voxel ({})", where, check.scale,
                         check.residualVoxels, zero);
    case VelocityCheck::Verdict::disagrees:
      return fmt::format(
          "{}: velocity: got s = {:.4g} (residual {:.2f} voxel, {:.2f} at s = 1, {}), expected 1; {}; "
          "if so multiply fluid.velocity_scale by {:.4g}",
          where, check.scale, check.residualVoxels, check.residualAtOneVoxels, zero, cause(check),
          check.scale);
    case VelocityCheck::Verdict::unexplained:
      break;
  }
  return fmt::format(
      "{}: velocity: got a residual of {:.2f} voxel at best (s = {:.3g}; {}), expected one well below; "
      "surface and velocity may be of different frames, places or axes",
      where, check.residualVoxels, check.scale, zero);
}

}  // namespace ebru
