"""What evaluate.py and compare.py share: where things are, progress, the metrics of one folder."""

import json
import os
import pathlib
import sys
import time

from evaluation import exemplar as exemplars
from evaluation import sequence
from evaluation.errors import InputError, UsageError

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Progress:
    """One line that renews itself on a terminal, a line every 10 % when piped; on stderr."""

    def __init__(self, what):
        self._what, self._begun, self._said = what, time.monotonic(), 0

    def __call__(self, done, total):
        took = time.monotonic() - self._begun
        text = f"{self._what}: frame {done} of {total}, {took:.0f} s"
        if sys.stderr.isatty():
            print(f"\r{text}, about {took / done * (total - done):.0f} s left   ", end="\n" if done == total else "",
                  file=sys.stderr, flush=True)
        elif done == total or done * 10 // total > self._said:
            self._said = done * 10 // total
            print(text, file=sys.stderr, flush=True)


def add_metric_arguments(parser):
    parser.add_argument("--flow", choices=sequence.optical_flow.ESTIMATORS, default="dis",
                        help="optical-flow estimator (default dis)")
    parser.add_argument("--windows", type=int, default=100, help="windows per frame the energy is measured on (default 100)")
    parser.add_argument("--side", type=int, default=21,
                        help="samples a side of those windows, odd: about one feature of the exemplar (default 21)")
    parser.add_argument("--seed", type=int, default=1, help="of the windows' places (default 1)")
    parser.add_argument("--jobs", type=int, default=0, help="processes (default: one per processor)")


def find_shot(name):
    """A file, or the name of one of scenes/."""
    for path in (pathlib.Path(name), ROOT / name, ROOT / "scenes" / f"{name}.toml"):
        if path.is_file():
            return path
    raise UsageError(f"{name}: no such shot file; name one, or a shot of scenes/")


def settings_of(arguments, shot=None):
    """@param shot  tables of the shot file"""
    shot = shot or {}
    texture = shot.get("texture", {})
    exemplar = getattr(arguments, "exemplar", None) or texture.get("exemplar")
    if arguments.side < 5 or arguments.side % 2 == 0:
        raise UsageError(f"--side: got {arguments.side}, expected an odd number of at least 5")
    if arguments.windows < 1:
        raise UsageError(f"--windows: got {arguments.windows}, expected at least 1")
    if arguments.jobs < 0 or arguments.seed < 0:
        name = "--jobs" if arguments.jobs < 0 else "--seed"
        raise UsageError(f"{name}: got {min(arguments.jobs, arguments.seed)}, expected 0 or more")
    texel_size = getattr(arguments, "texel_size", None) or texture.get("texel_size")
    fps = getattr(arguments, "fps", None) or (shot["shot"]["fps"] if shot else None)
    return sequence.Settings(
        exemplar=exemplars.read(exemplar) if exemplar else None,
        texel_size_world=texel_size, fps=fps,
        fluid={**shot.get("fluid", {}), "fps": shot.get("shot", {}).get("fps", 24.0)},
        layout=getattr(arguments, "layout", "ebru"), colour=getattr(arguments, "colour", "albedo"), flow=arguments.flow,
        windows=arguments.windows, side=arguments.side, seed=arguments.seed, jobs=arguments.jobs)


def write_json(path, value):
    temporary = path.with_name(f".{path.name}.tmp.{os.getpid()}")
    temporary.write_text(json.dumps(value, indent=1, allow_nan=False) + "\n")
    os.replace(temporary, path)


def run(main):
    """Ends the program as ebru does: 2 usage, 3 input data, 4 output."""
    try:
        sys.exit(main())
    except InputError as e:
        print(f"{pathlib.Path(sys.argv[0]).name}: error: {e}", file=sys.stderr)
        sys.exit(2 if isinstance(e, UsageError) else 3)
    except OSError as e:
        print(f"{pathlib.Path(sys.argv[0]).name}: error: {e.filename or 'output'}: {e.strerror or e}", file=sys.stderr)
        sys.exit(4)
    except KeyboardInterrupt:
        sys.exit(130)
