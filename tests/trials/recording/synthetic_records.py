"""Records, a plan and a robot of boxes that no physics produced, for tests of the log."""

from pathlib import Path

import numpy as np

from quadlab.controllers.telemetry import ControlTelemetry, LegMode
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.plan import MotionPlan, PlanReport, PlanVerdict
from quadlab.robots.legs import LEGS
from quadlab.robots.state import JointCommand, RobotState
from quadlab.simulation.geom_description import GeomDescription
from quadlab.trials.recording.config import LogConfig
from quadlab.trials.recording.record import BodyPoses, TickRecord
from quadlab.trials.recording.recorder import TrialRecorder, part_path

CONTROL_PERIOD = 0.0025  # [s]
LEVELS = ("torque", "friction", "swing", "torso", "forces")
BODIES = ("base", *(f"{leg}_{link}" for leg in LEGS for link in ("HIP", "THIGH", "SHANK")))
ATTACHMENTS = {"config.yaml": ("text/yaml", b"robot: box\n"), "manifest.json": ("application/json", b"{}")}
METADATA = {"trial_id": "0123456789abcdef", "robot": "box"}
PUSHED = range(10, 20)  # ticks


class InterruptedTrialError(Exception):
    """What goes wrong in ``write_interrupted_log``."""


def log_config(*, wall_times: bool = True, chunk_size_kib: int = 16) -> LogConfig:
    return LogConfig(scene_rate_hz=50.0, chunk_size_kib=chunk_size_kib, wall_times=wall_times)


def tick_record(index: int, *, wall_time_us: float = 100.0) -> TickRecord:
    random = np.random.default_rng(index)
    time_s = index * CONTROL_PERIOD
    state = RobotState(
        time_s=time_s,
        position_base_in_world=random.normal(size=3),
        quat_wxyz=_unit(random.normal(size=4)),
        joint_positions=random.normal(size=12),
        linear_velocity_base_in_world=random.normal(size=3),
        angular_velocity_base_in_base=random.normal(size=3),
        joint_velocities=random.normal(size=12),
        foot_forces_in_world=100.0 * random.uniform(size=(4, 3)),
    )
    pushes = ((random.normal(size=3), np.array([0.0, 150.0, 0.0])),) if index in PUSHED else ()
    return TickRecord(state, JointCommand(random.normal(size=12)), _telemetry(index, random, wall_time_us), pushes)


def body_poses(index: int) -> BodyPoses:
    random = np.random.default_rng(1000 + index)
    quats = np.array([_unit(random.normal(size=4)) for _ in BODIES])
    return BodyPoses(BODIES, random.normal(size=(len(BODIES), 3)), quats)


def motion_plan() -> MotionPlan:
    contacts = np.array([[True] * 4, [False, True, True, False], [True] * 4])
    knots = np.array([0.0, 0.5, 1.0])
    random = np.random.default_rng(7)
    com, heading, cop = (PiecewisePolynomial(knots, random.normal(size=(2, 4, d))) for d in (3, 1, 2))
    return MotionPlan(
        schedule=ContactSchedule(np.array([0.3, 0.4, 0.3]), contacts),
        com=com,
        heading=heading,
        cop=cop,
        footholds=tuple(random.normal(size=(1 + (not contacts[1, leg]), 3)) for leg in range(4)),
        report=PlanReport("synthetic", build_ms=1.0, solve_ms=2.0, iterations=3, variables=4, constraints=5),
        verdict=PlanVerdict(values={"com_jump_m": 0.0}, tolerances={"com_jump_m": 1e-6}),
    )


def geoms() -> list[GeomDescription]:
    origin, upright, grey = np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), (0.5, 0.5, 0.5, 1.0)
    tetrahedron = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    return [
        GeomDescription("world", "plane", origin, upright, np.zeros(3), grey),
        GeomDescription("world", "box", np.array([0.5, 0.0, 0.0]), upright, np.array([0.1, 0.5, 0.03]), grey),
        GeomDescription("base", "box", origin, upright, np.array([0.3, 0.15, 0.1]), grey),
        GeomDescription("base", "mesh", origin, upright, np.zeros(3), grey, tetrahedron, faces),
        GeomDescription("LF_THIGH", "capsule", origin, upright, np.array([0.02, 0.1, 0.0]), grey),
        GeomDescription("LF_SHANK", "cylinder", origin, upright, np.array([0.02, 0.1, 0.0]), grey),
        GeomDescription("LF_SHANK", "sphere", np.array([0.0, 0.0, -0.1]), upright, np.array([0.03, 0.0, 0.0]), grey),
    ]


def recorder(path: Path, config: LogConfig, levels: tuple[str, ...] = LEVELS) -> TrialRecorder:
    return TrialRecorder(
        path,
        config,
        level_names=levels,
        plan=motion_plan(),
        geoms=geoms(),
        attachments=ATTACHMENTS,
        metadata=METADATA,
    )


def write_log(path: Path, ticks: int = 200, config: LogConfig | None = None, wall_time_us: float = 100.0) -> Path:
    with recorder(path, config or log_config()) as log:
        for index in range(ticks):
            log.record(tick_record(index, wall_time_us=wall_time_us), body_poses(index))
    return path


def write_interrupted_log(path: Path, ticks: int) -> Path:
    """Return the part file of a trial that raised after ``ticks`` ticks."""
    try:
        with recorder(path, log_config()) as log:
            for index in range(ticks):
                log.record(tick_record(index), body_poses(index))
            raise InterruptedTrialError
    except InterruptedTrialError:
        return part_path(path)


def _telemetry(index: int, random: np.random.Generator, wall_time_us: float) -> ControlTelemetry:
    return ControlTelemetry(
        plan_time_s=index * CONTROL_PERIOD,
        plan_pose_in_world=random.normal(size=3),
        com_position=random.normal(size=3),
        com_velocity=random.normal(size=3),
        com_position_reference=random.normal(size=3),
        com_velocity_reference=random.normal(size=3),
        base_height_reference=0.5,
        base_rpy_reference=random.normal(size=3),
        cop_reference=random.normal(size=2),
        terrain_plane=random.normal(size=3),
        foot_positions=random.normal(size=(4, 3)),
        foot_position_references=np.where(np.arange(4)[:, None] % 3, np.nan, random.normal(size=(4, 3))),
        foot_contact_velocities=random.normal(size=(4, 3)),
        leg_modes=(LegMode.SWING, LegMode.STANCE, LegMode.STANCE, LegMode.SEARCH),
        planned_contacts=np.array([False, True, True, False]),
        contact_forces_desired=random.normal(size=(4, 3)),
        torques_desired=random.normal(size=12),
        level_residuals={level: float(random.uniform()) for level in LEVELS},
        solver_iterations=index,
        fallbacks=index // 100,
        model_us=wall_time_us,
        reference_us=2.0 * wall_time_us,
        solve_us=3.0 * wall_time_us,
        events=(f"LF late touch-down {index}",) if index % 50 == 7 else (),
    )


def _unit(vector: np.ndarray) -> np.ndarray:
    unit: np.ndarray = vector / np.linalg.norm(vector)
    return unit
