"""What is kept of a frame for the reports (frame_pictures.py draws it), small enough to pass between processes."""

import math

import numpy as np

from evaluation import frames

PICTURE_WIDTH = 960


def item_of(frame, estimated=None, difference=None):
    """Every n-th pixel, so that the picture is at most PICTURE_WIDTH wide. Motion stays in pixels of the frame.
    @param estimated  H x W x 2 optical flow or None  @param difference  H x W warp error or None"""
    stride = max(1, math.ceil(frame.width / PICTURE_WIDTH))
    small = np.s_[::stride, ::stride]

    def colours(layer, names="RGB"):
        channels = [f"{layer}.{c}" if layer else c for c in names]
        if not frame.has(*channels):
            return None
        linear = np.nan_to_num(np.stack([frame.planes[c] for c in channels], axis=-1))[small]
        return np.rint(255 * frames.encoded(linear)).astype(np.uint8)

    return {
        "frame": frame.number,
        "beauty": colours(""),
        "albedo": colours("albedo"),
        "forward": np.nan_to_num(frame.motion("forward"))[small] if frame.has("forward.u", "forward.v") else None,
        "estimated": None if estimated is None else estimated[small],
        "mask": (frame.fluid if frame.has("texture.mask") else np.ones((frame.height, frame.width), bool))[small],
        "warp": None if difference is None else difference[small],
    }
