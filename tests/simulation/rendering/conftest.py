"""Fixtures of the rendering tests."""

import pytest
from rendering_cases import trot_in_place

from quadlab.errors import MissingDependencyError
from quadlab.robots.catalogue import robot_config
from quadlab.robots.model import RobotModel, load_robot
from quadlab.simulation.rendering.motion import Motion
from quadlab.simulation.rendering.offscreen import create_context


@pytest.fixture
def requires_egl() -> None:
    try:
        context = create_context(16, 16)
    except MissingDependencyError as error:
        pytest.skip(str(error))
    context.free()


@pytest.fixture(scope="session")
def anymal() -> RobotModel:
    return load_robot(robot_config("anymal_b"))


@pytest.fixture(scope="session")
def motion(anymal: RobotModel) -> Motion:
    return trot_in_place(anymal, duration_s=1.0)
