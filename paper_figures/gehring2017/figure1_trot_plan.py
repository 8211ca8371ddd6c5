"""Gehring 2017, Fig. 1: a trot plan in space."""

import pandas as pd
from matplotlib.figure import Figure

from paper_figures.gehring2017.table1_objectives import shipped_config
from paper_figures.trial_claims import STACKS, completed, survival
from quadlab.analysis.artefact import Artefact, Claim, Verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.planners.plan import MotionPlan
from quadlab.plotting.plan_space_figure import plan_space_figure
from quadlab.plotting.style import paper_style
from quadlab.robots.legs import LEGS

STUDY, PLAN = "gehring2017_trot", "gehring2017_trot_plan"
CAPTION = (
    "The plan of the kinematic planner for two cycles of a trot, 0.8 s each, with 0.6 s of standing before and "
    "after. Squares on the ground: initial stance; circles: footholds; arcs: swings, as high as the clearance of "
    "the planner (7 cm, not printed in the paper). Thick line: CoM in the colour of the first of the two legs that "
    "swing, grey while all stand; black squares: base, with lines to the feet that stand. Thin lines on the ground: "
    "supports, in the same colours. Dots: CoP."
)
ARTEFACT = Artefact("G-F1", "Gehring 2017, Fig. 1", "A trot plan in space", (PLAN, STUDY), CAPTION)
DISTANCE = 0.03
"""Share by which the distance may be off."""
HEIGHT_MM, TILT_DEG = 3.0, 0.7


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return feet, CoM and base of the plan in a 3-D view."""
    return plan_space_figure(results.plan(PLAN, "trot"), shipped_config().clearance_m)


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return the footholds in the plan frame."""
    plan = results.plan(PLAN, "trot")
    rows = [
        (leg, number, *(float(value) for value in place))
        for leg, places in zip(LEGS, plan.footholds, strict=True)
        for number, place in enumerate(places)
    ]
    return pd.DataFrame(rows, columns=["leg", "stance", "x_m", "y_m", "z_m"])


def claims(results: StudyResults) -> list[Claim]:
    """Return that the checker accepts the plan, and how the robot trots it for 10 s with either controller.

    With the true state nothing is random: that trial stands beside those with the noise of sensors.
    """
    plan = results.plan(STUDY, "trot")
    table = results.table(STUDY)
    falls = [
        survival(f"trots 10 s with {text}, ekf and truth", table[table["controller"] == stack], "moves forward")
        for stack, text in STACKS.items()
    ]
    drawn = results.plan(PLAN, "trot").verdict
    text = "the plan passes the independent checker"
    checked = Claim(text, "-", ", ".join(drawn.violated) or "passes", Verdict.NEW)
    groups = completed(table).groupby(["controller", "estimator"], sort=False)
    tracked = [_tracking(f"{STACKS[str(stack)]}, {estimator}", rows, plan) for (stack, estimator), rows in groups]
    return [checked, *falls, *tracked]


def _tracking(name: str, rows: pd.DataFrame, plan: MotionPlan) -> Claim:
    planned = float(plan.com(plan.duration_s)[0] - plan.com(0.0)[0])
    off = rows["distance_m"] / planned - 1.0
    worst = float(off.iloc[int(off.abs().argmax())])
    in_world, tilt, torque = (
        float(rows[column].max()) for column in ("base_height_rms_mm", "roll_pitch_rms_deg", "torque_max_nm")
    )
    estimated = rows["base_height_believed_rms_mm"].notna().all()
    height = float(rows["base_height_believed_rms_mm"].max()) if estimated else in_world
    at_limit = float(rows["torque_limit_share"].max()) > 0.0
    holds = abs(worst) <= DISTANCE and height <= HEIGHT_MM and tilt <= TILT_DEG and not at_limit
    ours = f"{100 * worst:+.1f} %, {height:.2g} mm, {tilt:.2g} deg rms, {torque:.0f} N m{', the limit' * at_limit}"
    text = f"10 s of trot with {name}: distance, base height over the ground, roll and pitch, torque"
    aim = f"Aimed at here: {100 * DISTANCE:g} %, {HEIGHT_MM:g} mm, {TILT_DEG:g} deg, below the limit."
    drift = f"The height in the world, which the filter cannot know, is off by {in_world:.2g} mm rms."
    why = " ".join([*([] if holds else [aim]), *([drift] if estimated else [])])
    return Claim(text, "not printed", f"{ours}, worst of {len(rows)}", Verdict.NEW, why)
