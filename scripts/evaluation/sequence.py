"""All figures of a sequence: frame by frame in parallel processes, then summed up."""

import dataclasses
import functools
import math
import multiprocessing
import os

import cv2
import numpy as np

from evaluation import coherence, frames, likeness, masks, metrics, motion, optical_flow, windows
from evaluation.errors import InputError, NotComputed
from evaluation.exemplar import Exemplar
from evaluation.window_search import WindowSearch

HANDEDNESS_WINDOWS = 40
FLOOR_WINDOWS = 256
SPECTRUM_WINDOWS = 24  # per frame
MIN_SPECTRUM_WINDOWS = 4
PICTURE_WIDTH = 960
PICTURE_FRAMES = 3


@dataclasses.dataclass
class Settings:
    exemplar: Exemplar | None = None  # without one, what compares with it is not computed
    texel_size_world: float | None = None  # None: the header's
    fps: float | None = None  # None: the header's, else 24
    fluid: dict = dataclasses.field(default_factory=dict)  # table [fluid] of the shot
    layout: str = "ebru"
    colour: str = "albedo"  # the layer that is judged; "rgb" is the lit picture
    flow: str = "dis"
    windows: int = 100  # per frame
    side: int = 21  # texels; about one feature of the exemplar
    seed: int = 1
    jobs: int = 0  # 0: one per processor


@dataclasses.dataclass
class _Run:
    """What every process knows of the run."""

    paths: dict
    settings: Settings
    search: WindowSearch | None
    mirrored: bool
    shown: set


_run: _Run | None = None  # set once per process


def _texel_size(frame, settings):
    size = _texel_size_or_none(frame, settings)
    if not size:
        raise NotComputed("the header has no ebru:texelSizeWorld; give --texel-size or --shot")
    return float(size)


def _texel_size_or_none(frame, settings):
    return settings.texel_size_world or frame.attributes.get("ebru:texelSizeWorld")


def _fps(frame, settings):
    return float(settings.fps or frame.attributes.get("framesPerSecond") or 24.0)


def _exemplar(settings):
    if settings.exemplar is None:
        raise NotComputed("no exemplar; give --shot or --exemplar")
    return settings.exemplar


def _random(settings, *stream):
    return np.random.default_rng([settings.seed, *stream])


@functools.lru_cache(maxsize=2)
def _read(number):
    settings = _run.settings
    return frames.read(_run.paths[number], number, settings.layout, settings.colour)


class _Figures:
    """Collects figures and the reasons why others are missing."""

    def __init__(self):
        self.values, self.reasons = {}, {}

    def add(self, ids, compute):
        """@param ids  what compute() returns as a dict, or the one id of the number it returns"""
        try:
            found = compute()
            self.values.update(found if isinstance(found, dict) else {ids[0]: found})
        except NotComputed as e:
            self.reasons.update({i: str(e) for i in ids})


def _window_figures(frame, settings):
    """@return {id: value}, and what only the whole run can sum up"""
    exemplar, texel = _exemplar(settings), _texel_size(frame, settings)
    if _run.search is None:
        raise NotComputed(f"the exemplar has no contrast or is smaller than windows of {settings.side} texels")
    found = windows.cut(frame, texel, settings.side, settings.windows, _random(settings, frame.number, 0))
    if len(found) == 0:
        raise NotComputed(f"no window of {settings.side} texels fits: the surface is too far (over {windows.MAX_PIXEL_TEXELS} "
                          "texels a pixel), too bent or too small")
    values = found.mirrored().values if _run.mirrored else found.values
    distance, places = _run.search.nearest(values)
    return {"energy": float(distance.mean() / exemplar.sigma), "cover": likeness.cover(places[:, :2], exemplar),
            "_places": places[:, :2], "_pixel_texels": found.pixel_texels, "windows": len(found)}


def _spectrum(frame, settings):
    texel = _texel_size(frame, settings)
    found = windows.cut(frame, texel, likeness.SPECTRUM_SIDE, SPECTRUM_WINDOWS, _random(settings, frame.number, 1))
    if len(found) < MIN_SPECTRUM_WINDOWS:
        raise NotComputed(f"fewer than {MIN_SPECTRUM_WINDOWS} windows of {likeness.SPECTRUM_SIDE} texels fit")
    return {"_power": likeness.power(found.values), "_power_pixel_texels": found.pixel_texels}


def _begin(run):
    global _run
    _run = run
    _read.cache_clear()
    cv2.setNumThreads(1)


def _measure(number):
    """@return figures of one frame and of the pair it begins, reasons, and pictures for the report"""
    settings, frame, figures = _run.settings, _read(number), _Figures()
    figures.values["frame"] = number
    figures.add(["not_finite"], lambda: int((~frame.finite).sum()))
    figures.add(["holes"], lambda: likeness.holes(frame))
    figures.add(["contrast"], lambda: likeness.contrast(frame, _exemplar(settings)))
    figures.add(["distortion_mean", "distortion_p95"],
                lambda: likeness.distortion(frame, _exemplar(settings), _texel_size(frame, settings)))
    figures.add(["energy", "energy_floor", "energy_ratio", "cover"], lambda: _window_figures(frame, settings))
    figures.add(["spectrum_db"], lambda: _spectrum(frame, settings))
    figures.add(["motion_check_median", "motion_check_p99"], lambda: motion.check(frame, _fps(frame, settings)))
    figures.add(["motion_exact_median", "motion_exact_p99"], lambda: motion.check_exact(frame, settings.fluid))
    estimated = difference = None
    if number + 1 in _run.paths:
        estimated, difference = _measure_pair(frame, _read(number + 1), figures)
    pictures = picture_of(frame, estimated, difference) if number in _run.shown else None
    return figures.values, figures.reasons, pictures


def _measure_pair(frame, following, figures):
    """@return the estimated flow and the warp error, H x W x 2 and H x W, for the report"""
    settings = _run.settings
    if (following.width, following.height) != (frame.width, frame.height):
        raise InputError(f"{following.path}: size: got {following.width} x {following.height} px, expected {frame.width} x "
                         f"{frame.height} as in {frame.path.name}; render the sequence in one size")
    pair_ids = [name for name, metric in metrics.METRICS.items() if metric.pair]
    try:
        matched = masks.matched(frame, following, _texel_size_or_none(frame, settings), _fps(frame, settings))
    except NotComputed as e:
        figures.reasons.update({i: str(e) for i in pair_ids})
        return None, None
    figures.add(["motion_second_order_median", "motion_second_order_p99"],
                lambda: motion.check_second_order(frame, following, matched, _fps(frame, settings)))
    kept = {}

    def flow():
        values, kept["flow"] = optical_flow.compare(frame, following, matched, _exemplar(settings).sigma, settings.flow)
        return values

    def warp():
        kept["warp"] = coherence.warp_difference(frame, following, _exemplar(settings).sigma)
        return coherence.compare(kept["warp"], frame, matched)

    figures.add([i for i in pair_ids if i.startswith("flow_")], flow)
    figures.add(["warp_error", "warp_error_p99", "popping", "still_change"], warp)
    if "warp" in kept:
        figures.reasons.pop("still_change", None)
        figures.add(["still_change"], lambda: coherence.still(kept["warp"], frame, matched))
        kept["warp"] = np.where(matched, kept["warp"], np.nan).astype(np.float32)
    return kept.get("flow"), kept.get("warp")


def picture_of(frame, estimated=None, difference=None):
    """What the reports show of a frame, at most PICTURE_WIDTH wide."""
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


def _mirrored(settings, search, paths):
    """Either handedness is a likeness, one for the whole run: that of the first frame which has windows to tell."""
    for number in paths:
        frame = _read(number)
        try:
            found = windows.cut(frame, _texel_size(frame, settings), settings.side, HANDEDNESS_WINDOWS,
                                _random(settings, number, 2))
        except NotComputed:
            return False
        if len(found) >= HANDEDNESS_WINDOWS / 2:
            return bool(search.nearest(found.mirrored().values)[0].mean() < search.nearest(found.values)[0].mean())
    return False


def _search(settings):
    exemplar = settings.exemplar
    if exemplar is None or exemplar.sigma < 1e-6 or min(exemplar.luma.shape) < 1.5 * settings.side + 2:
        return None
    return WindowSearch(exemplar.luma, settings.side)


def _shown(numbers):
    """The first, the last that begins a pair, and those between."""
    begin = numbers[:-1] if len(numbers) > 1 else numbers
    return {begin[round(i * (len(begin) - 1) / (PICTURE_FRAMES - 1))] for i in range(PICTURE_FRAMES)}


def evaluate(paths, settings, progress=lambda done, total: None):
    """@param paths  {frame number: EXR file}; only consecutive numbers make pairs
    @return the result as it is written to metrics.json, and pictures for the report (see frame_pictures.py)
    @throw InputError"""
    numbers = sorted(paths)
    run = _Run(paths, settings, _search(settings), False, _shown(numbers))
    _begin(run)
    if run.search is not None:
        run.mirrored = _mirrored(settings, run.search, numbers)

    found = []
    jobs = min(settings.jobs or os.cpu_count() or 1, len(numbers))
    chunk = max(1, len(numbers) // (4 * jobs))  # neighbours in one process: the second frame of a pair is read once
    # New processes: OpenImageIO's and OpenCV's threads do not live on in a forked one.
    with multiprocessing.get_context("spawn").Pool(jobs, _begin, (run,)) as pool:
        for done, measured in enumerate(pool.imap(_measure, numbers, chunk), 1):
            found.append(measured)
            progress(done, len(numbers))
    first = _read(numbers[0])
    result = _sum_up(found, settings, first)
    return result, [pictures for _, _, pictures in found if pictures]


def _sum_up(found, settings, first):
    rows, reasons = [values for values, _, _ in found], {}
    for _, missing, _ in found:
        for name, reason in missing.items():
            reasons.setdefault(name, reason)
    spectrum = _likeness_over_all(rows, settings, reasons)
    summary = {}
    for name, metric in metrics.METRICS.items():
        values = [row[name] for row in rows if row.get(name) is not None]
        if not values:
            summary[name] = summary.get(name)
            continue
        reasons.pop(name, None)
        if name not in ("cover", "spectrum_db"):  # of all windows together
            total = name in ("holes", "not_finite")
            summary[name] = sum(values) if total else float(np.mean(values))
        if metric.worst in ("max", "min"):
            summary[f"{name}_{metric.worst}"] = max(values) if metric.worst == "max" else min(values)
    summary.update(_run_totals(rows, settings, spectrum))
    for name, metric in metrics.METRICS.items():
        if summary.get(name) is None:
            why = "needs two consecutive frames" if metric.pair else "no closed form" if "exact" in name else "no data"
            reasons.setdefault(name, why)
    clean = [{k: v for k, v in row.items() if not k.startswith("_")} for row in rows]
    for row in clean:
        for name in metrics.METRICS:
            row.setdefault(name, None)
    return {
        "name": first.attributes.get("ebru:shot", first.path.name.rsplit(".", 2)[0]),
        "method": first.attributes.get("ebru:method"),
        "folder": str(first.path.parent),
        "exemplar": settings.exemplar.path if settings.exemplar else None,
        "texel_size_world": _texel_size_or_none(first, settings),
        "fps": _fps(first, settings),
        "width": first.width,
        "height": first.height,
        "settings": {"layout": settings.layout, "colour": settings.colour, "flow": settings.flow, "windows": settings.windows,
                     "side": settings.side, "seed": settings.seed, "mirrored": _run.mirrored,
                     "sigma_exemplar": settings.exemplar.sigma if settings.exemplar else None},
        "frames": clean,
        "summary": summary,
        "not_computed": {name: reason for name, reason in reasons.items() if summary.get(name) is None},
        "definitions": metrics.definitions(),
        "spectrum": spectrum,
    }


def _likeness_over_all(rows, settings, reasons):
    """Adds to the rows what needs the exemplar's own figures at the sequence's pixel size.  @return the spectra"""
    with_energy = [row for row in rows if "energy" in row]
    if with_energy:
        pixel_texels = float(np.mean(np.concatenate([row["_pixel_texels"] for row in with_energy])))
        try:
            reference = likeness.floor_windows(settings.exemplar, pixel_texels, settings.side, FLOOR_WINDOWS,
                                               _random(settings, 0, 3))
            floor = float(_run.search.nearest(reference)[0].mean() / settings.exemplar.sigma)
            for row in with_energy:
                row["energy_floor"] = floor
                row["energy_ratio"] = row["energy"] / floor
        except NotComputed as e:
            reasons.update({"energy_floor": str(e), "energy_ratio": str(e)})
    with_power = [row for row in rows if "_power" in row]
    if not with_power:
        return None
    try:
        pixel_texels = float(np.mean(np.concatenate([row["_power_pixel_texels"] for row in with_power])))
        exemplar = _exemplar(settings)
        reference = likeness.power(likeness.floor_windows(exemplar, pixel_texels, likeness.SPECTRUM_SIDE, FLOOR_WINDOWS,
                                                          _random(settings, 0, 4)))
    except NotComputed as e:
        reasons["spectrum_db"] = str(e)
        return None
    for row in with_power:
        row["spectrum_db"] = likeness.spectrum_difference(row["_power"], reference)
    mean = np.mean([row["_power"] for row in with_power], axis=0)
    in_db = lambda power: [float(v) for v in 10 * np.log10(power + 1e-12)]
    return {"cycles_per_texel": [float(v) for v in likeness.SPECTRUM_BINS / likeness.SPECTRUM_SIDE],
            "exemplar_db": in_db(reference), "picture_db": in_db(mean)}


def _run_totals(rows, settings, spectrum):
    """Figures of all windows together; a mean over frames would hide or invent differences."""
    totals = {}
    places = [row["_places"] for row in rows if "_places" in row]
    if places:
        totals["cover"] = likeness.cover(np.concatenate(places), settings.exemplar)
    if spectrum:
        difference = np.array(spectrum["picture_db"]) - np.array(spectrum["exemplar_db"])
        totals["spectrum_db"] = float(np.sqrt(np.mean(difference**2)))
    return totals
