#!/usr/bin/python3
"""Renders a regression case and compares it with its reference pictures, or writes those.

    run_case.py CASE METHOD --ebru PROGRAM --compare PROGRAM
    run_case.py CASE METHOD --ebru PROGRAM --write            (through scripts/make_references)

A case is a folder with `args` (the shot, relative to the folder, and arguments of `ebru render`), `methods`, `tolerances`
(see tests/tools/compare_exr.cpp) and a README.md. A missing reference and a picture without one both fail.

A case with `reference_args` instead of `tolerances` is of light: its references are rendered with those arguments too (many
samples), and R, G, B are compared by a z-test (z_test.py) instead of pixel by pixel.
"""

import argparse
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile

import z_test

CASES = pathlib.Path(__file__).resolve().parent
REFERENCES = CASES.parents[1] / "reference_images"


def words_of(file):
    return shlex.split(file.read_text(), comments=True)


def is_statistical(case):
    return (CASES / case / "reference_args").exists()


def arguments_of(case, reference):
    """The words of `args`; the first is the shot."""
    words = words_of(CASES / case / "args")
    words[0] = str((CASES / case / words[0]).resolve())
    if is_statistical(case):
        words += ["--set", "render.variance=true"]
        if reference:
            words += words_of(CASES / case / "reference_args")
    return words


def render(ebru, case, method, folder, reference):
    command = [ebru, "render", *arguments_of(case, reference), "--method", method, "--out", str(folder), "--overwrite"]
    print(shlex.join(command), flush=True)
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"ebru ended with {run.returncode}:\n{run.stderr}")


def write(rendered, references):
    if references.exists():
        for old in references.glob("*.exr"):
            old.unlink()
    references.mkdir(parents=True, exist_ok=True)
    for picture in sorted(rendered.glob("*.exr")):
        shutil.copyfile(picture, references / picture.name)
        print(f"wrote {references / picture.name}")


def differences(program, result, reference, case, folder):
    """@return what is wrong, one line each"""
    if is_statistical(case):
        return z_test.compare_files(result, reference, folder)
    tolerances = CASES / case / "tolerances"
    run = subprocess.run([program, reference, result, tolerances], capture_output=True, text=True)
    return [] if run.returncode == 0 else [f"{run.stdout}{run.stderr}".rstrip()]


def compare(program, rendered, references, case):
    made = {p.name for p in rendered.glob("*.exr")}
    kept = {p.name for p in references.glob("*.exr")} if references.exists() else set()
    bad = [f"{name}: no reference in {references}; scripts/make_references writes it" for name in sorted(made - kept)]
    bad += [f"{name}: a reference that the case does not render" for name in sorted(kept - made)]
    if not made:
        bad.append("nothing was rendered")
    for name in sorted(made & kept):
        wrong = differences(program, rendered / name, references / name, case, rendered)
        bad += [f"{name}:", *wrong] if wrong else []
    return bad


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case")
    parser.add_argument("method")
    parser.add_argument("--ebru", required=True)
    parser.add_argument("--compare")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()

    references = REFERENCES / arguments.case / arguments.method
    with tempfile.TemporaryDirectory(prefix="ebru_regression_") as folder:
        rendered = pathlib.Path(folder)
        render(arguments.ebru, arguments.case, arguments.method, rendered, reference=arguments.write)
        if arguments.write:
            write(rendered, references)
            return
        bad = compare(arguments.compare, rendered, references, arguments.case)
        if bad:
            # Kept for a look: the difference of two pictures says more than a number.
            kept = pathlib.Path(tempfile.mkdtemp(prefix=f"ebru_{arguments.case}_{arguments.method}_"))
            shutil.copytree(rendered, kept, dirs_exist_ok=True)
            sys.exit("\n".join(bad) + f"\nrendered pictures: {kept}\nreferences: {references}")


main()
