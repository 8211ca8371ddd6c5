"""Filters, states and recorded motions shared by the tests of the estimator."""

import copy
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest.mock import patch

import numpy as np
import yaml

from quadlab.estimation.ekf import ExtendedKalmanFilter
from quadlab.estimation.error_state import FilterState
from quadlab.estimation.estimate import Estimate
from quadlab.geometry.rotations import Array, rotation_zyx
from quadlab.paths import CONF_DIR
from quadlab.robots.catalogue import robot_config
from quadlab.robots.model import RobotModel, load_robot
from quadlab.robots.state import JointCommand, RobotState
from quadlab.simulation.sensors import ImuSample, Sensors
from quadlab.trials.compose import compose_trial
from quadlab.trials.observer import Observer
from quadlab.trials.progress import SilentProgress
from quadlab.trials.result import TrialStatus
from quadlab.trials.runner import run_trial

PERIOD = 0.0025  # [s]

Tick = tuple[RobotState, ImuSample, JointCommand]
"""True state at the end of a control period, mean rates and torques in it."""


@lru_cache
def robot_named(name: str) -> RobotModel:
    return load_robot(robot_config(name))


def ekf_config(changes: dict[str, Any] | None = None, *, perfect: bool = False) -> ExtendedKalmanFilter.Config:
    """The shipped filter; ``changes`` by dotted key; ``perfect`` sensors and no initial error."""
    values = yaml.safe_load((CONF_DIR / "estimator" / "ekf.yaml").read_text())
    if perfect:
        values["sensors"] = _zeros(values["sensors"])
        values["initial"] = _zeros(values["initial"])
    for key, value in (changes or {}).items():
        *groups, name = key.split(".")
        group = values
        for part in groups:
            group = group[part]
        group[name] = value
    return ExtendedKalmanFilter.Config.model_validate(values)


def _zeros(values: dict[str, Any]) -> dict[str, Any]:
    return {key: _zeros(value) if isinstance(value, dict) else 0 for key, value in values.items()}


def any_filter_state(seed: int) -> FilterState:
    generator = np.random.default_rng(seed)
    return FilterState.of(
        position=generator.normal(size=3),
        velocity=generator.normal(size=3),
        rotation=rotation_zyx(*generator.uniform(-1.0, 1.0, 3)),
        feet=generator.normal(size=(4, 3)),
        accelerometer_bias=0.1 * generator.normal(size=3),
        gyro_bias=0.1 * generator.normal(size=3),
    )


def any_covariance(seed: int, size: float = 1e-2) -> Array:
    root = np.random.default_rng(seed).normal(size=(27, 27))
    covariance: Array = size**2 * (root @ root.T / 27 + np.eye(27))
    return covariance


@lru_cache
def recorded_motion(*overrides: str) -> tuple[Tick, ...]:
    """What the sensors of a trial that is controlled with the truth have to measure."""
    ticks: list[Tick] = []

    class RecordingObserver(Observer):
        """Keeps what passes by."""

        def observe(self, true_state: RobotState) -> Estimate:
            if not ticks or ticks[-1][0].time_s < true_state.time_s:
                torques = JointCommand(self._simulator.applied_torques.copy())
                ticks.append((true_state, self._simulator.imu(), torques))
            return super().observe(true_state)

    with patch("quadlab.trials.runner.Observer", RecordingObserver), TemporaryDirectory() as folder:
        result = run_trial(compose_trial(overrides), Path(folder), SilentProgress())
    assert result.status is TrialStatus.COMPLETED, result.status_reason
    return tuple(ticks)


@dataclass(frozen=True)
class Replay:
    """Truth, estimates and the filter's states and covariances of a recorded motion."""

    truth: tuple[RobotState, ...]
    estimates: tuple[Estimate, ...]
    states: tuple[FilterState, ...]
    covariances: tuple[Array, ...]
    sensors: Sensors


def replay(
    ticks: Sequence[Tick],
    config: ExtendedKalmanFilter.Config,
    seed: int,
    robot: str = "anymal_b",
    *,
    point_feet: bool = False,
) -> Replay:
    """``point_feet``: the filter takes the robot's feet for points that do not roll."""
    sensors = Sensors(config.sensors, PERIOD, seed)
    model = copy.copy(robot_named(robot))
    if point_feet:
        model.foot_radius = 0.0
    estimator = ExtendedKalmanFilter(config, model, PERIOD, seed)
    estimates: list[Estimate] = []
    states, covariances = [], []
    for state, imu, command in ticks:
        step = estimator.update if estimates else estimator.start
        estimates.append(step(partial(sensors.read, state, imu, command), state))
        states.append(estimator.state)
        covariances.append(copy.copy(estimator.covariance))
    return Replay(tuple(tick[0] for tick in ticks), tuple(estimates), tuple(states), tuple(covariances), sensors)
