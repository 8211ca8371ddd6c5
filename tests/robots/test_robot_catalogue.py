"""Every robot that comes with quadlab loads, and mistakes in a configuration are named."""

import numpy as np
import pytest

from quadlab.errors import RobotDescriptionError
from quadlab.robots.catalogue import robot_config, robot_names
from quadlab.robots.config import DescriptionOverrides, RobotConfig
from quadlab.robots.description import load_urdf_text
from quadlab.robots.model import load_robot


def test_the_papers_robots_are_in_the_catalogue() -> None:
    assert {"anymal_b", "hyq"} <= set(robot_names())


def test_masses_and_limits_of_the_papers() -> None:
    anymal, hyq = load_robot(robot_config("anymal_b")), load_robot(robot_config("hyq"))
    assert anymal.mass == pytest.approx(30.475, abs=1e-3)
    assert hyq.mass == pytest.approx(80.0, abs=1e-3)
    assert np.all(anymal.torque_limits == 40.0)
    assert np.all(hyq.torque_limits == 150.0)
    assert np.all(anymal.joint_velocity_limits == 15.0)


def test_unknown_robot_names_the_known_ones() -> None:
    with pytest.raises(RobotDescriptionError, match=r"unknown robot 'spot'; known: .*anymal_b.*hyq"):
        robot_config("spot")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"urdf": "hyq_description/robots/nothing.urdf"}, r"no URDF .*nearest: .*hyq_no_sensors\.urdf"),
        ({"base_link": "trunk"}, r"base_link 'trunk' is not the URDF's root link 'base_link'"),
        ({"foot_link": "{leg}_paw"}, r"no link 'lf_paw'; known: .*lf_foot"),
        ({"joints": ("{leg}_haa", "{leg}_hfe", "{leg}_kfe")}, r"no moving joint 'lf_haa'; known: .*lf_haa_joint"),
        ({"overrides": DescriptionOverrides(mass_kg={"body": 1.0})}, r"no link with mass 'body'; known: .*trunk"),
        ({"overrides": DescriptionOverrides(effort_nm={"knee": 1.0})}, r"no joint matches 'knee'; known: .*lf_kfe"),
    ],
)
def test_wrong_names_are_reported_with_what_exists(changes: dict[str, object], message: str) -> None:
    config = robot_config("hyq").model_copy(update=changes)
    with pytest.raises(RobotDescriptionError, match=message):
        load_robot(config)


def test_every_leg_must_be_named() -> None:
    values = robot_config("hyq").model_dump()
    del values["legs"]["LF"]
    with pytest.raises(ValueError, match="expected the legs LF, RF, LH, RH; got RF, LH, RH"):
        RobotConfig.model_validate(values)


def test_overrides_replace_values_of_the_urdf() -> None:
    overrides = DescriptionOverrides(
        mass_kg={"trunk": 10.0},
        effort_nm={"l._.*": 7.0},
        velocity_radps={".*": 3.0},
        position_rad={".*_hfe_.*": (-0.8, 0.9)},
        damping_nms={".*": 0.25},
    )
    base = robot_config("hyq")
    robot, original = load_robot(base.model_copy(update={"overrides": overrides})), load_robot(base)
    assert robot.mass == pytest.approx(original.mass - 54.186 + 10.0)
    assert robot.torque_limits.tolist() == [7.0, 7.0, 7.0, 150.0, 150.0, 150.0] * 2
    assert np.all(robot.joint_velocity_limits == 3.0)
    assert np.all(robot.joint_position_limits[1::3] == [-0.8, 0.9])
    assert np.all(robot.joint_damping == 0.25)


def test_armature_enters_the_mass_matrix() -> None:
    config = robot_config("anymal_b")
    without = load_robot(config)
    with_rotors = load_robot(config.model_copy(update={"armature_kgm2": (0.1, 0.2, 0.3)}))
    added = (
        with_rotors.kinematics(with_rotors.nominal_state()).mass_matrix
        - without.kinematics(without.nominal_state()).mass_matrix
    )
    np.testing.assert_allclose(added, np.diag([0.0] * 6 + [0.1, 0.2, 0.3] * 4), atol=1e-12)


def test_text_is_the_same_each_time() -> None:
    config = robot_config("anymal_b")
    assert load_urdf_text(config) == load_urdf_text(config)
