"""Orientation of the base, as yaw and as roll and pitch (Bellicoso 2016, Eq. 18, with three rotational rows)."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Literal

import numpy as np

from quadlab import geometry
from quadlab.configuration import register
from quadlab.controllers.reference import ControlReference
from quadlab.controllers.tasks.control_frame import Frame, FramedGains, write_turned_rows
from quadlab.controllers.tasks.gains import TrackingGains, tracking_target
from quadlab.controllers.tasks.task import TaskRows, Variable, empty_equation, equation
from quadlab.geometry.rotation_error import error_below_half_turn, rotation_error
from quadlab.geometry.rotations import Array
from quadlab.jit import compiled_entry, source_fingerprint
from quadlab.robots.kinematics import BASE_ANGULAR, VELOCITY_SIZE, Kinematics


def _write_angular_target(
    gains: TrackingGains, kinematics: Kinematics, reference: ControlReference, target: Array
) -> None:
    """Write what J_omega u_dot shall be in world axes, (3,) in [rad/s^2]; the error is R_ref boxminus R."""
    _target_below_half_turn(
        gains.proportional_per_s2,
        gains.derivative_per_s,
        reference.base_angular_acceleration,
        (reference.base_rotation, kinematics.base_rotation),
        (reference.base_angular_velocity, kinematics.base_angular_velocity),
        kinematics.base_bias,
        target,
    )
    if math.isnan(target[0]):
        error = rotation_error(reference.base_rotation, kinematics.base_rotation)
        velocity_error = reference.base_angular_velocity - kinematics.base_angular_velocity
        commanded = gains.acceleration(reference.base_angular_acceleration, velocity_error, error)
        target[:] = commanded - kinematics.base_bias[3:]


def _compile_target(fingerprint: int) -> Callable[..., None]:
    @compiled_entry
    def target_below_half_turn(
        proportional_per_s2: float,
        derivative_per_s: float,
        feed_forward: Array,
        rotations: tuple[Array, Array],
        velocities: tuple[Array, Array],
        base_bias: Array,
        target: Array,
    ) -> None:
        """Write the target of ``_write_angular_target``; NaN near half a turn. Pairs are reference and measured."""
        _ = fingerprint  # a closure variable, so that the cached machine code follows a change of what is called
        error = error_below_half_turn(rotations[0], rotations[1])
        errors = (error, np.zeros(3))
        tracking_target(proportional_per_s2, derivative_per_s, feed_forward, velocities, errors, base_bias[3:], target)

    return target_below_half_turn


_target_below_half_turn = _compile_target(
    source_fingerprint(Path(__file__).parent) ^ source_fingerprint(Path(geometry.__file__).parent)
)


@register("task", "base_yaw")
class BaseYawTask:
    """Rotation of the base about the vertical, or about the normal of the ground."""

    class Config(FramedGains):
        """Gains of the yaw motion."""

        task: Literal["base_yaw"]

    def __init__(self, config: Config) -> None:
        self.config = config
        self._target = np.empty(3)
        self._vertical_target = self._target[2:]
        self._turned = empty_equation(Variable.ACCELERATION, 1, VELOCITY_SIZE)

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return one row in accelerations."""
        _write_angular_target(self.config, kinematics, reference, self._target)
        if self.config.frame is Frame.CONTROL:
            _turn_into_control_frame(kinematics, reference, 2, self._target, self._turned)
            return self._turned
        return equation(Variable.ACCELERATION, kinematics.base_jacobian[5:], self._vertical_target)


@register("task", "base_roll_pitch")
class BaseRollPitchTask:
    """Rotation of the base about both horizontal axes of its heading frame, or heading and lateral of the ground."""

    class Config(FramedGains):
        """Gains of the roll and pitch motion."""

        task: Literal["base_roll_pitch"]

    def __init__(self, config: Config) -> None:
        self.config = config
        self._target = np.empty(3)
        self._rows = empty_equation(Variable.ACCELERATION, 2, VELOCITY_SIZE)

    def rows(self, kinematics: Kinematics, reference: ControlReference) -> TaskRows:
        """Return two rows in accelerations."""
        _write_angular_target(self.config, kinematics, reference, self._target)
        if self.config.frame is Frame.CONTROL:
            _turn_into_control_frame(kinematics, reference, 0, self._target, self._rows)
            return self._rows
        _turn_into_heading_frame(
            kinematics.base_rotation, kinematics.base_jacobian, self._target, self._rows.matrix, self._rows.upper
        )
        return self._rows


def _turn_into_control_frame(
    kinematics: Kinematics, reference: ControlReference, first: int, target: Array, rows: TaskRows
) -> None:
    """Write the rotation about the axes of the control frame from number ``first`` on to ``rows``."""
    jacobian = kinematics.base_jacobian[BASE_ANGULAR]
    write_turned_rows(reference.ground_axes, first, jacobian, target, (rows.matrix, rows.upper))


@compiled_entry
def _turn_into_heading_frame(rotation: Array, jacobian: Array, target: Array, matrix: Array, turned: Array) -> None:
    """Write the roll and pitch rows of ``jacobian``, (2, 18) of (6, 18), and of ``target``, (2,) of (3,)."""
    length = math.hypot(rotation[0, 0], rotation[1, 0])
    cosine, sine = rotation[0, 0] / length, rotation[1, 0] / length
    for column in range(jacobian.shape[1]):
        matrix[0, column] = cosine * jacobian[3, column] + sine * jacobian[4, column]
        matrix[1, column] = cosine * jacobian[4, column] - sine * jacobian[3, column]
    turned[0] = cosine * target[0] + sine * target[1]
    turned[1] = cosine * target[1] - sine * target[0]
