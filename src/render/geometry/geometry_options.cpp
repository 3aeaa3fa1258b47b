#include "render/geometry/geometry_options.h"

#include "render/option_fields.h"

namespace ebru {
namespace {

OptionFields joined(OptionFields first, const OptionFields& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

OptionFields fields(GroundOptions& o) {
  return joined(
      {
          optionField("enabled", &o.enabled, "", "Whether there is a ground, a horizontal plane (z is up)."),
          optionField("height", &o.height, "m", "Its z."),
          optionField("radius", &o.radius, "m", "It is a disc of this radius; 0 makes it infinite.", 0.0),
          optionField("centre", &o.centre, "m", "Centre (x, y) of the disc."),
          optionField("checker_size", &o.checker_size, "m", "Side of the squares of a checkerboard; 0 is plain.",
                      0.0),
          optionField("checker_colour", &o.checker_colour, "", "Colour of every other square.", 0.0, 1.0),
      },
      materialFields(o.material));
}

OptionFields fields(ObstacleOptions& o) {
  return joined(
      {
          optionChoice("shape", &o.shape, "An axis-aligned box or a sphere.", {"box", "sphere"}),
          optionField("position", &o.position, "m", "Its centre."),
          optionField("size", &o.size, "m", "Box: length along x, y and z.", 1e-6),
          optionField("radius", &o.radius, "m", "Sphere: its radius.", 1e-6),
      },
      materialFields(o.material));
}

}  // namespace ebru
