#include "render/materials/black_body.h"

#include "render/colorimetry.h"

namespace ebru {

Vec3d blackBodyXyz(double kelvin) {
  constexpr double stepNm = 2.0;
  Vec3d sum = Vec3d::Zero();
  for (double nm = 360.0; nm <= 830.0; nm += stepNm)
    sum += colourMatching(nm) * (planckRadiance(nm, kelvin) * stepNm * 1e-9);
  return sum;
}

Vec3d blackBodyRec709(double kelvin) {
  const Vec3d xyz = blackBodyXyz(kelvin);
  const Vec3d shown = rec709FromXyz(xyz).cwiseMax(0.0);
  return shown * (xyz.y() / luminanceRec709(shown));
}

}  // namespace ebru
