"""The default shot, whole: every pixel that sees the fluid has a texture, in every method, from the first frame to the last.

Right: no hole. Broken: texture.s is -1 where texture.mask is 1. Blind: what the texture looks like.
"""

import exr
from support import *

SCENE = ROOT / "scenes/dam_break.toml"


def test_default_shot_has_no_holes(folder):
    for method in texture_methods():
        out = folder / method
        render(SCENE, out, "--method", method, "--frames", "1,10,19,28", "--size", "160x90", "--spp", 1,
               "--set", "texture.texel_size=0.016")
        for frame in (1, 10, 19, 28):
            _, _, _, planes = exr.read(out / f"dam_break.{frame:04}.exr")
            fluid = [s for s, mask in zip(planes["texture.s"], planes["texture.mask"]) if mask == 1.0]
            assert len(fluid) > 1000, f"{method}, frame {frame}: {len(fluid)} pixels of fluid"
            holes = sum(1 for s in fluid if s < 0.0)
            assert holes == 0, f"{method}, frame {frame}: {holes} holes in {len(fluid)} pixels"


main()
