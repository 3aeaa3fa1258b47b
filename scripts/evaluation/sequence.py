"""All figures of a sequence, frame by frame in parallel processes; summing.py makes the summary."""

import dataclasses
import functools
import multiprocessing
import os

import cv2
import numpy as np

from evaluation import coherence, frames, likeness, masks, metrics, motion, optical_flow, summing, windows
from evaluation.errors import NotComputed
from evaluation.exemplar import Exemplar
from evaluation.frame_item import item_of
from evaluation.window_search import WindowSearch

HANDEDNESS_WINDOWS = 40
SPECTRUM_WINDOWS = 24  # per frame
MIN_SPECTRUM_WINDOWS = 4
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
    np.seterr(over="ignore", invalid="ignore")  # pixels that are not finite are counted and left out


def _after(number):
    """@return the frame with the camera that sees what frame `number` shows one frame later"""
    frame = _read(number)
    if number + 1 in _run.paths:
        return _read(number + 1)
    before = _read(number - 1) if number - 1 in _run.paths else frame
    if before.attributes.get("worldToNDC") != frame.attributes.get("worldToNDC"):
        raise NotComputed("the camera moves, and there is no next frame to say where it is then")
    return frame


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
    figures.add(["motion_check_median", "motion_check_p99"], lambda: motion.check(frame, _fps(frame, settings), _after(number)))
    figures.add(["motion_exact_median", "motion_exact_p99"], lambda: motion.check_exact(frame, settings.fluid, _after(number)))
    estimated = difference = None
    if number + 1 in _run.paths:
        estimated, difference = _measure_pair(frame, _read(number + 1), figures)
    pictures = item_of(frame, estimated, difference) if number in _run.shown else None
    return figures.values, figures.reasons, pictures


def _measure_pair(frame, following, figures):
    """@return the estimated flow and the warp error, H x W x 2 and H x W, for the report"""
    settings = _run.settings
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
    frames.check_one_size(paths)
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
    result = _described(_read(numbers[0]), settings)
    result.update(summing.sum_up([values for values, _, _ in found], [reasons for _, reasons, _ in found], settings.exemplar,
                                 run.search, settings.seed))
    return result, [pictures for _, _, pictures in found if pictures]


def _described(first, settings):
    """@return what the report says of the run"""
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
        "definitions": metrics.definitions(),
    }
