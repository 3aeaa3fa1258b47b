"""Cameras with keys, a shutter and a lens, from the shot file to the pictures."""

from support import *

KEYS = """
[[camera.key]]
frame = 1
[[camera.key]]
frame = 5
position = [0.75, -0.8, 0.7]
[[camera.key]]
frame = 7
position = [0.9, -0.6, 0.5]
"""
BLUR = ["--set", "camera.shutter=[-0.25, 0.25]", "--set", "camera.aperture_diameter=0.02"]


def write_moving_shot(folder, **options):
    shot = write_shot(folder, last=3, **options)
    shot.write_text(shot.read_text() + KEYS)
    return shot


def test_threads_and_split_runs_change_nothing(folder):
    shot = write_moving_shot(folder)
    render(shot, folder / "whole", *BLUR, "--threads", 2)
    render(shot, folder / "parts", *BLUR, "--threads", 1, "--frames", "1-2")
    render(shot, folder / "parts", *BLUR, "--threads", 1, "--resume")
    assert_same_files(pictures(folder / "parts"), pictures(folder / "whole"))


def test_shutter_and_lens_change_pictures_and_no_state(folder):
    """States that know the camera as well: what is in view depends on where it is."""
    shot, out = write_moving_shot(folder, method="quilt"), folder / "out"
    aware = ["--set", "texture.quilt.camera_aware=true", "--keep-states"]
    render(shot, out, *aware)
    sharp, states = pictures(out), files(out / "states")
    run = render(shot, out, *aware, *BLUR, "--resume")
    assert "are done already" not in run.stdout + run.stderr, run.stdout
    blurred = pictures(out)
    assert sorted(blurred) == sorted(sharp)
    assert all(blurred[name] != sharp[name] for name in sharp)
    assert_same_files(files(out / "states"), states)


main()
