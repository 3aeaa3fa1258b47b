"""What the tests of the evaluation share. A test file defines functions test_*(folder) and ends with

    if __name__ == "__main__":
        main()

because the processes that the evaluation starts read the file again.
"""

import math
import multiprocessing.dummy
import os
import pathlib
import subprocess
import sys
import types
import unittest.mock

# One thread per process, as scripts/requirements.py sets it; before NumPy is there.
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests/cli")]

import numpy as np

from evaluation import exemplar as exemplars
from evaluation import metrics, sequence, summing
from evaluation.errors import InputError
from sequences import Scene, crop_exemplar, write
from support import main

# Windows of so many texels fit nowhere: no time goes into the search for them.
NO_WINDOWS = 401
# Windows that are enough for the tolerances here.
FLOOR_WINDOWS, HANDEDNESS_WINDOWS = 48, 16


def scene_of(folder, name="pebbles", crop=128, **options):
    """@param crop  texels a side of the exemplar; a picture of up to crop pixels stays within it, moving a little
    @return a scene, and the exemplar's file"""
    folder.mkdir(parents=True, exist_ok=True)
    path, pixels = crop_exemplar(folder, name, crop)
    return Scene(pixels, **options), path


def evaluate(paths, exemplar, side=NO_WINDOWS, windows=40, forget=True, **settings):
    """sequence.evaluate in this process: to start one takes longer than the work. test_command.py starts real ones.
    @param exemplar  its file, or None  @param forget  begin as a new process does, with nothing kept of earlier runs
    @return what metrics.json holds"""
    settings = sequence.Settings(exemplars.read(exemplar) if exemplar else None, side=side, windows=windows, jobs=1,
                                 **settings)
    if forget:
        for function in vars(sequence).values():
            getattr(function, "cache_clear", lambda: None)()
    threads = types.SimpleNamespace(get_context=lambda kind: multiprocessing.dummy)
    with (unittest.mock.patch.multiple(sequence, multiprocessing=threads, HANDEDNESS_WINDOWS=HANDEDNESS_WINDOWS),
          unittest.mock.patch.object(summing, "FLOOR_WINDOWS", FLOOR_WINDOWS)):
        return sequence.evaluate(paths, settings)[0]


def evaluate_scene(folder, side=NO_WINDOWS, windows=40, omit=(), change=None, header=True, forget=True, **options):
    """Writes a scene and judges it. @param options  of Scene"""
    scene, exemplar = scene_of(folder, **options)
    paths = write(folder / "frames", scene, omit=omit, change=change, header=header)
    return evaluate(paths, exemplar, side, windows, forget)


def command(*arguments, expect=0):
    """Runs evaluate.py; @return its result, with stdout and stderr as text"""
    run = subprocess.run([sys.executable, "-B", ROOT / "scripts/evaluate.py", *map(str, arguments)],
                         capture_output=True, text=True)
    assert "Traceback" not in run.stderr, run.stderr
    codes = expect if isinstance(expect, tuple) else (expect,)
    assert run.returncode in codes, (
        f"evaluate.py {' '.join(map(str, arguments))}\nended with {run.returncode}, expected {expect}\n"
        f"{run.stdout}{run.stderr}")
    return run


def near(figures, name, expected, tolerance):
    value = figures[name]
    assert value is not None and abs(value - expected) <= tolerance, (
        f"{name}: got {value}, expected {expected} +- {tolerance}")


def below(figures, name, bound):
    value = figures[name]
    assert value is not None and value <= bound, f"{name}: got {value}, expected at most {bound}"


def above(figures, name, bound):
    value = figures[name]
    assert value is not None and value >= bound, f"{name}: got {value}, expected at least {bound}"


def row(result, number):
    (found,) = [r for r in result["frames"] if r["frame"] == number]
    return found


def missing_because(result, names, *parts):
    """These figures are missing, and the reason that is given has every part."""
    for name in names:
        assert result["summary"].get(name) is None, f"{name}: got {result['summary'][name]}, expected no figure"
        reason = result["not_computed"].get(name)
        assert reason and all(part in reason for part in parts), (
            f"{name}: got the reason {reason!r}, expected {parts} in it")


def ids(*beginnings):
    return [name for name in metrics.METRICS if name.startswith(beginnings)]


def refused(call, *parts):
    """call() refuses its input and says every part."""
    try:
        call()
    except InputError as error:
        for part in parts:
            assert part in str(error), f"expected {part!r} in {str(error)!r}"
        return
    raise AssertionError(f"nothing was refused; expected an error with {parts}")
