"""Do the motion vectors agree with velocity and camera?"""

import numpy as np

from evaluation import masks, sampling


def _moved(frame, p, after, arrived):
    """@param after  the frame whose camera sees the points when they have arrived
    @return H x W x 2: columns and rows from where `frame` sees p to where `after` sees `arrived`"""
    return after.project(arrived)[..., :2] - frame.project(p)[..., :2]


def check(frame, fps, after=None):
    """forward against project(P + velocity / fps) - project(P).
    @param after  the next frame, for its camera; without it the camera rests  @return {id: value}, pixels"""
    where = masks.require_any(frame.fluid, "fluid")
    p, v = frame.vector("P"), frame.vector("velocity")
    wanted = _moved(frame, p, after or frame, p + v / fps)
    difference = np.linalg.norm(frame.motion("forward") - wanted, axis=-1)[where]
    return {"motion_check_median": float(np.median(difference)), "motion_check_p99": float(np.percentile(difference, 99))}


def check_second_order(frame, following, matched, fps):
    """The same with the mean of the velocity at both ends of the step, read from the next frame: what remains is not the
    first-order check's own error.  @return {id: value}, pixels"""
    where = masks.require_any(matched, "matched")
    p, v = frame.vector("P"), frame.vector("velocity")
    arriving = sampling.bilinear(np.nan_to_num(following.vector("velocity")), masks.landing(frame))
    wanted = _moved(frame, p, following, p + 0.5 * (v + arriving) / fps)
    difference = np.linalg.norm(frame.motion("forward") - wanted, axis=-1)[where]
    return {"motion_second_order_median": float(np.median(difference)),
            "motion_second_order_p99": float(np.percentile(difference, 99))}


def exact_position(p, fluid):
    """Where points of a procedural fluid are one frame later, where a closed form exists.
    @param p  ... x 3 world  @param fluid  table [fluid] of the shot, with fps  @return ... x 3 or None"""
    if fluid.get("source") != "procedural":
        return None
    scene = fluid.get("scene", "vortex_sphere")
    speed, fps = fluid.get("speed", 1.0), fluid["fps"]
    if scene == "static_sphere":
        return p
    if scene == "translation":
        return p + np.array(fluid.get("shift", [0.02, 0.01, 0.0]))
    if scene == "shear":
        return p + np.stack([speed * p[..., 1], np.zeros_like(p[..., 0]), np.zeros_like(p[..., 0])], axis=-1) / fps
    if scene == "rigid_rotation":
        c, s = np.cos(speed / fps), np.sin(speed / fps)
        return np.stack([c * p[..., 0] - s * p[..., 1], s * p[..., 0] + c * p[..., 1], p[..., 2]], axis=-1)
    return None


def check_exact(frame, fluid, after=None):
    """forward against the exact path; `after` as in check.  @return {id: value}, pixels; empty where there is no closed form"""
    p = frame.vector("P").astype(float)
    arrived = exact_position(p, fluid)
    if arrived is None:
        return {}
    where = masks.require_any(frame.fluid, "fluid")
    wanted = _moved(frame, p, after or frame, arrived)
    difference = np.linalg.norm(frame.motion("forward") - wanted, axis=-1)[where]
    return {"motion_exact_median": float(np.median(difference)), "motion_exact_p99": float(np.percentile(difference, 99))}
