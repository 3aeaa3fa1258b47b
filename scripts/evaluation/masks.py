"""Where a metric looks."""

import cv2
import numpy as np

from evaluation import sampling
from evaluation.errors import NotComputed

COVERED_MARGIN_PX = 8
ROUND_TRIP_PX = 0.5
LANDING_TEXELS = 2.0
LANDING_MARGIN_PX = 2  # the reach of interpolation
TEXTURED_SIDE_PX = 15
TEXTURED_SHARE = 0.25

DEFINITIONS = {
    "covered": f"texture.mask = 1 there and in the {COVERED_MARGIN_PX} px around, all channels finite",
    "matched": f"covered in f, fluid in f + 1 and the {LANDING_MARGIN_PX} px around, "
               f"|forward(x) + backward(x + forward(x))| < {ROUND_TRIP_PX} px, and P of f + 1 "
               f"at x + forward within {LANDING_TEXELS:g} texels of P + velocity / fps where the frames have P and velocity",
    "textured": f"standard deviation of luma in {TEXTURED_SIDE_PX} x {TEXTURED_SIDE_PX} px at least {TEXTURED_SHARE:.0%} of "
                "the exemplar's",
}


def eroded(mask, margin):
    """@return bool: the mask holds in the square of `margin` px around; beyond the border it holds"""
    if margin == 0:
        return mask
    return cv2.erode(mask.astype(np.uint8), np.ones((2 * margin + 1, 2 * margin + 1), np.uint8)) > 0


def covered(frame):
    return eroded(frame.fluid, COVERED_MARGIN_PX)


def landing(frame):
    """@return H x W x 2: column and row index of where the pixel's point is in the next frame"""
    return sampling.pixel_raster(frame.height, frame.width) + np.nan_to_num(frame.motion("forward"), posinf=0, neginf=0)


def matched(frame, following, texel_size_world, fps):
    """@return H x W bool, of `frame`  @throw NotComputed without motion vectors"""
    at = landing(frame)
    result = covered(frame) & sampling.inside(at, frame.height, frame.width, 1.0)
    result &= sampling.bilinear(eroded(following.fluid, LANDING_MARGIN_PX).astype(np.float32), at) > 0.999
    round_trip = frame.motion("forward") + sampling.bilinear(np.nan_to_num(following.motion("backward")), at)
    result &= np.linalg.norm(round_trip, axis=-1) < ROUND_TRIP_PX
    if frame.has("P.X", "velocity.X") and following.has("P.X") and texel_size_world and fps:
        expected = frame.vector("P") + frame.vector("velocity") / fps
        found = sampling.bilinear(np.nan_to_num(following.vector("P")), at)
        result &= np.linalg.norm(found - expected, axis=-1) < LANDING_TEXELS * texel_size_world
    return result


def textured(frame, exemplar_sigma):
    luma = np.nan_to_num(frame.luma)
    side = (TEXTURED_SIDE_PX, TEXTURED_SIDE_PX)
    mean = cv2.blur(luma.astype(np.float64), side, borderType=cv2.BORDER_REFLECT)
    square = cv2.blur(luma.astype(np.float64) ** 2, side, borderType=cv2.BORDER_REFLECT)
    return np.sqrt(np.maximum(square - mean**2, 0)) >= TEXTURED_SHARE * exemplar_sigma


def require_any(mask, what):
    if not mask.any():
        raise NotComputed(f"no pixel is {what}")
    return mask
