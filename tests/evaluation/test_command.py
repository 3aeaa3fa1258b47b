"""evaluate.py from the outside: exit codes, files, messages; and the same figures however many processes work."""

import html.parser
import json

from checks import *
from evaluation import gates

OK, FAILED, USAGE, INPUT = 0, 1, 2, 3
VOID = {"area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"}


class Page(html.parser.HTMLParser):
    """Open tags are closed in order, and nothing is fetched from elsewhere."""

    def __init__(self):
        super().__init__()
        self.open, self.seen, self.text = [], set(), ""

    def handle_starttag(self, tag, attributes):
        self.handle_startendtag(tag, attributes)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.seen.add(tag)
        for name, value in attributes:
            if name in ("src", "href", "xlink:href", "data", "poster", "srcset"):
                assert value.startswith(("data:", "#")), f"<{tag} {name}={value[:60]!r}>"
            elif not name.startswith("xmlns"):
                assert "://" not in (value or ""), f"<{tag} {name}={value[:60]!r}>"

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, f"</{tag}> at {self.getpos()} within {self.open[-3:]}"
        self.open.pop()

    def handle_data(self, data):
        assert "@import" not in data and "url(http" not in data
        self.text += data


def read_json(path):
    def no_number(text):
        raise AssertionError(f"{path}: {text} is not JSON")

    return json.loads(path.read_text(), parse_constant=no_number)


def moving(folder, **options):
    scene, exemplar = scene_of(folder, **{"crop": 108, "width": 96, "height": 84, "shift": (3, -2), **options})
    write(folder / "frames", scene)
    return folder / "frames", exemplar


def test_figures_report_and_gates(folder):
    """Bounds that hold and bounds that do not; with two processes and with one, which changes nothing else."""
    frames, exemplar = moving(folder)
    arguments = [frames, "--exemplar", exemplar, "--windows", 12]
    run = command(*arguments, "--out", folder / "two", "--jobs", 2, "--write-flow", "flo", "--require", "holes=0",
                  "flow_excess=0.25", "contrast=0.8:1.2", "cover=0.1:", "motion_check_p99_max=0.02")
    result = read_json(folder / "two/metrics.json")
    assert [gate["passed"] for gate in result["gates"]] == 5 * [True], result["gates"]
    missing = [name for name in metrics.METRICS if not result["definitions"].get(name)]
    assert not missing, f"no definition of {missing}"
    for name in metrics.METRICS:
        assert (result["summary"].get(name) is None) == (name in result["not_computed"]), name
    near(result["summary"], "energy_ratio", 1, 0.2)
    assert str(folder / "two/metrics.json") in run.stdout and "energy_ratio" in run.stdout, run.stdout
    assert sorted(p.name for p in (folder / "two/flow").iterdir()) == [f"plane.{n:04}.flo" for n in (1, 2)]

    page = Page()
    page.feed((folder / "two/report.html").read_text())
    page.close()
    assert not page.open, f"never closed: {page.open}"
    assert "img" in page.seen and "svg" in page.seen and "energy_ratio" in page.text, page.seen

    run = command(*arguments, "--jobs", 1, "--write-flow", "kitti",
                  "--require", "holes=0", "still_change=0.01", "energy_ratio=0.1", "contrast=2:", expect=FAILED)
    named = [line for line in run.stderr.splitlines() if line.startswith("evaluate.py: failed: ")]
    # Those that hold are not named; what could not be computed does not hold.
    assert [line.split(": ")[2] for line in named] == ["still_change", "energy_ratio", "contrast"], run.stderr
    assert "nothing (" in named[0] and "at most 0.1" in named[1] and "at least 2" in named[2], named
    again = read_json(frames / "metrics.json")
    assert [gate["passed"] for gate in again["gates"]] == [True, False, False, False], again["gates"]
    assert (frames / "report.html").exists() and (frames / "flow/plane.0002.png").exists()
    assert {**again, "gates": None} == {**result, "gates": None}, "another number of processes, other figures"


def test_usage(folder):
    run = command(folder, "--flow", "guess", expect=USAGE)
    assert "guess" in run.stderr and "farneback" in run.stderr, run.stderr


def test_bounds_that_make_no_sense(folder):
    for text, *parts in (("nonsense=1", "nonsense", "energy_ratio"), ("holes", "holes"),
                         ("contrast_max=1", "contrast_max"), ("holes=few", "few", "LOWER:UPPER"),
                         ("holes=", "LOWER:UPPER"), ("holes=:", "LOWER:UPPER")):
        refused(lambda: gates.parse(text), *parts)
    for text, lower, upper in (("cover=0.5:", 0.5, None), ("holes=0", None, 0), ("contrast=0.9:1.1", 0.9, 1.1)):
        gate = gates.parse(text)
        assert (gate.lower, gate.upper) == (lower, upper), (text, gate)


def test_numbers_that_make_no_sense(folder):
    """Told before any work, by the option's name."""
    frames, _ = moving(folder, frames=1)
    for option, value in (("--side", 20), ("--jobs", -1)):
        run = command(frames, option, value, expect=(USAGE, INPUT))
        assert option in run.stderr and str(value) in run.stderr, run.stderr
    assert not (frames / "metrics.json").exists()


def test_frame_that_ends_early(folder):
    """A worker finds it; the program names it and writes no figures."""
    frames, exemplar = moving(folder)
    second = frames / "plane.0002.exr"
    second.write_bytes(second.read_bytes()[:-2000])
    run = command(frames, "--exemplar", exemplar, "--side", NO_WINDOWS, "--jobs", 1, expect=INPUT)
    assert "evaluate.py: error: " in run.stderr and "plane.0002.exr" in run.stderr, run.stderr
    assert not (frames / "metrics.json").exists()


def test_flow_files_of_frames_without_motion(folder):
    scene, _ = scene_of(folder, crop=64, width=32, height=32, frames=1)
    write(folder / "frames", scene, omit=("forward", "backward"))
    run = command(folder / "frames", "--write-flow", "flo", "--jobs", 1, expect=(OK, INPUT))
    assert "forward.u" in run.stderr, run.stderr


if __name__ == "__main__":
    main()
