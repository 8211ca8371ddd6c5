"""Controllers as the command line composes them."""

from functools import lru_cache
from typing import Any

import numpy as np
from controller_cases import disturbed_state, reference_at

from quadlab.configuration import part_of
from quadlab.controllers.level_solver import LevelledControllerConfig
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.resolver import Resolution, Resolver
from quadlab.geometry.rotations import Array
from quadlab.paths import CONF_DIR
from quadlab.robots.kinematics import Kinematics
from quadlab.robots.model import RobotModel
from quadlab.trials.compose import compose_trial

PRESETS = tuple(sorted(path.stem for path in (CONF_DIR / "controller").glob("*.yaml")))
FREE_HEIGHT = "bellicoso2016_manipulability"
"""The one whose base goes up or down by itself instead of staying where it is."""


@lru_cache
def preset(name: str, *overrides: str) -> Any:
    """The composed configuration of a controller, e.g. ``preset("weighted", "weights.forces=1.0e-6")``."""
    return compose_trial([f"controller={name}", *(f"controller.{override}" for override in overrides)]).controller


LEVELLED = tuple(name for name in PRESETS if isinstance(preset(name), LevelledControllerConfig))


def resolver_of(config: Any) -> Resolver:
    resolver: Any = part_of("controller", config)
    return resolver(config)  # type: ignore[no-any-return]


def near_rest(
    robot: RobotModel, stance: list[int], seed: int = 0, size: float = 0.3
) -> tuple[Kinematics, ControlReference]:
    """A slightly disturbed robot on the feet in ``stance``, asked to go on as it is."""
    kinematics = robot.kinematics(disturbed_state(robot, seed, size))
    return kinematics, reference_at(robot, kinematics, stance)


def resolved(config: Any, kinematics: Kinematics, reference: ControlReference) -> Resolution:
    return resolver_of(config).resolve(kinematics, reference, np.zeros(12))


def dynamics_residual(kinematics: Kinematics, resolution: Resolution) -> Array:
    """M u_dot + h - S^T tau - J^T lambda, (18,)."""
    residual: Array = kinematics.mass_matrix @ resolution.accelerations + kinematics.nonlinear_effects
    residual = residual - np.einsum("lij,li->j", kinematics.contact_jacobians, resolution.contact_forces)
    residual[6:] -= resolution.torques
    return residual
