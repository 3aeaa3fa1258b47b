"""What the reports show of a frame: its layers, its motion and its errors as pictures, and the keys to their colours.

An `item` (frame_item.py) is {"frame": int, "beauty", "albedo": picture or None, "forward", "estimated": flow or None, "mask": H x W
bool, "warp": H x W luma change along the motion in sigma of the exemplar, NaN where unmatched, or None}. Pictures and
flows are described in drawing.py; estimated flow comes only with forward.
"""

import numpy as np

from evaluation import drawing
from evaluation.html_page import figure
from evaluation.terminal_table import number

FORWARD_COLOUR = (255, 255, 255)
ESTIMATED_COLOUR = (230, 0, 120)
ARROWS_CAPTION = "Motion, white: channel, magenta: estimated"
ARROWS_WIDTH = 640  # narrower pictures are enlarged to about this width to give arrows room
ARROWS_ACROSS = 29


def top_error(items):
    """One scale for the warp errors of all items: 99 % of the values; None without values."""
    values = [item["warp"][np.isfinite(item["warp"])] for item in items if item["warp"] is not None]
    values = np.concatenate(values) if values else np.zeros(0)
    return max(float(np.percentile(values, 99)), 1e-3) if values.size else None


def top_speed(items):
    """One scale for the motion of all items, in pixels per frame."""
    return drawing.top_speed([(item["forward"], item["mask"]) for item in items])


def legend(items):
    """HTML keys to the colours of motion and errors, for those of them the items have."""
    parts = ""
    if any(item["forward"] is not None for item in items):
        wheel = f'<img class="wheel" src="{drawing.data_uri(drawing.flow_wheel(192))}" alt="flow colour wheel">'
        text = (
            "Motion: the hue is the direction, as seen from the centre of the wheel; white is still, full colour is "
            "the speed beside the frame's number, darker is faster."
        )
        parts += figure(wheel, text)
    top = top_error(items)
    if top is not None:
        ramp = np.tile(np.linspace(0, 1, 160), (14, 1))
        bar = f'<img class="bar" src="{drawing.data_uri(drawing.heat(ramp, 1))}" alt="warp error colours">'
        text = f"Warp error: 0 to {number(top)} sigma of the exemplar and more; grey where nothing is matched."
        parts += figure(bar, text)
    return f'<div class="legend">{parts}</div>' if parts else ""


def heading(frame, items):
    """HTML heading of the frame's pictures with the scale of their motion; items: those of the frame."""
    moving = any(item["forward"] is not None for item in items)
    speed = f" <small>full colour: {number(top_speed(items))} px per frame</small>" if moving else ""
    return f"<h3>Frame {frame}{speed}</h3>\n"


def arrows(item, max_px):
    """Arrows of the motion over the albedo, else the beauty; None without motion or picture.

    max_px: speed in pixels per frame whose arrow is a little longer than the raster's step.
    """
    back = item["beauty"] if item["albedo"] is None else item["albedo"]
    if item["forward"] is None or back is None:
        return None
    factor = max(1, min(ARROWS_WIDTH // back.shape[1], 2 * ARROWS_WIDTH // back.shape[0]))
    flows = [("forward", FORWARD_COLOUR), ("estimated", ESTIMATED_COLOUR)]
    flows = [(drawing.enlarged(item[key], factor), colour) for key, colour in flows if item[key] is not None]
    step = max(16, back.shape[1] * factor // ARROWS_ACROSS)
    mask = drawing.enlarged(item["mask"], factor)
    return drawing.flow_arrows(drawing.enlarged(back, factor), flows, step, 1.3 * step / max_px, mask)


def pictures(item, max_px, top):
    """Dict of caption -> picture for what there is of one frame, in the order it is shown.

    max_px: speed of full colour, pixels per frame; top: warp error of the brightest colour, None without errors.
    """
    drawn = {"Beauty": item["beauty"], "Albedo": item["albedo"]}
    for key, caption in (("forward", "Motion channel"), ("estimated", "Motion estimated from the texture")):
        drawn[caption] = None if item[key] is None else drawing.flow_colours(item[key], max_px, item["mask"])
    drawn["Warp error"] = None if item["warp"] is None or top is None else drawing.heat(item["warp"], top)
    drawn[ARROWS_CAPTION] = arrows(item, max_px)
    return {caption: picture for caption, picture in drawn.items() if picture is not None}
