"""The test card of docs/aovs.md moves by (10, 5) px per frame, right and up, as anyone may check in Nuke or Blender."""

import json
import pathlib
import sys

import numpy as np
import OpenImageIO as oiio

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))

from support import *


def channel(path, name):
    picture = oiio.ImageBuf(str(path))
    return picture.get_pixels(oiio.FLOAT)[..., picture.spec().channelnames.index(name)]


def test_card_moves_right_and_up(folder):
    render(ROOT / "scenes/test_card.toml", folder / "out", "--frames", "1-2", "--spp", 1)
    first, second = (folder / f"out/test_card.000{f}.exr" for f in (1, 2))
    box = channel(first, "texture.mask") == 1
    assert box.sum() > 10000
    for name, value in {"forward.u": 10, "forward.v": 5, "backward.u": -10, "backward.v": -5}.items():
        assert np.abs(channel(first, name)[box] - value).max() < 1e-3, name
    # +v is up: the picture of frame 2 is that of frame 1, 10 columns to the right and 5 rows higher.
    a, b = channel(first, "albedo.R")[5:, :-10], channel(second, "albedo.R")[:-5, 10:]
    inside = box[5:, :-10] & (channel(second, "texture.mask")[:-5, 10:] == 1)
    assert np.abs(a - b)[inside].mean() < 0.01 < np.abs(channel(first, "albedo.R") - channel(second, "albedo.R"))[box].mean()

    run = subprocess.run([ROOT / "scripts/evaluate.py", folder / "out", "--shot", "test_card", "--require",
                          "motion_exact_p99=0.001", "holes=0", "flow_excess=0.1"], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert json.loads((folder / "out/metrics.json").read_text())["frames"][0]["flow_epe"] < 0.1


if __name__ == "__main__":
    main()
