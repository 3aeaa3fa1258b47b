"""Does the texture look like the exemplar?"""

import numpy as np

from evaluation import masks, sampling, windows
from evaluation.errors import NotComputed

COVER_TILES = 8
SPECTRUM_SIDE = 64
# Up to the finest that a pixel of the coarsest windows still carries.
SPECTRUM_BINS = np.arange(1, int(SPECTRUM_SIDE / (2 * windows.MAX_PIXEL_TEXELS)))
FLOOR_PICTURES = 8
SEAM_TEXELS, SEAM_SHARE = 0.5, 0.25


def floor_windows(exemplar, pixel_texels, side, count, rng):
    """Windows of pictures of the exemplar laid on a plane at random angles, read in the same way as those of a frame.
    @return N x side x side"""
    height, width = exemplar.luma.shape
    reach = side / 2 + 1
    found = []
    for _ in range(FLOOR_PICTURES):
        # The exemplar spans the picture's middle; a pixel is `pixel_texels` wide.
        angle, shift = rng.uniform(0, 2 * np.pi), rng.uniform(-0.5, 0.5, 2)
        pixels = int(np.ceil(np.hypot(width, height) / pixel_texels)) + 2
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, -s], [s, c]])
        raster = (sampling.pixel_raster(pixels, pixels) - (pixels - 1) / 2) * pixel_texels
        middle = np.array([width - 1, height - 1]) / 2 + shift
        picture = sampling.Cubic(sampling.Cubic(exemplar.luma)(raster @ turn.T + middle))
        # Centres in the exemplar, far enough from its border for any angle.
        radius = reach * np.sqrt(2)
        if min(width, height) <= 2 * radius:
            raise NotComputed(f"the exemplar of {width} x {height} texels is too small for windows of {side}")
        n = -(-count // FLOOR_PICTURES)
        centres = rng.uniform([radius, radius], [width - 1 - radius, height - 1 - radius], (n, 2))
        angles = rng.uniform(0, 2 * np.pi, n)
        steps = np.arange(side) - (side - 1) / 2
        x, y = np.meshgrid(steps, steps)
        ca, sa = np.cos(angles)[:, None, None], np.sin(angles)[:, None, None]
        in_plane = ((centres - middle) @ turn)[:, None, None] + np.stack([ca * x - sa * y, sa * x + ca * y], axis=-1)
        found.append(picture(in_plane / pixel_texels + (pixels - 1) / 2))
    return np.concatenate(found)[:count]


def cover(places, exemplar):
    """@param places  N x 2 texels, where the nearest windows lie
    @return entropy over 8 x 8 tiles of the exemplar / log 64, corrected for the number of samples [Miller 1955]"""
    if len(places) == 0:
        return None
    height, width = exemplar.luma.shape
    tiles = np.floor(places / [width, height] * COVER_TILES).clip(0, COVER_TILES - 1).astype(int)
    counts = np.bincount(tiles[:, 0] + COVER_TILES * tiles[:, 1])
    p = counts[counts > 0] / counts.sum()
    entropy = -(p * np.log(p)).sum() + (len(p) - 1) / (2 * counts.sum())
    return float(min(1.0, entropy / np.log(COVER_TILES**2)))


def power(cut):
    """@param cut  N x 64 x 64  @return len(SPECTRUM_BINS): mean radially averaged power, Hann window, mean removed"""
    hann = np.hanning(SPECTRUM_SIDE + 1)[:-1]
    hann = np.outer(hann, hann)
    mean = (cut * hann).sum((1, 2), keepdims=True) / hann.sum()
    spectra = (np.abs(np.fft.fft2((cut - mean) * hann)) ** 2).mean(0)
    f = np.fft.fftfreq(SPECTRUM_SIDE, 1 / SPECTRUM_SIDE)
    ring = np.rint(np.hypot(f[:, None], f[None, :])).astype(int)
    return np.array([spectra[ring == k].mean() for k in SPECTRUM_BINS])


def decibels(power):
    return 10 * np.log10(power + 1e-12)


def spectrum_difference(picture, exemplar):
    """@param picture, exemplar  powers  @return RMS difference in dB"""
    return float(np.sqrt(np.mean((decibels(picture) - decibels(exemplar)) ** 2)))


def contrast(frame, exemplar):
    where = masks.require_any(masks.covered(frame), "covered")
    if exemplar.sigma < 1e-6:
        raise NotComputed("the exemplar has no contrast to compare with")
    return float(frame.luma[where].std() / exemplar.sigma)


def holes(frame):
    """Pixels that see fluid without a texture."""
    return int((frame.fluid & (frame.plane("texture.s") < 0)).sum())


def distortion(frame, exemplar, texel_size_world):
    """Singular values s1 >= s2 of d(st)/d(P) against isometry, from the pixels to the left and right, above and below; not
    across seams, where the two sides' differences of st disagree.  @return {id: value}: of max(s1, 1 / s2)"""
    height, width = exemplar.luma.shape
    st = frame.vector("texture", "st") * [width, height]
    p = frame.vector("P").astype(float) / texel_size_world
    usable = masks.eroded(frame.fluid & (st[..., 0] >= 0), 1)[1:-1, 1:-1]
    if not usable.any():
        raise NotComputed("no pixel is textured with textured neighbours")
    here, p_here = st[1:-1, 1:-1], p[1:-1, 1:-1]
    spans, p_spans = [], []
    for before, after in ((np.s_[1:-1, :-2], np.s_[1:-1, 2:]), (np.s_[:-2, 1:-1], np.s_[2:, 1:-1])):
        ahead, behind = st[after] - here, here - st[before]
        size = np.maximum(np.linalg.norm(ahead, axis=-1), np.linalg.norm(behind, axis=-1))
        usable &= np.linalg.norm(ahead - behind, axis=-1) <= SEAM_TEXELS + SEAM_SHARE * size
        usable &= np.linalg.norm(p[after] - 2 * p_here + p[before], axis=-1) <= SEAM_TEXELS + SEAM_SHARE * np.linalg.norm(
            p[after] - p[before], axis=-1)
        spans.append(0.5 * (ahead + behind))
        p_spans.append(0.5 * (p[after] - p[before]))
    n = frame.vector("N")[1:-1, 1:-1][usable].astype(float)
    if len(n) == 0:
        raise NotComputed("no pixel has neighbours of one piece of texture")
    t, b = windows.tangents(n)
    on_surface = np.stack([np.stack([(d[usable] * a).sum(-1) for d in p_spans], -1) for a in (t, b)], -2)  # N x 2 x 2
    in_texture = np.stack([d[usable] for d in spans], -1)
    regular = np.abs(np.linalg.det(on_surface)) > 1e-9
    if not regular.any():
        raise NotComputed("P does not change from pixel to pixel")
    jacobian = in_texture[regular] @ np.linalg.inv(on_surface[regular])
    s = np.linalg.svd(jacobian, compute_uv=False)
    worst = np.maximum(s[:, 0], 1 / np.maximum(s[:, 1], 1e-3))
    return {"distortion_mean": float(worst.mean()), "distortion_p95": float(np.percentile(worst, 95))}
