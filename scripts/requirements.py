"""Python modules of the evaluation scripts, installed on their first use."""

import importlib.util
import os
import pathlib
import subprocess
import sys

MODULES = ("numpy", "scipy", "cv2", "OpenImageIO", "matplotlib")


def provide():
    """@return when all modules are there; ends the program when they cannot be installed"""
    # Many processes with one thread each are faster than the other way round.
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    if all(importlib.util.find_spec(module) for module in MODULES):
        return
    setup = pathlib.Path(__file__).with_name("setup")
    if subprocess.run([setup, "--for", "evaluation"], stdout=sys.stderr).returncode != 0:
        sys.exit(1)
    importlib.invalidate_caches()
    missing = [module for module in MODULES if not importlib.util.find_spec(module)]
    if missing:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: error: Python has no {', '.join(missing)}; run it with Debian's Python, "
                 "/usr/bin/python3")
