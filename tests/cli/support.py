"""What the tests of the command line share: small shots, running the program, comparing results.

A test file defines functions test_*(folder) and ends with support.main(); each gets an empty folder of its own.
"""

import inspect
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import traceback

ROOT = pathlib.Path(__file__).resolve().parents[2]
# CTest names the programs; by hand those of the release build are taken.
EBRU = os.environ.get("EBRU", str(ROOT / "build/release/ebru"))
MAKE_VDB = os.environ.get("EBRU_MAKE_VDB", str(ROOT / "build/release/tests/make_vdb"))
COMPARE_EXR = os.environ.get("EBRU_COMPARE_EXR", str(ROOT / "build/release/tests/compare_exr"))
EXEMPLAR = ROOT / "scenes/exemplars/checker.png"

SHOT = """[shot]
name = "tiny"
first_frame = 1
last_frame = {last}
fps = 24
[fluid]
{fluid}
[texture]
method = "{method}"
exemplar = "{exemplar}"
texel_size = {texel}
[camera]
position = {position}
target = {target}
vertical_fov_deg = 30
size = [48, 32]
[render]
spp = 2
[ground]
enabled = true
height = {ground}
"""

# A small ball drawn out by Enright's deformation: everything moves, and not as a rigid body.
VORTEX = """source = "procedural"
scene = "vortex_sphere"
size = 0.5
voxel_size = 0.03
period_frames = 16"""


def write_shot(folder, fluid=VORTEX, method="particles", last=8, exemplar=EXEMPLAR, texel=0.012,
               position="[0.35, -0.9, 0.6]", target="[0.35, 0.35, 0.35]", ground=0.0):
    path = folder / "tiny.toml"
    path.write_text(SHOT.format(fluid=fluid, method=method, last=last, exemplar=exemplar, texel=texel,
                                position=position, target=target, ground=ground))
    return path


def write_cache(folder, frames=4, **faults):
    """A ball that moves by 0.01 m per frame, as VDBs. `faults` maps "frame_3" to more arguments of make_vdb."""
    cache = folder / "cache"
    cache.mkdir()
    for frame in range(1, frames + 1):
        arguments = ["--centre", str(0.01 * frame), "--velocity", "0.24", "0", "0"]
        arguments += faults.get(f"frame_{frame}", [])
        subprocess.run([MAKE_VDB, cache / f"ball.{frame:04}.vdb", *arguments], check=True)
    return cache


def write_cache_shot(folder, frames=4, fluid="", **options):
    options = {"position": "[0, -1.5, 0.4]", "target": "[0, 0, 0]", "ground": -0.3, "texel": 0.02, **options}
    return write_shot(folder, f'source = "vdb"\npath = "cache/ball.####.vdb"\n{fluid}', last=frames, **options)


def ebru(*arguments, expect=0, **options):
    """Runs the program; @return its result, with stdout and stderr as text."""
    run = subprocess.run([EBRU, *map(str, arguments)], capture_output=True, text=True, **options)
    assert run.returncode == expect, (
        f"ebru {' '.join(map(str, arguments))}\nended with {run.returncode}, expected {expect}\n{run.stdout}{run.stderr}")
    return run


def render(shot, out, *arguments, expect=0, **options):
    return ebru("render", shot, "--out", out, *arguments, expect=expect, **options)


def methods():
    """Names of all methods, as `ebru methods` lists them."""
    return [line.split()[0] for line in ebru("methods").stdout.splitlines()]


def texture_methods():
    """All but `plain`: it shows the material alone and has neither texture nor states, which is what the tests that go
    through the methods look at."""
    return [name for name in methods() if name != "plain"]


def says(run, *parts):
    """Every part is in what the run said on stderr."""
    for part in parts:
        assert part in run.stderr, f"expected to find {part!r} in\n{run.stderr}"


def files(folder, pattern="**/*"):
    """Relative name -> bytes of every file."""
    if not folder.exists():
        return {}
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.glob(pattern)) if p.is_file()}


def assert_same_files(got, expected, what=""):
    assert expected, f"{what}: nothing to compare with"
    assert got.keys() == expected.keys(), f"{what}: got files {sorted(got)}, expected {sorted(expected)}"
    for name in expected:
        assert got[name] == expected[name], f"{what}: {name} differs"


def pictures(folder):
    """Those under their final names."""
    return {name: content for name, content in files(folder, "*.exr").items() if ".tmp." not in name}


def assert_nothing_written(folder):
    left = files(folder)
    assert not left, f"{folder}: got {sorted(left)}, expected nothing"


def assert_no_temporaries(folder):
    left = [name for name in files(folder) if ".tmp." in name]
    assert not left, f"{folder}: got {left}, expected no temporaries"


def main():
    module = sys.modules["__main__"]
    only = sys.argv[1:]
    failed = 0
    for name, test in inspect.getmembers(module, inspect.isfunction):
        if not name.startswith("test_") or (only and name not in only):
            continue
        folder = pathlib.Path(tempfile.mkdtemp(prefix=f"ebru_{name}_"))
        try:
            test(folder)
            print(f"ok      {name}", flush=True)
        except Exception:
            failed += 1
            print(f"FAILED  {name}\n{traceback.format_exc()}", flush=True)
        finally:
            shutil.rmtree(folder, ignore_errors=True)
    sys.exit(1 if failed else 0)
