"""Curves, events, plan and pictures of a trial that stay when its log is gone."""

from collections.abc import Iterable
from fnmatch import fnmatch
from pathlib import Path

import numpy as np
import pandas as pd

from quadlab.analysis.log_reader import read_log
from quadlab.analysis.trial_config import logged_config
from quadlab.analysis.trial_directory import find_log
from quadlab.analysis.trial_log import TrialLog
from quadlab.errors import ConfigurationError
from quadlab.planners.plan_io import save_plan
from quadlab.plotting.trial_video import recorded_motion
from quadlab.robots.model import load_robot
from quadlab.simulation.rendering.config import RenderConfig, ViewConfig
from quadlab.simulation.rendering.renderer import render_frames
from quadlab.simulation.rendering.strip import write_png
from quadlab.studies.config import TraceConfig
from quadlab.studies.files import StudyFolder
from quadlab.trials.problems import suggestion

SNAPSHOT = RenderConfig(
    width=480,
    height=360,
    show_foot_forces=False,
    show_com_reference=False,
    view=ViewConfig(azimuth_deg=-65.0, elevation_deg=10.0),
)
"""Pictures show nothing but robot and ground, from where no leg hides another for long."""


def write_trace(trace: TraceConfig, folder: StudyFolder, directory: Path) -> None:
    """Keep what ``trace`` asks for of the trial in ``directory``.

    Raises:
        LogError: if the trial has no whole log.
        MissingDependencyError: if pictures are asked for and OpenGL is missing.
    """
    log = read_log(find_log(directory))
    for path in (folder.trace(trace.name), folder.plan(trace.name)):
        path.parent.mkdir(parents=True, exist_ok=True)
    chosen_columns(log, trace).to_parquet(folder.trace(trace.name), compression="zstd")
    log.events.to_csv(folder.events(trace.name))
    save_plan(log.plan, folder.plan(trace.name))
    if trace.snapshots_s:
        _write_snapshots(log, trace, folder)


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
    period_s = float(np.median(np.diff(chosen.index.to_numpy(float)))) if len(chosen) > 1 else 1.0
    return chosen.iloc[:: max(1, round(1.0 / (period_s * trace.rate_hz)))]


def matches_any(name: str, patterns: Iterable[str]) -> bool:
    """Whether a name fits one of some patterns with ``*`` and ``?``."""
    return any(fnmatch(name, pattern) for pattern in patterns)


def _write_snapshots(log: TrialLog, trace: TraceConfig, folder: StudyFolder) -> None:
    config = logged_config(log)
    times_s = np.array(trace.snapshots_s)
    frames = render_frames(load_robot(config.robot), config.scenario, recorded_motion(log), times_s, SNAPSHOT)
    for number, frame in enumerate(frames):
        write_png(frame, folder.snapshot(trace.name, number))
