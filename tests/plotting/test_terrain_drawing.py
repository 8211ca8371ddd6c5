"""Heights under the feet are those of the ground that the simulator builds."""

import math
from typing import Any

import numpy as np
import pytest
from plotting_cases import PLANK
from pydantic import TypeAdapter

from quadlab.plotting.axes.terrain import ground_heights, ground_under_feet
from quadlab.simulation.ground import Ground
from quadlab.simulation.terrain import TerrainConfig, build_ground

STEP = {"kind": "step", "edge_x_m": 1.0, "height_m": -0.14}
SLOPE = {"kind": "slope", "start_x_m": 1.0, "length_m": 2.0, "angle_deg": 10.0, "width_m": 4.0}
TURNED = {**PLANK, "yaw_deg": 90.0}
RISE = 2.0 * math.tan(math.radians(10.0))


def _ground(*pieces: dict[str, Any]) -> Ground:
    return build_ground(TypeAdapter(tuple[TerrainConfig, ...]).validate_python(pieces))


@pytest.mark.parametrize(
    ("pieces", "point", "height"),
    [
        ([], (3.0, 2.0), 0.0),
        ([PLANK], (0.45, 0.4), 0.05),
        ([PLANK], (0.39, 0.0), 0.0),
        ([PLANK], (0.5, 0.51), 0.0),
        ([TURNED], (0.9, 0.05), 0.05),
        ([TURNED], (0.5, 0.4), 0.0),
        ([STEP], (0.99, 0.0), 0.0),
        ([STEP], (1.01, 0.0), -0.14),
        ([SLOPE], (0.5, 0.0), 0.0),
        ([SLOPE], (2.0, 0.0), 0.5 * RISE),
        ([SLOPE], (3.5, 0.0), RISE),
        ([PLANK, STEP], (0.5, 0.0), 0.05),
    ],
)
def test_height_of_the_ground(pieces: list[dict[str, Any]], point: tuple[float, float], height: float) -> None:
    assert ground_heights(_ground(*pieces), np.array([point]))[0] == pytest.approx(height, abs=1e-9)


def test_a_round_foot_stands_on_the_edge_beside_its_centre() -> None:
    ground, feet = _ground(PLANK), np.array([[0.39, 0.0], [0.36, 0.0]])
    np.testing.assert_allclose(ground_heights(ground, feet), 0.0)
    np.testing.assert_allclose(ground_under_feet(ground, feet, radius=0.03), [0.05, 0.0])
