"""Reads pictures between their pixels."""

import numpy as np
from scipy import ndimage


def pixel_raster(height, width):
    """@return H x W x 2: column and row index of every pixel"""
    rows, columns = np.mgrid[0:height, 0:width]
    return np.stack([columns, rows], axis=-1).astype(np.float32)


def bilinear(plane, at):
    """@param plane  H x W or H x W x C  @param at  ... x 2: column, row as indices (centres at whole numbers)
    @return ... or ... x C; clamped to the border"""
    if plane.ndim == 3:
        return np.stack([bilinear(plane[..., c], at) for c in range(plane.shape[2])], axis=-1)
    return ndimage.map_coordinates(plane, [at[..., 1], at[..., 0]], order=1, mode="nearest")


class Cubic:
    """Interpolation by cubic splines. Where the picture is not finite it is taken as 0."""

    def __init__(self, plane):
        self._coefficients = ndimage.spline_filter(np.nan_to_num(plane, posinf=0, neginf=0), order=3, mode="mirror",
                                                   output=np.float32)

    def __call__(self, at):
        """@param at  ... x 2: column, row as indices  @return ... float32"""
        return ndimage.map_coordinates(self._coefficients, [at[..., 1], at[..., 0]], order=3, mode="mirror",
                                       prefilter=False)


def inside(at, height, width, margin=0.0):
    """@return bool: at least `margin` pixels within the outermost pixel centres"""
    x, y = at[..., 0], at[..., 1]
    return (x >= margin) & (y >= margin) & (x <= width - 1 - margin) & (y <= height - 1 - margin)
