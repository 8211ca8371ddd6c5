"""What the simulated robot is and the controller does not know: payload, wrong inertias, weak drives."""

from typing import Any

import numpy as np

from quadlab.configuration import NonNegative, Positive, StrictModel, Vector3
from quadlab.geometry.rotations import Array


class ModelErrorConfig(StrictModel):
    """How the simulated robot differs from its description; planner, controller and estimator use the description.

    Attributes:
        payload_kg: point mass fixed to the base in [kg].
        payload_position_m: of it in base axes from the base origin in [m].
        inertia_scale: factor on the rotational inertias of all links, masses apart.
        torque_scale: factor on the torques that the drives give; recorded and sensed torques are those asked for, as of
            drives that tell them from the current. The cost of transport counts what they give.
    """

    payload_kg: NonNegative
    payload_position_m: Vector3
    inertia_scale: Positive
    torque_scale: Positive


def apply_model_error(spec: Any, base_link: str, error: ModelErrorConfig) -> None:
    """Change a ``mujoco.MjSpec`` whose bodies have explicit inertias.

    Args:
        spec: to be changed.
        base_link: body that carries the payload.
        error: by how much.
    """
    for body in spec.bodies:
        if body.explicitinertial:
            body.fullinertia = error.inertia_scale * np.asarray(body.fullinertia)
    for motor in spec.actuators:
        motor.gainprm[0] *= error.torque_scale
    if error.payload_kg:
        _add_point_mass(spec.body(base_link), error.payload_kg, np.array(error.payload_position_m))


def _add_point_mass(body: Any, mass: float, position: Array) -> None:
    """Fuse a point mass at ``position``, (3,) in [m] in body axes, into the body's inertia."""
    total = body.mass + mass
    center = (body.mass * np.asarray(body.ipos) + mass * position) / total
    inertia = _full(np.asarray(body.fullinertia))
    inertia += _about(body.mass, np.asarray(body.ipos) - center) + _about(mass, position - center)
    body.mass, body.ipos = total, center
    body.fullinertia = [*np.diag(inertia), inertia[0, 1], inertia[0, 2], inertia[1, 2]]


def _full(six: Array) -> Array:
    """Return the symmetric matrix of xx, yy, zz, xy, xz, yz, (3, 3)."""
    xx, yy, zz, xy, xz, yz = six
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _about(mass: float, arm: Array) -> Array:
    """Return the inertia of a point mass at ``arm`` in [m] about the origin, (3, 3) in [kg m^2]."""
    return mass * (float(arm @ arm) * np.eye(3) - np.outer(arm, arm))
