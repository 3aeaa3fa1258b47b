"""Figures of motion and coherence on a plane whose motion is known.

Right: what moves with the fluid has no warp error and no more error of flow than the estimator itself.
Broken: a sign, a rate or a camera is misread, or a texture that does not ride on the fluid goes unnoticed.
Blind: surfaces that bend or hide each other.
"""

from checks import *
from evaluation import frames, motion
from sequences import SWIM

SHIFT = (3, -2)
SHIFT_PX = math.hypot(*SHIFT)


def test_translation(folder):
    """Velocity times the frame's time is the path itself, so nothing remains but rounding: of P (float32, about
    1 m / 2^24 in pixels of 9 mm: 1e-5 px) and of albedo (half). The shift is of whole pixels: nothing is between
    pixels."""
    result = evaluate_scene(folder, shift=SHIFT, fps=(24000, 1001), side=21)
    figures = result["summary"]
    near(result, "fps", 24000 / 1001, 1e-9)
    below(figures, "motion_check_median", 1e-4)
    below(figures, "motion_check_p99", 1e-4)
    below(figures, "motion_second_order_p99", 1e-4)
    below(figures, "flow_epe", 0.05)
    below(figures, "flow_fl", 0)
    near(figures, "flow_excess", 0, 0.02)
    below(figures, "warp_error", 1e-3)
    below(figures, "popping", 0)
    near(figures, "holes", 0, 0)
    near(figures, "not_finite", 0, 0)
    # A part of the exemplar is seen, with a little less contrast than the whole.
    near(figures, "contrast", 1, 0.03)
    near(figures, "distortion_mean", 1, 1e-3)
    near(figures, "distortion_p95", 1, 1e-3)
    near(figures, "energy_ratio", 1.025, 0.125)
    assert set(result["not_computed"]) == set(ids("motion_exact", "still")), result["not_computed"]


def test_rotation(folder):
    """A straight step of length a r misses the arc of the same length by |exp(ia) - 1 - ia| r = a^2 / 2 r. Pixels of a
    disc of radius R have their median at r = R / sqrt(2) and 99 % within sqrt(.99) R. The mean velocity of both ends
    misses it by a^3 / 12 r, which is near rounding here."""
    angle, options = 0.02, dict(turn=0.02, extent="disc")
    scene, _ = scene_of(folder, **options)
    figures = evaluate_scene(folder, **options)["summary"]
    median = angle**2 / 2 * scene.disc_radius / math.sqrt(2)
    near(figures, "motion_check_median", median, 0.02 * median)
    near(figures, "motion_check_p99", angle**2 / 2 * scene.disc_radius * math.sqrt(0.99), 0.02 * median)
    below(figures, "motion_second_order_p99", 0.02 * median)
    below(figures, "flow_epe", 0.15)
    below(figures, "flow_excess", 0.1)
    below(figures, "warp_error", 0.05)
    near(figures, "distortion_mean", 1, 1e-3)


def test_exact_path_of_procedural_fluids(folder):
    """Where the shot names a motion with a closed form, forward agrees with it; at another speed it is off."""
    turning, _ = scene_of(folder, turn=0.02, extent="disc", frames=1)
    moving = turning.with_(turn=0.0, shift=SHIFT)
    (turned,) = write(folder / "turning", turning).values()
    (moved,) = write(folder / "moving", moving).values()
    fluid = {"source": "procedural", "fps": 24.0}
    figures = motion.check_exact(frames.read(turned, 1), {**fluid, "scene": "rigid_rotation", "speed": 0.02 * 24})
    below(figures, "motion_exact_p99", 1e-4)
    # Backwards: each point is off by the chord of twice the angle.
    figures = motion.check_exact(frames.read(turned, 1), {**fluid, "scene": "rigid_rotation", "speed": -0.02 * 24})
    near(figures, "motion_exact_median", 2 * math.sin(0.02) * turning.disc_radius / math.sqrt(2), 0.02)
    shift = [SHIFT[0] * moving.pixel_size, SHIFT[1] * moving.pixel_size, 0.0]
    figures = motion.check_exact(frames.read(moved, 1), {**fluid, "scene": "translation", "shift": shift})
    below(figures, "motion_exact_p99", 1e-4)
    figures = motion.check_exact(frames.read(moved, 1), {**fluid, "scene": "static_sphere"})
    near(figures, "motion_exact_median", SHIFT_PX, 1e-4)
    assert motion.check_exact(frames.read(moved, 1), {**fluid, "scene": "vortex_sphere"}) == {}


def test_motion_with_the_wrong_sign(folder):
    """Both v flipped: off by twice v, 2 px. That is 1.8 texels, so pixels count as matched, and flow shows it too."""

    def flip(planes, frame):
        planes["forward.v"] *= -1
        planes["backward.v"] *= -1

    figures = evaluate_scene(folder, shift=(3, -1), change=flip)["summary"]
    near(figures, "motion_check_median", 2, 1e-3)
    near(figures, "flow_epe", 2, 0.1)
    above(figures, "flow_excess", 1.5)


def test_motion_that_cannot_be_matched(folder):
    """forward off by 4 px, which is 3.6 texels: no pixel is matched, which is said; it does not pass as good. Shown by
    backward alone where there is no P, and by P alone where backward is wrong in the same way."""

    def flip_forward(planes, frame):
        planes["forward.v"] *= -1

    def flip(planes, frame):
        flip_forward(planes, frame)
        planes["backward.v"] *= -1

    result = evaluate_scene(folder / "backward", shift=SHIFT, change=flip_forward, omit=("P",))
    missing_because(result, ids("flow_", "warp_", "popping"), "no pixel is matched")
    result = evaluate_scene(folder / "P", shift=SHIFT, change=flip)
    missing_because(result, ids("flow_", "warp_", "popping"), "no pixel is matched")
    near(result["summary"], "motion_check_median", 4, 1e-3)


def test_velocity_in_the_wrong_unit(folder):
    """m/frame instead of m/s: almost all of the motion is missing."""

    def slow(planes, frame):
        for axis in "XYZ":
            planes[f"velocity.{axis}"] /= 24

    figures = evaluate_scene(folder, shift=SHIFT, change=slow, frames=1)["summary"]
    near(figures, "motion_check_median", SHIFT_PX * 23 / 24, 1e-3)


def test_texture_of_another_place_in_every_frame(folder):
    """Unrelated luma: mean |a - b| is 2 / sqrt(pi) = 1.13 sigma if normal, and there is no flow to find."""
    figures = evaluate_scene(folder, shift=SHIFT, texture="shuffled")["summary"]
    above(figures, "warp_error", 0.8)
    above(figures, "popping", 0.5)
    above(figures, "flow_excess", 1)
    above(figures, "flow_fl", 0.3)
    below(figures, "motion_check_p99", 1e-4)


def test_texture_fixed_to_the_screen(folder):
    """The picture stands still while the fluid moves: the error of flow is the motion itself, over 3 px everywhere."""
    figures = evaluate_scene(folder, shift=SHIFT, texture="frozen")["summary"]
    near(figures, "flow_epe", SHIFT_PX, 0.01)
    above(figures, "flow_fl", 0.99)
    # A pebble's shading is wide: about 4 px away luma has not changed completely.
    above(figures, "warp_error", 0.3)
    below(figures, "motion_check_p99", 1e-4)


def test_texture_that_swims_on_a_still_fluid(folder):
    """The texture's own motion is the error of flow, and still_change sees it; the motion vectors are right."""
    figures = evaluate_scene(folder, texture="swimming")["summary"]
    near(figures, "motion_check_p99", 0, 1e-9)
    near(figures, "flow_epe_median", SWIM, 0.1)
    above(figures, "still_change", 0.05)
    # All of it is still.
    near(figures, "still_change", figures["warp_error"], 1e-12)


def test_other_estimator(folder):
    """Farneback's finds the motion of a texture that rides, and the lack of it in one that does not."""
    scene, exemplar = scene_of(folder, shift=SHIFT)
    figures = evaluate(write(folder / "exact", scene), exemplar, flow="farneback")
    assert figures["settings"]["flow"] == "farneback"
    below(figures["summary"], "flow_epe_median", 0.2)
    dis = evaluate(write(folder / "exact", scene), exemplar)
    assert figures["summary"]["flow_epe"] != dis["summary"]["flow_epe"], "the same estimator twice"
    figures = evaluate(write(folder / "frozen", scene.with_(texture="frozen")), exemplar, flow="farneback")
    near(figures["summary"], "flow_epe", SHIFT_PX, 0.01)


def test_still(folder):
    """Nothing moves: two equal pictures, no change at all."""
    figures = evaluate_scene(folder)["summary"]
    for name in ("still_change", "warp_error_p99", "motion_check_p99", "motion_second_order_p99", "flow_excess"):
        near(figures, name, 0, 1e-6)


def test_gap_in_the_numbers(folder):
    """Only frames 1 and 2 are neighbours: what compares frames is of this pair alone."""
    scene, exemplar = scene_of(folder, shift=SHIFT, width=96, height=80)
    result = evaluate(write(folder / "frames", scene, numbers=[1, 2, 4]), exemplar)
    assert [r["frame"] for r in result["frames"]] == [1, 2, 4]
    for name in ids("flow_", "warp_", "popping", "motion_second"):
        assert row(result, 1)[name] is not None, name
        assert row(result, 2)[name] is None and row(result, 4)[name] is None, name
        near(result["summary"], name, row(result, 1)[name], 0)
    assert row(result, 4)["contrast"] is not None


if __name__ == "__main__":
    main()
