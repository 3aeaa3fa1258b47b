"""Frames that lack something, or hold what is no number.

Right: figures that can be had are right, the others have a reason that names what is missing.
Broken: a traceback, a figure made of nothing, a reason that is another one's.
"""

import json

from checks import *
from evaluation import frames
from sequences import write_png

SHIFT = (3, -2)
PAIR = ids("flow_", "warp_", "popping", "still", "motion_second")
EXEMPLAR = ids("energy", "cover", "contrast", "distortion", "flow_", "warp_", "popping", "still")
SMALL = dict(crop=108, width=96, height=80, shift=SHIFT)


def test_no_exemplar(folder):
    scene, _ = scene_of(folder, **SMALL)
    result = evaluate(write(folder / "frames", scene), None)
    missing_because(result, EXEMPLAR, "no exemplar")
    missing_because(result, ["spectrum_db"])
    for name in ("motion_check_p99", "motion_second_order_p99"):
        below(result["summary"], name, 1e-4)
    near(result["summary"], "holes", 0, 0)


def test_exemplar_of_one_colour(folder):
    """There is no contrast to measure by."""
    scene, _ = scene_of(folder, **SMALL)
    grey = folder / "grey.png"
    write_png(grey, np.full((108, 108, 3), 0.5))
    result = evaluate(write(folder / "frames", scene), grey, side=21)
    missing_because(result, ("contrast", "energy", "energy_ratio", "warp_error", "still_change"), "contrast")
    near(result["summary"], "distortion_mean", 1, 1e-3)
    json.dumps(result, allow_nan=False)


def test_picture_of_one_colour(folder):
    """Nothing to follow: no flow, and no contrast, which is a figure."""

    def paint(planes, frame):
        for c in "RGB":
            planes[f"albedo.{c}"][:] = 0.2

    result = evaluate_scene(folder, change=paint, **SMALL)
    missing_because(result, ids("flow_"), "textured")
    near(result["summary"], "contrast", 0, 1e-6)
    near(result["summary"], "warp_error", 0, 1e-6)
    json.dumps(result, allow_nan=False)


def test_no_positions(folder):
    result = evaluate_scene(folder, side=21, omit=("P",), **SMALL)
    missing_because(result, ids("energy", "cover", "spectrum", "distortion", "motion_check", "motion_second"), "P.X")
    near(result["summary"], "contrast", 1, 0.2)
    near(result["summary"], "flow_excess", 0, 0.05)
    below(result["summary"], "warp_error", 1e-3)


def test_no_velocity(folder):
    result = evaluate_scene(folder, omit=("velocity",), **SMALL)
    missing_because(result, ids("motion_check", "motion_second"), "velocity.X")
    near(result["summary"], "flow_excess", 0, 0.05)
    near(result["summary"], "distortion_mean", 1, 1e-3)


def test_no_motion_vectors(folder):
    for omit, channel in ((("forward", "backward"), "forward.u"), (("backward",), "backward.u")):
        result = evaluate_scene(folder, omit=omit, **SMALL)
        missing_because(result, PAIR, channel)
        near(result["summary"], "distortion_mean", 1, 1e-3)
        near(result["summary"], "contrast", 1, 0.2)


def test_no_texture_coordinates(folder):
    result = evaluate_scene(folder, omit=("texture.s", "texture.t"), **SMALL)
    missing_because(result, ids("holes", "distortion"), "texture.s")
    near(result["summary"], "flow_excess", 0, 0.05)


def test_no_albedo(folder):
    result = evaluate_scene(folder, side=21, omit=("albedo",), **SMALL)
    missing_because(result, ids("energy", "cover", "spectrum", "contrast", "flow_", "warp_", "popping"), "albedo.R")
    near(result["summary"], "distortion_mean", 1, 1e-3)


def test_no_mask_takes_the_coverage(folder):
    """Without texture.mask the fluid is where A is over 1/2; without both, that is the reason."""
    with_mask = evaluate_scene(folder / "with", extent="border", **SMALL)
    without = evaluate_scene(folder / "without", extent="border", omit=("texture.mask",), **SMALL)
    assert with_mask["summary"] == without["summary"]
    neither = evaluate_scene(folder / "neither", omit=("texture.mask", "A"), **SMALL)
    missing_because(neither, ids("contrast", "holes", "distortion", "flow_", "warp_"), "texture.mask")


def test_no_header(folder):
    """Neither camera nor rate nor texel size: only what needs none of them, and 24 frames per second."""
    result = evaluate_scene(folder, side=21, header=False, **SMALL)
    missing_because(result, ids("motion_check", "motion_second"), "worldToNDC")
    missing_because(result, ids("energy", "cover", "spectrum", "distortion"), "texelSizeWorld")
    near(result["summary"], "flow_excess", 0, 0.05)
    near(result, "fps", 24, 0)


def test_one_frame(folder):
    result = evaluate_scene(folder, **{**SMALL, "frames": 1})
    missing_because(result, PAIR, "two consecutive frames")
    below(result["summary"], "motion_check_p99", 1e-4)


def test_frames_without_any_fluid(folder):
    def empty(planes, frame):
        for values in planes.values():
            values[:] = 0

    result = evaluate_scene(folder, side=21, change=empty, **SMALL)
    near(result["summary"], "holes", 0, 0)
    # Every other figure has its reason.
    missing_because(result, [name for name in metrics.METRICS if name not in ("holes", "not_finite")])


def test_frames_of_a_pixel(folder):
    """Too little for almost everything, which is said; nothing breaks, and nothing is not a number."""
    for width, height in ((1, 1), (1, 40), (100, 3)):
        result = evaluate_scene(folder / f"{width}", side=21, width=width, height=height, crop=108)
        json.dumps(result, allow_nan=False)
        missing_because(result, ids("energy", "spectrum", "flow_"))
        near(result["summary"], "holes", 0, 0)
        below(result["summary"], "motion_check_p99", 1e-4)


def test_values_that_are_no_numbers(folder):
    """Four pixels of each frame, in different channels, and nine more of the second one: counted once each, and all
    else is as without them. The fluid moves by parts of a pixel, so they would reach others through interpolation."""
    pixels = {(40, 50): "albedo.R", (60, 90): "P.X", (61, 90): "forward.u", (90, 30): "velocity.Z"}

    def spoil(planes, frame):
        for (r, c), name in pixels.items():
            planes[name][r, c] = np.inf if name == "P.X" else np.nan
        planes["P.Y"][60, 90] = np.nan  # counted already
        if frame == 2:
            planes["albedo.G"][80, 20:110:10] = np.nan
        planes["texture.s"][20, 20] = planes["texture.s"][40, 50] = -1  # the second is not a hole but no number

    scene, exemplar = scene_of(folder, shift=(2.5, -1.25))
    paths = write(folder / "frames", scene, numbers=[1, 2])
    # The same two frames once more, spoilt; there is a gap before them.
    spoilt = write(folder / "spoilt", scene, numbers=[1, 2], change=spoil)
    paths |= {number + 3: path for number, path in spoilt.items()}
    result = evaluate(paths, exemplar, side=21, windows=30)
    clean, figures = row(result, 1), row(result, 4)
    near(result["summary"], "not_finite", 2 * len(pixels) + 9, 0)
    near(result["summary"], "not_finite_max", len(pixels) + 9, 0)
    near(result["summary"], "holes", 2, 0)
    for name, tolerance in (("contrast", 0.01), ("distortion_mean", 1e-4), ("motion_check_p99", 1e-5),
                            ("flow_epe", 0.05), ("warp_error", 2e-3), ("energy_ratio", 0.2),
                            ("motion_second_order_p99", 1e-4)):
        near(figures, name, clean[name], tolerance)
    json.dumps(result, allow_nan=False)


def test_channels_of_zeros(folder):
    """A channel that a renderer writes but never fills: no figure can be right that needs it, and none ends the run."""
    for layer, missing in (("P", ids("distortion", "energy", "spectrum")), ("N", ids("energy", "spectrum"))):

        def clear(planes, frame):
            for axis in "XYZ":
                planes[f"{layer}.{axis}"][:] = 0

        result = evaluate_scene(folder / layer, side=21, change=clear, **SMALL)
        missing_because(result, missing)
        json.dumps(result, allow_nan=False)


def test_frames_of_different_sizes(folder):
    scene, exemplar = scene_of(folder, **SMALL)
    paths = write(folder / "frames", scene, numbers=[1])
    paths |= write(folder / "frames", scene.with_(width=90), numbers=[2])
    refused(lambda: evaluate(paths, exemplar), "plane.0002.exr", "90 x 80", "96 x 80", "plane.0001.exr")
    # No pair, but a mean over both.
    paths[7] = paths.pop(2)
    refused(lambda: evaluate(paths, exemplar), "plane.0002.exr", "90 x 80", "96 x 80", "plane.0001.exr")


def test_folders_without_one_sequence(folder):
    refused(lambda: frames.find(folder), str(folder), "NAME.0001.exr")
    refused(lambda: frames.find(folder / "nowhere"), "nowhere", "no such folder")
    for name in ("first.0001.exr", "first.0002.exr", "second.0007.exr", ".first.0003.exr", "notes.exr"):
        (folder / name).write_bytes(b"")
    refused(lambda: frames.find(folder), "2 sequences", "first.####.exr", "second.####.exr", "--pattern")
    assert list(frames.find(folder, "first.*.exr")) == [1, 2]
    assert list(frames.find(folder, "second.*.exr")) == [7]
    refused(lambda: frames.find(folder, "third.*.exr"), "expected a sequence")


def test_damaged_frames(folder):
    scene, _ = scene_of(folder, **{**SMALL, "frames": 1})
    (path,) = write(folder / "frames", scene).values()
    data = path.read_bytes()
    for share in (0, 0.01, 0.1, 0.5, 0.97):
        path.write_bytes(data[: int(len(data) * share)])
        refused(lambda: frames.read(path, 1), "plane.0001.exr", "render it again")
    path.write_bytes(b"this is no picture" * 100)
    refused(lambda: frames.read(path, 1), "plane.0001.exr")


def test_exemplars_that_are_no_pictures(folder):
    refused(lambda: exemplars.read(folder / "nowhere.png"), "nowhere.png")
    (folder / "text.png").write_text("no picture")
    refused(lambda: exemplars.read(folder / "text.png"), "text.png")


if __name__ == "__main__":
    main()
