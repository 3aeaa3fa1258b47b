"""From the figures of the frames to those of the sequence.

A row holds the figures of one frame by id; keys that begin with "_" are for here: "_places" and "_pixel_texels" of its energy
windows, "_power" and "_power_pixel_texels" of its spectrum.
"""

import numpy as np

from evaluation import likeness, metrics
from evaluation.errors import NotComputed

FLOOR_WINDOWS = 256
SUMS = ("holes", "not_finite")
OF_ALL_WINDOWS = ("cover", "spectrum_db")  # a mean over frames would hide or invent differences


def sum_up(rows, missing, exemplar, search, seed):
    """@param missing  {id: reason} of every frame  @param search  None without energies
    @return "frames", "summary", "not_computed" and "spectrum" of metrics.json. Changes the rows."""
    reasons = {}
    for of_frame in missing:
        reasons = {**of_frame, **reasons}  # the first reason counts
    totals = _energy_floor(rows, exemplar, search, seed, reasons)
    spectrum, difference = _spectrum(rows, exemplar, seed, reasons)
    totals["spectrum_db"] = difference
    summary = _summary(rows, totals)
    for name, metric in metrics.METRICS.items():
        why = "needs two consecutive frames" if metric.pair else "no closed form" if "exact" in name else "no data"
        reasons.setdefault(name, why)
    return {
        "frames": [{**dict.fromkeys(metrics.METRICS), **{k: v for k, v in row.items() if not k.startswith("_")}} for row in rows],
        "summary": summary,
        "not_computed": {name: reason for name, reason in reasons.items() if summary.get(name) is None},
        "spectrum": spectrum,
    }


def _summary(rows, totals):
    """Means or sums over the frames, or the totals of all windows; and the worst frame's."""
    summary = {}
    for name, metric in metrics.METRICS.items():
        values = [row[name] for row in rows if row.get(name) is not None]
        if name in OF_ALL_WINDOWS:
            summary[name] = totals.get(name)
        elif not values:
            summary[name] = None
        else:
            summary[name] = sum(values) if name in SUMS else float(np.mean(values))
        if values and metric.worst in ("max", "min"):
            summary[f"{name}_{metric.worst}"] = max(values) if metric.worst == "max" else min(values)
    return summary


def _energy_floor(rows, exemplar, search, seed, reasons):
    """Adds the floor, at the mean pixel size of the sequence's windows, and the ratio to the rows.  @return {"cover": value}"""
    rows = [row for row in rows if "energy" in row]
    if not rows:
        return {}
    try:
        pixel_texels = float(np.mean(np.concatenate([row["_pixel_texels"] for row in rows])))
        reference = likeness.floor_windows(exemplar, pixel_texels, search.side, FLOOR_WINDOWS, np.random.default_rng([seed, 0, 3]))
        floor = float(search.nearest(reference)[0].mean() / exemplar.sigma)
        for row in rows:
            row["energy_floor"], row["energy_ratio"] = floor, row["energy"] / floor
    except NotComputed as e:
        reasons.update({"energy_floor": str(e), "energy_ratio": str(e)})
    return {"cover": likeness.cover(np.concatenate([row["_places"] for row in rows]), exemplar)}


def _spectrum(rows, exemplar, seed, reasons):
    """Adds the difference from the exemplar's spectrum at the same pixel size to the rows.
    @return both curves, and the difference of all windows together; None without"""
    rows = [row for row in rows if "_power" in row]
    if not rows:
        return None, None
    try:
        if exemplar is None:
            raise NotComputed("no exemplar; give --shot or --exemplar")
        pixel_texels = float(np.mean(np.concatenate([row["_power_pixel_texels"] for row in rows])))
        reference = likeness.power(likeness.floor_windows(exemplar, pixel_texels, likeness.SPECTRUM_SIDE, FLOOR_WINDOWS,
                                                          np.random.default_rng([seed, 0, 4])))
    except NotComputed as e:
        reasons["spectrum_db"] = str(e)
        return None, None
    for row in rows:
        row["spectrum_db"] = likeness.spectrum_difference(row["_power"], reference)
    mean = np.mean([row["_power"] for row in rows], axis=0)
    return {"cycles_per_texel": (likeness.SPECTRUM_BINS / likeness.SPECTRUM_SIDE).tolist(),
            "exemplar_db": likeness.decibels(reference).tolist(),
            "picture_db": likeness.decibels(mean).tolist()}, likeness.spectrum_difference(mean, reference)
