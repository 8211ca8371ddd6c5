"""Commands become waypoints."""

import numpy as np
import pytest
from planning_cases import CONF, load
from pydantic import TypeAdapter

from quadlab.errors import ConfigurationError
from quadlab.planners.command import CommandConfig, GoalCommand, PerStrideCommand, compose, waypoints
from quadlab.planners.heading import heading_spline

TIMES = [0.6, 1.4, 2.2, 3.0]
ADAPTER: TypeAdapter[PerStrideCommand | GoalCommand] = TypeAdapter(CommandConfig)


@pytest.mark.parametrize("path", sorted((CONF / "command").glob("*.yaml")), ids=lambda path: path.stem)
def test_every_command_file_is_valid(path: object) -> None:
    command = ADAPTER.validate_python(load(f"command/{getattr(path, 'name', '')}"))
    assert len(waypoints(command, TIMES, np.zeros(3), 4.0).poses) == 6


def test_strides_chain_in_the_frame_of_the_pose_before() -> None:
    command = PerStrideCommand(kind="per_stride", x_m=0.1, y_m=0.0, yaw_deg=30.0)
    poses = waypoints(command, TIMES, np.array([1.0, 2.0, np.pi / 2]), 4.0).poses
    angles = np.pi / 2 + np.deg2rad([0.0, 30.0, 60.0])
    expected = np.array([1.0, 2.0]) + 0.1 * np.array([np.cos(angles).sum(), np.sin(angles).sum()])
    np.testing.assert_allclose(poses[-1, :2], expected, atol=1e-12)
    assert poses[-1, 2] == pytest.approx(np.pi)


def test_waypoints_hold_the_start_and_the_goal() -> None:
    path = waypoints(PerStrideCommand(kind="per_stride", x_m=0.1, y_m=0.0, yaw_deg=0.0), TIMES, np.zeros(3), 4.0)
    np.testing.assert_allclose(path.times_s, [0.0, *TIMES, 4.0])
    np.testing.assert_allclose(path.poses[:, 0], [0.0, 0.0, 0.1, 0.2, 0.3, 0.3])


def test_waypoints_without_standing_have_no_double_times() -> None:
    command = PerStrideCommand(kind="per_stride", x_m=0.1, y_m=0.0, yaw_deg=0.0)
    path = waypoints(command, [0.0, 1.0, 2.0], np.zeros(3), 2.0)
    np.testing.assert_allclose(path.times_s, [0.0, 1.0, 2.0])
    np.testing.assert_allclose(path.poses[:, 0], [0.0, 0.1, 0.2])


@pytest.mark.parametrize("yaw_deg", [0.0, 45.0, -170.0, 350.0])
@pytest.mark.parametrize("start", [(0.0, 0.0, 0.0), (1.0, -2.0, 2.5)])
def test_goal_is_hit_with_equal_strides(yaw_deg: float, start: tuple[float, float, float]) -> None:
    command = GoalCommand(kind="goal", x_m=1.0, y_m=-0.4, yaw_deg=yaw_deg)
    poses = waypoints(command, np.linspace(0.6, 6.2, 8).tolist(), np.array(start), 7.0).poses[1:-1]
    goal = compose(np.array(start), np.array([1.0, -0.4, np.deg2rad(yaw_deg)]))
    np.testing.assert_allclose(poses[-1], goal, atol=1e-12)
    lengths = np.linalg.norm(np.diff(poses[:, :2], axis=0), axis=1)
    np.testing.assert_allclose(lengths, lengths[0], atol=1e-12)
    np.testing.assert_allclose(np.diff(poses[:, 2]), np.deg2rad(yaw_deg) / 7, atol=1e-12)


def test_turn_on_the_spot_may_be_a_full_turn() -> None:
    poses = waypoints(GoalCommand(kind="goal", x_m=0.0, y_m=0.0, yaw_deg=360.0), TIMES, np.zeros(3), 4.0).poses
    np.testing.assert_allclose(poses[-1], [0.0, 0.0, 2.0 * np.pi], atol=1e-12)


def test_full_turn_with_displacement_is_a_clear_error() -> None:
    with pytest.raises(ConfigurationError, match="yaw_deg"):
        waypoints(GoalCommand(kind="goal", x_m=1.0, y_m=0.0, yaw_deg=360.0), TIMES, np.zeros(3), 4.0)


def test_heading_is_smooth_monotone_and_passes_the_waypoints() -> None:
    path = waypoints(PerStrideCommand(kind="per_stride", x_m=0.1, y_m=0.0, yaw_deg=20.0), TIMES, np.zeros(3), 4.0)
    heading = heading_spline(path)
    times = np.linspace(0.0, 4.0, 4001)
    yaw = np.array([heading(t)[0] for t in times])
    rate = np.array([heading(t, 1)[0] for t in times])
    acceleration = np.array([heading(t, 2)[0] for t in times])
    assert np.diff(yaw).min() > -1e-12
    assert np.abs(np.diff(rate)).max() < 0.005
    assert np.abs(np.diff(acceleration)).max() < 0.05
    for time, pose in zip(path.times_s, path.poses, strict=True):
        assert heading(float(time))[0] == pytest.approx(pose[2], abs=1e-9)
    assert (rate[times <= 0.6] == 0.0).all()
