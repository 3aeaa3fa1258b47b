#include "render/film/aovs.h"

#include <string>

namespace ebru {

const std::array<AovInfo, aovCount>& aovTable() {
  using enum ChannelType;
  static const std::array<AovInfo, aovCount> table{{
      {"R", half, "scene-linear", "lit picture, red, premultiplied"},
      {"G", half, "scene-linear", "lit picture, green, premultiplied"},
      {"B", half, "scene-linear", "lit picture, blue, premultiplied"},
      {"A", half, "0 to 1", "part of the pixel that geometry covers; 1 everywhere with render.background"},
      {"albedo.R", half, "scene-linear", "unlit colour of the surface: the texture's on the fluid; red"},
      {"albedo.G", half, "scene-linear", "as albedo.R, green"},
      {"albedo.B", half, "scene-linear", "as albedo.R, blue"},
      {"Z", float32, "m", "depth along the view axis"},
      {"P.X", float32, "m", "world position, x"},
      {"P.Y", float32, "m", "world position, y"},
      {"P.Z", float32, "m", "world position, z"},
      {"N.X", float32, "", "world unit shading normal out of the body, x; not turned to the camera"},
      {"N.Y", float32, "", "as N.X, y"},
      {"N.Z", float32, "", "as N.X, z"},
      {"velocity.X", float32, "m/s", "world velocity of the fluid, x; 0 off the fluid"},
      {"velocity.Y", float32, "m/s", "as velocity.X, y"},
      {"velocity.Z", float32, "m/s", "as velocity.X, z"},
      {"forward.u", float32, "px",
       "to where the material point is seen in frame f + 1, positive to the right"},
      {"forward.v", float32, "px", "as forward.u, positive up"},
      {"backward.u", float32, "px",
       "to where the material point is seen in frame f - 1, positive to the right"},
      {"backward.v", float32, "px", "as backward.u, positive up"},
      {"texture.s", float32, "", "exemplar coordinate in 0 to 1, to the right; -1 in a hole"},
      {"texture.t", float32, "", "exemplar coordinate in 0 to 1, down the image; -1 in a hole"},
      {"texture.age", float32, "frames",
       "that this piece of texture has been carried; still frames do not count"},
      {"texture.distortion", float32, "",
       "largest stretch or squash of the texture, 1 is isometric; 0 in a hole"},
      {"texture.id", float32, "", "particle or patch, an integer below 2^24"},
      {"texture.mask", float32, "0 or 1",
       "1 where the fluid's surface is what the pixel sees, also in a hole"},
      {"samples", float32, "", "samples that the lit picture took here"},
  }};
  return table;
}

FrameBuffer::FrameBuffer(int width, int height, bool variance) {
  image_.width = width;
  image_.height = height;
  for (const AovInfo& aov : aovTable()) image_.add(std::string(aov.channel), aov.type);
  if (variance)
    for (const char* channel : {"variance.R", "variance.G", "variance.B"}) image_.add(channel, ChannelType::float32);
}

}  // namespace ebru
