"""States know the camera when texture.quilt.camera_aware is on, and only then."""

from support import *

MOVED = "camera.position=[0.9, -0.6, 0.5]"


def states(folder, name, *arguments):
    out = folder / name
    ebru("synth", write_shot(folder, method="quilt", last=5), "--out", out, *arguments)
    return files(out / "states")


def test_off_the_camera_changes_no_state(folder):
    assert_same_files(states(folder, "moved", "--set", MOVED), states(folder, "there"))


def test_on_it_does(folder):
    aware = ["--set", "texture.quilt.camera_aware=true"]
    there, moved = states(folder, "there", *aware), states(folder, "moved", *aware, "--set", MOVED)
    assert sorted(there) == sorted(moved)
    # Bytes 20 to 36 are the fingerprint.
    contents = [[state[:20] + state[36:] for _, state in sorted(s.items())] for s in (there, moved)]
    assert contents[0] != contents[1]


def test_on_threads_and_resumption_change_nothing(folder):
    aware = ["--set", "texture.quilt.camera_aware=true"]
    whole = states(folder, "whole", *aware, "--threads", 2)
    states(folder, "parts", *aware, "--threads", 1, "--frames", "1-3")
    assert_same_files(states(folder, "parts", *aware, "--threads", 1, "--resume"), whole)


main()
