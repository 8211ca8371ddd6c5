"""How torso and limbs move on an unperceived step down, judged by Bellicoso 2016, V and VI-B."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from quadlab.analysis.artefact import Claim, verdict
from quadlab.controllers.telemetry import LegMode
from quadlab.robots.legs import LEGS

EDGE_M = 0.75
"""Where the edge is in the trials whose curves and pictures are kept."""
DESCENDED_M = 0.05
"""Below that, a hind foot is on its way down the step."""
TILTED_DEG, STRAIGHT_DEG = 1.0, 6.0
"""From which pitch or roll on the torso adapts; how far off straight a knee still is a straight one."""
LIFTED_MM = 20.0
"""While a leg searches, another foot higher than that means that the robot falls."""
REACHED_M = 0.001
"""So near to a limit, which is soft, it counts as reached."""
LOWERED_MM = 10.0
"""By which the torso has gone down, not only swayed."""
LOW_MM = 50.0
"""A foot higher above the upper level than that no longer extends downwards."""
SOON_S = 0.5
"""An answer to a limit that comes later is none."""
DIAGONAL = {"LF": "RH", "RF": "LH", "LH": "RF", "RH": "LF"}
SWINGS_UP = (
    "the leg gets straight, then swings up about the hip while the torso rolls; how the robot of the paper fails is "
    "not printed."
)


@dataclass(frozen=True)
class _Search:
    """The leg that searches first, while the others stand.

    Attributes:
        leg: its name.
        straight_s: time in [s] from which its knee is straight; infinity if it never is.
        foot_mm: height of its foot in [mm] over the time in [s].
    """

    leg: str
    straight_s: float
    foot_mm: "pd.Series[float]"


def stretched(trace: pd.DataFrame, step_m: float) -> Claim:
    """Return how straight the knee of the searching leg gets, and what becomes of its foot while the others stand.

    Args:
        trace: of the trial without limb limits, columns ``<table>.<column>``, by time in [s].
        step_m: height of the step in [m].
    """
    search = _first_search(trace)
    down_mm = -float(search.foot_mm.min())
    ours = (
        f"{search.leg} searches: its foot gets {down_mm:.0f} mm down, its knee is less than {STRAIGHT_DEG:g} deg off "
        f"straight from {search.straight_s:.1f} s on, the foot rises to {search.foot_mm.max():.0f} mm while the others "
        "stand"
    )
    straight = bool(np.isfinite(search.straight_s)) and down_mm < 1e3 * step_m
    found = verdict(holds=straight and stays_low(trace), partly=straight)
    text = f"without limb limits, edge at {EDGE_M:g} m: the leg stretches and does not reach the ground"
    why = "" if stays_low(trace) else SWINGS_UP[0].upper() + SWINGS_UP[1:]
    return Claim(text, "extends until its kinematic limits", ours, found, why)


def stays_low(trace: pd.DataFrame) -> bool:
    """Whether the foot of the leg that searches first stays near the ground while the others stand."""
    return float(_first_search(trace).foot_mm.max()) < LOW_MM


def _first_search(trace: pd.DataFrame) -> _Search:
    searches = {leg: trace[f"control.leg_mode_{leg}"] == LegMode.SEARCH for leg in LEGS}
    first = min(LEGS, key=lambda leg: _first(searches[leg]))
    rows = trace[searches[first]]
    heights_mm = 1e3 * rows[[f"control.foot_position_{leg}_z" for leg in LEGS]].set_axis(LEGS, axis=1)
    standing = ~(heights_mm.drop(columns=first) > LIFTED_MM).any(axis=1).cummax()
    knee_deg = np.degrees(rows.loc[standing, f"state.joint_position_{first}_KFE"].abs())
    return _Search(first, _first(knee_deg <= STRAIGHT_DEG), heights_mm.loc[standing, first])


def _first(flags: "pd.Series[bool]") -> float:
    """Return the first time at which ``flags``, by time in [s], hold; never is infinity."""
    return float(flags.idxmax()) if flags.any() else float("inf")  # type: ignore[arg-type]


def adaptation(rows: pd.DataFrame, step_m: float) -> Claim:
    """Return how the torso moves before a hind leg descends: after that the terrain alone lowers it.

    Args:
        rows: of the trial with limb limits, columns of ``figure5_step_down.numbers``.
        step_m: height of the step in [m].
    """
    hind = rows[["LH_z_m", "RH_z_m"]].min(axis=1) < -DESCENDED_M
    before = rows[~hind.cummax()]
    drop_mm = 1e3 * float(before["base_z_m"].iloc[0] - before["base_z_m"].min())
    pitch, roll = (float(before[f"{key}_deg"].abs().max()) for key in ("pitch", "roll"))
    half_mm = 500.0 * step_m
    height = f"height -{drop_mm:.0f} mm (half of the step is {half_mm:.0f})"
    ours = f"{height}, pitch up to {pitch:.1f} deg, roll up to {roll:.1f} deg"
    moves = drop_mm > half_mm and min(pitch, roll) > TILTED_DEG
    text = "height, pitch and roll adapt before a hind leg descends"
    return Claim(text, "adapt", ours, verdict(holds=moves))


def tilts_at_the_limit(rows: pd.DataFrame, limit_m: float) -> Claim:
    """Return when a limb reaches its limit and when the torso tilts.

    Args:
        rows: as of ``adaptation``.
        limit_m: largest height of a hip over its foot in [m].
    """
    reached = min(_reached(rows, limit_m).values())
    tilted = _first((rows[["pitch_deg", "roll_deg"]].abs().max(axis=1) > TILTED_DEG).set_axis(rows["time_s"]))
    farthest = float(rows[[f"{leg}_extension_m" for leg in LEGS]].to_numpy().max())
    ours = (
        f"limit of {limit_m:.3f} m reached at {reached:.2f} s, tilt above {TILTED_DEG:g} deg at {tilted:.2f} s; "
        f"up to {1e3 * (farthest - limit_m):.0f} mm beyond the limit"
    )
    why = "The limit is soft and does not hold back the foot, which searches faster than the torso follows."
    text = "the torso tilts when a limb reaches its limit"
    return Claim(text, "when the limit is reached", ours, verdict(holds=0.0 <= tilted - reached <= SOON_S), why)


def _reached(rows: pd.DataFrame, limit_m: float) -> dict[str, float]:
    """Return when each limb first reaches the limit, in [s]."""
    at_limit = {leg: rows[f"{leg}_extension_m"] > limit_m - REACHED_M for leg in LEGS}
    return {leg: _first(flags.set_axis(rows["time_s"])) for leg, flags in at_limit.items()}


def lowers_at_the_limit(rows: pd.DataFrame, limit_m: float) -> Claim:
    """Return when the hind leg across from the first limb at its limit reaches its own, and when the torso goes down.

    Args:
        rows: as of ``adaptation``.
        limit_m: largest height of a hip over its foot in [m].
    """
    reached = _reached(rows, limit_m)
    fore = min(("LF", "RF"), key=lambda leg: reached[leg])
    hind = DIAGONAL[fore]
    drop_mm = 1e3 * (rows["base_z_m"].iloc[0] - rows["base_z_m"]).set_axis(rows["time_s"])
    lowered = _first(drop_mm > LOWERED_MM)
    in_order = 0.0 <= lowered - reached[hind] <= SOON_S
    ours = (
        f"{fore} at {reached[fore]:.2f} s, {hind} at {reached[hind]:.2f} s, {LOWERED_MM:g} mm lower at {lowered:.2f} s"
    )
    if np.isfinite(reached[hind]):
        ours += f" and {drop_mm[reached[hind]]:.0f} mm when {hind} reaches it"
    both = bool(np.isfinite([lowered, reached[hind]]).all())
    why = "" if in_order else f"The torso goes down together with its tilt, when {fore} reaches its limit."
    text = "the tilt brings the diagonal hind leg to its limit, then the height goes down"
    return Claim(text, "in this order", ours, verdict(holds=in_order, partly=both), why)
