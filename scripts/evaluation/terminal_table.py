"""How each metric reads, and plain-text tables of results for an 80 x 24 terminal.

A `result` is the evaluation of one sequence as it is written to JSON: "frames" is a list of {metric id: number or
None}, "summary" holds the means over the frames under the same ids, "not_computed" maps ids to reasons. Keys that are
missing count as None.
Nothing here draws, so the tables are available without matplotlib.
"""
import dataclasses
import math

from evaluation import metrics

COLUMNS = 79
ROWS = 23  # one row of the screen is left to the prompt


@dataclasses.dataclass(frozen=True)
class Reading:
    """How a figure is read by people; its definition and its bound are in metrics.py."""

    what: str = ""  # the question it answers
    unit: str = ""
    best: str = "low"  # which value wins: "low", "high", "one" (nearest to 1) or "none"
    hint: str = ""  # stands in for a bound where there is none, at most 31 characters
    secondary: bool = False  # left to the report when the terminal is full


# In reading order.
READINGS = {
    "energy_ratio": Reading("does it look like the exemplar, relative to the exemplar itself"),
    "warp_error": Reading("does the texture ride on the fluid"),
    "contrast": Reading("ghosting and blur lower it", best="one"),
    "cover": Reading("is all of the exemplar used", best="high"),
    "spectrum_db": Reading("has it the exemplar's frequencies", "dB"),
    "energy": Reading("distance to the nearest pieces of the exemplar", hint="see energy_ratio"),
    "energy_floor": Reading("the same distance for the exemplar itself", best="none", secondary=True),
    "warp_error_p99": Reading("the strongest changes of the texture along the motion"),
    "popping": Reading("sudden changes of the texture along the motion"),
    "still_change": Reading("does the texture change where nothing flows"),
    "distortion_mean": Reading("squash and stretch of the texture", hint="near 1 (isometry)"),
    "distortion_p95": Reading("squash and stretch of the texture, 95 %", hint="near 1 (isometry)"),
    "holes": Reading("fluid without a texture", "px"),
    "not_finite": Reading("pixels with NaN or infinite values", "px"),
    "motion_check_median": Reading("is the motion channel the projected velocity", "px"),
    "motion_check_p99": Reading("is the motion channel the projected velocity, 99 %", "px", secondary=True),
    "motion_second_order_median": Reading("is the motion channel the projected path", "px", secondary=True),
    "motion_second_order_p99": Reading("is the motion channel the projected path, 99 %", "px", secondary=True),
    "motion_exact_median": Reading("is the motion channel the exact path", "px"),
    "motion_exact_p99": Reading("is the motion channel the exact path, 99 %", "px", secondary=True),
    "flow_excess": Reading("apparent motion against the motion channel, beyond the floor", "px"),
    "flow_epe": Reading("apparent motion against the motion channel", "px", hint="see flow_excess"),
    "flow_floor": Reading("what the flow estimator itself cannot resolve", "px", best="none"),
    "flow_epe_median": Reading("apparent motion against the motion channel, median", "px", secondary=True),
    "flow_angle_deg": Reading("apparent motion against the motion channel, angle", "deg", secondary=True),
    "flow_fl": Reading("share of pixels whose apparent motion is plainly wrong", secondary=True),
}


def good(metric):
    """The bound of the metric as text, or a hint what is good; empty without either."""
    bound = metrics.METRICS[metric].good if metric in metrics.METRICS else ""
    return bound or READINGS.get(metric, Reading()).hint


def bounds(metric):
    """(lowest, highest) good value, read from "<= 1.3", ">= 0.85", "0.95 to 1.05" or "0"; other texts bound nothing."""
    text = good(metric)
    try:
        if text.startswith("<="):
            return -math.inf, float(text[2:])
        if text.startswith(">="):
            return float(text[2:]), math.inf
        low, _, high = text.partition(" to ")
        return float(low), float(high or low)
    except ValueError:
        return -math.inf, math.inf


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def number(value):
    """A value with 3 significant digits, counts in full; "-" for what is not a finite number."""
    if not is_number(value):
        return "-"
    if isinstance(value, int):
        return str(value)
    if value == 0:
        return "0"
    rounded = float(f"{value:.2e}")
    if abs(rounded) < 1e-3 or abs(rounded) >= 1e7:
        return f"{rounded:.2e}"
    return f"{rounded:.{max(0, 2 - math.floor(math.log10(abs(rounded))))}f}"


def label(result):
    """What a result is called among others."""
    return str(result.get("method") or result.get("name") or "?")


def summary_value(result, metric):
    return (result.get("summary") or {}).get(metric)


def series(result, metric):
    """(frames, values) of the frames that have the metric."""
    pairs = [(frame.get("frame", index), frame.get(metric)) for index, frame in enumerate(result.get("frames") or [])]
    pairs = [pair for pair in pairs if is_number(pair[1])]
    return [frame for frame, _ in pairs], [value for _, value in pairs]


def badness(metric, value):
    """Grows the worse a value is; None where no value is better than another."""
    best = READINGS[metric].best if metric in READINGS else "none"
    return {"low": value, "high": -value, "one": abs(value - 1), "none": None}[best]


def outside_bound(metric, value):
    """True where the value breaks the bound of the metric."""
    low, high = bounds(metric)
    return is_number(value) and not low <= value <= high


def worst_frame(result, metric):
    """(frame, value) of the worst frame; None where there are not two frames that differ."""
    frames, values = series(result, metric)
    if len(set(values)) < 2 or badness(metric, values[0]) is None:
        return None
    return max(zip(frames, values), key=lambda pair: badness(metric, pair[1]))


def metric_ids(results):
    """Ids for the rows of a table: known ones that have a value or a reason, then the others.

    A worst value is left out beside its mean, since the worst frame says the same.
    """
    summaries = [result.get("summary") or {} for result in results]
    present = {key: None for summary in summaries for key, value in summary.items() if is_number(value)}
    missing = {key: None for result in results for key in result.get("not_computed") or {}}
    named = {key for key in READINGS if key in missing or not READINGS[key].secondary and key_for(missing, key)}
    known = [key for key in READINGS if key in present or key in named]
    others = [key for key in present if key not in READINGS]
    others += [key for key in missing if key not in READINGS and not any(key_for([key], other) for other in READINGS)]
    return known + [key for key in others if not (key.endswith(("_max", "_min")) and key[:-4] in present)]


def key_for(keys, metric):
    """Which of the keys speaks of the metric: itself or the longest one its id begins with; None without one."""
    return max((key for key in keys if metric == key or metric.startswith(key + "_")), key=len, default=None)


def reason(result, metric):
    """Why a metric has no value, or None."""
    reasons = result.get("not_computed") or {}
    key = key_for(reasons, metric)
    return None if key is None else str(reasons[key])


def best_values(metric, values):
    """Indices of the winning values as printed; none where all are alike or there is no better and worse."""
    scores = {
        index: badness(metric, float(number(value))) for index, value in enumerate(values) if is_number(value)
    }
    if len(set(scores.values())) < 2 or None in scores.values():
        return set()
    winner = min(scores.values())
    return {index for index, score in scores.items() if score == winner}


def undominated(results):
    """Labels of the results no other one beats in both energy_ratio and warp_error, among those that have both."""
    pair = ("energy_ratio", "warp_error")
    points = [[label(result), *(summary_value(result, key) for key in pair)] for result in results]
    points = [point for point in points if is_number(point[1]) and is_number(point[2])]

    def beats(a, b):
        return a[1] <= b[1] and a[2] <= b[2] and a[1:] != b[1:]

    return [point[0] for point in points if not any(beats(other, point) for other in points)]


def cut(text, width):
    """The text on one line, at most `width` characters."""
    text = " ".join(str(text).split())
    return text if len(text) <= width else text[: max(width - 2, 0)] + ".."


def screen_ids(result, room):
    """(ids shown, ids left out): secondary ones go first, then those at the end."""
    ids = metric_ids([result])
    if len(ids) <= room:
        return ids, []
    spare = [key for key in ids if key not in READINGS or READINGS[key].secondary]
    primary = [key for key in ids if key not in spare]
    shown = set((primary + spare)[:room])
    return [key for key in ids if key in shown], [key for key in ids if key not in shown]


def summary_row(result, metric):
    value = summary_value(result, metric)
    if not is_number(value):
        return f"{cut(metric, 20):20} {'-':>9}   {cut(reason(result, metric) or 'not computed', COLUMNS - 33)}"
    worst = worst_frame(result, metric)
    worst_text = f"{number(worst[1])} @ {worst[0]}" if worst else ""
    mark = "!" if outside_bound(metric, value) else " "
    return f"{cut(metric, 20):20} {number(value):>9} {mark} {cut(worst_text, 15):15} {cut(good(metric), 31)}".rstrip()


def gates_line(result):
    """One line on the gates, None where there are none."""
    gates = result.get("gates") or []
    failed = [f"{gate.get('metric')} {number(gate.get('value'))}" for gate in gates if not gate.get("passed")]
    if not gates:
        return None
    if not failed:
        return f"gates: all {len(gates)} passed"
    return cut(f"gates: {len(failed)} of {len(gates)} failed: {', '.join(failed)}", COLUMNS)


def summary_table(result):
    """The means of one result with the worst frame and the bound of each, at most 23 lines of 79 characters.

    "!" marks a value outside its bound; what was not computed is "-" with the reason.
    """
    frames = [frame.get("frame") for frame in result.get("frames") or []]
    span = f"frames {frames[0]} to {frames[-1]}" if len(frames) > 1 else f"frame {frames[0]}" if frames else "no frames"
    lines = [
        cut(f"{result.get('name', '?')}, {label(result)}: {span}", COLUMNS),
        f"{'metric':20} {'mean':>9}   {'worst @ frame':15} good",
    ]
    gates = gates_line(result)
    room = ROWS - len(lines) - bool(gates) - 1
    shown, left = screen_ids(result, room)
    lines += [summary_row(result, metric) for metric in shown] or ["nothing was computed"]
    if left:
        lines.append(cut(f"in the report: {', '.join(left)}", COLUMNS))
    return "\n".join(lines + [gates] * bool(gates))


def comparison_table(results):
    """The means of several results, methods as columns: "*" is the best of the row, "!" outside the bound."""
    width = max([9] + [min(len(label(result)), 16) for result in results]) + 2
    rows = [f"{'metric':20}" + "".join(f"{cut(label(result), width - 2):>{width}}  " for result in results)]
    for metric in metric_ids(results):
        values = [summary_value(result, metric) for result in results]
        best = best_values(metric, values)
        row = f"{cut(metric, 20):20}"
        for index, value in enumerate(values):
            mark = ("*" if index in best else " ") + ("!" if outside_bound(metric, value) else " ")
            row += f"{number(value):>{width}}{mark}"
        rows.append(row)
    pair = undominated(results)
    if pair:
        rows.append(f"not beaten in energy_ratio and warp_error together: {', '.join(pair)}")
    return "\n".join(row.rstrip() for row in rows)
