"""From a robot and a ground to MuJoCo's model: kinematic tree from the URDF, inertias from Pinocchio."""

import xml.etree.ElementTree as ET
from typing import Any

import mujoco
import numpy as np

from quadlab.robots.config import foot_links_in_urdf
from quadlab.robots.model import RobotModel
from quadlab.simulation.collision import ROBOT_CONTACTS, TERRAIN_CONTACTS, add_collision_shapes
from quadlab.simulation.conventions import ACCELEROMETER, GYROSCOPE, foot_force_sensor, foot_geom
from quadlab.simulation.ground import Ground
from quadlab.simulation.links import link_placements

CONTACT_TIME_CONSTANT = 0.005  # [s]
CONTACT_DAMPING_RATIO = 1.0
FRICTION_IMPEDANCE_RATIO = 100.0
"""Stiff enough that feet neither sink nor creep: a standing robot moves by less than 0.1 mm in 5 s."""

TORSIONAL_FRICTION = 0.005  # [m]
ROLLING_FRICTION = 0.0001  # [m]

IMU_SITE = "imu"


def build_spec(robot: RobotModel, ground: Ground, friction: float, timestep_s: float) -> Any:
    """Return the ``mujoco.MjSpec`` of ``robot`` on ``ground``, ready to compile or to be given visual meshes.

    Args:
        robot: the robot.
        ground: floor and boxes.
        friction: Coulomb coefficient between robot and ground.
        timestep_s: of the physics in [s].
    """
    spec = _kinematic_tree(robot)
    _set_options(spec, timestep_s)
    _set_dynamics(spec, robot)
    carriers = {link: placement.body for link, placement in link_placements(robot).items()}
    add_collision_shapes(spec, robot, carriers)
    _add_feet(spec, robot)
    _add_motors(spec, robot)
    _add_imu(spec, robot)
    _add_ground(spec, ground, friction)
    return spec


def _kinematic_tree(robot: RobotModel) -> Any:
    """Return the URDF's links and joints without shapes and inertias, and with a free base."""
    root = ET.fromstring(robot.urdf_text)
    for link in root.findall("link"):
        for tag in ("visual", "collision", "inertial"):
            for element in link.findall(tag):
                link.remove(element)
    spec = mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))
    spec.modelname = robot.name
    spec.body(robot.config.base_link).add_freejoint(name="free_base")
    return spec


def _set_options(spec: Any, timestep_s: float) -> None:
    spec.compiler.fusestatic = True
    spec.compiler.discardvisual = False
    spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    option = spec.option
    option.timestep = timestep_s
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = FRICTION_IMPEDANCE_RATIO
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    # A state that blew up must stay visible as such, not be replaced by the initial state.
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET


def _set_dynamics(spec: Any, robot: RobotModel) -> None:
    """Give bodies and joints the inertias, rotor inertias and friction of the Pinocchio model."""
    model = robot.pin_model
    for joint_id in range(1, model.njoints):
        is_base = joint_id == 1
        joint = None if is_base else spec.joint(model.names[joint_id])
        body = spec.body(robot.config.base_link) if joint is None else joint.parent
        inertia = model.inertias[joint_id]
        matrix = inertia.inertia
        body.explicitinertial = True
        body.mass = inertia.mass
        body.ipos = inertia.lever
        body.fullinertia = [*np.diag(matrix), matrix[0, 1], matrix[0, 2], matrix[1, 2]]
        if joint is not None:
            joint.armature = float(model.armature[model.joints[joint_id].idx_v])
            # The motors clip the torque; a second clip at the joint would hide which one acted.
            joint.actfrclimited = False


def _add_feet(spec: Any, robot: RobotModel) -> None:
    """Add the spherical feet and the sensors of the ground's force on them."""
    for leg, link in enumerate(foot_links_in_urdf(robot.config)):
        spec.body(link).add_geom(
            name=foot_geom(leg),
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[robot.foot_radius, 0.0, 0.0],
            pos=list(robot.config.foot_center_m),
            contype=ROBOT_CONTACTS,
            conaffinity=TERRAIN_CONTACTS,
            mass=0.0,
            rgba=[0.1, 0.1, 0.1, 1.0],
        )
        sensor = spec.add_sensor(
            name=foot_force_sensor(leg),
            type=mujoco.mjtSensor.mjSENS_CONTACT,
            objtype=mujoco.mjtObj.mjOBJ_GEOM,
            objname=foot_geom(leg),
        )
        found, force = mujoco.mjtConDataField.mjCONDATA_FOUND, mujoco.mjtConDataField.mjCONDATA_FORCE
        net_force = 3  # reduces all contacts of the geom to one force in world axes
        sensor.intprm[0] = (1 << found.value) | (1 << force.value)
        sensor.intprm[1] = net_force
        sensor.intprm[2] = 1


def _add_motors(spec: Any, robot: RobotModel) -> None:
    for name, limit in zip(robot.joint_names, robot.torque_limits.tolist(), strict=True):
        motor = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        motor.set_to_motor()
        motor.ctrllimited = motor.forcelimited = True
        motor.ctrlrange = motor.forcerange = [-limit, limit]


def _add_imu(spec: Any, robot: RobotModel) -> None:
    """Add gyroscope and accelerometer at the base's origin, in base axes."""
    spec.body(robot.config.base_link).add_site(name=IMU_SITE)
    for name, sensor_type in (
        (GYROSCOPE, mujoco.mjtSensor.mjSENS_GYRO),
        (ACCELEROMETER, mujoco.mjtSensor.mjSENS_ACCELEROMETER),
    ):
        spec.add_sensor(name=name, type=sensor_type, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=IMU_SITE)


def _add_ground(spec: Any, ground: Ground, friction: float) -> None:
    """Add floor and boxes; their priority makes their friction and stiffness count instead of the robot's."""
    contact = {
        "contype": TERRAIN_CONTACTS,
        "conaffinity": ROBOT_CONTACTS,
        "condim": 3,
        "priority": 1,
        "friction": [friction, TORSIONAL_FRICTION, ROLLING_FRICTION],
        "solref": [CONTACT_TIME_CONSTANT, CONTACT_DAMPING_RATIO],
    }
    plane, box = mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_BOX
    floor = [0.0, 0.0, ground.floor_height]
    spec.worldbody.add_geom(name="floor", type=plane, size=[0.0, 0.0, 0.05], pos=floor, **contact)
    for piece in ground.boxes:
        spec.worldbody.add_geom(
            name=piece.name, type=box, size=piece.half_size, pos=piece.center, quat=piece.quat_wxyz, **contact
        )
