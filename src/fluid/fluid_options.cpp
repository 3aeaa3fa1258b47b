#include "fluid/fluid_options.h"

#include <utility>

#include "fluid/frame_pattern.h"

namespace ebru {

namespace {

OptionField field(std::string key, OptionTarget target, std::string unit, std::string help) {
  OptionField f;
  f.key = std::move(key);
  f.target = target;
  f.unit = std::move(unit);
  f.help = std::move(help);
  return f;
}

OptionField ranged(OptionField f, double lower, double upper) {
  f.lower = lower;
  f.upper = upper;
  return f;
}

OptionField chosen(OptionField f, std::vector<std::string> choices) {
  f.choices = std::move(choices);
  return f;
}

OptionField file(OptionField f) {
  f.path = true;
  return f;
}

}  // namespace

bool readsOneFile(const FluidOptions& options) {
  return options.source == "mesh" && FramePattern(options.path).isSingle();
}

OptionFields fields(FluidOptions& o) {
  return {
      chosen(field("source", &o.source, "", "where frames come from: OpenVDB files, PLY meshes with a velocity per vertex, or a formula"),
             {"vdb", "mesh", "procedural"}),
      file(field("path", &o.path, "",
                 "the cache's files, # or %04d for the frame number: cache/dam.####.vdb; one mesh without a number is a "
                 "still surface in a steady flow")),
      field("surface", &o.surface, "", "name of the float level set that bounds the fluid, for source = vdb"),
      field("velocity", &o.velocity, "",
            "name of the vec3s velocity grid, staggered or centred, or of three float grids NAME.x .y .z, for source = vdb"),
      field("velocity_scale", &o.velocity_scale, "",
            "turns the cache's velocity into world units per second; 24 for one stored per frame at 24 fps"),
      chosen(field("scene", &o.scene, "", "which formula, for source = procedural"),
             {"static_sphere", "translation", "rigid_rotation", "shear", "vortex_sphere", "merge_split"}),
      chosen(field("shape", &o.shape, "",
                   "what moves in translation and rigid_rotation; box is a flat box with rounded edges"),
             {"sphere", "box"}),
      ranged(field("size", &o.size, "m",
                   "radius of the sphere, half edge of the box, slab or unit cube of the procedural scene"),
             1e-6, 1e6),
      ranged(field("voxel_size", &o.voxel_size, "m",
                   "voxel of the level set made from a formula; around a mesh it is always the median length of its "
                   "edges, within 1/1024 to 1/64 of its longest side"),
             1e-6, 1e6),
      field("speed", &o.speed, "",
            "rigid_rotation: rad/s; shear: 1/s; vortex_sphere: 2 is the usual deformation"),
      field("shift", &o.shift, "m", "translation: way per frame"),
      ranged(field("period_frames", &o.period_frames, "frames",
                   "last frame of a procedural scene and of a single mesh, and the period of vortex_sphere and merge_split"),
             1, 1e6),
  };
}

}  // namespace ebru
