"""Pictures show what the record says; missing libraries are one clear line."""

import ctypes
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rendering_cases import SMALL, scenario, trot_in_place

from quadlab.errors import LogError, MissingDependencyError
from quadlab.robots.catalogue import robot_config, robot_names
from quadlab.robots.model import RobotModel, load_robot
from quadlab.simulation.model_builder import build_spec
from quadlab.simulation.rendering.camera import smoothed
from quadlab.simulation.rendering.motion import Motion
from quadlab.simulation.rendering.offscreen import Frame, create_context
from quadlab.simulation.rendering.renderer import render_frames
from quadlab.simulation.rendering.visuals import VISUAL_GROUP, add_visuals
from quadlab.simulation.terrain import build_ground

PUSH = {"body": "base", "direction": (0.0, 1.0, 0.0), "force_n": 150.0, "start_s": 0.4, "duration_s": 0.2}


@pytest.fixture(autouse=True)
def _own_cache(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.getbasetemp() / "cache"))


def frame_at(time_s: float, robot: RobotModel, motion: Motion, **changes: Any) -> Frame:
    return next(iter(render_frames(robot, scenario(**changes), motion, np.array([time_s]), SMALL)))


def reddish(frame: Frame) -> int:
    red, green, blue = (frame[..., channel].astype(int) for channel in range(3))
    return int(np.sum((red > green + 60) & (red > blue + 60)))


@pytest.mark.parametrize("name", robot_names())
def test_visuals_neither_touch_nor_weigh(name: str) -> None:
    robot = load_robot(robot_config(name))
    spec = build_spec(robot, build_ground(()), 0.8, 1e-3)
    plain = spec.compile()
    add_visuals(spec, robot, 0.03)
    drawn = spec.compile()
    shown = drawn.geom_group == VISUAL_GROUP
    assert shown.sum() >= 13, "fewer shapes than a trunk and four legs of three links"
    assert not drawn.geom_contype[shown].any()
    assert not drawn.geom_conaffinity[shown].any()
    assert drawn.body_mass == pytest.approx(plain.body_mass)
    assert drawn.body_inertia == pytest.approx(plain.body_inertia)


@pytest.mark.usefixtures("requires_egl")
@pytest.mark.parametrize("name", ["anymal_b", "hyq", "solo12"])
def test_robot_is_seen_in_the_middle_of_the_picture(name: str) -> None:
    """The middle of the picture has far more contrast than the bare floor in its corner."""
    robot = load_robot(robot_config(name))
    here = trot_in_place(robot, 0.1)
    frame = frame_at(0.0, robot, here)
    assert frame.shape == (SMALL.height, SMALL.width, 3)
    middle = frame[35:70, 60:100].astype(float)
    empty_floor = frame[85:, :30].astype(float)
    assert middle.std() > 3.0 * empty_floor.std()


@pytest.mark.usefixtures("requires_egl")
def test_moving_joints_move_the_picture(anymal: RobotModel, motion: Motion) -> None:
    still, moved, again = (frame_at(time_s, anymal, motion) for time_s in (0.0, 0.25, 0.0))
    assert np.array_equal(still, again)
    assert np.abs(still.astype(int) - moved.astype(int)).max() > 50


@pytest.mark.usefixtures("requires_egl")
def test_push_is_drawn_while_it_acts(anymal: RobotModel, motion: Motion) -> None:
    before, during, after = (reddish(frame_at(time_s, anymal, motion, pushes=[PUSH])) for time_s in (0.3, 0.5, 0.7))
    assert during > before + 50
    assert abs(after - before) < 20


@pytest.mark.usefixtures("requires_egl")
def test_foot_forces_and_reference_are_drawn(anymal: RobotModel, motion: Motion) -> None:
    forces = np.zeros((len(motion.times_s), 4, 3))
    forces[..., 2] = 75.0
    line = motion.positions_base_in_world[0] + np.linspace([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 50)
    more = replace(motion, foot_forces_in_world=forces, com_reference_in_world=line)
    assert not np.array_equal(frame_at(0.0, anymal, motion), frame_at(0.0, anymal, more))


def test_missing_opengl_is_one_line_that_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    def no_library(name: str, *_: Any, **__: Any) -> None:
        raise OSError(f"{name}: cannot open shared object file")

    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setattr(ctypes, "CDLL", no_library)
    with pytest.raises(MissingDependencyError, match="apt-get install libegl1 libopengl0 libgl1-mesa-dri") as caught:
        create_context(16, 16)
    assert "\n" not in str(caught.value)


def test_opengl_that_cannot_start_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: Any) -> None:
        raise RuntimeError("Cannot initialize\n a EGL device display.")

    monkeypatch.setattr("importlib.import_module", lambda _: type("Module", (), {"GLContext": broken}))
    with pytest.raises(MissingDependencyError, match="Cannot initialize a EGL device display") as caught:
        create_context(16, 16)
    assert "\n" not in str(caught.value)


def test_camera_ignores_steps_and_follows_a_steady_walk() -> None:
    times_s = np.linspace(0.0, 8.0, 401)
    walk = np.stack([0.3 * times_s, np.zeros_like(times_s)], axis=1)
    shaking = walk + np.stack([np.zeros_like(times_s), 0.02 * np.sin(15.0 * times_s)], axis=1)
    assert smoothed(walk, times_s, 0.5) == pytest.approx(walk, abs=1e-9)
    assert np.abs(smoothed(shaking, times_s, 0.5) - walk)[100:-100].max() < 1e-3
    assert smoothed(shaking, times_s, 0.0) is shaking


def test_motion_is_interpolated_and_checked(motion: Motion) -> None:
    flipped = replace(
        motion, quats_wxyz=motion.quats_wxyz * np.where(np.arange(len(motion.times_s)) % 2, 1, -1)[:, None]
    )
    between = flipped.at(np.array([0.005, 0.5]))
    assert np.abs(between.quats_wxyz @ motion.quats_wxyz[0]) == pytest.approx([1.0, 1.0])
    assert between.joint_positions[1] == pytest.approx(motion.joint_positions[50])
    with pytest.raises(LogError, match=r"joint_positions: expected shape \(101, 12\)"):
        replace(motion, joint_positions=motion.joint_positions[:, :3])
    with pytest.raises(LogError, match="later"):
        replace(motion, times_s=motion.times_s[::-1])


def test_cache_path_is_the_users(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from quadlab.simulation.rendering.mesh_cache import cache_folder  # noqa: PLC0415

    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache_folder() == tmp_path / "quadlab"
