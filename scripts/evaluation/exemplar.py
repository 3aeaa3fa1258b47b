"""The example image, as the metrics see it."""

import dataclasses

import numpy as np
import OpenImageIO as oiio

from evaluation.errors import InputError
from evaluation.frames import encoded


@dataclasses.dataclass
class Exemplar:
    path: str
    luma: np.ndarray  # H x W float32, 0 to 1: mean of the three channels, sRGB-encoded

    @property
    def sigma(self):
        return float(self.luma.std())


def read(path):
    """8- and 16-bit files hold encoded values, float files scene-linear ones.
    @throw InputError if it is no picture of finite values"""
    picture = oiio.ImageBuf(str(path))
    pixels = picture.get_pixels(oiio.FLOAT) if picture.initialized else None
    if pixels is None:
        raise InputError(f"{path}: got a file OpenImageIO cannot read ({picture.geterror().strip()}), expected a picture")
    colours = pixels[..., :3] if pixels.shape[-1] >= 3 else pixels[..., :1]
    if picture.spec().format.basetype in (oiio.HALF, oiio.FLOAT, oiio.DOUBLE):
        colours = encoded(colours)
    luma = np.ascontiguousarray(colours.mean(axis=-1), np.float32)
    if not np.isfinite(luma).all():
        raise InputError(f"{path}: pixels: got values that are not finite, expected finite ones")
    return Exemplar(str(path), luma)
