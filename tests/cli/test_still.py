"""Closed forms through the whole program: where nothing flows nothing changes, and the camera does not move."""

import exr
from support import *

STILL = """source = "procedural"
scene = "static_sphere"
size = 0.3
voxel_size = 0.02
period_frames = 8"""


def test_still_fluid_gives_the_same_picture_every_frame_and_no_motion(folder):
    for method in texture_methods():
        shot = write_shot(folder, STILL, method=method, last=4, position="[0, -1.6, 0.5]", target="[0, 0, 0]",
                          ground=-0.3, texel=0.02)
        out = folder / method
        render(shot, out)
        frames = [exr.read(out / f"tiny.{f:04}.exr") for f in range(1, 5)]
        covered = [value > 0 for value in frames[0][3]["texture.mask"]]
        assert sum(covered) > 50
        for header, width, height, planes in frames:
            for channel in ("forward.u", "forward.v", "backward.u", "backward.v"):
                on_fluid = [value for value, c in zip(planes[channel], covered) if c]
                assert all(value == 0.0 for value in on_fluid), f"{method}: {channel}: {max(map(abs, on_fluid))}"
            for channel, plane in planes.items():
                assert plane == frames[0][3][channel], f"{method}: {channel} changes"


def test_header_says_what_the_picture_is(folder):
    shot, out = write_shot(folder, last=2), folder / "out"
    render(shot, out, "--seed", "7")
    header, width, height, planes = exr.read(out / "tiny.0002.exr")
    assert (width, height) == (48, 32)
    assert exr.text_attribute(header, "ebru:shot") == "tiny"
    assert exr.text_attribute(header, "ebru:method") == "particles"
    assert len(exr.text_attribute(header, "ebru:fingerprint")) == 16
    assert int.from_bytes(header["ebru:seed"][1], "little") == 7
    assert int.from_bytes(header["ebru:spp"][1], "little") == 2
    version = ebru("--version").stdout.split()[1]
    assert exr.text_attribute(header, "ebru:version") == version
    for name in ("worldToCamera", "worldToNDC", "framesPerSecond", "ebru:texelSizeWorld", "ebru:velocity"):
        assert name in header, name
    # What every EXR file has is no key of ebru's.
    own = set(header) - {"channels", "compression", "dataWindow", "displayWindow", "lineOrder", "pixelAspectRatio",
                         "screenWindowCenter", "screenWindowWidth"}
    section = (ROOT / "docs/aovs.md").read_text().split("## Header\n")[1]
    rows = [[cell.strip() for cell in line.split("|")[1:3]] for line in section.splitlines() if line.startswith("| ")][1:]
    documented = {name: kind for names, kind in rows for name in names.split(", ")}
    assert {name: header[name][0] for name in own} == documented, (own, documented)


main()
