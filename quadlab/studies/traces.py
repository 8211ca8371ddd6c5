"""Curves, events, plan and pictures of a trial that stay when its log is gone."""

from collections.abc import Iterable
from fnmatch import fnmatch
from math import ceil
from pathlib import Path

import numpy as np
import pandas as pd

from quadlab.analysis.log_reader import read_log
from quadlab.analysis.trial_config import logged_config
from quadlab.analysis.trial_directory import find_log
from quadlab.analysis.trial_log import TrialLog
from quadlab.errors import ConfigurationError
from quadlab.geometry.rotations import Array
from quadlab.planners.plan_io import plan_to_bytes
from quadlab.plotting.trial_video import recorded_motion
from quadlab.robots.model import load_robot
from quadlab.simulation.rendering.config import RenderConfig, ViewConfig
from quadlab.simulation.rendering.offscreen import Frame
from quadlab.simulation.rendering.renderer import render_frames
from quadlab.simulation.rendering.strip import write_png
from quadlab.studies.config import TraceConfig
from quadlab.studies.files import StudyFolder, remove_trace
from quadlab.trials.files import write_bytes, write_text
from quadlab.trials.problems import suggestion

SNAPSHOT = RenderConfig(
    width=480,
    height=360,
    show_foot_forces=False,
    show_com_reference=False,
    view=ViewConfig(azimuth_deg=-65.0, elevation_deg=10.0),
)
"""Pictures show nothing but robot and ground, from where no leg hides another for long."""
SAME_RATE = 1e-4
"""Share by which a rate may differ from what times that were rounded say."""


def write_trace(trace: TraceConfig, folder: StudyFolder, directory: Path) -> None:
    """Keep what ``trace`` asks for of the trial in ``directory``.

    What an earlier form of the trace left is removed, but not if anything is wrong.

    Raises:
        LogError: if the trial has no whole log.
        MissingDependencyError: if pictures are asked for and OpenGL is missing.
    """
    log = read_log(find_log(directory))
    curves = chosen_columns(log, trace).to_parquet(compression="zstd")
    plan, pictures = plan_to_bytes(log.plan), _snapshots(log, trace)
    remove_trace(trace.name, folder)
    write_bytes(folder.trace(trace.name), curves)
    write_text(folder.events(trace.name), log.events.to_csv())
    write_bytes(folder.plan(trace.name), plan)
    for number, picture in enumerate(pictures):
        write_png(picture, folder.snapshot(trace.name, number))


def chosen_columns(log: TrialLog, trace: TraceConfig) -> pd.DataFrame:
    """Return the columns that match, named ``<table>.<column>``, thinned out to the rate, in single precision.

    Raises:
        ConfigurationError: if a pattern matches none.
    """
    tables = {"state": log.state, "estimate": log.estimate, "control": log.control, "levels": log.levels}
    columns = {f"{name}.{column}": table[column] for name, table in tables.items() for column in table.columns}
    for pattern in trace.columns:
        if not any(fnmatch(name, pattern) for name in columns):
            raise ConfigurationError(f"trace '{trace.name}': no column '{pattern}'; {suggestion(pattern, columns)}")
    chosen = pd.DataFrame(
        {name: column for name, column in columns.items() if matches_any(name, trace.columns)}
    ).astype(np.float32)
    return chosen.iloc[:: ticks_between(chosen.index.to_numpy(float), trace.rate_hz)]


def ticks_between(times_s: Array, rate_hz: float) -> int:
    """Return n so that every n-th tick comes at ``rate_hz`` at most; times are (k,) in [s]."""
    period_s = float(np.median(np.diff(times_s))) if len(times_s) > 1 else 1.0
    return max(1, ceil((1.0 - SAME_RATE) / (period_s * rate_hz)))


def matches_any(name: str, patterns: Iterable[str]) -> bool:
    """Whether a name fits one of some patterns with ``*`` and ``?``."""
    return any(fnmatch(name, pattern) for pattern in patterns)


def _snapshots(log: TrialLog, trace: TraceConfig) -> list[Frame]:
    """Return the pictures that are asked for, (height, width, 3) each."""
    if not trace.snapshots_s:
        return []
    config = logged_config(log)
    times_s = np.array(trace.snapshots_s)
    return list(render_frames(load_robot(config.robot), config.scenario, recorded_motion(log), times_s, SNAPSHOT))
