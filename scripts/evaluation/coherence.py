"""Does the texture ride on the fluid?"""

import numpy as np

from evaluation import masks, sampling
from evaluation.errors import NotComputed

STILL_PX = 0.05
POPPING_SIGMA = 0.5


def warp_difference(frame, following, exemplar_sigma):
    """@return H x W: |luma of f + 1 at x + forward - luma of f at x| / sigma(exemplar), by cubic interpolation"""
    if exemplar_sigma < 1e-6:
        raise NotComputed("the exemplar has no contrast to measure by")
    return np.abs(sampling.Cubic(following.luma)(masks.landing(frame)) - frame.luma) / exemplar_sigma


def compare(difference, frame, matched):
    """@return {id: value}"""
    where = masks.require_any(matched, "matched")
    values = difference[where]
    return {"warp_error": float(values.mean()), "warp_error_p99": float(np.percentile(values, 99)),
            "popping": float((values > POPPING_SIGMA).mean())}


def still(difference, frame, matched):
    where = matched & (np.linalg.norm(frame.motion("forward"), axis=-1) < STILL_PX)
    masks.require_any(where, f"matched and moves less than {STILL_PX} px")
    return {"still_change": float(difference[where].mean())}
