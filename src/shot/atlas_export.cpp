#include "shot/atlas_export.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "core/parallel.h"
#include "render/renderer.h"
#include "shot/output_files.h"
#include "surface/mesh_measures.h"

namespace ebru {
namespace {

struct AtlasChannel {
  std::string_view name;
  ChannelType type;
};
constexpr std::array<AtlasChannel, 5> channels{{{"R", ChannelType::half},
                                                {"G", ChannelType::half},
                                                {"B", ChannelType::half},
                                                {"A", ChannelType::half},
                                                {"displacement", ChannelType::float32}}};

/// Width of a texel on each triangle, metres: side of the square that has the area a texel covers there.
std::vector<float> footprints(const TriangleMesh& mesh, const SurfaceAtlas& atlas) {
  std::vector<float> widths(mesh.triangles.size());
  parallelFor(widths.size(), 4096, [&](std::size_t t) {
    const Vec2d size(atlas.width, atlas.height);
    const Vec2d a = atlas.uv[t][0].cast<double>().cwiseProduct(size);
    const Vec2d b = atlas.uv[t][1].cast<double>().cwiseProduct(size) - a;
    const Vec2d c = atlas.uv[t][2].cast<double>().cwiseProduct(size) - a;
    const double texels = 0.5 * (b.x() * c.y() - b.y() * c.x());
    const double steepest = 2.0 * atlas.texelSizeWorld;
    const double width = texels > 0.0 ? std::sqrt(areaNormal(mesh, t).norm() / texels) : atlas.texelSizeWorld;
    // Corners are rounded to parts of a texel: a triangle much smaller than that has no ratio of its own.
    widths[t] = static_cast<float>(std::clamp(width, atlas.texelSizeWorld, steepest));
  });
  return widths;
}

TextureSample sampleAt(const AtlasPoint& at, float footprintWorld, const TextureField& texture) {
  SurfacePoint point;
  point.position = at.continued;
  point.normal = at.normal;
  point.triangle = at.triangle;
  point.barycentric = at.barycentric;
  point.footprintWorld = footprintWorld;
  TextureSample sample = texture.lookup(point);
  if (sample.valid || at.continued == at.position) return sample;
  // Beside the rim of a thin sheet there may be nothing, but there is on the triangle.
  point.position = at.position;
  return texture.lookup(point);
}

}  // namespace

ChannelImage bakeAtlas(const FluidFrame& frame, const SurfaceAtlas& atlas, const TextureField& texture) {
  ChannelImage image;
  image.width = atlas.width;
  image.height = atlas.height;
  for (const AtlasChannel& channel : channels) image.add(std::string(channel.name), channel.type);
  image.attributes = {{"imageCounter", frame.frame},
                      {"framesPerSecond", rationalFramesPerSecond(frame.framesPerSecond)},
                      {"ebru:atlasTexelSizeWorld", static_cast<float>(atlas.texelSizeWorld)}};
  const std::vector<float> widths = footprints(frame.mesh, atlas);
  // Short runs of a row: neighbours of the texture are then in the cache, and no row of dense charts is one task.
  constexpr std::size_t run = 256;
  const auto columns = static_cast<std::size_t>(atlas.width), texels = columns * static_cast<std::size_t>(atlas.height);
  parallelBlocks(texels, run, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      AtlasPoint at;
      if (!atlasPoint(frame.mesh, atlas, static_cast<int>(i % columns), static_cast<int>(i / columns), at)) continue;
      const TextureSample sample = sampleAt(at, widths[at.triangle], texture);
      if (!sample.valid) continue;
      for (std::size_t k = 0; k < 3; ++k)
        image.channels[k].data[i] = sample.alpha * sample.colour[static_cast<int>(k)];
      image.channels[3].data[i] = sample.alpha;
      image.channels[4].data[i] = sample.displacement;
    }
  });
  return image;
}

bool isFinishedAtlas(const std::filesystem::path& path, int width, int height, const std::string& fingerprint) {
  std::vector<std::string_view> names;
  for (const AtlasChannel& channel : channels) names.push_back(channel.name);
  const auto image = finishedExr(path, names, fingerprint);
  return image && image->width == width && image->height == height;
}

}  // namespace ebru
