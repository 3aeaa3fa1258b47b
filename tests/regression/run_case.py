#!/usr/bin/env python3
"""Renders a regression case and compares it with its reference pictures, or writes those.

    run_case.py CASE METHOD --ebru PROGRAM --compare PROGRAM
    run_case.py CASE METHOD --ebru PROGRAM --write            (through scripts/make_references)

A case is a folder with `args` (the shot, relative to the folder, and arguments of `ebru render`), `methods`, `tolerances`
(see tests/tools/compare_exr.cpp) and a README.md. A missing reference and a picture without one both fail.
"""

import argparse
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile

CASES = pathlib.Path(__file__).resolve().parent
REFERENCES = CASES.parents[1] / "reference_images"


def arguments_of(case):
    """The words of `args`; the first is the shot."""
    text = (CASES / case / "args").read_text()
    words = shlex.split(text, comments=True)
    words[0] = str((CASES / case / words[0]).resolve())
    return words


def render(ebru, case, method, folder):
    command = [ebru, "render", *arguments_of(case), "--method", method, "--out", str(folder), "--overwrite"]
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


def compare(program, rendered, references, tolerances):
    made = {p.name for p in rendered.glob("*.exr")}
    kept = {p.name for p in references.glob("*.exr")} if references.exists() else set()
    bad = [f"{name}: no reference in {references}; scripts/make_references writes it" for name in sorted(made - kept)]
    bad += [f"{name}: a reference that the case does not render" for name in sorted(kept - made)]
    if not made:
        bad.append("nothing was rendered")
    for name in sorted(made & kept):
        run = subprocess.run([program, references / name, rendered / name, tolerances], capture_output=True, text=True)
        if run.returncode != 0:
            bad.append(f"{name}:\n{run.stdout}{run.stderr}".rstrip())
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
        render(arguments.ebru, arguments.case, arguments.method, rendered)
        if arguments.write:
            write(rendered, references)
            return
        bad = compare(arguments.compare, rendered, references, CASES / arguments.case / "tolerances")
        if bad:
            # Kept for a look: the difference of two pictures says more than a number.
            kept = pathlib.Path(tempfile.mkdtemp(prefix=f"ebru_{arguments.case}_{arguments.method}_"))
            shutil.copytree(rendered, kept, dirs_exist_ok=True)
            sys.exit("\n".join(bad) + f"\nrendered pictures: {kept}\nreferences: {references}")


main()
