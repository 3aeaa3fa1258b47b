#include "likeness/picture_windows.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/error.h"
#include "core/random.h"
#include "core/vec.h"
#include "exemplar/exemplar.h"
#include "likeness/grey_image.h"

namespace ebru::likeness {
namespace {

constexpr double maxPixelTexels = 1.25;
constexpr double maxBendTexels = 2.0;
constexpr int triesPerWindow = 60;

const std::vector<float>& plane(const ChannelImage& picture, const char* name) {
  const ChannelImage::Channel* channel = picture.find(name);
  if (!channel) throw InputError(fmt::format("channel {} is missing", name));
  return channel->data;
}

class Surface {
 public:
  Surface(const ChannelImage& picture, double texelSizeWorld)
      : texel_(texelSizeWorld),
        luma_(picture.width, picture.height),
        mask_(plane(picture, "texture.mask")),
        p_{&plane(picture, "P.X"), &plane(picture, "P.Y"), &plane(picture, "P.Z")},
        n_{&plane(picture, "N.X"), &plane(picture, "N.Y"), &plane(picture, "N.Z")} {
    const auto* attribute = picture.attribute("worldToNDC");
    const Mat4d* matrix = attribute ? std::get_if<Mat4d>(attribute) : nullptr;
    if (!matrix) throw InputError("header: worldToNDC is missing");
    worldToNdc_ = *matrix;
    const auto &r = plane(picture, "albedo.R"), &g = plane(picture, "albedo.G"), &b = plane(picture, "albedo.B");
    for (std::size_t i = 0; i < luma_.data.size(); ++i)
      luma_.data[i] = encodedTexel(Vec3f(r[i], g[i], b[i]), 0.0f).head<3>().mean();
  }

  const GreyImage& luma() const { return luma_; }

  /// The longest extent of the pixel on the surface, in texels, if a window may have its centre there.
  std::optional<double> usablePixelTexels(int x, int y) const {
    if (!seesFluid(x, y)) return std::nullopt;
    const Vec3d p = position(x, y), n = normal(x, y);
    if (!(n.norm() > 0.5) || project(p + texel_ * n).z() >= project(p).z()) return std::nullopt;
    Vec3f tangent, bitangent;
    completeFrame(n.cast<float>(), tangent, bitangent);
    Eigen::Matrix2d pixelsPerTexel;
    pixelsPerTexel.col(0) = (project(p + texel_ * tangent.cast<double>()) - project(p)).head<2>();
    pixelsPerTexel.col(1) = (project(p + texel_ * bitangent.cast<double>()) - project(p)).head<2>();
    const double smallest = pixelsPerTexel.jacobiSvd().singularValues()[1];
    if (smallest * maxPixelTexels < 1.0) return std::nullopt;
    return 1.0 / smallest;
  }

  /// The window around pixel (x, y), turned by `angle` from an arbitrary tangent.
  std::optional<Window> window(int x, int y, double angle, int side) const {
    const Vec3d centre = position(x, y);
    Vec3f tangent, bitangent;
    completeFrame(normal(x, y).cast<float>(), tangent, bitangent);
    const Vec3d t = tangent.cast<double>(), b = bitangent.cast<double>();
    const Vec3d across = std::cos(angle) * t + std::sin(angle) * b;
    // Down the window: with the normal towards the eye and `across` to the right, the bitangent points up.
    const Vec3d down = std::sin(angle) * t - std::cos(angle) * b;
    Window window;
    window.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int j = -side / 2; j <= side / 2; ++j)
      for (int i = -side / 2; i <= side / 2; ++i) {
        const Vec3d point = centre + texel_ * (i * across + j * down);
        const Vec3d raster = project(point);
        if (!seen(raster, point)) return std::nullopt;
        window.push_back(luma_.sample(static_cast<float>(raster.x()), static_cast<float>(raster.y())));
      }
    return window;
  }

 private:
  bool seesFluid(int x, int y) const { return mask_[luma_.index(x, y)] == 1.0f; }

  Vec3d position(int x, int y) const { return vector(p_, luma_.index(x, y)); }
  Vec3d normal(int x, int y) const { return vector(n_, luma_.index(x, y)); }
  static Vec3d vector(const std::vector<float>* const (&planes)[3], std::size_t i) {
    return {(*planes[0])[i], (*planes[1])[i], (*planes[2])[i]};
  }

  /// Column and row in pixels, and a depth that increases away from the camera.
  Vec3d project(const Vec3d& p) const {
    const Eigen::RowVector4d h = Eigen::RowVector4d(p.x(), p.y(), p.z(), 1.0) * worldToNdc_;
    return {h[0] / h[3] * luma_.width, h[1] / h[3] * luma_.height, h[2] / h[3]};
  }

  bool seen(const Vec3d& raster, const Vec3d& point) const {
    if (!(raster.x() >= 2.0 && raster.y() >= 2.0 && raster.x() <= luma_.width - 2.0 && raster.y() <= luma_.height - 2.0))
      return false;
    float unused;
    const int x0 = pixelBefore(static_cast<float>(raster.x()), unused) - 1;
    const int y0 = pixelBefore(static_cast<float>(raster.y()), unused) - 1;
    for (int y = y0; y < y0 + 4; ++y)
      for (int x = x0; x < x0 + 4; ++x)
        if (x < 0 || y < 0 || x >= luma_.width || y >= luma_.height || !seesFluid(x, y)) return false;
    const int x = static_cast<int>(raster.x()), y = static_cast<int>(raster.y());
    return (position(x, y) - point).norm() <= maxBendTexels * texel_;
  }

  double texel_;
  GreyImage luma_;
  const std::vector<float>& mask_;
  const std::vector<float>* const p_[3];
  const std::vector<float>* const n_[3];
  Mat4d worldToNdc_;
};

}  // namespace

WindowSet cutWindows(const ChannelImage& picture, double texelSizeWorld, int side, int count, std::uint64_t seed) {
  const Surface surface(picture, texelSizeWorld);
  WindowSet set;
  struct Centre {
    int x, y;
    double pixelTexels;
  };
  std::vector<Centre> usable;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      if (const auto pixelTexels = surface.usablePixelTexels(x, y)) {
        usable.push_back({x, y, *pixelTexels});
        set.usableLuma.push_back(surface.luma().at(x, y));
      }
  if (usable.empty()) return set;

  Random random(seed, 0, 0);
  for (int i = 0; i < count * triesPerWindow && static_cast<int>(set.windows.size()) < count; ++i) {
    const Centre& centre = usable[random.below(static_cast<std::uint32_t>(usable.size()))];
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(random.uniform());
    if (auto window = surface.window(centre.x, centre.y, angle, side)) {
      set.windows.push_back(std::move(*window));
      set.pixelTexels.push_back(static_cast<float>(centre.pixelTexels));
    }
  }
  return set;
}

}  // namespace ebru::likeness
