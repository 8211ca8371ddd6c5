"""Gehring 2017, Table I: weights and final costs of the objectives, three motions."""

import pandas as pd
import yaml
from matplotlib.figure import Figure

from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.paths import CONF_DIR
from quadlab.planners.kinematic_sqp.config import KinematicSqpConfig
from quadlab.plotting.style import paper_style
from quadlab.plotting.table_figure import TableText, table_figure

STUDY = "gehring2017_table1"
CAPTION = (
    "Weighted costs after the last iteration, walk, trot and transition, from standing. The regulariser and the "
    "even loads, which the paper does not list, are left out. Our distances: 0.2 m (walk, as printed), 0.15 m "
    "(trot) and 0.2 m (transition) a stride."
)
ARTEFACT = Artefact("G-TAB1", "Gehring 2017, Table I", "Costs of the objectives", (STUDY,), CAPTION)
MOTIONS = ("walk", "trot", "transition")
PRINTED = {
    "com_consistency": ("Center of mass consistency", 1e5, (0.41, 0.01, 0.12)),
    "feet_consistency": ("End-effectors consistency", 1e5, (0.23, 0.01, 0.09)),
    "dynamic_stability": ("Dynamic stability", 1e3, (2.18, 0.02, 1.00)),
    "travel_distance_transition": ("Traveling distance of 1st cycle", 1e3, (11.95, 2.91, 15.79)),
    "travel_distance_periodic": ("Traveling distance of 2nd cycle", 3e3, (5.71, 0.25, 1.64)),
    "turning_angle_periodic": ("Turning angle of 2nd cycle", 1e3, (0.05, 0.00, 0.00)),
    "smooth_base": ("Smooth base motion", 1e2, (5.57, 0.04, 1.12)),
    "smooth_joints": ("Smooth joint motions", 1e1, (3.08, 1.26, 1.46)),
    "smooth_com": ("Smooth center of mass motion", 1e1, (0.40, 0.001, 0.10)),
    "smooth_feet": ("Smooth end effector motions", 1e1, (2.27, 0.08, 0.34)),
}
"""Name, weight and costs of walk, trot and transition as printed; our names of the objectives as keys."""
UNPRINTED = "Clearance, w_min and regulariser are not printed"
INFERRED = (
    "smoothness counts in units of the sample period here, an inference: Eq. (5) as printed does not suit the weights."
)
WHY = {
    "walk": f"{UNPRINTED}; {INFERRED}",
    "trot": f"{UNPRINTED}, nor is the distance; {INFERRED}",
    "transition": f"{UNPRINTED}, nor is the distance; {INFERRED}",
}
"""Why costs differ, by motion; the paper prints the distance of the walk, 0.2 m a stride, which is also ours."""


EQUAL, CLOSE = 1.1, 3.0
"""Costs that differ by less than these factors count as equal and as close."""
DISTANCES = ("travel_distance_transition", "travel_distance_periodic")
"""Objectives whose cost is the weighted square of how far a cycle misses its distance in [m]."""


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return the table: name, weight, then cost here and in the paper by motion."""
    header = (
        ("", "", *(name for motion in MOTIONS for name in (motion, ""))),
        ("objective", "weight", *(("here", "paper") * len(MOTIONS))),
    )
    table = numbers(results)
    rows = [
        (name, _power(weight), *(cell for motion in MOTIONS for cell in _cells(table, objective, motion)))
        for objective, (name, weight, _) in PRINTED.items()
    ]
    return table_figure(TableText(header, tuple(rows)))


def _power(weight: float) -> str:
    """Return a weight as a power of ten."""
    digit, exponent = f"{weight:.0e}".split("e")
    power = f"$10^{{{int(exponent)}}}$"
    return power if digit == "1" else rf"{digit} $\cdot$ {power}"


def _cells(table: pd.DataFrame, objective: str, motion: str) -> tuple[str, str]:
    row = table[(table["objective"] == objective) & (table["motion"] == motion)].iloc[0]
    printed = float(row["paper"])
    return f"{row['cost']:.3f}", f"{printed:.2f}" if round(printed, 2) == printed else f"{printed:.3f}"


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return one row an objective and motion: weight in the paper, cost here and in the paper."""
    table = results.table(STUDY).set_index("motion")
    rows = [
        (objective, weight, motion, float(table.loc[motion, f"cost_{objective}"]), printed)  # type: ignore[arg-type]
        for objective, (_, weight, costs) in PRINTED.items()
        for motion, printed in zip(MOTIONS, costs, strict=True)
    ]
    return pd.DataFrame(rows, columns=["objective", "weight", "motion", "cost", "paper"])


def claims(results: StudyResults) -> list[Claim]:
    """Return the totals beside the paper's, the ratios of single objectives, and whether our weights are printed."""
    table = numbers(results)
    found = []
    for motion in MOTIONS:
        rows = table[table["motion"] == motion]
        ours, paper = rows[["cost", "paper"]].sum()
        text = f"{motion}: sum of the costs in Table I, without the regulariser"
        judged = verdict(holds=within(ours / paper, EQUAL), partly=within(ours / paper, CLOSE))
        found.append(Claim(text, f"{paper:.3g}", f"{ours:.3g}", judged, f"{largest_gap(rows)} {WHY[motion]}"))
    found += [_ratios(motion, table[table["motion"] == motion]) for motion in MOTIONS]
    used = shipped_weights()
    same = [name for name, (_, weight, _) in PRINTED.items() if used.get(name) == weight]
    text = "weights of the objectives as printed"
    return [*found, Claim(text, str(len(PRINTED)), str(len(same)), verdict(holds=len(same) == len(PRINTED)))]


def within(ratio: float, factor: float) -> bool:
    """Whether two numbers of that ratio differ by less than ``factor``."""
    return 1.0 / factor < ratio < factor


def largest_gap(rows: pd.DataFrame) -> str:
    """Return of which objective the costs of a motion are farthest apart, as a sentence."""
    worst = rows.iloc[int((rows["cost"] - rows["paper"]).abs().argmax())]
    costs = f"{PRINTED[str(worst['objective'])][0].lower()}, {worst['paper']:.4g} printed, {worst['cost']:.2g} here"
    if worst["objective"] not in DISTANCES:
        return f"Farthest apart: {costs}."
    paper_mm, ours_mm = (1e3 * float(worst[key] / worst["weight"]) ** 0.5 for key in ("paper", "cost"))
    return f"Farthest apart: {costs}; the cycle misses its distance by {paper_mm:.0f} mm there, {ours_mm:.0f} mm here."


def _ratios(motion: str, rows: pd.DataFrame) -> Claim:
    """Return the smallest and largest ratio of our costs to the printed ones, and how many are close."""
    printed = rows[rows["paper"] > 0.0].set_index("objective")
    ratio = printed["cost"] / printed["paper"]
    close = sum(within(value, CLOSE) for value in ratio)
    names = (str(ratio.idxmin()), str(ratio.idxmax()))
    ends = (f"{float(ratio[name]):.2g} ({PRINTED[name][0].lower()})" for name in names)
    ours = f"{' to '.join(ends)}, {close} of {len(ratio)} within a factor of {CLOSE:g}"
    found = verdict(holds=close == len(ratio), partly=2 * close >= len(ratio))
    return Claim(f"{motion}: cost here / cost in the paper, by objective", "1", ours, found, WHY[motion])


def shipped_weights() -> dict[str, float]:
    """Return the weights of the shipped planner by objective."""
    return {name: float(value) for name, value in shipped_config().weights.model_dump().items()}


def shipped_config() -> KinematicSqpConfig:
    """Return ``conf/planner/kinematic_sqp.yaml``."""
    text = (CONF_DIR / "planner" / "kinematic_sqp.yaml").read_text(encoding="utf-8")
    return KinematicSqpConfig.model_validate(yaml.safe_load(text))
