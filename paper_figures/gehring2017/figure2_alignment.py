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
from quadlab.plotting.style import MEASURED, NEUTRAL, SERIES, TEXT_WIDTH, paper_style
from quadlab.robots.legs import LEGS

STUDY = "gehring2017_walk_push"
CAPTION = (
    "A walk 0.25 s after a push to the right of 160 N for 0.15 s (0.79 m/s); estimator ekf, seed 1, perturbed "
    "start. Open circles and plus: measured feet and CoM. Dots and crosses: feet and CoM of the plan, coloured by "
    "the way it is laid: as it was made (grey), upon position and yaw of the base (orange), upon the feet "
    "(green); mixed: feet of the plan base-centred, CoM feet-centred, as the controller does."
)
ARTEFACT = Artefact(
    "G-F2", "Gehring 2017, Fig. 2", "Alignment of a plan with a robot that was pushed", (STUDY,), CAPTION
)
DRAWN = "drawing, no measurement"
BY_DEFINITION = "That is how this alignment is defined; the picture is what is new."
AFTER_PUSH_S = 0.25
"""Time of the picture after the end of the push."""


@dataclass(frozen=True)
class Moment:
    """Plan and robot at one time.

    Attributes:
        com, feet: measured in the world, (2,) and (4, 2) in [m].
        yaw: heading of the base in the world in [rad].
        planned_com, planned_feet, planned_yaw: in the plan frame.
    """

    com: Array
    feet: Array
    yaw: float
    planned_com: Array
    planned_feet: Array
    planned_yaw: float

    def alignments(self) -> dict[str, PlanarPose]:
        """Return the ways to lay the plan; the mixed one takes the torso feet-centred, swing feet base-centred."""
        feet = feet_alignment(self.planned_feet, self.feet)
        base = base_alignment(self.planned_com, self.planned_yaw, self.com, self.yaw)
        return {"unaligned": identity_alignment(), "base-centred": base, "feet-centred": feet}


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return one panel a way of alignment: measured feet and CoM in black, the plan in the colour of how it is laid."""
    now = moment(results)
    figure = Figure(figsize=(TEXT_WIDTH, 2.0), layout="constrained")
    ways = now.alignments()
    panels = figure.subplots(1, len(ways) + 1, sharex=True, sharey=True)
    colours = dict(zip(ways, (NEUTRAL, *SERIES[2:]), strict=True))
    for axes, name in zip(panels, [*ways, "mixed"], strict=True):
        torso, swing = ("feet-centred", "base-centred") if name == "mixed" else (name, name)
        feet = np.array([ways[swing].position(foot) for foot in now.planned_feet])
        axes.plot(*now.feet.T, "o", color=MEASURED, markersize=5.0, fillstyle="none", label="measured foot")
        axes.plot(*now.com, "P", color=MEASURED, markersize=5.0, label="measured CoM")
        axes.plot(*feet.T, "o", color=colours[swing], markersize=2.5, label="planned foot")
        axes.plot(
            *ways[torso].position(now.planned_com), "X", color=colours[torso], markersize=5.0, label="planned CoM"
        )
        axes.set_title(name, loc="left")
        axes.set(xlabel="x [m]", aspect="equal")
    panels[0].set_ylabel("y [m]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def moment(results: StudyResults) -> Moment:
    """Return plan and robot ``AFTER_PUSH_S`` after the end of the push of the kept trial."""
    trace, plan = results.trace(STUDY, "push"), results.plan(STUDY, "push")
    pushed = trace.index[(trace["state.push_force_y"] != 0.0).to_numpy()]
    time_s = float(pushed[-1]) + AFTER_PUSH_S
    row = trace.iloc[int(np.argmin(np.abs(trace.index - time_s)))]
    feet = np.array([[row[f"control.foot_position_{leg}_{axis}"] for axis in "xy"] for leg in LEGS])
    com = np.array([row["control.com_x"], row["control.com_y"]])
    planned = plan.at(time_s)
    yaw = float(row["control.base_yaw"])
    return Moment(com, feet, yaw, planned.com_position[:2], planned_feet(plan, time_s), planned.yaw)


def planned_feet(plan: MotionPlan, time_s: float) -> Array:
    """Return where each foot stands by plan, or lifted off if it swings, (4, 2) in the plan frame in [m]."""
    landed = [sum(swing.end_s <= time_s for swing in plan.schedule.swings[leg]) for leg in range(len(LEGS))]
    return np.array([plan.footholds[leg][count][:2] for leg, count in enumerate(landed)])


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return how far CoM, feet and yaw of the plan are from the robot's, by way of alignment."""
    now = moment(results)
    rows = []
    for name, pose in now.alignments().items():
        com = np.linalg.norm(pose.position(now.planned_com) - now.com)
        feet = np.linalg.norm(
            np.mean([pose.position(foot) for foot in now.planned_feet], axis=0) - now.feet.mean(axis=0)
        )
        yaw = np.degrees(wrap_angle(pose.yaw + now.planned_yaw - now.yaw))
        rows.append((name, 1e3 * com, 1e3 * feet, yaw))
    return pd.DataFrame(rows, columns=["alignment", "com_off_mm", "mean_foot_off_mm", "yaw_off_deg"])


def claims(results: StudyResults) -> list[Claim]:
    """Return what each way of alignment brings together."""
    table = numbers(results).set_index("alignment")
    base, feet = (float(table["com_off_mm"].loc["base-centred"]), float(table["mean_foot_off_mm"].loc["feet-centred"]))
    off = float(table["com_off_mm"].loc["unaligned"])
    return [
        Claim(
            "base-centred: planned and measured base coincide",
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
