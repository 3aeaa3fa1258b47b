"""Motion vectors in the formats of the optical-flow benchmarks: pixels, u to the right, v down, row 0 at the top."""

import struct

import cv2
import numpy as np

UNKNOWN = 1e10
FORMATS = {"flo": ".flo", "kitti": ".png"}


def write_flo(path, flow, valid):
    """Middlebury: "PIEH", width, height (int32), u v (float32) row by row; over 1e9 is unknown."""
    height, width = valid.shape
    values = np.where(valid[..., None], flow, UNKNOWN).astype("<f4")
    path.write_bytes(b"PIEH" + struct.pack("<ii", width, height) + values.tobytes())


def write_kitti(path, flow, valid):
    """KITTI: 16-bit PNG, R = 64 u + 32768, G = 64 v + 32768, B = 1 where valid. Reaches +-512 px."""
    reached = valid & (np.abs(flow) < 511.9).all(axis=-1)
    values = np.where(reached[..., None], np.rint(64 * flow + 32768), 0).astype(np.uint16)
    # OpenCV writes blue first.
    cv2.imwrite(str(path), np.dstack([reached.astype(np.uint16), values[..., 1], values[..., 0]]))


def write(folder, name, frame, kind):
    """forward of a frame to folder/name.####"""
    flow = frame.motion("forward")
    valid = frame.fluid & np.isfinite(flow).all(axis=-1)
    path = folder / f"{name}.{frame.number:04}{FORMATS[kind]}"
    (write_flo if kind == "flo" else write_kitti)(path, flow, valid)
    return path
