"""Windows of the texture in the tangent plane of the surface a picture shows, at the exemplar's density.

A window is a raster, one exemplar texel apart, in the tangent plane of a pixel, turned by a random angle; it is read from the
picture by projection with the header's camera. Its centre is a pixel whose surface faces the camera and of which one pixel is
at most 1.25 texels long on the surface. Every sample lies on fluid, and the surface seen there is within 2 texels (times side
/ 21 for larger windows) of the tangent plane: where the surface bends more, or another is in front, there is no window.
"""

import dataclasses

import numpy as np

from evaluation import masks, sampling

MAX_PIXEL_TEXELS = 1.25
BEND_TEXELS = 2.0
BEND_SIDE = 21
TRIES = 12  # candidates per window wanted


@dataclasses.dataclass
class Windows:
    values: np.ndarray  # N x side x side luma, 0 to 1
    pixel_texels: np.ndarray  # N: the longest extent of the centre's pixel on the surface, in texels

    def __len__(self):
        return len(self.values)

    def mirrored(self):
        return Windows(self.values[:, :, ::-1], self.pixel_texels)


def empty(side):
    return Windows(np.zeros((0, side, side), np.float32), np.zeros(0))


def tangents(normals):
    """@param normals  ... x 3, unit  @return two unit vectors that complete them to right-handed frames"""
    x, y, z = np.moveaxis(normals, -1, 0)
    sign = np.where(z >= 0, 1.0, -1.0)
    a = -1.0 / (sign + z)
    b = x * y * a
    return np.stack([1 + sign * x * x * a, sign * b, -sign * x], -1), np.stack([b, sign + y * y * a, -y], -1)


def pixel_texels(frame, texel_size_world):
    """@return H x W: the longest extent of a pixel on the surface, in texels; infinite off the fluid and seen from behind"""
    p, n = np.nan_to_num(frame.vector("P")).astype(float), np.nan_to_num(frame.vector("N")).astype(float)
    t, b = tangents(n)
    here = frame.project(p)
    column = (frame.project(p + texel_size_world * t) - here)[..., :2]
    row = (frame.project(p + texel_size_world * b) - here)[..., :2]
    # The smaller singular value of the 2 x 2 matrix of both.
    with np.errstate(all="ignore"):
        half = 0.5 * ((column**2).sum(-1) + (row**2).sum(-1))
        determinant = column[..., 0] * row[..., 1] - column[..., 1] * row[..., 0]
        smaller = np.sqrt(np.maximum(half - np.sqrt(np.maximum(half**2 - determinant**2, 0)), 0))
        faces = frame.project(p + texel_size_world * n)[..., 2] < here[..., 2]
        usable = frame.fluid & faces & (np.linalg.norm(n, axis=-1) > 0.5) & (smaller > 0)
        return np.where(usable, 1.0 / smaller, np.inf)


def cut(frame, texel_size_world, side, count, rng):
    """@param side  samples a side  @param count  windows wanted; there may be fewer  @return Windows"""
    extents = pixel_texels(frame, texel_size_world)
    rows, columns = np.nonzero(extents <= MAX_PIXEL_TEXELS)
    if len(rows) == 0:
        return empty(side)
    positions = np.nan_to_num(frame.vector("P")).astype(float)
    readable = masks.eroded(frame.fluid, 2)
    luma = sampling.Cubic(frame.luma)
    bend = BEND_TEXELS * max(1.0, side / BEND_SIDE) * texel_size_world
    steps = (np.arange(side) - (side - 1) / 2) * texel_size_world

    kept, extents_kept, wanted = [], [], count
    for _ in range(TRIES):
        chosen = rng.integers(len(rows), size=wanted)
        r, c = rows[chosen], columns[chosen]
        p, n = positions[r, c], frame.vector("N")[r, c].astype(float)
        t, b = tangents(n)
        angle = rng.uniform(0, 2 * np.pi, size=(wanted, 1))
        across = np.cos(angle) * t + np.sin(angle) * b
        down = np.sin(angle) * t - np.cos(angle) * b  # normal towards the eye, `across` to the right
        points = (p[:, None, None] + steps[None, None, :, None] * across[:, None, None]
                  + steps[None, :, None, None] * down[:, None, None])
        at = frame.project(points)[..., :2] - 0.5
        within = sampling.inside(at, frame.height, frame.width, 1.0)
        near = np.rint(np.where(within[..., None], at, 0)).astype(int)
        seen = within & readable[near[..., 1], near[..., 0]]
        seen &= np.linalg.norm(positions[near[..., 1], near[..., 0]] - points, axis=-1) <= bend
        good = seen.all(axis=(1, 2))
        if good.any():
            kept.append(luma(at[good]))
            extents_kept.append(extents[r[good], c[good]])
        wanted = count - sum(map(len, kept))
        if wanted <= 0:
            break
    if not kept:
        return empty(side)
    return Windows(np.concatenate(kept)[:count], np.concatenate(extents_kept)[:count])
