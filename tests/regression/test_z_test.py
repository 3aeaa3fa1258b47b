#!/usr/bin/python3
"""The z-test accepts noise, sees a pixel, a block and a picture that are wrong, and refuses values it cannot judge."""

import sys

import numpy as np
import z_test

SIZE, REFERENCE_SPP, SPP = (54, 96), 4096, 128


def noisy(truth, spp, seed):
    """Exponentially distributed samples: as skewed as the light of a path tracer."""
    random = np.random.default_rng(seed)
    samples = random.gamma(spp, truth / spp)  # the mean of spp exponential ones
    count = np.full(truth.shape[:2], float(spp))
    return z_test.Picture(samples, truth**2 / spp, count)


def main():
    y, x = np.mgrid[0 : SIZE[0], 0 : SIZE[1]]
    truth = (0.05 + 0.9 * (x + y) / (SIZE[0] + SIZE[1]))[..., None] * np.array([1.0, 0.7, 0.4])
    reference = noisy(truth, REFERENCE_SPP, 1)
    for seed in range(2, 22):
        bad = z_test.compare(noisy(truth, SPP, seed), reference)
        if bad:
            sys.exit(f"seed {seed}: the same scene was refused: {bad}")
    dead = noisy(truth, SPP, 3)
    dead.mean[20, 30] = 0.0
    dark = noisy(truth, SPP, 4)
    dark.mean[16:24, 40:48] *= 0.9
    corner = noisy(truth, SPP, 7)
    corner.mean[48:, 88:] *= 0.8  # 6 rows only: the height is no multiple of 8
    bright = noisy(truth, SPP, 5)
    bright.mean *= 1.01
    right = noisy(truth, SPP, 8)
    right.mean[:, SIZE[0] :] *= 1.02  # beyond the largest square from the upper left corner
    for name, picture in (("pixel", dead), ("block", dark), ("block", corner), ("picture", bright), ("picture", right)):
        bad = z_test.compare(picture, reference)
        if not any(line.startswith(name) for line in bad):
            sys.exit(f"a wrong {name} was not seen: {bad}")
    for plane, value in (("mean", np.nan), ("mean", -np.inf), ("variance", np.nan), ("variance", np.inf), ("variance", -1e-6),
                         ("samples", 0.0), ("samples", np.nan)):
        for name, at in (("result", 0), ("reference", 1)):
            pictures = [noisy(truth, SPP, 6), noisy(truth, REFERENCE_SPP, 1)]
            getattr(pictures[at], plane)[20, 30] = value
            bad = z_test.compare(*pictures)
            if not (len(bad) == 1 and bad[0].startswith(name) and plane in bad[0] and "(30, 20)" in bad[0]):
                sys.exit(f"{plane} {value} of the {name}: got {bad}, expected one line that says so")
    print("ok")


main()
