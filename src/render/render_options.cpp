#include "render/render_options.h"

namespace ebru {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

OptionField field(std::string key, OptionTarget target, std::string unit, std::string help,
                  double lower = -unbounded, double upper = unbounded) {
  OptionField result;
  result.key = std::move(key);
  result.target = target;
  result.unit = std::move(unit);
  result.help = std::move(help);
  result.lower = lower;
  result.upper = upper;
  return result;
}

OptionField choice(std::string key, std::string* target, std::string help, std::vector<std::string> choices) {
  OptionField result = field(std::move(key), target, "", std::move(help));
  result.choices = std::move(choices);
  return result;
}

}  // namespace

OptionFields fields(CameraOptions& o) {
  return {
      field("position", &o.position, "m", "Where the camera stands."),
      field("target", &o.target, "m", "The point in the middle of the picture."),
      field("up", &o.up, "", "The direction that is up in the picture; any length, not along the view."),
      choice("projection", &o.projection, "Kind of camera.", {"perspective", "orthographic"}),
      field("vertical_fov_deg", &o.vertical_fov_deg, "deg", "Perspective: angle from lower to upper edge.",
            0.01, 170.0),
      field("orthographic_height", &o.orthographic_height, "m",
            "Orthographic: height of the picture in the world; its width follows from the pixels, which are "
            "square.",
            1e-6),
      field("size", &o.size, "px", "Width and height of the picture.", 1, 65536),
  };
}

OptionFields fields(RenderOptions& o) {
  return {
      field("spp", &o.spp, "", "Samples per pixel of the lit picture; data channels always take one.", 1,
            65536),
      field(
          "filter_width_px", &o.filter_width_px, "px",
          "Full width of the Blackman-Harris pixel filter of the lit picture; 0 samples pixel centres only.",
          0.0, 8.0),
      field("animate_seed", &o.animate_seed, "",
            "New sampling noise in every frame; else the noise stands still, and so does the picture of what stands "
            "still."),
      field("background", &o.background, "",
            "Show the environment behind everything, with alpha 1; else the background is empty, with alpha "
            "0."),
      field("fluid_colour", &o.fluid_colour, "", "Albedo of the fluid where it has no texture.", 0.0, 1.0),
      field("specular", &o.specular, "",
            "Strength of the fluid's coat: reflectance at normal incidence is 0.08 times this; 0 is plain "
            "diffuse.",
            0.0, 1.0),
      field("roughness", &o.roughness, "",
            "Roughness of the coat; the GGX width is its square [Walter et al. 2007].", 0.02, 1.0),
  };
}

OptionFields fields(LightOptions& o) {
  OptionField image =
      field("image", &o.image, "",
            "Environment: latitude-longitude picture (z up, its middle column is +y, to its right +x), "
            "multiplied by colour and intensity; without it the colour is constant.");
  image.path = true;
  return {
      choice("type", &o.type, "A distant sun, or an environment all around.", {"sun", "environment"}),
      field("colour", &o.colour, "", "Colour of the light.", 0.0),
      field("intensity", &o.intensity, "",
            "Factor on the colour. Sun: 1 lights a white diffuse surface that faces it to 1 (irradiance pi). "
            "Environment: radiance.",
            0.0),
      field("direction", &o.direction, "", "Sun: the direction towards it, any length."),
      field("angular_diameter_deg", &o.angular_diameter_deg, "deg",
            "Sun: its diameter; larger makes softer shadows, 0 hard ones.", 0.0, 90.0),
      image,
      field("rotation_deg", &o.rotation_deg, "deg",
            "Environment: turned counter-clockwise about +z, seen from above.", -360.0, 360.0),
  };
}

OptionFields fields(GroundOptions& o) {
  return {
      field("enabled", &o.enabled, "", "Whether there is a ground, a horizontal plane (z is up)."),
      field("height", &o.height, "m", "Its z."),
      field("radius", &o.radius, "m", "It is a disc of this radius; 0 makes it infinite.", 0.0),
      field("centre", &o.centre, "m", "Centre (x, y) of the disc."),
      field("colour", &o.colour, "", "Albedo; diffuse.", 0.0, 1.0),
      field("checker_size", &o.checker_size, "m", "Side of the squares of a checkerboard; 0 is plain.", 0.0),
      field("checker_colour", &o.checker_colour, "", "Albedo of every other square.", 0.0, 1.0),
  };
}

OptionFields fields(ObstacleOptions& o) {
  return {
      choice("shape", &o.shape, "An axis-aligned box or a sphere.", {"box", "sphere"}),
      field("position", &o.position, "m", "Its centre."),
      field("size", &o.size, "m", "Box: length along x, y and z.", 1e-6),
      field("radius", &o.radius, "m", "Sphere: its radius.", 1e-6),
      field("colour", &o.colour, "", "Albedo; diffuse.", 0.0, 1.0),
  };
}

std::vector<LightOptions> defaultLights() {
  LightOptions sun;
  sun.colour = {1.0, 0.94, 0.86};
  sun.intensity = 0.8;
  sun.angular_diameter_deg = 3.0;
  LightOptions sky;
  sky.type = "environment";
  sky.colour = {0.85, 0.93, 1.0};
  sky.intensity = 0.35;
  return {sun, sky};
}

}  // namespace ebru
