"""Does the picture move as the motion vectors say? Optical flow of the texture against forward.u/v."""

import cv2
import numpy as np

from evaluation import masks, sampling
from evaluation.errors import NotComputed

ESTIMATORS = ("dis", "farneback")
MIN_SIDE_PX = 16


def _bytes(luma):
    return np.clip(np.rint(255 * np.nan_to_num(luma)), 0, 255).astype(np.uint8)


def estimate(luma, following, estimator="dis"):
    """@param luma, following  H x W, 0 to 1  @return H x W x 2 pixels, columns right and rows down"""
    height, width = luma.shape
    if min(height, width) < MIN_SIDE_PX:
        raise NotComputed(f"frames of {width} x {height} px; optical flow needs {MIN_SIDE_PX} x {MIN_SIDE_PX}")
    if estimator == "farneback":
        return cv2.calcOpticalFlowFarneback(_bytes(luma), _bytes(following), None, 0.5, 5, 15, 5, 7, 1.5, 0)
    dis = cv2.DISOpticalFlow_create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
    dis.setFinestScale(0)
    dis.setPatchStride(1)
    dis.setVariationalRefinementIterations(5)
    return dis.calc(_bytes(luma), _bytes(following), None)


def errors(estimated, expected):
    """@param estimated, expected  N x 2 pixels
    @return end-point error: mean, median; mean angle between (u, v, 1) in degrees; share with an error over 3 px and over 5 %"""
    epe = np.linalg.norm(estimated - expected, axis=-1)
    size = np.linalg.norm(expected, axis=-1)
    a = np.concatenate([estimated, np.ones_like(epe)[:, None]], axis=-1).astype(float)
    b = np.concatenate([expected, np.ones_like(epe)[:, None]], axis=-1).astype(float)
    cosine = (a * b).sum(-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
    return {
        "epe": float(epe.mean()),
        "epe_median": float(np.median(epe)),
        "angle_deg": float(np.degrees(np.arccos(np.clip(cosine, -1, 1))).mean()),
        "fl": float(((epe > 3) & (epe > 0.05 * size)).mean()),
    }


def carried(frame, following):
    """Luma of `frame` moved exactly as the motion vectors of `following` say; where there is none, that of `following`.
    @return H x W"""
    from_where = sampling.pixel_raster(frame.height, frame.width) + np.nan_to_num(following.motion("backward"))
    moved = sampling.Cubic(frame.luma)(from_where)
    known = following.fluid & sampling.inside(from_where, frame.height, frame.width)
    return np.where(known, moved, following.luma)


def compare(frame, following, matched, exemplar_sigma, estimator="dis"):
    """@return {id: value} and the estimated H x W x 2"""
    where = masks.require_any(matched & masks.textured(frame, exemplar_sigma), "matched and textured")
    expected = frame.motion("forward")
    estimated = estimate(frame.luma, following.luma, estimator)
    measured = errors(estimated[where], expected[where])
    floor = errors(estimate(frame.luma, carried(frame, following), estimator)[where], expected[where])
    return {
        "flow_epe": measured["epe"],
        "flow_epe_median": measured["epe_median"],
        "flow_angle_deg": measured["angle_deg"],
        "flow_fl": measured["fl"],
        "flow_floor": floor["epe"],
        "flow_excess": measured["epe"] - floor["epe"],
    }, estimated
