#include "render/lights/light_options.h"

#include "render/option_fields.h"

namespace ebru {

OptionFields fields(LightOptions& o) {
  OptionField image =
      optionField("image", &o.image, "",
                  "Environment: latitude-longitude picture (z up, its middle column is +y, to its right +x), "
                  "multiplied by colour and intensity; without it the colour is constant.");
  image.path = true;
  return {
      optionChoice(
          "type", &o.type,
          "A distant sun; an environment all around; a clear sky with its sun [Preetham et al. 1999]; a "
          "glowing sphere; a glowing rectangle. Lights hide nothing.",
          {"sun", "environment", "sky", "sphere", "quad"}),
      optionField("colour", &o.colour, "", "Colour of the light.", 0.0, 1e6),
      optionField(
          "intensity", &o.intensity, "",
          "Factor on the colour. Sun: 1 lights a white diffuse surface that faces it to 1 (irradiance "
          "pi). Environment, sphere, quad: radiance. Sphere: a white diffuse surface that faces it at "
          "the distance d is lit to (radius / d)^2. Sky: 1 lights white open ground at noon to about "
          "1 (radiance 1 is 100 klx / pi).",
          0.0, mostLight),
      optionField("direction", &o.direction, "", "Sun, sky: the direction towards the sun, any length."),
      optionField("angular_diameter_deg", &o.angular_diameter_deg, "deg",
                  "Sun, sky: the sun's diameter; larger makes softer shadows, 0 hard ones.", 0.0, 90.0),
      optionField("turbidity", &o.turbidity, "",
                  "Sky: haze; 2 is very clear, 3 clear, 6 hazy, 10 thick haze.", 2.0, 10.0),
      optionField("sun_intensity", &o.sun_intensity, "",
                  "Sky: factor on its sun; 0 takes the sun away and leaves the sky.", 0.0, 1e6),
      optionField("ground_albedo", &o.ground_albedo, "",
                  "Sky: colour of the ground below its horizon, which sky and sun light.", 0.0, 1.0),
      image,
      optionField("rotation_deg", &o.rotation_deg, "deg",
                  "Environment: turned counter-clockwise about +z, seen from above.", -360.0, 360.0),
      optionField("position", &o.position, "m", "Sphere, quad: the centre.", -mostWorld, mostWorld),
      optionField("radius", &o.radius, "m", "Sphere: its radius.", 1e-6, mostWorld),
      optionField("facing", &o.facing, "", "Quad: the direction in which it shines, any length."),
      optionField(
          "size", &o.size, "m",
          "Quad: width and height; the width is horizontal (along x if it faces straight up or down).", 1e-6,
          mostWorld),
      optionField("roll_deg", &o.roll_deg, "deg",
                  "Quad: turned in its plane, counter-clockwise for who looks at its bright side.", -360.0,
                  360.0),
      optionField("two_sided", &o.two_sided, "", "Quad: shines from its back as well."),
  };
}

std::vector<LightOptions> defaultLights() {
  LightOptions sky;
  sky.type = "sky";
  // White balance: open ground in this sky is grey, not faintly purple.
  sky.colour = {0.98, 1.05, 0.98};
  // Softer than the sun's own shadows, and fewer of its rays reach the ground over a mirror by chance.
  sky.angular_diameter_deg = 3.0;
  return {sky};
}

}  // namespace ebru
