"""Video and snapshot strip of a trial, from its log alone."""

from pathlib import Path

from quadlab.analysis.log_reader import read_log
from quadlab.analysis.trial_config import logged_config
from quadlab.analysis.trial_directory import find_log
from quadlab.analysis.trial_log import TrialLog, leg_vectors, vectors
from quadlab.robots.model import load_robot
from quadlab.simulation.rendering.config import RenderConfig
from quadlab.simulation.rendering.motion import Motion
from quadlab.simulation.rendering.trial_render import RenderedTrial, render_trial


def render_trial_log(directory: Path, options: RenderConfig | None = None) -> RenderedTrial:
    """Write ``video.mp4`` and ``strip.png`` into ``directory``.

    Args:
        directory: of the trial; holds its log.
        options: how to draw.

    Raises:
        LogError: if there is no log, or not a whole one.
        MissingDependencyError: if OpenGL or ffmpeg is missing; says what to install.
    """
    log = read_log(find_log(directory))
    config = logged_config(log)
    robot = load_robot(config.robot)
    return render_trial(robot, config.scenario, recorded_motion(log), directory, options or RenderConfig())


def recorded_motion(log: TrialLog) -> Motion:
    """Return what a picture needs of a log."""
    state = log.state
    return Motion(
        times_s=state.index.to_numpy(),
        positions_base_in_world=vectors(state, "base_position"),
        quats_wxyz=vectors(state, "base_quat"),
        joint_positions=vectors(state, "joint_position"),
        foot_forces_in_world=leg_vectors(state, "foot_force"),
        com_reference_in_world=vectors(log.control, "com_reference"),
    )
