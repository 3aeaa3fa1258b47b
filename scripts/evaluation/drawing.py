"""Pictures of flows and errors. A picture is H x W x 3 uint8, sRGB, in RGB order.

A flow is H x W x 2 in pixels per frame, u right, v down; a mask is H x W, true where there is fluid, None for all.
"""
import base64

import cv2
import matplotlib
import numpy as np

NOTHING = (56, 56, 56)  # pixels that have no value

# The Middlebury colour wheel [Baker 2011]: hues between red, yellow, green, cyan, blue, magenta and red again, with as
# many steps in each as the eye tells apart.
WHEEL_STEPS = (15, 6, 4, 11, 13, 6)
WHEEL_CORNERS = ((1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 1, 1), (0, 0, 1), (1, 0, 1), (1, 0, 0))


def colour_wheel():
    """55 x 3 colours in 0..1, from motion to the right (red) over down (yellow) clockwise as seen on the screen."""
    corners = np.array(WHEEL_CORNERS, float)
    return np.concatenate(
        [
            corners[i] + (corners[i + 1] - corners[i]) * np.arange(steps)[:, None] / steps
            for i, steps in enumerate(WHEEL_STEPS)
        ]
    )


def flow_colours(flow, max_px, mask=None):
    """Motion on the Middlebury wheel: hue is the direction, saturation grows from white (still) to full at `max_px`.

    Faster pixels are darkened to 3/4; outside the mask and where the flow is not finite it is dark grey.
    """
    flow = np.asarray(flow, float)
    valid = np.isfinite(flow).all(-1)
    if mask is not None:
        valid &= np.asarray(mask, bool)
    u, v = np.where(valid[..., None], flow, 0).transpose(2, 0, 1)
    wheel = colour_wheel()
    place = np.mod(np.arctan2(v, u) / (2 * np.pi), 1) * len(wheel)
    low = place.astype(int)
    part = (place - low)[..., None]
    hue = (1 - part) * wheel[low % len(wheel)] + part * wheel[(low + 1) % len(wheel)]
    speed = (np.hypot(u, v) / max(max_px, 1e-9))[..., None]
    colour = np.where(speed <= 1, 1 - np.minimum(speed, 1) * (1 - hue), 0.75 * hue)
    return np.where(valid[..., None], np.rint(255 * colour), NOTHING).astype(np.uint8)


def flow_wheel(size):
    """Legend of flow_colours: the colour of each motion from the centre, `max_px` at the rim; size x size."""
    axis = (np.arange(size) + 0.5) * 2 / size - 1
    flow = np.stack(np.meshgrid(axis, axis), -1)
    return flow_colours(flow, 1, np.hypot(flow[..., 0], flow[..., 1]) <= 1)


def top_speed(flows_and_masks, least=0.1):
    """99 % of the speed over all (flow, mask) pairs, in pixels per frame, at least `least`. A flow may be None."""
    speeds = [np.zeros(0)]
    for flow, mask in flows_and_masks:
        if flow is not None:
            speed = np.hypot(flow[..., 0], flow[..., 1])
            inside = np.isfinite(speed) if mask is None else np.isfinite(speed) & np.asarray(mask, bool)
            speeds.append(speed[inside])
    speeds = np.concatenate(speeds)
    return max(float(np.percentile(speeds, 99)), least) if speeds.size else least


def flow_arrows(picture, flows, step_px, scale, mask=None):
    """Arrows on the dimmed picture, from a raster every `step_px` pixels to where `scale` times the motion leads.

    flows: list of (flow, (r, g, b) in 0..255). Later ones are thinner, so that an earlier one shows under them where
    they agree. No motion is a dot.
    """
    canvas = (np.asarray(picture) * 0.45).astype(np.uint8)
    height, width = canvas.shape[:2]
    step_px = max(int(step_px), 1)
    rows = np.arange(min(step_px // 2, height - 1), height, step_px)
    columns = np.arange(min(step_px // 2, width - 1), width, step_px)
    for order, (flow, colour) in enumerate(flows):
        thickness = max(len(flows) - order, 1)
        for row in rows:
            for column in columns:
                if (mask is None or mask[row, column]) and np.isfinite(flow[row, column]).all():
                    draw_arrow(canvas, (column, row), scale * flow[row, column].astype(float), colour, thickness)
    return canvas


def draw_arrow(canvas, start, along, colour, thickness):
    """One antialiased arrow in place; start (x, y) and along (dx, dy) in pixels."""
    bits = 4  # fractional bits of OpenCV's fixed-point coordinates
    length = float(np.hypot(*along))
    # Clamped so that fixed-point coordinates cannot overflow.
    along = np.asarray(along) * min(1, 4096 / max(length, 1e-9))

    def fixed(point):
        return tuple(int(round(float(c) * 2**bits)) for c in point)

    if length < 0.75:
        cv2.circle(canvas, fixed(start), thickness * 2 ** (bits - 1), colour, -1, cv2.LINE_AA, bits)
        return
    end = np.add(start, along)
    cv2.line(canvas, fixed(start), fixed(end), colour, thickness, cv2.LINE_AA, bits)
    back = -along / np.hypot(*along) * min(0.4 * length, 4 + 2 * thickness)
    for side in (-0.6, 0.6):
        barb = end + back + side * np.array([-back[1], back[0]])
        cv2.line(canvas, fixed(end), fixed(barb), colour, thickness, cv2.LINE_AA, bits)


def heat(values, top):
    """H x W values from 0 (dark violet) to `top` and more (yellow), perceptually even; dark grey where not finite."""
    values = np.asarray(values, float)
    valid = np.isfinite(values)
    table = matplotlib.colormaps["viridis"](np.arange(256), bytes=True)[:, :3]
    level = np.clip(np.where(valid, values, 0) / max(top, 1e-12), 0, 1)
    return np.where(valid[..., None], table[np.rint(255 * level).astype(int)], NOTHING).astype(np.uint8)


def png_bytes(rgb):
    """The picture as a PNG file."""
    done, data = cv2.imencode(".png", np.ascontiguousarray(rgb[..., ::-1]), [cv2.IMWRITE_PNG_COMPRESSION, 7])
    if not done:
        raise ValueError(f"a picture of shape {rgb.shape} cannot be written as PNG")
    return data.tobytes()


def data_uri(rgb):
    """The picture as the address of an HTML image that needs no file."""
    return "data:image/png;base64," + base64.b64encode(png_bytes(rgb)).decode()


def enlarged(rgb, factor):
    """Every pixel as factor x factor pixels; for arrays of any number of channels."""
    return np.repeat(np.repeat(rgb, factor, 0), factor, 1)


def thumbnail(rgb, width):
    """The picture at most `width` pixels wide, averaged down."""
    height_now, width_now = rgb.shape[:2]
    if width_now <= width:
        return rgb
    size = (width, max(1, round(height_now * width / width_now)))
    return cv2.resize(np.ascontiguousarray(rgb), size, interpolation=cv2.INTER_AREA)
