"""How far the legs of a kept trial reach, beside the limit of Bellicoso 2016, Eq. (35)."""

from dataclasses import replace

import numpy as np
import pandas as pd
import yaml

from quadlab.geometry.rotations import Array
from quadlab.paths import CONF_DIR
from quadlab.robots.catalogue import robot_config
from quadlab.robots.legs import JOINT_NAMES

ROBOT = "anymal_b"


def limb_extensions(trace: pd.DataFrame) -> Array:
    """Return the height of the hips over their feet at each row of a trace, (n, 4) in [m], order ``LEGS``.

    Args:
        trace: with pose of the base and joint positions of the table ``state``.
    """
    from quadlab.robots.model import load_robot  # noqa: PLC0415 - loads the robot's physics

    robot = load_robot(robot_config(ROBOT))
    positions, quats, joints = (
        trace[[f"state.{name}" for name in names]].to_numpy(float)
        for names in (
            [f"base_position_{axis}" for axis in "xyz"],
            [f"base_quat_{part}" for part in "wxyz"],
            [f"joint_position_{joint}" for joint in JOINT_NAMES],
        )
    )
    nominal = robot.nominal_state()
    found = []
    for position, quat, angles in zip(positions, quats, joints, strict=True):
        state = replace(nominal, position_base_in_world=position, quat_wxyz=quat, joint_positions=angles)
        kinematics = robot.kinematics(state)
        found.append(kinematics.hip_positions[:, 2] - kinematics.foot_positions[:, 2])
    return np.array(found)


def extension_limit(controller: str) -> float:
    """Return the largest height of a hip over its foot in [m] that the levels of ``conf/controller/`` allow."""
    from quadlab.robots.model import load_robot  # noqa: PLC0415 - loads the robot's physics

    text = (CONF_DIR / "controller" / f"{controller}.yaml").read_text(encoding="utf-8")
    tasks = [task for level in yaml.safe_load(text)["levels"] for task in level["tasks"]]
    share = next(task["maximum"] for task in tasks if task["task"] == "limb_extension")
    return float(share) * float(load_robot(robot_config(ROBOT)).nominal_state().position_base_in_world[2])
