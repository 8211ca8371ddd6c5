"""What a trial amounts to in numbers: on ticks whose answer is known, and computed again from a log."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from synthetic_records import CONTROL_PERIOD
from tick_cases import FOOT_FORCES, HEIGHT_M, exact_telemetry, still_state, turned

from quadlab.analysis.log_reader import read_log
from quadlab.analysis.trial_log import vectors
from quadlab.constants import GRAVITY
from quadlab.controllers.telemetry import ControlTelemetry, LegMode
from quadlab.robots.model import load_robot
from quadlab.robots.state import JointCommand, RobotState
from quadlab.trials.compose import compose_trial
from quadlab.trials.config import RunOptions
from quadlab.trials.job import run_job
from quadlab.trials.metrics import TrialMetrics
from quadlab.trials.progress import SilentProgress

LIMITS = np.full(12, 40.0)  # [N m]
STANDING, SWINGING = (LegMode.STANCE,) * 4, (LegMode.SWING, *(LegMode.STANCE,) * 3)


def summary(
    states: Sequence[RobotState],
    telemetry: Sequence[ControlTelemetry] | None = None,
    torques: Sequence[np.ndarray] | None = None,
    limit_names: tuple[str, ...] = (),
) -> dict[str, Any]:
    """Metrics of ticks without error and torque but for what is given."""
    metrics = TrialMetrics(30.0, LIMITS, CONTROL_PERIOD, limit_names)
    for index, state in enumerate(states):
        told = telemetry[index] if telemetry else exact_telemetry()
        command = JointCommand(torques[index] if torques else np.zeros(12))
        metrics.add(state, command, told, state.position_base_in_world)
    return metrics.summary()


def still(count: int) -> list[RobotState]:
    return [still_state(index) for index in range(count)]


def test_robot_that_stands_as_planned_has_no_error() -> None:
    found = summary(still(3))
    errors = ("com_error_rms_mm", "com_error_max_mm", "base_height_rms_mm", "roll_pitch_rms_deg", "foot_slip_max_mm")
    assert [found[name] for name in errors] == [0.0] * len(errors)
    assert found["survived_s"] == pytest.approx(3 * CONTROL_PERIOD)
    assert found["cost_of_transport"] is None
    assert summary([]) == {}


def test_error_of_the_com_is_horizontal() -> None:
    told = [exact_telemetry(com_position=np.array([x, y, 0.1])) for x, y in ((0.0, 0.0), (0.003, -0.004))]
    found = summary(still(2), told)
    assert found["com_error_max_mm"] == pytest.approx(5.0)
    assert found["com_error_rms_mm"] == pytest.approx(5.0 / math.sqrt(2.0))


def test_height_is_judged_by_the_reference_of_its_tick() -> None:
    told = [exact_telemetry(base_height_reference=HEIGHT_M + rise) for rise in (0.0, 0.01)]
    assert summary(still(2), told)["base_height_rms_mm"] == pytest.approx(10.0 / math.sqrt(2.0))


@pytest.mark.parametrize(
    ("measured", "reference", "error_rad"),
    [
        ((2.0, -0.2, 0.1), (2.0, -0.2, 0.1), 0.0),
        ((0.3, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0),  # heading does not count
        ((2.0, 0.1, 0.0), (2.0, 0.0, 0.0), 0.1),
        ((-1.0, 0.0, 0.1), (-1.0, 0.0, -0.1), 0.2),
    ],
    ids=str,
)
def test_roll_and_pitch_are_told_apart_from_heading(
    measured: tuple[float, float, float], reference: tuple[float, float, float], error_rad: float
) -> None:
    """Both given as yaw, pitch and roll."""
    told = exact_telemetry(base_rpy_reference=np.array(reference[::-1]))
    found = summary([still_state(quat_wxyz=turned(*measured))], [told])
    assert found["roll_pitch_rms_deg"] == pytest.approx(math.degrees(error_rad), abs=1e-9)


def slip_mm(spells: Sequence[tuple[int, tuple[LegMode, ...], bool]]) -> float:
    """Slip of LF at 0.2 m/s over ``spells`` of (ticks, modes of the legs, whether LF is loaded)."""
    velocities = np.zeros((4, 3))
    velocities[0] = [0.12, -0.16, 5.0]  # [m/s]
    unloaded = FOOT_FORCES * np.array([0.0, 1.0, 1.0, 1.0])[:, None]
    ticks = [(modes, loaded) for count, modes, loaded in spells for _ in range(count)]
    states = [
        still_state(i, foot_forces_in_world=FOOT_FORCES if loaded else unloaded) for i, (_, loaded) in enumerate(ticks)
    ]
    told = [exact_telemetry(foot_contact_velocities=velocities, leg_modes=modes) for modes, _ in ticks]
    slip: float = summary(states, told)["foot_slip_max_mm"]
    return slip


def test_slip_is_the_longest_way_of_a_loaded_foot_in_one_stance() -> None:
    per_tick_mm = 1e3 * 0.2 * CONTROL_PERIOD
    assert slip_mm([(4, STANDING, True), (9, SWINGING, True), (6, STANDING, True)]) == pytest.approx(6 * per_tick_mm)
    assert slip_mm([(4, STANDING, True), (3, STANDING, False), (1, STANDING, True)]) == pytest.approx(5 * per_tick_mm)


def test_limit_is_reached_in_ticks_in_which_any_joint_reaches_it() -> None:
    torques = [np.zeros(12) for _ in range(4)]
    torques[1][3], torques[2][5] = -40.0, 39.0
    found = summary(still(4), torques=torques)
    assert found["torque_max_nm"] == 40.0
    assert found["torque_limit_share"] == 0.25


def test_speed_is_the_straight_way_over_the_time_upright() -> None:
    places = ([0.0, 0.0, 0.5], [9.0, 9.0, 0.5], [0.3, 0.4, 0.2])
    found = summary([still_state(i, position_base_in_world=np.array(place)) for i, place in enumerate(places)])
    assert found["distance_m"] == pytest.approx(0.5)
    assert found["mean_speed_mps"] == pytest.approx(0.5 / (3 * CONTROL_PERIOD))


def test_largest_unmet_limit_of_any_tick_is_kept() -> None:
    residuals = (
        {"torque": 0.0, "friction": 2.0},
        {"torque": math.nan, "friction": math.nan},
        {"torque": 1.0, "friction": 0.0},
    )
    told = [exact_telemetry(level_residuals=values) for values in residuals]
    assert summary(still(3), told, limit_names=("torque", "friction"))["limit_residual_max"] == 2.0
    assert summary(still(3), told, limit_names=("torque",))["limit_residual_max"] == 1.0
    assert summary(still(3), told)["limit_residual_max"] is None


def test_hash_tells_of_every_tick() -> None:
    moved = [*still(2), still_state(2, position_base_in_world=np.array([0.0, 0.0, HEIGHT_M + 1e-15]))]
    assert summary(still(3))["state_sha256"] == summary(still(3))["state_sha256"]
    assert len({summary(states)["state_sha256"] for states in (still(2), still(3), moved, moved[::-1])}) == 4


@pytest.mark.parametrize(("payload_kg", "torque_scale"), [(0.0, 1.0), (5.0, 0.9)])
def test_cost_of_transport_is_that_of_the_simulated_robot(
    tmp_path: Path, payload_kg: float, torque_scale: float
) -> None:
    """Which carries what the controller does not know of, with drives that give less than is asked for."""
    error = f"simulation.model_error.payload_kg={payload_kg}", f"simulation.model_error.torque_scale={torque_scale}"
    config = compose_trial(["gait=trot", "duration_s=2.5", *error])
    outcome = run_job(config, RunOptions(force=False, results_dir=str(tmp_path)), SilentProgress())
    assert outcome.result is not None
    state = read_log(outcome.directory / "trial.mcap").state
    power = torque_scale * np.abs(vectors(state, "joint_torque") * vectors(state, "joint_velocity"))
    mass, distance = load_robot(config.robot).mass + payload_kg, outcome.result.distance_m
    assert distance is not None
    expected = power.sum() / config.controller.rate_hz / (mass * GRAVITY * distance)
    assert outcome.result.cost_of_transport == pytest.approx(expected, rel=1e-6)
