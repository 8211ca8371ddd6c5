"""Short logs that no physics produced, of robots and gaits that exist."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from synthetic_records import CONTROL_PERIOD, LEVELS, METADATA, body_poses, geoms, log_config, tick_record

from quadlab.controllers.telemetry import LegMode
from quadlab.gaits.gait import GaitConfig, contact_schedule
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.paths import CONF_DIR
from quadlab.planners.plan import MotionPlan, PlanReport, PlanVerdict
from quadlab.robots.catalogue import robot_config
from quadlab.robots.description import load_urdf_text
from quadlab.trials.recording.record import TickRecord
from quadlab.trials.recording.recorder import TrialRecorder

PLANK = {
    "kind": "plank",
    "center_x_m": 0.5,
    "center_y_m": 0.0,
    "length_m": 0.2,
    "width_m": 1.0,
    "height_m": 0.05,
    "yaw_deg": 0.0,
}
GAITS = {"walk": 12.0, "trot": 4.0}
"""Duration in [s] of the schedule of each gait."""


def gait_schedule(gait: str) -> ContactSchedule:
    config = GaitConfig.model_validate(yaml.safe_load((CONF_DIR / "gait" / f"{gait}.yaml").read_text()))
    return contact_schedule(config, GAITS[gait])


def straight_plan(schedule: ContactSchedule, step: float = 0.1) -> MotionPlan:
    """Every swing goes ``step`` in [m] forward, the CoM follows at constant speed."""
    corners = np.array([[0.35, 0.2, 0.0], [0.35, -0.2, 0.0], [-0.35, 0.2, 0.0], [-0.35, -0.2, 0.0]])
    footholds = tuple(
        corner + np.outer(np.arange(len(swings) + 1), [step, 0.0, 0.0])
        for corner, swings in zip(corners, schedule.swings, strict=True)
    )
    knots = np.array([0.0, schedule.duration_s])
    speed = step * len(schedule.swings[0]) / schedule.duration_s
    return MotionPlan(
        schedule=schedule,
        com=PiecewisePolynomial(knots, np.array([[[0.0, 0.0, 0.5], [speed, 0.0, 0.0]]])),
        heading=PiecewisePolynomial(knots, np.zeros((1, 1, 1))),
        cop=PiecewisePolynomial(knots, np.array([[[0.0, 0.0], [speed, 0.0]]])),
        footholds=footholds,
        report=PlanReport("synthetic", build_ms=0.0, solve_ms=0.0, iterations=1, variables=1, constraints=1),
        verdict=PlanVerdict({}, {}),
    )


def scheduled_tick(index: int, schedule: ContactSchedule, period_s: float, modes: tuple[LegMode, ...]) -> TickRecord:
    """The tick at ``index * period_s`` in which the plan's contacts hold and the legs are in ``modes``."""
    tick, time_s = tick_record(index), index * period_s
    telemetry = tick.telemetry._replace(
        plan_time_s=time_s,
        planned_contacts=schedule.contacts_at(time_s),
        leg_modes=modes,
        events=("LF early touch-down at 0.80 of the swing", "push of 3 N starts") if index == 7 else (),
    )
    return tick._replace(state=replace(tick.state, time_s=time_s), telemetry=telemetry)


def write_trial(
    directory: Path,
    ticks: list[TickRecord],
    plan: MotionPlan,
    *,
    robot: str = "anymal_b",
    terrain: tuple[dict[str, Any], ...] = (PLANK,),
    wall_times: bool = True,
) -> Path:
    directory.mkdir(parents=True, exist_ok=True)
    description = robot_config(robot)
    config = {
        "robot": description.model_dump(mode="json"),
        "planner": {"kind": "synthetic"},
        "controller": {"kind": "hierarchical", "rate_hz": 1.0 / CONTROL_PERIOD},
        "estimator": {"kind": "truth"},
        "scenario": {"name": "plank", "terrain": list(terrain)},
        "seed": 0,
    }
    attachments = {
        "config.yaml": ("text/yaml", yaml.safe_dump(config).encode()),
        "robot.urdf": ("application/xml", load_urdf_text(description).encode()),
    }
    with TrialRecorder(
        directory / "trial.mcap",
        log_config(wall_times=wall_times),
        level_names=LEVELS,
        plan=plan,
        geoms=geoms(),
        attachments=attachments,
        metadata={**METADATA, "robot": robot, "gait": "trot"},
    ) as recorder:
        for index, tick in enumerate(ticks):
            recorder.record(tick, body_poses(index))
    return directory
