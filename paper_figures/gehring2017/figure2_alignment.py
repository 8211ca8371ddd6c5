"""Gehring 2017, Fig. 2: where a plan lies for a robot that was pushed, by way of aligning it; from a logged push."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quadlab.analysis.artefact import Artefact, Claim, Verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.controllers.tracking.alignment import (
    PlanarPose,
    base_alignment,
    feet_alignment,
    identity_alignment,
)
from quadlab.geometry.rotations import Array, wrap_angle
from quadlab.planners.plan import MotionPlan
from quadlab.plotting.style import MEASURED, NEUTRAL, REFERENCE, SERIES, TEXT_WIDTH, paper_style
from quadlab.robots.legs import LEGS

STUDY = "gehring2017_walk_push"
CAPTION = (
    "A walk 0.25 s after a push to the right of 160 N for 0.15 s (0.79 m/s); estimator ekf, seed 1, perturbed "
    "start. Dashed with open circles, open plus: measured feet and CoM. Solid with dots, cross: feet and CoM of the "
    "plan, coloured by the way it is laid: as it was made (grey), upon position of the CoM and yaw of the base "
    "(orange), upon the feet (green). Mixed, as the controller does: feet of the plan base-centred; the cross is the "
    "controller's reference of the CoM (blue), which is feet-centred and filtered."
)
ARTEFACT = Artefact(
    "G-F2", "Gehring 2017, Fig. 2", "Alignment of a plan with a robot that was pushed", (STUDY,), CAPTION
)
DRAWN = "drawing, no measurement"
BY_DEFINITION = "That is how this alignment is defined; the picture is what is new."
AFTER_PUSH_S = 0.25
"""Time of the picture after the end of the push in [s]."""
AROUND = [LEGS.index(leg) for leg in ("LF", "RF", "RH", "LH", "LF")]
"""Feet in the order in which a line goes round them."""


@dataclass(frozen=True)
class Moment:
    """Plan and robot at one time.

    Attributes:
        com, feet: measured in the world, (2,) and (4, 2) in [m].
        yaw: heading of the base in the world in [rad].
        reference: what the controller wants the CoM to be at, in the world, (2,) in [m].
        planned_com, planned_feet, planned_yaw: in the plan frame.
    """

    com: Array
    feet: Array
    yaw: float
    reference: Array
    planned_com: Array
    planned_feet: Array
    planned_yaw: float

    def alignments(self) -> dict[str, PlanarPose]:
        """Return the ways to lay the plan, of which the controller mixes the last two."""
        feet = feet_alignment(self.planned_feet, self.feet)
        base = base_alignment(self.planned_com, self.planned_yaw, self.com, self.yaw)
        return {"unaligned": identity_alignment(), "base-centred": base, "feet-centred": feet}

    def laid(self) -> dict[str, tuple[Array, Array]]:
        """Return the CoM, (2,), and the feet, (4, 2), of the plan in the world in [m], by way of alignment."""
        laid = {
            name: (pose.position(self.planned_com), np.array([pose.position(foot) for foot in self.planned_feet]))
            for name, pose in self.alignments().items()
        }
        return {**laid, "mixed": (self.reference, laid["base-centred"][1])}


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return one panel a way of alignment: measured feet and CoM in black, the plan in the colour of how it is laid."""
    now = moment(results)
    figure = Figure(figsize=(TEXT_WIDTH, 1.75), layout="constrained")
    laid = now.laid()
    panels = figure.subplots(1, len(laid), sharex=True, sharey=True)
    colours = ((NEUTRAL, NEUTRAL), (SERIES[2], SERIES[2]), (SERIES[3], SERIES[3]), (REFERENCE, SERIES[2]))
    for axes, (name, (com, feet)), (for_com, for_feet) in zip(panels, laid.items(), colours, strict=True):
        axes.plot(*now.feet[AROUND].T, "o--", color=MEASURED, ms=5.0, mfc="none", label="measured feet")
        axes.plot(*feet[AROUND].T, "o-", color=for_feet, ms=2.5, label="planned feet")
        axes.plot(*com, "X", ls="", color=for_com, ms=6.0, mew=0.0, label="planned CoM")
        axes.plot(*now.com, "P", ls="", color=MEASURED, ms=6.0, mfc="none", mew=0.8, label="measured CoM")
        axes.set_title(name, loc="left")
        axes.set(xlabel="x [m]", aspect="equal")
    panels[0].set_ylabel("y [m]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=4)
    return figure


def moment(results: StudyResults) -> Moment:
    """Return plan and robot ``AFTER_PUSH_S`` after the end of the push of the kept trial."""
    trace, plan = results.trace(STUDY, "push"), results.plan(STUDY, "push")
    pushed = trace.index[(trace["state.push_force_y"] != 0.0).to_numpy()]
    time_s = float(pushed[-1]) + AFTER_PUSH_S
    row = trace.iloc[int(np.argmin(np.abs(trace.index - time_s)))]
    feet = np.array([[row[f"control.foot_position_{leg}_{axis}"] for axis in "xy"] for leg in LEGS])
    com, reference = (np.array([row[f"control.{key}_{axis}"] for axis in "xy"]) for key in ("com", "com_reference"))
    planned = plan.at(time_s)
    yaw = float(row["control.base_yaw"])
    return Moment(com, feet, yaw, reference, planned.com_position[:2], planned_feet(plan, time_s), planned.yaw)


def planned_feet(plan: MotionPlan, time_s: float) -> Array:
    """Return where each foot stands by plan, or lifted off if it swings, (4, 2) in the plan frame in [m]."""
    return np.array([plan.foothold_at(leg, time_s)[:2] for leg in range(len(LEGS))])


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return how far CoM and feet of the plan are from the robot's, and its yaw if it has one, by alignment."""
    now = moment(results)
    ways = now.alignments()
    rows = []
    for name, (com, feet) in now.laid().items():
        com_off = np.linalg.norm(com - now.com)
        feet_off = np.linalg.norm(feet.mean(axis=0) - now.feet.mean(axis=0))
        yaw = np.degrees(wrap_angle(ways[name].yaw + now.planned_yaw - now.yaw)) if name in ways else None
        rows.append((name, 1e3 * com_off, 1e3 * feet_off, yaw))
    return pd.DataFrame(rows, columns=["alignment", "com_off_mm", "mean_foot_off_mm", "yaw_off_deg"])


def claims(results: StudyResults) -> list[Claim]:
    """Return what each way of alignment brings together."""
    table = numbers(results).set_index("alignment")
    base, feet = (float(table["com_off_mm"].loc["base-centred"]), float(table["mean_foot_off_mm"].loc["feet-centred"]))
    off = float(table["com_off_mm"].loc["unaligned"])
    return [
        Claim(
            "base-centred: planned and measured CoM coincide",
            DRAWN,
            f"{base:.2g} mm apart, {off:.0f} mm unaligned",
            Verdict.NEW,
            BY_DEFINITION,
        ),
        Claim(
            "feet-centred: means of planned and measured feet coincide",
            DRAWN,
            f"{feet:.2g} mm apart",
            Verdict.NEW,
            BY_DEFINITION,
        ),
    ]
