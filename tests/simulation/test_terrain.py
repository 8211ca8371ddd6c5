"""The ground is as high as its configuration says, everywhere along the way."""

import math
from typing import Any

import mujoco
import numpy as np
import pytest

from quadlab.errors import ConfigurationError
from quadlab.robots.catalogue import robot_config
from quadlab.robots.model import load_robot
from quadlab.simulation.model_builder import build_spec
from quadlab.simulation.terrain import PlankConfig, SlopeConfig, StepConfig, TerrainConfig, build_ground

PLANK = PlankConfig(kind="plank", center_x_m=1.0, center_y_m=0.5, length_m=0.2, width_m=1.0, height_m=0.05, yaw_deg=0.0)
STEP_UP = StepConfig(kind="step", edge_x_m=1.5, height_m=0.1)
STEP_DOWN = StepConfig(kind="step", edge_x_m=1.5, height_m=-0.14)
RAMP_UP = SlopeConfig(kind="slope", start_x_m=1.0, length_m=2.0, angle_deg=10.0, width_m=4.0)
RAMP_DOWN = SlopeConfig(kind="slope", start_x_m=1.0, length_m=2.0, angle_deg=-10.0, width_m=4.0)


def heights(*terrain: TerrainConfig) -> Any:
    """Return a function that probes the height of the ground from above, with the robot moved out of the way."""
    spec = build_spec(load_robot(robot_config("anymal_b")), build_ground(terrain), 0.8, 0.001)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[2] = 100.0
    mujoco.mj_forward(model, data)

    def height(x: float, y: float) -> float:
        start = np.array([x, y, 10.0])
        found = np.array([-1], dtype=np.int32)
        return 10.0 - float(mujoco.mj_ray(model, data, start, np.array([0.0, 0.0, -1.0]), None, 1, -1, found))

    return height


@pytest.mark.parametrize("terrain", [(), (PLANK,), (STEP_UP,), (STEP_DOWN,), (RAMP_UP,), (RAMP_DOWN,)])
def test_the_robot_starts_on_level_ground_at_zero(terrain: tuple[TerrainConfig, ...]) -> None:
    height = heights(*terrain)
    for x in (-3.0, -0.5, 0.0, 0.5):
        for y in (-0.4, 0.0, 0.4):
            assert height(x, y) == pytest.approx(0.0, abs=1e-9)


def test_plank() -> None:
    height = heights(PLANK)
    assert height(1.0, 0.5) == pytest.approx(0.05)
    assert height(1.09, 0.95) == pytest.approx(0.05)
    assert height(1.11, 0.5) == pytest.approx(0.0)
    assert height(1.0, -0.05) == pytest.approx(0.0)


def test_turned_plank_lies_along_y() -> None:
    height = heights(PLANK.model_copy(update={"yaw_deg": 90.0}))
    assert height(1.45, 0.5) == pytest.approx(0.05)
    assert height(1.0, 0.65) == pytest.approx(0.0)


@pytest.mark.parametrize("step", [STEP_UP, STEP_DOWN])
def test_step(step: StepConfig) -> None:
    height = heights(step)
    assert height(1.49, 0.0) == pytest.approx(0.0, abs=1e-9)
    assert height(1.51, 0.0) == pytest.approx(step.height_m)
    assert height(6.0, 3.0) == pytest.approx(step.height_m)


@pytest.mark.parametrize("slope", [RAMP_UP, RAMP_DOWN])
def test_slope(slope: SlopeConfig) -> None:
    height = heights(slope)
    gradient = math.tan(math.radians(slope.angle_deg))
    for x in (1.01, 1.5, 2.5, 2.99):
        assert height(x, 0.3) == pytest.approx(gradient * (x - 1.0), abs=1e-9)
    assert height(3.5, 0.0) == pytest.approx(gradient * 2.0, abs=1e-9)


def test_plank_on_ground_above_a_step_down() -> None:
    height = heights(PLANK, STEP_DOWN)
    assert height(1.0, 0.5) == pytest.approx(0.05)
    assert height(1.3, 0.5) == pytest.approx(0.0, abs=1e-9)
    assert height(1.7, 0.5) == pytest.approx(-0.14)


def test_two_descents_are_refused() -> None:
    with pytest.raises(ConfigurationError, match="at most one piece may lead below z = 0; got 2: step, slope"):
        build_ground((STEP_DOWN, RAMP_DOWN))


def test_terrain_decides_friction_and_stiffness() -> None:
    model = build_spec(load_robot(robot_config("anymal_b")), build_ground((PLANK,)), 0.35, 0.001).compile()
    for name in ("floor", "terrain_0"):
        assert model.geom(name).friction[0] == 0.35
        assert model.geom(name).priority[0] == 1
