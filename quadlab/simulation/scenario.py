"""What happens to the robot in a trial: ground, pushes and the initial state."""

from dataclasses import replace

import numpy as np

from quadlab.configuration import NonNegative, Positive, StrictModel
from quadlab.geometry.rotations import matrix_to_quat, rotation_zyx
from quadlab.robots.legs import JOINT_COUNT
from quadlab.robots.model import RobotModel
from quadlab.robots.state import RobotState
from quadlab.simulation.push import PushConfig
from quadlab.simulation.terrain import TerrainConfig


class InitialPerturbationConfig(StrictModel):
    """Half ranges of the uniform distributions from which a trial's seed draws the initial state.

    Attributes:
        yaw_deg, pitch_deg, roll_deg: of the base in [deg].
        joint_rad: of every joint angle in [rad].
        velocity_mps: of every component of the base's velocity in [m/s].
    """

    yaw_deg: NonNegative
    pitch_deg: NonNegative
    roll_deg: NonNegative
    joint_rad: NonNegative
    velocity_mps: NonNegative


class ScenarioConfig(StrictModel):
    """One scenario.

    Attributes:
        name: of the scenario.
        friction: Coulomb coefficient between robot and ground.
        terrain: pieces on the floor.
        pushes: in any number; they add up.
        initial_perturbation: how far the initial state may be from the nominal stance.
    """

    name: str
    friction: Positive
    terrain: tuple[TerrainConfig, ...]
    pushes: tuple[PushConfig, ...]
    initial_perturbation: InitialPerturbationConfig


def initial_state(robot: RobotModel, perturbation: InitialPerturbationConfig, seed: int) -> RobotState:
    """Return the nominal stance, perturbed by draws of ``seed``, with the lowest foot touching z = 0.

    The draws do not depend on the ranges, so that scenarios with equal seeds can be compared.
    """
    nominal = robot.nominal_state()
    generator = np.random.default_rng(seed)
    yaw, pitch, roll = generator.uniform(-1.0, 1.0, 3) * np.radians(
        [perturbation.yaw_deg, perturbation.pitch_deg, perturbation.roll_deg]
    )
    joint_offsets = perturbation.joint_rad * generator.uniform(-1.0, 1.0, JOINT_COUNT)
    velocity = perturbation.velocity_mps * generator.uniform(-1.0, 1.0, 3)
    lower, upper = robot.joint_position_limits.T
    state = replace(
        nominal,
        quat_wxyz=matrix_to_quat(rotation_zyx(yaw, pitch, roll)),
        joint_positions=np.clip(nominal.joint_positions + joint_offsets, lower, upper),
        linear_velocity_base_in_world=velocity,
    )
    lowest = float(robot.kinematics(state).foot_positions[:, 2].min())
    position = state.position_base_in_world - np.array([0.0, 0.0, lowest])
    return replace(state, position_base_in_world=position)
