"""The comparison of several results of one shot as an HTML page. `result` is described in terminal_table.py."""

from evaluation import drawing, frame_pictures, plots, terminal_table
from evaluation.html_page import escaped, picture_table, table, write_page
from evaluation.report import metric_ids, subtitle, value_text
from evaluation.terminal_table import READINGS, good, label, summary_value

STRIP_WIDTH = 320  # of a picture, pixels


def methods_table(results):
    rows = []
    for metric in metric_ids(results):
        values = [summary_value(result, metric) for result in results]
        best = terminal_table.best_values(metric, values)
        cells = [
            (value_text(metric, value, " *"), "number best") if index in best else (value_text(metric, value), "number")
            for index, value in enumerate(values)
        ]
        name = f"{metric}<br><small>{escaped(READINGS[metric].what)}</small>"
        rows.append([(name, "tight"), *cells, (escaped(good(metric)), "")])
    note = "* and bold: best of the row."
    pair = terminal_table.undominated(results)
    if pair:
        note += (
            " Energy and warp error pull against each other, so a method is better only when it is better in both; not "
            f"beaten in both: <strong>{escaped(', '.join(pair))}</strong>."
        )
    heads = ["metric", *(label(result) for result in results), "good"]
    return f"{table(heads, rows)}<p><small>{note}</small></p>"


def missing_table(results):
    """What was not computed and why; methods with the same reason share a row."""
    methods = {}
    for result in results:
        for missing in result["not_computed"].items():
            methods.setdefault(missing, []).append(label(result))
    rows = [
        [(metric, "name"), (escaped(", ".join(names)), "tight"), (escaped(reason), "")]
        for (metric, reason), names in methods.items()
    ]
    return table(["metric", "methods", "reason"], rows, "stack")


def side_by_side(pictures_by_method):
    """Each frame that any method has, methods as columns, all errors on one scale, the motion on one scale a frame."""
    every = [item for items in pictures_by_method.values() for item in items]
    top = frame_pictures.top_error(every)
    parts = frame_pictures.legend(every)
    for frame in sorted({item["frame"] for item in every}):
        shown = {m: item for m, items in pictures_by_method.items() for item in items if item["frame"] == frame}
        max_px = frame_pictures.top_speed(shown.values())
        drawn = {method: frame_pictures.pictures(item, max_px, top) for method, item in shown.items()}
        captions = dict.fromkeys(caption for pictures in drawn.values() for caption in pictures)
        rows = {c: [drawn.get(method, {}).get(c) for method in pictures_by_method] for c in captions}
        parts += frame_pictures.heading(frame, shown.values()) + picture_table("", list(pictures_by_method), rows)
    return parts


def movie_strip(strips):
    """Methods as rows, time to the right."""
    frames = sorted({frame for strip in strips.values() for frame, _ in strip})
    small = {m: {frame: drawing.thumbnail(rgb, STRIP_WIDTH) for frame, rgb in strip} for m, strip in strips.items()}
    rows = {method: [pictures.get(frame) for frame in frames] for method, pictures in small.items()}
    return picture_table("frame", frames, rows, "strip")


def write_comparison(path, results, pictures_by_method, strips):
    """Writes the comparison of several results of one shot as an HTML file.

    pictures_by_method: dict of method -> items (see frame_pictures.py); strips: dict of method -> list of (frame,
    picture). Their keys are shown in the order given.
    """
    sections = {
        "Methods": methods_table(results),
        "Energy against warp error": plots.energy_against_warp(results),
        "Movie strip": movie_strip(strips),
        "Side by side": side_by_side(pictures_by_method),
        "Per frame": plots.curves(results),
        "Spectrum": plots.spectrum(results),
        "Not computed": missing_table(results),
    }
    write_page(path, f"{results[0]['name']}: comparison of methods", subtitle(results[0]), sections)
