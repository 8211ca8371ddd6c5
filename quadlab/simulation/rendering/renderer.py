"""Frames of a trial, drawn after the trial from its record; the simulated model itself carries no meshes."""

from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np

from quadlab.constants import GRAVITY
from quadlab.geometry.rotations import Array, quat_to_matrix, yaw_of
from quadlab.robots.legs import LEG_COUNT
from quadlab.robots.model import RobotModel
from quadlab.simulation.conventions import foot_geom
from quadlab.simulation.links import link_placements
from quadlab.simulation.model_builder import build_spec
from quadlab.simulation.push import PushConfig
from quadlab.simulation.rendering import overlay
from quadlab.simulation.rendering.camera import camera_at, smoothed
from quadlab.simulation.rendering.config import RenderConfig
from quadlab.simulation.rendering.look import apply_look, move_key_light
from quadlab.simulation.rendering.motion import Motion
from quadlab.simulation.rendering.offscreen import Frame, OffscreenRenderer
from quadlab.simulation.rendering.visuals import add_visuals
from quadlab.simulation.scenario import ScenarioConfig
from quadlab.simulation.terrain import build_ground

ANY_TIMESTEP_S = 1e-3
"""Nothing is integrated here."""

PUSH_ARROW_SIZES = 0.8
"""Length of the arrow of a push by half the robot's weight, in robot sizes; it grows with the force."""

FOOT_ARROW_SIZES = 0.8
"""Length of the arrow of a foot that carries the whole robot, in robot sizes."""

LINE_SHARE = 0.006
"""Width of lines as a share of the picture's height."""

CAMERA_STEP_S = 0.02
CELL_DIGITS = 4
"""Mesh cells are rounded to this many digits in [m], so that the cache serves variants of one robot."""


def robot_size(robot: RobotModel) -> float:
    """Return the diagonal of the box that holds feet and centre of mass in the nominal stance, in [m]."""
    feet = robot.nominal_feet_in_com
    return float(np.linalg.norm([*np.ptp(feet, axis=0), robot.nominal_com_height]))


def render_frames(
    robot: RobotModel, scenario: ScenarioConfig, motion: Motion, times_s: Array, config: RenderConfig
) -> Iterator[Frame]:
    """Yield the picture of each time, (height, width, 3).

    Args:
        robot: the robot.
        scenario: gives terrain and pushes.
        motion: the record.
        times_s: when to look, (k,) in [s].
        config: how to draw.

    Raises:
        MissingDependencyError: if no OpenGL for drawing without a display is installed.
        RobotDescriptionError: if a mesh of the robot cannot be read.
    """
    picture = _TrialPicture(robot, scenario, motion, config)
    with OffscreenRenderer(picture.model, config.width, config.height) as renderer:
        moments = motion.at(times_s)
        targets = picture.camera_targets(times_s)
        for index in range(len(times_s)):
            picture.place(renderer, moments, index, targets[index])
            yield renderer.draw()


class _TrialPicture:
    """The compiled model with meshes and light, and everything that is put into its scene."""

    def __init__(self, robot: RobotModel, scenario: ScenarioConfig, motion: Motion, config: RenderConfig) -> None:
        self._robot, self._scenario, self._motion, self._config = robot, scenario, motion, config
        self._size = robot_size(robot)
        spec = build_spec(robot, build_ground(scenario.terrain), scenario.friction, ANY_TIMESTEP_S)
        add_visuals(spec, robot, round(config.mesh_cell_sizes * self._size, CELL_DIGITS))
        apply_look(spec, self._size, config.shadow_pixels, config.samples, (config.height, config.width))
        self.model = spec.compile()
        self._data = mujoco.MjData(self.model)
        self._joints = np.array([self.model.joint(name).qposadr[0] for name in robot.joint_names])
        self._heading = yaw_of(quat_to_matrix(motion.quats_wxyz[0]))
        self._weight = robot.mass * GRAVITY

    def camera_targets(self, times_s: Array) -> Array:
        """Return the point the camera looks at, (k, 3) in [m]: the base without its fast motions, a bit lower."""
        start, end = self._motion.span
        even = np.linspace(start, end, max(2, int((end - start) / CAMERA_STEP_S)))
        base = self._motion.at(even).positions_base_in_world
        steady = smoothed(base, even, self._config.view.smoothing_s)
        lowered = steady - np.array([0.0, 0.0, 0.4 * self._robot.nominal_com_height])
        return np.stack([np.interp(times_s, even, column) for column in lowered.T], axis=1)

    def place(self, renderer: OffscreenRenderer, moments: Motion, index: int, target: Array) -> None:
        """Put robot, camera, light, arrows and lines of one moment into the scene."""
        data = self._data
        data.qpos[:3] = moments.positions_base_in_world[index]
        data.qpos[3:7] = moments.quats_wxyz[index]
        data.qpos[self._joints] = moments.joint_positions[index]
        mujoco.mj_kinematics(self.model, data)
        mujoco.mj_comPos(self.model, data)
        mujoco.mj_camlight(self.model, data)
        renderer.update(data, camera_at(target, self._heading, self._size, self._config.view))
        move_key_light(renderer.scene, target, self._size)
        self._draw_reference(renderer.scene)
        self._draw_pushes(renderer.scene, float(moments.times_s[index]))
        self._draw_foot_forces(renderer.scene, moments, index)

    def _draw_reference(self, scene: Any) -> None:
        reference = self._motion.com_reference_in_world
        if self._config.show_com_reference and reference is not None:
            overlay.add_line(scene, reference, LINE_SHARE * self._config.height, overlay.REFERENCE_RGBA)

    def _draw_pushes(self, scene: Any, time_s: float) -> None:
        """Draw an arrow whose tip is at the centre of mass of the pushed body, drawn outside of the body."""
        for push in self._scenario.pushes:
            if push.start_s <= time_s < push.start_s + push.duration_s and push.force_n > 0.0:
                direction = push.force / push.force_n
                length = PUSH_ARROW_SIZES * self._size * push.force_n / (0.5 * self._weight)
                tip = self._data.xipos[self._pushed_body(push)] - 0.15 * self._size * direction
                overlay.add_arrow(scene, tip - length * direction, tip, 0.03 * self._size, overlay.PUSH_RGBA)

    def _pushed_body(self, push: PushConfig) -> int:
        link = push.link(self._robot.config.base_link)
        return int(self.model.body(link_placements(self._robot)[link].body).id)

    def _draw_foot_forces(self, scene: Any, moments: Motion, index: int) -> None:
        forces = moments.foot_forces_in_world
        if not self._config.show_foot_forces or forces is None:
            return
        for foot, force in zip(self._contact_points(), forces[index], strict=True):
            tip = foot + FOOT_ARROW_SIZES * self._size / self._weight * force
            overlay.add_arrow(scene, foot, tip, 0.012 * self._size, overlay.FORCE_RGBA)

    def _contact_points(self) -> Array:
        """Return the lowest point of each foot's sphere, (4, 3) in [m]."""
        ids = [self.model.geom(foot_geom(leg)).id for leg in range(LEG_COUNT)]
        return np.asarray(self._data.geom_xpos[ids] - np.array([0.0, 0.0, self._robot.foot_radius]))
