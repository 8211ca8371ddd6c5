"""Motions and scenarios for tests of rendering."""

from typing import Any

import numpy as np

from quadlab.robots.model import RobotModel
from quadlab.simulation.rendering.config import RenderConfig
from quadlab.simulation.rendering.motion import Motion
from quadlab.simulation.scenario import ScenarioConfig

SMALL = RenderConfig(width=160, height=100, fps=10.0, shadow_pixels=256, samples=0, mesh_cell_sizes=0.03, snapshots=3)

FLAT: dict[str, Any] = {
    "name": "flat",
    "friction": 0.8,
    "terrain": [],
    "pushes": [],
    "initial_perturbation": {
        "yaw_deg": 0.0,
        "pitch_deg": 0.0,
        "roll_deg": 0.0,
        "joint_rad": 0.0,
        "velocity_mps": 0.0,
    },
}


def scenario(**changes: Any) -> ScenarioConfig:
    return ScenarioConfig.model_validate(FLAT | changes)


def trot_in_place(robot: RobotModel, duration_s: float) -> Motion:
    nominal = robot.nominal_state()
    times_s = np.linspace(0.0, duration_s, int(duration_s * 100) + 1)
    count = len(times_s)
    joints = np.tile(nominal.joint_positions, (count, 1))
    joints[:, 1] += 0.2 * np.sin(2.0 * np.pi * times_s)
    return Motion(
        times_s,
        np.tile(nominal.position_base_in_world, (count, 1)),
        np.tile(nominal.quat_wxyz, (count, 1)),
        joints,
    )
