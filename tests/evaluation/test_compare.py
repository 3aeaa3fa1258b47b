"""compare.py renders, judges and lays side by side."""

import json
import pathlib
import sys

TESTS = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent / "scripts"), str(TESTS / "cli")]

from evaluation import shot as shots
from evaluation.errors import UsageError
from support import *


def compare(*arguments, expect=0):
    words = [ROOT / "scripts/compare.py", *arguments, "--ebru", EBRU, "--windows", "10", "--side", "9"]
    run = subprocess.run(list(map(str, words)), capture_output=True, text=True)
    assert run.returncode == expect, run.stdout + run.stderr
    return run


def test_methods_side_by_side(folder):
    shot, out = write_shot(folder), folder / "out"
    arguments = [shot, "--methods", "particles,synthesis", "--frames", "1-2", "--size", "160x120", "--set", "fluid.period_frames=96",
                 "--out", out]
    run = compare(*arguments)
    summaries = json.loads((out / "comparison.json").read_text())
    assert list(summaries) == ["particles", "synthesis"]
    assert all(summary["holes"] == 0 and summary["warp_error"] > 0 for summary in summaries.values())
    assert summaries["particles"]["warp_error"] != summaries["synthesis"]["warp_error"]
    page = (out / "comparison.html").read_text()
    assert "particles" in page and "synthesis" in page and "data:image" in page
    assert "particles" in run.stdout and "warp_error" in run.stdout
    frames = pictures(out / "particles")
    assert len(frames) == 2 and json.loads((out / "particles/metrics.json").read_text())["method"] == "particles"
    assert "left out" not in run.stderr, run.stderr
    # Pictures of other settings beyond the frames asked for, of another size and of the same.
    render(shot, out / "particles", "--frames", "3", "--size", "48x32")
    render(shot, out / "particles", "--frames", "4-5", "--size", "160x120", "--seed", "7")
    says(compare(*arguments), "particles: 3 pictures that were not asked for are left out: tiny.0003.exr to tiny.0005.exr")
    assert json.loads((out / "comparison.json").read_text()) == summaries
    kept = {name: content for name, content in pictures(out / "particles").items() if name in frames}
    assert_same_files(kept, frames, "frames that are there are kept")


def test_frames_as_render_reads_them(folder):
    tables = {"shot": {"first_frame": 3, "last_frame": 6}}
    for text, expected in ((None, {3, 4, 5, 6}), ("7", {7}), ("1-8x3", {1, 4, 7}), ("1-10y3", {2, 3, 5, 6, 8, 9}),
                           ("1-9:4", set(range(1, 10))), ("5-2", {2, 3, 4, 5}), ("8-1x3", {8, 5, 2}),
                           ("-4--2", {-4, -3, -2}), ("1,5,7-9", {1, 5, 7, 8, 9})):
        assert shots.frames_of(tables, text) == expected, (text, shots.frames_of(tables, text))
    for text in ("a", "1-", "1-5x", "1-5x0", "1,,2", "1 - 5"):
        try:
            shots.frames_of(tables, text)
        except UsageError as error:
            assert "--frames" in str(error), error
        else:
            raise AssertionError(f"{text}: expected an error")


def test_mistakes(folder):
    shot = write_shot(folder)
    says(compare(shot, "--methods", "particles,synthesys", "--out", folder / "out", expect=2), "synthesys")
    says(compare(shot, "--methods", "particles,particles", "--out", folder / "out", expect=2), "--methods")
    says(compare(folder / "nowhere.toml", "--methods", "particles", expect=2), "nowhere.toml")


if __name__ == "__main__":
    main()
