"""Reads the frames of a sequence."""

import dataclasses
import functools
import pathlib
import re

import numpy as np
import OpenImageIO as oiio

from evaluation import layouts
from evaluation.errors import InputError, NotComputed

_NUMBER = re.compile(r"^(.*?)(\d+)\.exr$")


def encoded(linear):
    """The sRGB curve, clamped to [0, 1]. NaN stays."""
    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055)


@dataclasses.dataclass
class Frame:
    """One picture, row 0 at the top. Channels by ebru's names, whatever wrote them."""

    path: pathlib.Path
    number: int
    width: int
    height: int
    planes: dict  # name -> H x W float32
    attributes: dict  # name -> value
    colour: str = "albedo"  # the layer that is judged

    def has(self, *names):
        return all(name in self.planes for name in names)

    def plane(self, name):
        if name not in self.planes:
            raise NotComputed(f"the frames have no channel {name}")
        return self.planes[name]

    def vector(self, layer, parts="XYZ"):
        """@return H x W x len(parts)"""
        return np.stack([self.plane(f"{layer}.{part}" if layer else part) for part in parts], axis=-1)

    def motion(self, layer):
        """@return H x W x 2 pixels, columns to the right and rows down"""
        return self.vector(layer, "uv") * np.float32([1, -1])

    def colours(self):
        """@return H x W x 3 of the judged layer, sRGB-encoded, 0 to 1"""
        return encoded(self.vector("" if self.colour == "rgb" else self.colour, "RGB"))

    @functools.cached_property
    def luma(self):
        """@return H x W float32: mean of the three encoded channels, 0 to 1"""
        return self.colours().mean(axis=-1).astype(np.float32)

    @functools.cached_property
    def fluid(self):
        """@return H x W bool: the pixel sees the fluid, and everything in it is finite"""
        return (self.plane("texture.mask") == 1.0) & self.finite

    @functools.cached_property
    def finite(self):
        """@return H x W bool: no channel is NaN or infinite"""
        return np.logical_and.reduce([np.isfinite(plane) for plane in self.planes.values()])

    def world_to_ndc(self):
        """@return 4 x 4, for row vectors; (0, 0) is the upper left corner of the picture, (1, 1) the lower right"""
        if "worldToNDC" not in self.attributes:
            raise NotComputed("the frames' header has no worldToNDC")
        return np.array(self.attributes["worldToNDC"], float).reshape(4, 4)

    def project(self, points):
        """@param points ... x 3 world  @return ... x 3: column, row (pixels) and depth (grows away from the camera)"""
        m = self.world_to_ndc()
        with np.errstate(all="ignore"):
            h = points.astype(float) @ m[:3] + m[3]
            return h[..., :3] / h[..., 3:] * [self.width, self.height, 1.0]


def find(folder, pattern=None):
    """@return {frame number: path} of the EXR files in `folder`, in order"""
    folder = pathlib.Path(folder)
    if not folder.is_dir():
        raise InputError(f"{folder}: no such folder; name the one the frames were rendered to")
    names = {}
    for path in sorted(folder.glob(pattern or "*.exr")):
        match = _NUMBER.match(path.name)
        if match and not path.name.startswith("."):
            names.setdefault(match[1], {})[int(match[2])] = path
    if not names:
        raise InputError(f"{folder}: got no file NAME.0001.exr, expected a sequence; name the folder of the frames")
    if len(names) > 1:
        raise InputError(f"{folder}: got {len(names)} sequences ({', '.join(n + '####.exr' for n in sorted(names))}), "
                         "expected one; choose with --pattern 'NAME.*.exr'")
    (numbered,) = names.values()
    return dict(sorted(numbered.items()))


# Of the attributes that are used; OpenImageIO spells some in its own way.
_SPELLINGS = {"worldtondc": "worldToNDC", "worldtocamera": "worldToCamera", "framespersecond": "framesPerSecond"}


def _attributes(spec):
    found = {}
    for attribute in spec.extra_attribs:
        found[_SPELLINGS.get(attribute.name.lower(), attribute.name)] = attribute.value
    if "framesPerSecond" in found:
        rate = found["framesPerSecond"]
        found["framesPerSecond"] = rate[0] / rate[1] if isinstance(rate, tuple) else float(rate)
    return found


def _placed(data, spec):
    """The data window's pixels on the display window, which the camera sees; 0 where there are none."""
    x, y = spec.x - spec.full_x, spec.y - spec.full_y
    if (x, y, spec.width, spec.height) == (0, 0, spec.full_width, spec.full_height):
        return data
    whole = np.zeros((spec.full_height, spec.full_width, data.shape[2]), np.float32)
    left, top = max(x, 0), max(y, 0)
    right, bottom = min(x + spec.width, spec.full_width), min(y + spec.height, spec.full_height)
    if right > left and bottom > top:
        whole[top:bottom, left:right] = data[top - y : bottom - y, left - x : right - x]
    return whole


def check_one_size(paths):
    """@param paths  {frame number: EXR file}; read() says what is wrong with one that cannot be opened
    @throw InputError"""
    first = None
    for path in paths.values():
        picture = oiio.ImageInput.open(str(path))
        if picture is None:
            oiio.geterror()
            continue
        spec = picture.spec()
        picture.close()
        size = (spec.full_width, spec.full_height)
        first = first or (path, size)
        if size != first[1]:
            raise InputError(f"{path}: size: got {size[0]} x {size[1]} px, expected {first[1][0]} x {first[1][1]} as in "
                             f"{first[0].name}; render the sequence in one size")


def read(path, number, layout="ebru", colour="albedo"):
    """@throw InputError if the file is no whole EXR picture"""
    picture = oiio.ImageInput.open(str(path))
    if picture is None:
        raise InputError(f"{path}: got a file that cannot be opened ({oiio.geterror().strip()}), expected EXR; "
                         "render it again")
    planes, attributes = {}, {}
    try:
        part = 0
        while picture.seek_subimage(part, 0):
            spec = picture.spec()
            data = picture.read_image(part, 0, 0, spec.nchannels, oiio.FLOAT)
            if data is None:
                raise InputError(f"{path}: got a file that ends early or is damaged ({picture.geterror().strip()}), "
                                 "expected a whole picture; render it again")
            if part == 0:
                width, height = spec.full_width, spec.full_height
                attributes = _attributes(spec)
            elif (spec.full_width, spec.full_height) != (width, height):
                raise InputError(f"{path}: parts: got {spec.full_width} x {spec.full_height} and {width} x {height} px, "
                                 "expected one size")
            data = _placed(np.asarray(data, np.float32).reshape(spec.height, spec.width, spec.nchannels), spec)
            for i, name in enumerate(spec.channelnames):
                planes.setdefault(name, np.ascontiguousarray(data[..., i]))
            part += 1
    finally:
        picture.close()
    return Frame(pathlib.Path(path), number, width, height, layouts.ebru_planes(planes, layout, path), attributes, colour)
