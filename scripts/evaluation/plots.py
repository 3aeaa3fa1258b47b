"""Plots of results as HTML figures with inline SVG, in the colours of the page whether it is light or dark.

`result` is described in terminal_table.py. A plot without anything to show is empty text.
"""

import dataclasses
import io
import math
import re

import matplotlib
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from evaluation.html_page import escaped, figure
from evaluation.terminal_table import bounds, is_number, label, series, summary_value

# Stand-ins that become colours of the page once a plot is SVG.
INK, RULE, GOOD = "#010203", "#040506", "#070809"
PAGE_COLOURS = {INK: "currentColor", RULE: "var(--rule)", GOOD: "var(--good)"}
# Readable on white and on near-black; each with its own mark, so that colour is not the only difference.
LINE_COLOURS = ("#2f80d0", "#d9701a", "#1f9a6a", "#b755a0", "#a98600", "#6f6fd8", "#c8484f", "#7f8a8f")
MARKS = "osD^vPX*"
# Later lines have gaps, which show an equal earlier one beneath.
DASHES = ("-", (0, (5, 2)), (0, (2, 2)), (0, (7, 2, 1, 2)))
MARKED_FRAMES = 12  # lines of at most as many frames have a mark at each


@dataclasses.dataclass(frozen=True)
class Curve:
    """A plot over the frames; in a comparison only the first metric is shown."""

    title: str
    metrics: tuple
    unit: str = ""
    from_zero: bool = True


CURVES = (
    Curve("Energy ratio", ("energy_ratio",), from_zero=False),
    Curve("Contrast", ("contrast",), from_zero=False),
    Curve("Warp error", ("warp_error", "warp_error_p99"), "sigma of the exemplar"),
    Curve("Flow error", ("flow_epe", "flow_floor"), "px"),
    Curve("Distortion", ("distortion_mean", "distortion_p95"), "1 = isometry", from_zero=False),
    Curve("Holes", ("holes", "not_finite"), "px"),
    Curve("Spectrum", ("spectrum_db",), "dB"),
    Curve("Cover", ("cover",), from_zero=False),
    Curve("Popping", ("popping",)),
    Curve("Change where still", ("still_change",)),
    Curve("Motion against the velocity", ("motion_check_median", "motion_check_p99"), "px"),
    Curve("Motion against the path", ("motion_second_order_median", "motion_second_order_p99"), "px"),
    Curve("Motion against the exact path", ("motion_exact_median", "motion_exact_p99"), "px"),
)


def look(index):
    """Colour and mark of the index-th line."""
    return LINE_COLOURS[index % len(LINE_COLOURS)], MARKS[index % len(MARKS)]


def new_axes(width, height):
    """A pair of axes in a figure of its own; size in inches of 72 CSS pixels."""
    plot = Figure(figsize=(width, height), layout="constrained")
    axes = plot.add_subplot()
    plot.patch.set_visible(False)
    axes.patch.set_visible(False)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(RULE)
    axes.tick_params(color=RULE, labelcolor=INK, labelsize=9, length=0)
    axes.grid(color=RULE, linewidth=0.6)
    axes.set_axisbelow(True)
    return axes


def name_axes(axes, x, y=""):
    axes.set_xlabel(x, fontsize=9, color=INK)
    axes.set_ylabel(y, fontsize=9, color=INK)


def legend_above(axes):
    """A legend above the axes, where there is more than one thing to tell apart."""
    names = axes.get_legend_handles_labels()[1]
    if len(names) > 1:
        place = {"loc": "lower left", "bbox_to_anchor": (0, 1), "borderaxespad": 0.2, "ncol": min(4, len(names))}
        axes.legend(frameon=False, labelcolor=INK, fontsize=9, handlelength=1.8, columnspacing=1.2, **place)


def shade_good(axes, metric):
    """Shades the good range of the metric, keeping the vertical limits; false where it has none or a single value."""
    low, high = bounds(metric)
    if low == high or not (math.isfinite(low) or math.isfinite(high)):
        return False
    limits = axes.get_ylim()
    axes.axhspan(max(low, limits[0]), min(high, limits[1]), color=GOOD, alpha=0.15, linewidth=0)
    axes.set_ylim(limits)
    return True


def svg(axes, alt):
    """Inline SVG; `alt` says what is shown and differs between the plots of a page, whose identifiers share a space."""
    out = io.StringIO()
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": alt}):
        FigureCanvasSVG(axes.figure).print_svg(out, metadata={"Date": None})
    text = out.getvalue()
    view = re.search(r'viewBox="[^"]*"', text)[0]
    text = text[text.index(">", text.index("<svg")) + 1 :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.S)
    used = set(re.findall(r'(?:url\(|href=")#([^")]+)', text))
    text = re.sub(r' id="([^"]*)"', lambda match: match[0] if match[1] in used else "", text)
    for stand_in, colour in PAGE_COLOURS.items():
        text = text.replace(stand_in, colour)
    return f'<svg {view} role="img" aria-label="{escaped(alt)}">' + text.replace("xlink:href", "href")


def value_limits(curve, values):
    """(lowest, highest) of the vertical axis: the values and the ends of the good range, with some room."""
    seen = [*values, *(end for end in bounds(curve.metrics[0]) if math.isfinite(end)), *[0] * curve.from_zero]
    low, high = min(seen), max(seen)
    room = (high - low or abs(high) or 1) * 0.06
    return low if curve.from_zero and low == 0 else low - room, high + room


def curve_plot(curve, lines, frames):
    """lines: list of (name, frames, values); frames: (first, last) of the axis. Empty where all values are 0."""
    values = [value for line in lines for value in line[2]]
    if not any(values):
        return ""
    axes = new_axes(5, 2.6)
    for index, (name, at, line) in enumerate(lines):
        colour, mark = look(index)
        style = {"marker": mark, "markersize": 4} if len(at) <= MARKED_FRAMES else {}
        axes.plot(at, line, linestyle=DASHES[index % len(DASHES)], color=colour, linewidth=1.6, label=name, **style)
    room = 0.02 * (frames[1] - frames[0]) or 0.5
    axes.set_xlim(frames[0] - room, frames[1] + room)
    axes.set_ylim(value_limits(curve, values))
    shaded = shade_good(axes, curve.metrics[0])
    axes.xaxis.set_major_locator(MaxNLocator(8, integer=True, min_n_ticks=1))
    axes.yaxis.set_major_locator(MaxNLocator(5))
    name_axes(axes, "frame")
    legend_above(axes)
    caption = curve.title + f" ({curve.unit})" * bool(curve.unit)
    if shaded:
        caption += f", good {curve.metrics[0]} shaded"
    return figure(svg(axes, f"{curve.title} per frame"), caption)


def curves(results):
    """Plots over the frames: of several results the first metric of each curve, of one result all."""
    numbers = [frame["frame"] for result in results for frame in result["frames"]]
    plots = ""
    for curve in CURVES:
        if len(results) == 1:
            lines = [(metric, *series(results[0], metric)) for metric in curve.metrics]
        else:
            lines = [(label(result), *series(result, curve.metrics[0])) for result in results]
        plots += curve_plot(curve, lines, (min(numbers), max(numbers)))
    return f'<div class="plots">{plots}</div>'


def spectrum(results):
    """Power of each result's frames and of the exemplar (dashed) over spatial frequency."""
    axes = new_axes(5.5, 2.8)
    with_spectrum = [(index, result) for index, result in enumerate(results) if result["spectrum"]]
    if not with_spectrum:
        return ""
    for index, result in with_spectrum:
        lines = result["spectrum"]
        name = "frames" if len(results) == 1 else label(result)
        axes.plot(lines["cycles_per_texel"], lines["picture_db"], color=look(index)[0], linewidth=1.6, label=name)
    lines = with_spectrum[0][1]["spectrum"]
    axes.plot(lines["cycles_per_texel"], lines["exemplar_db"], "--", color=INK, linewidth=1.4, label="exemplar")
    name_axes(axes, "cycles per texel", "power (dB)")
    legend_above(axes)
    caption = "Radially averaged power spectrum of luma. Below the exemplar detail is missing, above it is foreign."
    return f'<div class="wide">{figure(svg(axes, "power spectrum"), caption)}</div>'


def energy_against_warp(results):
    """Energy ratio against warp error: a mark per method, a thin trail of its frames."""
    axes = new_axes(5.5, 3.6)
    for index, result in enumerate(results):
        colour, mark = look(index)
        warp, energy = summary_value(result, "warp_error"), summary_value(result, "energy_ratio")
        if is_number(warp) and is_number(energy):
            trail = [(frame["warp_error"], frame["energy_ratio"]) for frame in result["frames"]]
            trail = [pair for pair in trail if None not in pair]
            axes.plot(*zip(*trail), color=colour, linewidth=1, alpha=0.5)
            axes.plot([warp], [energy], mark, color=colour, markersize=9, label=label(result))
    if not axes.lines:
        return ""
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, 0.98), max(high, 1.34))
    axes.set_xlim(left=0)
    shade_good(axes, "energy_ratio")
    x, y = "warp error (sigma of the exemplar): does it ride on the fluid", "energy ratio: does it look like it"
    name_axes(axes, x, y)
    legend_above(axes)
    caption = "Nearer the lower left is better. Marks are means, trails the frames; good energy ratios are shaded."
    return f'<div class="wide">{figure(svg(axes, "energy ratio against warp error"), caption)}</div>'
