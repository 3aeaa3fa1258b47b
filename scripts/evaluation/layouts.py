"""Which channel of a renderer's EXR files is which, and with which sign.

Everything past this file speaks ebru's language (docs/aovs.md): albedo.R/G/B scene-linear, Z, P.X/Y/Z, N.X/Y/Z, velocity.X/Y/Z,
forward.u/v and backward.u/v in pixels (+u right, +v up) to where the point is in frame f + 1 and f - 1, texture.s/t/id/mask.
"""

import numpy as np

from evaluation.errors import InputError

NAMES = ("ebru", "nuke", "blender")

AXES = ("X", "Y", "Z")
COLOURS = ("R", "G", "B")
EBRU = (
    ["R", "G", "B", "A", "Z"]
    + [f"{layer}.{axis}" for layer in ("P", "N", "velocity") for axis in AXES]
    + [f"albedo.{colour}" for colour in COLOURS]
    + [f"{layer}.{axis}" for layer in ("forward", "backward") for axis in "uv"]
    + [f"texture.{name}" for name in ("s", "t", "age", "distortion", "id", "mask")]
)

# Nuke writes R G B A of a layer as words, x y z in lower case, and puts what has no layer into `rgba` or `other`.
_WORDS = {"R": "red", "G": "green", "B": "blue", "A": "alpha"}


def _nuke_spellings(name):
    layer, _, last = name.rpartition(".")
    word = _WORDS.get(last, last)
    spellings = [name, f"{layer}.{word}" if layer else word, f"{layer}.{last.lower()}" if layer else last]
    if not layer:
        spellings += [f"rgba.{word}", f"other.{last}", f"depth.{last}"]
    if layer in ("P", "N", "velocity"):  # a layer of three is a colour to Nuke
        spellings += [f"{layer}.{_WORDS[COLOURS[AXES.index(last)]]}", f"{layer}.{COLOURS[AXES.index(last)]}"]
    return spellings


def _nuke(planes):
    found = {}
    for name in EBRU:
        for spelling in _nuke_spellings(name):
            if spelling in planes:
                found[name] = planes[spelling]
                break
    return found


# Cycles' passes. Vector: X Y = previous - current, Z W = current - next, pixels, y up.
_BLENDER = {
    **{colour: ("Combined", colour, 1) for colour in "RGBA"},
    **{f"albedo.{colour}": ("DiffCol", colour, 1) for colour in COLOURS},
    "Z": ("Depth", "Z", 1),
    **{f"P.{axis}": ("Position", axis, 1) for axis in AXES},
    **{f"N.{axis}": ("Normal", axis, 1) for axis in AXES},
    "forward.u": ("Vector", "Z", -1),
    "forward.v": ("Vector", "W", -1),
    "backward.u": ("Vector", "X", 1),
    "backward.v": ("Vector", "Y", 1),
    "texture.s": ("UV", "U", 1),
    "texture.t": ("UV", "V", 1),
    "texture.mask": ("IndexOB", "X", 1),
}
_BLENDER_ALTERNATIVES = {"DiffCol": ("Denoising Albedo",), "Depth": ("Z",), "Vector": ("Motion",)}


def _blender(planes):
    # View layer . pass . channel; the passes of the first view layer count.
    passes = {}
    for name in sorted(planes):
        parts = name.rsplit(".", 2)
        passes.setdefault((parts[-2] if len(parts) > 1 else "", parts[-1]), planes[name])
    found = {}
    for name, (pass_name, channel, sign) in _BLENDER.items():
        for spelling in (pass_name, *_BLENDER_ALTERNATIVES.get(pass_name, ())):
            if (spelling, channel) in passes:
                found[name] = sign * passes[spelling, channel]
                break
    if "texture.mask" in found:
        found["texture.mask"] = (found["texture.mask"] > 0).astype(np.float32)
    return found


def ebru_planes(planes, layout, where):
    """@param planes  channel name -> H x W as in the file
    @return ebru's channel name -> H x W, those that are there
    @throw InputError if not a single one is"""
    found = {"ebru": lambda: {n: planes[n] for n in EBRU if n in planes}, "nuke": lambda: _nuke(planes),
             "blender": lambda: _blender(planes)}[layout]()
    if "texture.mask" not in found and "A" in found:
        found["texture.mask"] = (found["A"] > 0.5).astype(np.float32)
    if not found:
        raise InputError(f"{where}: channels: got {', '.join(sorted(planes)) or 'none'}, expected those of {layout}; "
                         f"choose another --layout ({', '.join(NAMES)})")
    return found
