"""The named scalars of the log: which columns each topic has and where in a tick their values are found."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from quadlab.errors import LogError
from quadlab.estimation.estimate import Estimate, FilterReport
from quadlab.geometry.rotations import euler_zyx
from quadlab.robots.legs import JOINT_NAMES, LEGS
from quadlab.trials.recording.packed_message import FieldType
from quadlab.trials.recording.record import TickRecord

XY, XYZ, WXYZ = ("x", "y"), ("x", "y", "z"), ("w", "x", "y", "z")
ROLL_PITCH_YAW = ("roll", "pitch", "yaw")
LEGS_XYZ = tuple(f"{leg}_{axis}" for leg in LEGS for axis in XYZ)


@dataclass(frozen=True)
class Block:
    """Neighbouring columns of one quantity.

    Attributes:
        name: common start of the column names.
        components: ends of the column names; none for a scalar.
        value: the numbers of a tick, as many as there are columns.
        type: how they are stored.
    """

    name: str
    components: tuple[str, ...]
    value: Callable[[TickRecord], ArrayLike]
    type: FieldType = FieldType.FLOAT

    @property
    def columns(self) -> tuple[str, ...]:
        """Full names of the columns."""
        return tuple(f"{self.name}_{part}" for part in self.components) or (self.name,)


def _total_push(tick: TickRecord) -> ArrayLike:
    return np.sum([force for _, force in tick.pushes], axis=0) if tick.pushes else 0.0


def _base_height(tick: TickRecord) -> float:
    return float(tick.state.position_base_in_world[2])


def _state(name: str, components: tuple[str, ...], value: Callable[[TickRecord], ArrayLike]) -> Block:
    return Block(name, components, value, FieldType.DOUBLE)


STATE_BLOCKS = (
    _state("time_s", (), lambda tick: tick.state.time_s),
    _state("base_position", XYZ, lambda tick: tick.state.position_base_in_world),
    _state("base_quat", WXYZ, lambda tick: tick.state.quat_wxyz),
    _state("base_linear_velocity_in_world", XYZ, lambda tick: tick.state.linear_velocity_base_in_world),
    _state("base_angular_velocity_in_base", XYZ, lambda tick: tick.state.angular_velocity_base_in_base),
    _state("joint_position", JOINT_NAMES, lambda tick: tick.state.joint_positions),
    _state("joint_velocity", JOINT_NAMES, lambda tick: tick.state.joint_velocities),
    _state("joint_torque", JOINT_NAMES, lambda tick: tick.command.torques),
    _state("foot_force", LEGS_XYZ, lambda tick: tick.state.foot_forces_in_world.ravel()),
    _state("push_force", XYZ, _total_push),
)
"""Topic /state: SI units, world components unless the name says otherwise; torques are the applied ones."""


def _estimate(tick: TickRecord) -> Estimate:
    if tick.estimate is None:
        raise LogError("a log of estimates needs the estimate of every tick")
    return tick.estimate


def _filter(tick: TickRecord) -> FilterReport:
    report = _estimate(tick).report
    if report is None:
        raise LogError("a log of estimates needs the filter's report of every tick")
    return report


ESTIMATE_BLOCKS = (
    _state("base_position", XYZ, lambda tick: _estimate(tick).state.position_base_in_world),
    _state("base_quat", WXYZ, lambda tick: _estimate(tick).state.quat_wxyz),
    _state("base_linear_velocity_in_world", XYZ, lambda tick: _estimate(tick).state.linear_velocity_base_in_world),
    _state("base_angular_velocity_in_base", XYZ, lambda tick: _estimate(tick).state.angular_velocity_base_in_base),
    Block("joint_position", JOINT_NAMES, lambda tick: _estimate(tick).state.joint_positions),
    Block("joint_velocity", JOINT_NAMES, lambda tick: _estimate(tick).state.joint_velocities),
    Block("foot_force", LEGS_XYZ, lambda tick: _estimate(tick).state.foot_forces_in_world.ravel()),
    Block("accelerometer_bias", XYZ, lambda tick: _filter(tick).accelerometer_bias),
    Block("gyro_bias", XYZ, lambda tick: _filter(tick).gyro_bias),
    Block("base_position_std", XYZ, lambda tick: _filter(tick).position_std),
    Block("base_velocity_std", XYZ, lambda tick: _filter(tick).velocity_std),
    Block("base_orientation_std", XYZ, lambda tick: _filter(tick).orientation_std),
    Block("contact", LEGS, lambda tick: _filter(tick).contacts, FieldType.FIXED32),
    Block("foot_used", LEGS, lambda tick: _filter(tick).used, FieldType.FIXED32),
    Block("innovation_squared", (), lambda tick: _filter(tick).innovation_squared),
    Block("innovation_size", (), lambda tick: _filter(tick).innovation_size, FieldType.FIXED32),
    Block("outliers", (), lambda tick: _filter(tick).outliers, FieldType.FIXED32),
)
"""Topic /estimate: what the controller was given in place of /state, and what the filter says about it."""

CONTROL_BLOCKS = (
    Block("plan_time_s", (), lambda tick: tick.telemetry.plan_time_s),
    Block("plan_pose", ("x", "y", "yaw"), lambda tick: tick.telemetry.plan_pose_in_world),
    Block("com", XYZ, lambda tick: tick.telemetry.com_position),
    Block("com_reference", XYZ, lambda tick: tick.telemetry.com_position_reference),
    Block("com_error", XYZ, lambda tick: tick.telemetry.com_position - tick.telemetry.com_position_reference),
    Block("com_velocity", XYZ, lambda tick: tick.telemetry.com_velocity),
    Block("com_velocity_reference", XYZ, lambda tick: tick.telemetry.com_velocity_reference),
    Block("base_height_reference", (), lambda tick: tick.telemetry.base_height_reference),
    Block("base_height_error", (), lambda tick: _base_height(tick) - tick.telemetry.base_height_reference),
    Block("base", ROLL_PITCH_YAW, lambda tick: euler_zyx(tick.state.rotation_base_to_world)[::-1]),
    Block("base_reference", ROLL_PITCH_YAW, lambda tick: tick.telemetry.base_rpy_reference),
    Block("cop_reference", XY, lambda tick: tick.telemetry.cop_reference),
    Block("terrain_plane", ("a", "b", "c"), lambda tick: tick.telemetry.terrain_plane),
    Block("foot_position", LEGS_XYZ, lambda tick: tick.telemetry.foot_positions.ravel()),
    Block("foot_position_reference", LEGS_XYZ, lambda tick: tick.telemetry.foot_position_references.ravel()),
    Block("foot_contact_velocity", LEGS_XYZ, lambda tick: tick.telemetry.foot_contact_velocities.ravel()),
    Block("contact_force_desired", LEGS_XYZ, lambda tick: tick.telemetry.contact_forces_desired.ravel()),
    Block("torque_desired", JOINT_NAMES, lambda tick: tick.telemetry.torques_desired),
    Block("leg_mode", LEGS, lambda tick: tick.telemetry.leg_modes, FieldType.FIXED32),
    Block("planned_contact", LEGS, lambda tick: tick.telemetry.planned_contacts, FieldType.FIXED32),
    Block("solver_iterations", (), lambda tick: tick.telemetry.solver_iterations, FieldType.FIXED32),
    Block("fallbacks", (), lambda tick: tick.telemetry.fallbacks, FieldType.FIXED32),
    Block("certificate", (), lambda tick: tick.telemetry.certificate),
)
"""Topic /control: what the controller wanted; world components; errors are measured minus reference."""

TIMING_BLOCKS = (
    Block("model_us", (), lambda tick: tick.telemetry.model_us),
    Block("reference_us", (), lambda tick: tick.telemetry.reference_us),
    Block("solve_us", (), lambda tick: tick.telemetry.solve_us),
    Block("tick_us", (), lambda tick: tick.telemetry.tick_us),
)
"""Topic /timing: computing time, the only numbers of a log that differ between two runs."""


def level_blocks(level_names: Sequence[str]) -> tuple[Block, ...]:
    """Return the blocks of /wbc_levels: the residual of each level of the controller; NaN if a tick has none.

    Raises:
        LogError: if two levels have the same column name.
    """
    columns = [level_column(name) for name in level_names]
    if len(set(columns)) != len(columns):
        raise LogError(f"levels need different column names; have {', '.join(columns)}")
    return tuple(Block(column, (), _residual_of(name)) for column, name in zip(columns, level_names, strict=True))


def level_column(level_name: str) -> str:
    """Return ``level_name`` as a protobuf field name: letters, digits and underscores, a letter first."""
    column = re.sub(r"\W+", "_", level_name, flags=re.ASCII).strip("_")
    return column if column[:1].isalpha() else f"level_{column}"


def _residual_of(level_name: str) -> Callable[[TickRecord], float]:
    return lambda tick: tick.telemetry.level_residuals.get(level_name, np.nan)
