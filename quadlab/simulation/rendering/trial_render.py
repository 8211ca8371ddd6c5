"""Video and strip of a trial: what the command line draws."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quadlab.geometry.rotations import Array
from quadlab.robots.model import RobotModel
from quadlab.simulation.rendering.config import RenderConfig
from quadlab.simulation.rendering.motion import Motion
from quadlab.simulation.rendering.offscreen import Frame
from quadlab.simulation.rendering.renderer import render_frames
from quadlab.simulation.rendering.strip import snapshot_strip, write_png
from quadlab.simulation.rendering.video import ffmpeg_program, write_video
from quadlab.simulation.scenario import ScenarioConfig

VIDEO_NAME = "video.mp4"
STRIP_NAME = "strip.png"


@dataclass(frozen=True)
class RenderedTrial:
    """Files that were written.

    Attributes:
        video: mp4.
        strip: png.
        frames: in the video.
    """

    video: Path
    strip: Path
    frames: int


def render_trial(
    robot: RobotModel, scenario: ScenarioConfig, motion: Motion, folder: Path, config: RenderConfig
) -> RenderedTrial:
    """Draw a recorded trial into ``video.mp4`` and ``strip.png`` in ``folder``.

    Args:
        robot: the robot of the trial.
        scenario: gives terrain and pushes.
        motion: the record.
        folder: is made if it does not exist; files of these names are replaced.
        config: how to draw.

    Raises:
        MissingDependencyError: if OpenGL or ffmpeg is missing; says what to install.
        RobotDescriptionError: if a mesh of the robot cannot be read.
    """
    ffmpeg_program()
    folder.mkdir(parents=True, exist_ok=True)
    times_s = video_times(motion, config)
    chosen = {int(np.argmin(np.abs(times_s - time_s))) for time_s in snapshot_times(motion, scenario, config)}
    snapshots: dict[int, Frame] = {}

    def watched() -> Iterator[Frame]:
        for index, frame in enumerate(render_frames(robot, scenario, motion, times_s, config)):
            if index in chosen:
                snapshots[index] = frame
            yield frame

    count = write_video(watched(), folder / VIDEO_NAME, config.fps)
    labels = [f"{times_s[index]:.2f} s" for index in snapshots]
    write_png(snapshot_strip(list(snapshots.values()), labels, config.strip_columns), folder / STRIP_NAME)
    return RenderedTrial(folder / VIDEO_NAME, folder / STRIP_NAME, count)


def video_times(motion: Motion, config: RenderConfig) -> Array:
    """Return the trial time of each frame of the video, (n,) in [s]."""
    start, end = motion.span
    step = 1.0 / (config.fps * config.slow_down)
    return np.asarray(start + step * np.arange(int((end - start) / step + 1e-9) + 1), np.float64)


def snapshot_times(motion: Motion, scenario: ScenarioConfig, config: RenderConfig) -> Array:
    """Return increasing times for the strip, (n,) in [s]: evenly spread, the nearest ones moved into the pushes."""
    start, end = motion.span
    times_s = np.linspace(start, end, config.snapshots)
    for push in scenario.pushes:
        middle = push.start_s + 0.5 * push.duration_s
        if start <= middle <= end:
            times_s[int(np.argmin(np.abs(times_s - middle)))] = middle
    return np.unique(times_s)
