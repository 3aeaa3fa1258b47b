"""The comparer of the regression tests sees what it has to see."""

from support import *


def compare(reference, result, tolerances, expect, *parts):
    run = subprocess.run([COMPARE_EXR, reference, result, tolerances], capture_output=True, text=True)
    assert run.returncode == expect, f"ended with {run.returncode}, expected {expect}\n{run.stdout}{run.stderr}"
    for part in parts:
        assert part in run.stdout + run.stderr, f"expected to find {part!r} in\n{run.stdout}{run.stderr}"


def test_differences_are_found(folder):
    render(write_shot(folder, last=2), folder / "out")
    good, changed = folder / "out/tiny.0001.exr", folder / "changed.exr"
    strict = folder / "strict"
    strict.write_text("* 0 0  # bit for bit\n")
    compare(good, good, strict, 0)

    def change(*arguments):
        subprocess.run(["oiiotool", good, *arguments, "-d", "float", "-o", changed], check=True)

    change("--ch", "R,G,B,A")
    compare(good, changed, strict, 1, "channel forward.u is missing", "channel Z is missing")
    compare(changed, good, strict, 1, "got channel forward.u, expected no such channel")
    compare(good, changed, folder / "nowhere", 2, "no tolerances")

    change("--attrib", "ebru:method", "other")
    compare(good, changed, strict, 1, "header: ebru:method: got \"other\", expected \"particles\"")
    change("--eraseattrib", "ebru:seed")
    compare(good, changed, strict, 1, "header: ebru:seed is missing")

    change("--addc", "0.5")
    loose = folder / "loose"
    loose.write_text("forward.* 0.4 0\n* 0.6 0\n")
    compare(good, changed, strict, 1, "R: ", "forward.u: ")
    compare(good, changed, loose, 1, "forward.u: 100.000 % of the pixels differ by more than 0.4")
    compare(good, folder / "out/tiny.0002.exr", strict, 1, "P.X: ", "imageCounter")

    change("--resize", "24x16")
    compare(good, changed, loose, 1, "size: got 24 x 16, expected 48 x 32")
    compare(good, folder / "nowhere.exr", loose, 2, "nowhere.exr")


main()
