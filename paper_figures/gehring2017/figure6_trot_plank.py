"""Gehring 2017, Fig. 6: a trot over a plank that nobody announced, under the front legs."""

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from paper_figures.known_limits import known_limits
from paper_figures.trial_claims import LEG_LENGTH_M, paper_stack, survival, variant_claims
from quadlab.analysis.artefact import Artefact, Claim, Verdict, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.controllers.telemetry import LegMode
from quadlab.plotting.intervals import intervals_where
from quadlab.plotting.style import COLUMN_WIDTH, MEASURED, REFERENCE, SERIES, paper_style
from quadlab.robots.legs import LEGS
from quadlab.studies.config import load_study

STUDY, WALK, TROT = "gehring2017_trot_plank", "gehring2017_walk_push", "gehring2017_trot"
CAPTION = (
    "Trot, 0.8 s and 0.25 m a stride, over a plank 8 cm high and 20 cm deep with its middle at x = 0.65 m; our "
    "priorities, estimator ekf, seed 0, nominal start. Wide blue: desired, for feet while they swing; dashed: "
    "measured; dotted: height of the plank. Bands: a foot has contact with it, in the row of pitch any of them. LF "
    "brushes it and lands behind it, RF stands on it and the nose goes up; then RH and LH stand on it and the nose "
    "goes down."
)
ARTEFACT = Artefact("G-F6", "Gehring 2017, Fig. 6", "Trot over an unperceived plank", (STUDY,), CAPTION)
HEIGHT, PLACE = "scenario.terrain.0.height_m", "scenario.terrain.0.center_x_m"
PLANK = SERIES[2]
TILTS_DEG = 1.0
"""By so much the desired pitch has to turn to either side."""
OFF_M, STANDS_S = 0.01, 0.05
"""How far a standing foot may be off the height of the plank; less than that time it only brushes it."""
RECOVERS = "recovers; height not printed"
NEEDED = {0.08: 10, 0.10: 8}
"""How many of ten places count as good, by height in [m]."""


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return pitch with its reference, and the heights of the feet with theirs, over time."""
    table, height_m = numbers(results), plank_height_m()
    figure = Figure(figsize=(COLUMN_WIDTH, 4.8), layout="constrained")
    for_pitch, *for_feet = figure.subplots(1 + len(LEGS), 1, sharex=True)
    for_pitch.plot(table["time_s"], table["pitch_reference_deg"], color=REFERENCE, linewidth=2.0, label="desired")
    for_pitch.plot(table["time_s"], table["pitch_deg"], "--", color=MEASURED, label="measured")
    for_pitch.set_ylabel("pitch [deg]")
    for axes, leg in zip(for_feet, LEGS, strict=True):
        axes.sharey(for_feet[0])
        axes.plot(table["time_s"], table[f"{leg}_z_reference_m"], color=REFERENCE, linewidth=2.0)
        axes.plot(table["time_s"], table[f"{leg}_z_m"], "--", color=MEASURED)
        axes.axhline(height_m, color=PLANK, linestyle=":", label="height of the plank")
        axes.set_ylabel(f"{leg} height [m]")
        _mark_contacts((for_pitch, axes), table, leg)
    handles = {
        label: artist
        for axes in (for_pitch, for_feet[0])
        for artist, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    figure.legend(handles.values(), handles, loc="outside upper center", ncols=2)
    for_feet[-1].set_xlabel("time [s]")
    figure.align_ylabels()
    return figure


def _mark_contacts(rows: Sequence[Axes], table: pd.DataFrame, leg: str) -> None:
    times = table["time_s"].to_numpy()
    for span in intervals_where(times, table[f"{leg}_on_plank"].to_numpy() > 0, float(times[-1])):
        for axes in rows:
            axes.axvspan(span.start_s, span.end_s, color=PLANK, alpha=0.2, lw=0, label="contact with the plank")


def plank_height_m() -> float:
    """Return the height of the plank of the kept trial in [m], as the study says."""
    return float(next(trace.where[HEIGHT] for trace in load_study(STUDY).traces if trace.name == "plank"))


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return pitch and heights of the feet, their references, and which feet stand on the plank, over time."""
    trace, half_m = results.trace(STUDY, "plank"), 0.5 * plank_height_m()
    angles = {
        "pitch_deg": np.degrees(trace["control.base_pitch"].to_numpy()),
        "pitch_reference_deg": np.degrees(trace["control.base_reference_pitch"].to_numpy()),
    }
    heights = {f"{leg}_z_m": trace[f"control.foot_position_{leg}_z"].to_numpy() for leg in LEGS}
    references = {f"{leg}_z_reference_m": trace[f"control.foot_position_reference_{leg}_z"].to_numpy() for leg in LEGS}
    on_plank = {
        f"{leg}_on_plank": (
            (trace[f"control.leg_mode_{leg}"].to_numpy() == LegMode.STANCE) & (heights[f"{leg}_z_m"] > half_m)
        ).astype(int)
        for leg in LEGS
    }
    return pd.DataFrame({"time_s": trace.index.to_numpy(), **angles, **heights, **references, **on_plank})


def claims(results: StudyResults) -> list[Claim]:
    """Return that walk and trot share their settings, which heights are passed, how, and what holds the robot up."""
    curves, height_m = numbers(results), plank_height_m()
    table, limits = results.table(STUDY), known_limits(results, STUDY)
    reference = table[table["variant"] == "reference"]
    heights = [
        survival(
            f"trots over a plank of {100 * height:.0f} cm with our priorities, {estimator}",
            reference[np.isclose(reference[HEIGHT], height) & (reference["estimator"] == estimator)],
            RECOVERS,
            needed,
            "The arc of the swing is 12 cm high; falls were not diagnosed place by place.",
        )
        for height, needed in NEEDED.items()
        for estimator in ("ekf", "truth")
    ]
    highest = 100.0 * limits["limit"].fillna(0.0)
    share = 100.0 * highest.min() / (100.0 * LEG_LENGTH_M)
    ours = f"{highest.min():.0f} cm ({share:.0f} % of the leg), up to {highest.max():.0f} cm, {len(highest)} places"
    same = table[np.isclose(table[HEIGHT], 0.08) & table[PLACE].isin([0.55, 0.60, 0.65, 0.70, 0.75])]
    return [
        same_settings(),
        *heights,
        pitch_adapts(curves),
        feet_adapt(curves, height_m),
        paper_stack(same, RECOVERS, "trots over a plank of 8 cm"),
        Claim("highest plank that is passed at every place tried, ekf", "not printed", ours, Verdict.NEW),
        *variant_claims(same, "8 cm"),
    ]


def same_settings() -> Claim:
    """Return how many values of planner and controller the trots do not share with the walk."""
    walk, *trots = (_settings(study) for study in (WALK, TROT, STUDY))
    names = set(walk).union(*trots)
    differing = sorted(
        name for name in names if any(name not in trot or trot[name] != walk.get(name) for trot in trots)
    )
    text = "trot, with and without the plank, against the walk: weights, gains, priorities and all else"
    ours = f"{len(differing)} of {len(names)} values of planner and controller differ"
    why = f"These do: {', '.join(differing)}." if differing else ""
    return Claim(text, "the exact same", ours, verdict(holds=not differing), why)


def _settings(study: str) -> dict[str, object]:
    from quadlab.trials.compose import compose_trial  # noqa: PLC0415 - loads what trials need

    config = compose_trial(load_study(study).blocks[0].overrides)
    chosen = config.model_dump(mode="json", include={"planner", "controller"})
    return dict(_leaves(chosen, ""))


def _leaves(value: object, name: str) -> Iterator[tuple[str, object]]:
    """Yield dotted name and value of everything in nested dictionaries and lists."""
    if isinstance(value, dict | list):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _leaves(part, f"{name}.{key}" if name else str(key))
    else:
        yield name, value


def pitch_adapts(curves: pd.DataFrame) -> Claim:
    """Return how the desired pitch turns while a fore foot and while a hind foot stands on the plank."""
    on_plank = {leg: curves[f"{leg}_on_plank"] > 0 for leg in LEGS}
    desired = curves["pitch_reference_deg"]
    fore = float(desired[on_plank["LF"] | on_plank["RF"]].min())
    hind = float(desired[on_plank["LH"] | on_plank["RH"]].max())
    up, down = fore <= -TILTS_DEG, hind >= TILTS_DEG
    text = "desired pitch while a fore foot, then a hind foot stands on the plank, positive nose down [deg]"
    return Claim(text, "adapts", f"{fore:.1f}, then {hind:+.1f}", verdict(holds=up and down, partly=up or down))


def feet_adapt(curves: pd.DataFrame, height_m: float) -> Claim:
    """Return at which height feet stand on the plank, and how high the highest swing is beside the others.

    Args:
        curves: as ``numbers`` returns them.
        height_m: of the plank in [m].
    """
    least = STANDS_S / float(np.median(np.diff(curves["time_s"])))
    standing = {leg: curves.loc[curves[f"{leg}_on_plank"] > 0, f"{leg}_z_m"] for leg in LEGS}
    heights = {leg: float(values.median()) for leg, values in standing.items() if len(values) >= least}
    highest, usual = _apexes(curves)
    stand = bool(heights) and max(abs(height - height_m) for height in heights.values()) <= OFF_M
    higher = highest >= usual + 0.5 * height_m
    feet = ", ".join(f"{leg} {1e3 * height:.0f}" for leg, height in heights.items()) or "none"
    ours = f"{feet} of {1e3 * height_m:.0f}; highest desired swing {1e3 * highest:.0f}, usual {1e3 * usual:.0f}"
    text = "heights of the feet that stand on the plank, and of the swing that begins on it [mm]"
    return Claim(text, "foot heights adapt", ours, verdict(holds=stand and higher, partly=stand or higher))


def _apexes(curves: pd.DataFrame) -> tuple[float, float]:
    """Return the highest and the median top of all desired swings in [m]."""
    times = curves["time_s"].to_numpy()
    tops = [
        float(curves.loc[(times >= span.start_s) & (times < span.end_s), f"{leg}_z_reference_m"].max())
        for leg in LEGS
        for span in intervals_where(times, curves[f"{leg}_z_reference_m"].notna().to_numpy(), float(times[-1]))
    ]
    return max(tops), float(np.median(tops))
