"""Every figure by its id: what it is, and what is good. docs/metrics.md says the same at length."""

import dataclasses

from evaluation import likeness, masks, windows


@dataclasses.dataclass(frozen=True)
class Metric:
    definition: str
    good: str = ""
    pair: bool = False  # of frame f and f + 1
    worst: str = "max"  # which end of it is bad: max, min, or none


_LUMA = "luma = mean of the three channels of the judged layer (albedo), sRGB-encoded, 0 to 1"

METRICS = {
    "energy": Metric(
        "mean over tangent-plane windows (settings: side, texels) of the RMS distance of luma to the nearest exemplar window over "
        "all positions and angles, / sigma(exemplar); windows lie where a pixel is at most "
        f"{windows.MAX_PIXEL_TEXELS} texels long and the surface within {windows.BEND_TEXELS:g} texels of its tangent plane"),
    "energy_floor": Metric("energy of the exemplar itself on a plane, turned by random angles, at the same pixel size",
                           worst="none"),
    "energy_ratio": Metric("energy / energy_floor: 1 cannot be told from the exemplar", "<= 1.3"),
    "cover": Metric("entropy of where the nearest windows lie on an 8 x 8 tiling of the exemplar / log 64, corrected for the "
                    "number of windows (Miller 1955)", ">= 0.85", worst="min"),
    "spectrum_db": Metric(
        f"RMS difference in dB of the radially averaged power spectra of luma, Hann windows of {likeness.SPECTRUM_SIDE} x "
        f"{likeness.SPECTRUM_SIDE} texels in the tangent plane, mean removed, up to {likeness.SPECTRUM_BINS[-1]} cycles per "
        "window; the exemplar's windows are read from pictures of it at the same pixel size", "<= 1.5"),
    "contrast": Metric("sigma(luma on covered) / sigma(exemplar)", "0.95 to 1.05", worst="none"),
    "distortion_mean": Metric("mean of max(s1, 1 / s2), singular values of d(st) / d(P) from neighbouring pixels against "
                              "isometry; not across seams"),
    "distortion_p95": Metric("95 % quantile of what distortion_mean is the mean of"),
    "holes": Metric("pixels that see fluid without a texture (texture.s < 0)", "0"),
    "not_finite": Metric("pixels with a channel that is NaN or infinite; left out of everything else", "0"),
    "motion_check_median": Metric("median over fluid of |forward - (project(P + velocity / fps) - project(P))|, px, by the "
                                  "header's worldToNDC", "see motion_second_order_median"),
    "motion_check_p99": Metric("99 % quantile of what motion_check_median is the median of"),
    "motion_second_order_median": Metric("motion_check_median with the mean of the velocity at P and at the landing place in f + 1, on "
                                         "matched, px", "<= 0.1", pair=True),
    "motion_second_order_p99": Metric("99 % quantile of what motion_second_order_median is the median of", pair=True),
    "motion_exact_median": Metric("median over fluid of |forward - exact|, px, for procedural fluids with a closed form",
                                  "<= 0.02"),
    "motion_exact_p99": Metric("99 % quantile of what motion_exact_median is the median of"),
    "flow_epe": Metric("mean end-point error of the estimated optical flow (8-bit luma of f and f + 1) against forward, px, on "
                       "matched and textured", pair=True),
    "flow_epe_median": Metric("median of what flow_epe is the mean of", pair=True),
    "flow_angle_deg": Metric("mean angle between (u, v, 1) of both, degrees", pair=True),
    "flow_fl": Metric("share of pixels with an end-point error over 3 px and over 5 %", pair=True),
    "flow_floor": Metric("flow_epe with luma of f, moved exactly as backward of f + 1 says, in place of luma of f + 1",
                         pair=True, worst="none"),
    "flow_excess": Metric("flow_epe - flow_floor", "<= 0.25", pair=True),
    "warp_error": Metric("mean |luma of f + 1 at x + forward - luma of f at x| / sigma(exemplar), cubic interpolation, on "
                         "matched", "low", pair=True),
    "warp_error_p99": Metric("99 % quantile of what warp_error is the mean of", "low", pair=True),
    "popping": Metric("share of matched pixels whose difference, of which warp_error is the mean, is over 0.5", "low", pair=True),
    "still_change": Metric("warp_error where |forward| < 0.05 px", "<= 0.01", pair=True),
}

MASKS = {"luma": _LUMA, **masks.DEFINITIONS}


def definitions():
    return {**MASKS, **{name: metric.definition for name, metric in METRICS.items()}}
