"""What a shot file says that the pictures do not."""

import pathlib
import re
import tomllib

from evaluation.errors import UsageError


def _value(text):
    """As `ebru render --set` reads it: TOML, else a string without its quotes."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def _override(tables, setting):
    """@param setting  "table.key=value"; what names an element of an array concerns no figure"""
    name, _, value = setting.partition("=")
    table, _, key = name.strip().partition(".")
    if key and "." not in key:
        tables.setdefault(table, {})[key] = _value(value.strip())


_FRAMES = re.compile(r"(-?\d+)(?:-(-?\d+)(?:([xy:])(\d+))?)?")


def frames_of(tables, asked=None):
    """@param asked  as `ebru render --frames` reads it; None: all of the shot
    @return the set of frame numbers  @throw UsageError"""
    if not asked:
        shot = tables["shot"]
        return set(range(shot.get("first_frame", 1), shot.get("last_frame", 1) + 1))
    found = set()
    for part in asked.split(","):
        match = _FRAMES.fullmatch(part)
        step = int(match[4] or 1) if match else 0
        if step < 1:
            raise UsageError(f"--frames: got \"{part}\", expected frames like 7, 1-48, 1-48x2, 1-48y2 or 1-48:8")
        first, last = int(match[1]), int(match[2] or match[1])
        run = range(first, last + 1) if last >= first else range(first, last - 1, -1)
        stepped = set(run[::step])
        # Staggered frames are all of the run in another order.
        found |= {"x": stepped, "y": set(run) - stepped}.get(match[3], set(run))
    return found


def read(path, settings=()):
    """@param settings  as given to `ebru render --set`
    @return the tables of the shot, file names made absolute  @throw UsageError"""
    path = pathlib.Path(path)
    try:
        tables = tomllib.loads(path.read_text())
    except OSError as e:
        raise UsageError(f"{path}: cannot be read ({e.strerror}); name a shot file") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as e:
        raise UsageError(f"{path}: got a file that is no TOML ({e}), expected a shot") from None
    for setting in settings:
        _override(tables, setting)
    named = tables.get("texture", {}).get("exemplar", [])
    # One picture is what a sequence is compared with: of several the first.
    pictures = named if isinstance(named, list) else [named]
    if pictures:
        tables["texture"]["exemplar"] = str((path.parent / pictures[0]).resolve())
    tables.setdefault("shot", {}).setdefault("fps", 24.0)
    tables["shot"].setdefault("name", path.stem)
    return tables
