#include "render/lights/light_options.h"

#include "render/option_fields.h"

namespace ebru {

OptionFields fields(LightOptions& o) {
  OptionField image = optionField(
      "image", &o.image, "",
      "Environment: latitude-longitude picture (z up, its middle column is +y, to its right +x), "
      "multiplied by colour and intensity; without it the colour is constant.");
  image.path = true;
  return {
      optionChoice("type", &o.type, "A distant sun, or an environment all around.", {"sun", "environment"}),
      optionField("colour", &o.colour, "", "Colour of the light.", 0.0),
      optionField("intensity", &o.intensity, "",
                  "Factor on the colour. Sun: 1 lights a white diffuse surface that faces it to 1 (irradiance "
                  "pi). Environment: radiance.",
                  0.0),
      optionField("direction", &o.direction, "", "Sun: the direction towards it, any length."),
      optionField("angular_diameter_deg", &o.angular_diameter_deg, "deg",
                  "Sun: its diameter; larger makes softer shadows, 0 hard ones.", 0.0, 90.0),
      image,
      optionField("rotation_deg", &o.rotation_deg, "deg",
                  "Environment: turned counter-clockwise about +z, seen from above.", -360.0, 360.0),
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
