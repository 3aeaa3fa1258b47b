"""compare.py renders, judges and lays side by side."""

import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))

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
    compare(*arguments)
    assert_same_files(pictures(out / "particles"), frames, "frames that are there are kept")


def test_mistakes(folder):
    shot = write_shot(folder)
    says(compare(shot, "--methods", "particles,synthesys", "--out", folder / "out", expect=2), "synthesys")
    says(compare(shot, "--methods", "particles,particles", "--out", folder / "out", expect=2), "--methods")
    says(compare(folder / "nowhere.toml", "--methods", "particles", expect=2), "nowhere.toml")


if __name__ == "__main__":
    main()
