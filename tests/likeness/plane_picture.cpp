#include "likeness/plane_picture.h"

#include <array>
#include <cmath>

#include "core/parallel.h"

namespace ebru::likeness {

ChannelImage planePicture(const PlaneView& view, const std::function<Texel(const Vec2f&)>& colour) {
  ChannelImage picture;
  picture.width = view.width;
  picture.height = view.height;
  constexpr std::array names{"albedo.R", "albedo.G", "albedo.B",     "P.X", "P.Y", "P.Z",
                             "N.X",      "N.Y",      "N.Z", "texture.mask"};
  for (const char* name : names) picture.add(name, ChannelType::float32);

  const double pixelWorld = view.pixelTexels * view.texelSizeWorld;
  Mat4d worldToNdc = Mat4d::Identity();
  worldToNdc(0, 0) = 1.0 / (view.width * pixelWorld);
  worldToNdc(1, 1) = -1.0 / (view.height * pixelWorld);
  worldToNdc(2, 2) = -1.0;
  worldToNdc(3, 2) = 1.0;
  picture.attributes.emplace_back("worldToNDC", worldToNdc);

  parallelFor(static_cast<std::size_t>(view.height), 8, [&](std::size_t row) {
    for (int column = 0; column < view.width; ++column) {
      const double x = column + 0.5, y = static_cast<double>(row) + 0.5;
      const Texel texel = colour((view.pixelTexels * Vec2d(x, y)).cast<float>());
      if (texel[0] < 0.0f) continue;
      const Vec3f linear = linearColour(texel);
      const std::array<float, names.size()> values{linear.x(),
                                                   linear.y(),
                                                   linear.z(),
                                                   static_cast<float>(x * pixelWorld),
                                                   static_cast<float>(-y * pixelWorld),
                                                   0.0f,
                                                   0.0f,
                                                   0.0f,
                                                   1.0f,
                                                   1.0f};
      const std::size_t pixel = row * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(column);
      for (std::size_t c = 0; c < values.size(); ++c) picture.channels[c].data[pixel] = values[c];
    }
  });
  return picture;
}

ChannelImage exemplarPicture(const PlaneView& view, const Exemplar& exemplar, float angle, const Vec2f& shift) {
  const Vec2f size(static_cast<float>(exemplar.width()), static_cast<float>(exemplar.height()));
  const Vec2f middle = 0.5f * static_cast<float>(view.pixelTexels) *
                       Vec2f(static_cast<float>(view.width), static_cast<float>(view.height));
  const Mat2f turn = Eigen::Rotation2Df(angle).toRotationMatrix();
  return planePicture(view, [&](const Vec2f& point) -> Texel {
    const Vec2f uv = turn * (point - middle) + shift + 0.5f * size;
    const bool within = (uv.array() >= 0.5f).all() && (uv.array() <= size.array() - 0.5f).all();
    // Overshoot of the interpolation must not count as a hole.
    return within ? Texel(exemplar.sample(0, uv).max(0.0f)) : Texel::Constant(-1.0f);
  });
}

}  // namespace ebru::likeness
