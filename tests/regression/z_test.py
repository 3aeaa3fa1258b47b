"""Whether two noisy pictures are of the same scene: a z-test per pixel and channel.

A picture brings R, G, B and their estimated variances (render.variance). Under the hypothesis that both have the same
expectation, the difference divided by its standard deviation is normal; the smallest p-value of all pixels is judged at a
level that Sidak's correction makes right for their number [in the manner of Mitsuba's tests]. The mean over blocks of 8 x 8
pixels and over the whole picture is judged too, and sees a bias that drowns in the noise of a pixel. Pictures with values
that no test can judge (not finite, a negative variance, no samples) are refused before.
"""

import dataclasses
import math
import pathlib

import numpy as np
import OpenImageIO as oiio
from scipy.special import erfc

COLOURS = ("R", "G", "B")
VARIANCES = ("variance.R", "variance.G", "variance.B")
SIGNIFICANCE = 0.001


@dataclasses.dataclass
class Picture:
    """mean and variance (of the mean): height x width x 3; samples: height x width."""

    mean: np.ndarray
    variance: np.ndarray
    samples: np.ndarray


def read(path):
    image = oiio.ImageBuf(str(path))
    if image.has_error:
        raise SystemExit(f"{path}: cannot be read: {image.geterror()}")
    names = image.spec().channelnames
    missing = [name for name in (*COLOURS, *VARIANCES, "samples") if name not in names]
    if missing:
        raise SystemExit(f"{path}: no channels {', '.join(missing)}; render with --set render.variance=true")
    pixels = image.get_pixels(oiio.FLOAT).astype(np.float64)
    plane = {name: pixels[..., i] for i, name in enumerate(names)}
    stack = lambda channels: np.stack([plane[name] for name in channels], axis=-1)
    return Picture(stack(COLOURS), stack(VARIANCES), plane["samples"])


def write(path, values):
    """An RGB picture for people."""
    buffer = oiio.ImageBuf(oiio.ImageSpec(values.shape[1], values.shape[0], 3, oiio.FLOAT))
    buffer.set_pixels(oiio.ROI(), np.ascontiguousarray(values, dtype=np.float32))
    buffer.write(str(path))


def blocks(values, shape):
    """Sums over blocks of `shape` (height, width) from the upper left corner on; those at the other edges may be smaller."""
    height, width = shape
    padding = [(0, -n % side) for n, side in zip(values.shape, shape)] + [(0, 0)]
    values = np.pad(values, padding)
    return values.reshape(values.shape[0] // height, height, values.shape[1] // width, width, -1).sum(axis=(1, 3))


def smallest_p(difference, variance):
    """The smallest p-value, corrected for the number of values [Sidak 1967], and where it is."""
    z = np.abs(difference) / np.sqrt(variance)
    p = erfc(z / math.sqrt(2.0))
    place = np.unravel_index(np.argmin(p), p.shape)
    return -np.expm1(p.size * np.log1p(-np.minimum(p[place], 1.0 - 1e-16))), place


def half_rounding(values):
    """Variance of what is lost where a value becomes a half: a twelfth of the square of the last place's worth."""
    return (np.maximum(np.abs(values), 2.0**-14) * 2.0**-10) ** 2 / 12.0


def impossible(picture, name):
    """@return a line for each kind of value that cannot be judged, with the first pixel that has it"""
    bad = []
    for what, right in (
        ("mean: got values that are not finite", np.isfinite(picture.mean)),
        ("variance: got values that are negative or not finite", np.isfinite(picture.variance) & (picture.variance >= 0.0)),
        ("samples: got numbers that are not above 0", np.isfinite(picture.samples) & (picture.samples > 0.0)),
    ):
        places = np.argwhere(~right.reshape(*right.shape[:2], -1).all(axis=-1))
        if len(places):
            bad.append(f"{name}: {what}, in {len(places)} pixels, the first ({places[0][1]}, {places[0][0]})")
    return bad


def compare(result, reference):
    """@return what is wrong, one line each; empty if the pictures agree."""
    if result.mean.shape != reference.mean.shape:
        return [f"size: got {result.mean.shape[:2]}, expected {reference.mean.shape[:2]}"]
    bad = impossible(result, "result") + impossible(reference, "reference")
    if bad:
        return bad
    # The reference knows the variance of one sample better than the result does.
    of_sample = reference.variance * reference.samples[..., None]
    variance = reference.variance + of_sample / result.samples[..., None]
    variance += half_rounding(reference.mean) + half_rounding(result.mean)
    difference = result.mean - reference.mean
    whole = difference.shape[:2]
    for shape, name in (((1, 1), "pixel"), ((8, 8), "block of 8 x 8 pixels"), (whole, "picture")):
        sums, pixels = blocks(difference, shape), blocks(np.ones((*whole, 1)), shape)
        p, (y, x, channel) = smallest_p(sums, blocks(variance, shape))
        if p < SIGNIFICANCE:
            bad.append(
                f"{name} at ({x * shape[1]}, {y * shape[0]}), {COLOURS[channel]}: got p = {p:.2g}, expected at least "
                f"{SIGNIFICANCE}; mean difference {sums[y, x, channel] / pixels[y, x, 0]:.3g}"
            )
    return bad


def compare_files(result_path, reference_path, folder):
    """@return as compare; where they differ, pictures to look at are left in `folder`."""
    result, reference = read(result_path), read(reference_path)
    bad = compare(result, reference)
    if bad:
        stem = pathlib.Path(folder) / pathlib.Path(result_path).stem
        write(f"{stem}.result.exr", result.mean)
        write(f"{stem}.reference.exr", reference.mean)
        write(f"{stem}.difference.exr", result.mean - reference.mean)
    return bad
