"""The height of the hips over the feet, from the columns of a trace."""

import numpy as np
import pandas as pd
import pytest

from paper_figures.limb_extensions import ROBOT, extension_limit, limb_extensions
from quadlab.robots.catalogue import robot_config
from quadlab.robots.legs import JOINT_NAMES
from quadlab.robots.model import load_robot


def _nominal_trace(height_m: float) -> pd.DataFrame:
    state = load_robot(robot_config(ROBOT)).nominal_state()
    base = {f"state.base_position_{axis}": 0.0 for axis in "xy"} | {"state.base_position_z": height_m}
    quat = dict(zip([f"state.base_quat_{part}" for part in "wxyz"], state.quat_wxyz, strict=True))
    joints = dict(zip([f"state.joint_position_{joint}" for joint in JOINT_NAMES], state.joint_positions, strict=True))
    return pd.DataFrame([base | quat | joints])


def test_extension_does_not_depend_on_where_the_base_is() -> None:
    np.testing.assert_allclose(limb_extensions(_nominal_trace(0.2)), limb_extensions(_nominal_trace(0.6)))


def test_standing_legs_are_within_the_limit() -> None:
    extensions = limb_extensions(_nominal_trace(0.5))
    assert extensions.shape == (1, 4)
    assert (extensions < extension_limit("bellicoso2016")).all()
    assert extensions.max() == pytest.approx(extension_limit("bellicoso2016"), rel=0.1)
