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
          optionField("height", &o.height, "m", "Its z.", -mostWorld, mostWorld),
          optionField("radius", &o.radius, "m", "It is a disc of this radius; 0 makes it infinite.", 0.0,
                      mostWorld),
          optionField("centre", &o.centre, "m", "Centre (x, y) of the disc.", -mostWorld, mostWorld),
          optionField("checker_size", &o.checker_size, "m",
                      "Side of the squares of a checkerboard; 0 is plain.", 0.0),
          optionField("checker_colour", &o.checker_colour, "", "Colour of every other square.", 0.0, 1.0),
      },
      materialFields(o.material));
}

OptionFields fields(ObstacleOptions& o) {
  OptionField file =
      optionField("file", &o.file, "",
                  "Mesh: its file, .obj or .ply, counter-clockwise from outside. It is shaded smooth where "
                  "the file has normals, else flat.");
  file.path = true;
  return joined(
      {
          optionChoice("shape", &o.shape,
                       "An axis-aligned box, a sphere, a tank (a box that is hollow and open at the top), or "
                       "a mesh from "
                       "a file.",
                       {"box", "sphere", "tank", "mesh"}),
          optionField("position", &o.position, "m", "Its centre; mesh: where the file's origin comes to lie.",
                      -mostWorld, mostWorld),
          optionField("size", &o.size, "m", "Box and tank: length along x, y and z, outside.", 1e-6,
                      mostWorld),
          optionField("radius", &o.radius, "m", "Sphere: its radius.", 1e-6, mostWorld),
          optionField("thickness", &o.thickness, "m", "Tank: of its walls and its floor.", 1e-6, mostWorld),
          file,
          optionField("scale", &o.scale, "", "Mesh: metres per unit of the file.", 1e-12, mostWorld),
      },
      materialFields(o.material));
}

}  // namespace ebru
