"""Fixtures of the tests of controllers."""

import pytest
from controller_cases import ROBOTS, robot_named

from quadlab.robots.model import RobotModel


@pytest.fixture(params=ROBOTS)
def robot(request: pytest.FixtureRequest) -> RobotModel:
    return robot_named(request.param)
