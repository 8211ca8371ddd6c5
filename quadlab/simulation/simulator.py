"""MuJoCo behind quadlab's types: joint torques in, robot states out."""

import math
import warnings
from typing import Any

import mujoco
import numpy as np

from quadlab.configuration import Positive, StrictModel
from quadlab.errors import ConfigurationError, QuadlabError
from quadlab.geometry.rotations import Array
from quadlab.robots.legs import JOINT_NAMES
from quadlab.robots.model import RobotModel
from quadlab.robots.state import JointCommand, JointDrive, RobotState, all_finite
from quadlab.simulation.conventions import MujocoMap, PhysicsArrays
from quadlab.simulation.links import link_placements
from quadlab.simulation.model_builder import build_spec
from quadlab.simulation.model_error import ModelErrorConfig, apply_model_error
from quadlab.simulation.push import PushConfig, ScheduledPush
from quadlab.simulation.scenario import ScenarioConfig, initial_state
from quadlab.simulation.sensors import ImuIntegrator, ImuSample
from quadlab.simulation.terrain import build_ground
from quadlab.simulation.timing import check_period

_STATE = mujoco.mjtState.mjSTATE_INTEGRATION
_ALLOWED_PENETRATION = 1e-3  # [m]


def _say(warning: str) -> None:
    """Say what MuJoCo warns of; else it writes a log file where the command is run.

    That the numbers blow up is left to the outcome of the trial.
    """
    if "unstable" not in warning:
        warnings.warn(warning, RuntimeWarning, stacklevel=1)


mujoco.set_mju_user_warning(_say)


class SimulationConfig(StrictModel):
    """How the physics is integrated.

    Attributes:
        timestep_s: of the physics in [s]; control periods must be whole multiples of it.
        model_error: how the simulated robot differs from the one that the controller knows.
    """

    timestep_s: Positive
    model_error: ModelErrorConfig


class Simulator:
    """One robot in one scenario; equal arguments give bit-identical trials on one machine.

    Attributes:
        model: the compiled ``mujoco.MjModel``.
    """

    def __init__(self, robot: RobotModel, scenario: ScenarioConfig, config: SimulationConfig, seed: int) -> None:
        self._robot = robot
        self._timestep_s = config.timestep_s
        spec = build_spec(robot, build_ground(scenario.terrain), scenario.friction, config.timestep_s)
        apply_model_error(spec, robot.config.base_link, config.model_error)
        self.model: Any = spec.compile()
        self._data: Any = mujoco.MjData(self.model)
        self._arrays = PhysicsArrays.of(self._data)
        self._map = MujocoMap.of(self.model, robot)
        self._body_names = tuple(self.model.body(body).name for body in range(1, self.model.nbody))
        self._imu = ImuIntegrator.of(self.model)
        self._state_size = int(mujoco.mj_stateSize(self.model, _STATE))
        self._pushes = tuple(self._schedule(push) for push in scenario.pushes)
        self._initial_state = initial_state(robot, scenario.initial_perturbation, seed)
        self._step = 0
        self._looked = False
        self.reset()

    def _schedule(self, push: PushConfig) -> ScheduledPush:
        placements = link_placements(self._robot)
        link = push.link(self._robot.config.base_link)
        if link not in placements:
            raise ConfigurationError(f"push.body: unknown link '{push.body}'; known: base, {', '.join(placements)}")
        first = math.ceil(push.start_s / self._timestep_s - 1e-6)
        steps = check_period(push.duration_s, self._timestep_s)
        return ScheduledPush(self.model.body(placements[link].body).id, push.force, first, first + steps)

    def reset(self) -> RobotState:
        """Return to the initial state at time zero.

        Raises:
            ConfigurationError: if the robot starts inside the terrain.
        """
        mujoco.mj_resetData(self.model, self._data)
        self._step = 0
        self._imu.restart()
        self._map.write_state(self._arrays, self._initial_state)
        mujoco.mj_forward(self.model, self._data)
        for contact in self._data.contact:
            if contact.dist < -_ALLOWED_PENETRATION:
                names = [self.model.geom(int(geom)).name or "the robot's body" for geom in contact.geom]
                raise ConfigurationError(f"scenario: the robot starts inside the terrain: {names[0]} and {names[1]}")
        return self.read()

    @property
    def time_s(self) -> float:
        """Time since the reset in [s]."""
        return self._step * self._timestep_s

    @property
    def applied_torques(self) -> Array:
        """Torques within the limits at the last physics step, (12,) in [N m]; drives change them in every step."""
        return np.asarray(self._arrays.ctrl[self._map.ctrl])

    def imu(self) -> ImuSample:
        """Return the mean rates of the inertial unit during the last ``advance``; at the start the present ones."""
        return self._imu.sample(self._arrays)

    def read(self) -> RobotState:
        """Return the true state; the foot forces are those under the torques and pushes of the last step.

        Reading does not change the trial: the solver's warm start stays that of the last step.
        """
        mujoco.mj_forward(self.model, self._data)
        self._looked = True
        return self._map.read_state(self._arrays, self.time_s)

    def advance(self, command: JointCommand, duration_s: float) -> None:
        """Hold the torques of ``command``, clipped to the limits, for ``duration_s`` in [s]; drives act every step.

        Raises:
            ConfigurationError: if ``duration_s`` is not a whole multiple of the timestep.
            QuadlabError: if a torque is not finite.
        """
        steps = check_period(duration_s, self._timestep_s)
        torques, limits = np.asarray(command.torques), self._robot.torque_limits
        if not all_finite(torques):
            names = [name for name, torque in zip(JOINT_NAMES, torques, strict=True) if not math.isfinite(torque)]
            raise QuadlabError(f"torque command is not finite: {', '.join(names)}")
        self._imu.restart()
        for step in range(steps):
            total = torques if command.drive is None else torques + self._drive_torques(command.drive, step)
            self._arrays.ctrl[self._map.ctrl] = np.minimum(np.maximum(total, -limits), limits)
            self._apply_pushes()
            self._integrate()
            self._imu.add(self._arrays)
            self._step += 1

    def _integrate(self) -> None:
        """Make one step; what depends on positions and velocities alone is not computed again after a reading."""
        if self._looked:
            mujoco.mj_step2(self.model, self._data)
        else:
            mujoco.mj_step(self.model, self._data)
        self._looked = False

    def _drive_torques(self, drive: JointDrive, step: int) -> Array:
        positions, velocities = self._map.joints(self._arrays)
        return drive.torques(step * self._timestep_s, positions, velocities)

    def _apply_pushes(self) -> None:
        if not self._pushes:
            return
        self._data.xfrc_applied[:] = 0.0
        for push in self._pushes:
            if push.is_active(self._step):
                self._data.xfrc_applied[push.body, :3] += push.force

    def active_pushes(self) -> list[tuple[Array, Array]]:
        """Return point of application, (3,) in [m], and force, (3,) in [N], of each push that acts now."""
        if not self._pushes:
            return []
        mujoco.mj_kinematics(self.model, self._data)
        return [
            (self._data.xipos[push.body].copy(), push.force.copy())
            for push in self._pushes
            if push.is_active(self._step)
        ]

    def body_poses(self) -> tuple[tuple[str, ...], Array, Array]:
        """Return names, (n,), positions, (n, 3) in [m], and quaternions wxyz, (n, 4), of the robot's bodies."""
        mujoco.mj_kinematics(self.model, self._data)
        return self._body_names, self._data.xpos[1:].copy(), self._data.xquat[1:].copy()

    def integration_state(self) -> Array:
        """Return everything that the future depends on besides the commands; see ``restore``."""
        state = np.empty(self._state_size)
        mujoco.mj_getState(self.model, self._data, state, _STATE)
        return state

    def restore(self, state: Array) -> RobotState:
        """Return to a state that ``integration_state`` gave, time included."""
        mujoco.mj_setState(self.model, self._data, state, _STATE)
        self._step = round(self._data.time / self._timestep_s)
        self._imu.restart()
        return self.read()
