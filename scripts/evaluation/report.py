"""The report of one result as an HTML page. `result` is described in terminal_table.py."""

from evaluation import frame_pictures, plots, terminal_table
from evaluation.html_page import escaped, figure, image, table, write_page
from evaluation.terminal_table import READINGS, good, label, number, summary_value


def value_text(metric, value, mark=""):
    """Number with unit and mark, as HTML that says so where it is outside its bound."""
    unit = READINGS[metric].unit if value is not None else ""
    text = f"{number(value)} {unit}".strip() + mark
    outside = '<br><small class="bad">outside</small>' if terminal_table.outside_bound(metric, value) else ""
    return text + outside


def metric_ids(results):
    """Ids for the rows of a table; without the least of a metric, which is its worst frame."""
    return [metric for metric in terminal_table.metric_ids(results) if metric in READINGS]


def gates_table(result):
    rows = []
    for gate in result["gates"]:
        passed = ("passed", "tight good") if gate["passed"] else ("FAILED", "tight bad best")
        bound = escaped(gate["bound"])
        if "reason" in gate:
            bound += f"<br><small>{escaped(gate['reason'])}</small>"
        rows.append([(gate["metric"], "name"), (number(gate["value"]), "number"), passed, (bound, "")])
    return table(["metric", "value", "gate", "bound"], rows)


def summary_table(result):
    rows = []
    for metric in metric_ids([result]):
        value = summary_value(result, metric)
        if value is None:
            continue
        worst = terminal_table.worst_frame(result, metric)
        worst_text = f"{number(worst[1])} <small>at frame {worst[0]}</small>" if worst else ""
        what = READINGS[metric].what
        what = what[0].upper() + what[1:]
        rows.append(
            [
                (metric, "name"),
                (value_text(metric, value), "number"),
                (worst_text, "number"),
                (escaped(good(metric)), "tight"),
                (f"{escaped(what)}<br><small>{escaped(result['definitions'][metric])}</small>", ""),
            ]
        )
    return table(["metric", "mean", "worst", "good", "what it is"], rows, "stack")


def texts_table(heads, texts):
    """Table of two columns; texts: dict of name -> plain text."""
    return table(heads, [[(escaped(name), "name"), (escaped(text), "")] for name, text in texts.items()], "stack")


def settings_of(result):
    """Dict of name -> text: everything about the run that is a single value, and what stands under "settings"."""
    plain = {key: value for key, value in result.items() if isinstance(value, (str, int, float))} | result["settings"]
    return {
        key.replace("_", " "): number(value) if isinstance(value, float) else value
        for key, value in plain.items()
        if value is not None
    }


def pictures_of(items):
    """HTML; items: described in frame_pictures.py."""
    top = frame_pictures.top_error(items)
    parts = frame_pictures.legend(items)
    for item in items:
        drawn = frame_pictures.pictures(item, frame_pictures.top_speed([item]), top)
        shown = "".join(figure(image(rgb, caption), caption) for caption, rgb in drawn.items())
        parts += f'{frame_pictures.heading(item["frame"], [item])}<div class="pictures">{shown}</div>\n'
    return parts


def subtitle(result):
    frames = [frame["frame"] for frame in result["frames"]]
    span = f"{len(frames)} frames, {frames[0]} to {frames[-1]}" if len(frames) > 1 else f"frame {frames[0]}"
    facts = [span, f"{result['width']} x {result['height']} px", f"{number(result['fps'])} fps"]
    return ", ".join(facts + [f"exemplar {result['exemplar']}"] * bool(result["exemplar"]))


def write_report(path, result, pictures):
    """Writes the report of one result as an HTML file; pictures: list of items (see frame_pictures.py), in order."""
    terms = {name: text for name, text in result["definitions"].items() if name not in READINGS}
    sections = {
        "Gates": gates_table(result),
        "Summary": summary_table(result),
        "Not computed": texts_table(["metric", "reason"], result["not_computed"]),
        "Pictures": pictures_of(pictures),
        "Per frame": plots.curves([result]),
        "Spectrum": plots.spectrum([result]),
        "Terms": texts_table(["term", "definition"], terms),
        "Settings": texts_table(["setting", "value"], settings_of(result)),
    }
    write_page(path, f"{result['name']}: {label(result)}", subtitle(result), sections)
