"""Collects what one tick did into its telemetry."""

import numpy as np

from quadlab.controllers.resolver import Resolution
from quadlab.controllers.telemetry import ControlTelemetry
from quadlab.controllers.tracking.tracker import TrackedTick
from quadlab.geometry.rotations import euler_zyx
from quadlab.robots.kinematics import Kinematics


def describe_tick(
    tracked: TrackedTick,
    kinematics: Kinematics,
    resolution: Resolution,
    *,
    fallbacks: int,
    timings_us: tuple[float, float, float],
) -> ControlTelemetry:
    """Return the telemetry of a tick.

    The reference of the CoM is that of the tasks in x and y; its height is that of the base's reference, with the CoM
    as far from the base as measured, and its vertical velocity is zero also where the ground rises.

    Args:
        tracked: what the tracker asked for.
        kinematics: measured.
        resolution: what the controller commands.
        fallbacks: counted so far.
        timings_us: model, reference and solve in [us].
    """
    reference = tracked.reference
    yaw, pitch, roll = euler_zyx(reference.base_rotation)
    height_of_com_over_base = float(kinematics.com_position[2] - kinematics.base_position[2])
    (x, y), (velocity_x, velocity_y) = reference.com_position.tolist(), reference.com_velocity.tolist()
    return ControlTelemetry(
        plan_time_s=tracked.plan_time_s,
        plan_pose_in_world=tracked.plan_pose_in_world,
        com_position=kinematics.com_position,
        com_velocity=kinematics.com_velocity,
        com_position_reference=np.array([x, y, reference.base_height + height_of_com_over_base]),
        com_velocity_reference=np.array([velocity_x, velocity_y, 0.0]),
        base_height_reference=reference.base_height,
        base_rpy_reference=np.array([roll, pitch, yaw]),
        cop_reference=tracked.torso_alignment.position(tracked.sample.cop),
        terrain_plane=np.array([tracked.terrain.height, *tracked.terrain.slope]),
        foot_positions=kinematics.foot_positions,
        foot_position_references=reference.foot_positions,
        foot_contact_velocities=kinematics.contact_jacobians @ kinematics.generalized_velocity,
        leg_modes=tracked.modes,
        planned_contacts=tracked.sample.contacts,
        contact_forces_desired=resolution.contact_forces,
        torques_desired=resolution.torques,
        level_residuals=resolution.residuals,
        solver_iterations=resolution.iterations,
        fallbacks=fallbacks,
        model_us=timings_us[0],
        reference_us=timings_us[1],
        solve_us=timings_us[2],
        certificate=resolution.certificate,
        events=tracked.events if resolution.solved else (*tracked.events, _not_solved(resolution, fallbacks)),
    )


def _not_solved(resolution: Resolution, fallbacks: int) -> str:
    return f"tick not solved, the last torques are kept ({fallbacks} so far): {resolution.reason}"
