"""What a shot file says that the pictures do not."""

import pathlib
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
