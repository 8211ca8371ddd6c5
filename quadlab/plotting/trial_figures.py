"""All figures of a trial, as files beside its log."""

from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

from quadlab.plotting.figure_files import PAPER_FORMATS, save_figure
from quadlab.plotting.trial.base import base_figure
from quadlab.plotting.trial.com import com_figure
from quadlab.plotting.trial.feet import feet_figure
from quadlab.plotting.trial.forces import forces_figure
from quadlab.plotting.trial.levels import levels_figure
from quadlab.plotting.trial.overview import overview_figure
from quadlab.plotting.trial.timing import timing_figure
from quadlab.plotting.trial.top_down import top_down_figure
from quadlab.plotting.trial.torques import torques_figure
from quadlab.plotting.trial_view import TrialView, load_trial_view

PLOTS_DIR = "plots"

DrawTrial = Callable[[TrialView], Figure]

FIGURES: dict[str, DrawTrial] = {
    "plan_top_down": top_down_figure,
    "com": com_figure,
    "base": base_figure,
    "feet": feet_figure,
    "forces": forces_figure,
    "torques": torques_figure,
    "levels": levels_figure,
    "timing": timing_figure,
}
"""Figures for a paper, by the name of their file."""


def plot_trial(directory: Path, output: Path | None = None) -> list[Path]:
    """Draw the trial in ``directory`` and return the files written.

    Equal logs give equal bytes. What the log does not hold (computing times, levels) gets no figure.

    Args:
        directory: of a trial, with its ``trial.mcap``.
        output: where the files go; by default ``plots`` in ``directory``.

    Raises:
        LogError: if there is no log to draw.
    """
    view = load_trial_view(directory)
    folder = output if output is not None else directory / PLOTS_DIR
    paths = save_figure(overview_figure(view), folder, "overview", ["png"])
    for name, draw in figures_of(view).items():
        paths += save_figure(draw(view), folder, name, PAPER_FORMATS)
    return paths


def figures_of(view: TrialView) -> dict[str, DrawTrial]:
    """Return those of ``FIGURES`` for which the log has the data."""
    tables = {"timing": view.log.timing, "levels": view.log.levels}
    missing = {name for name, table in tables.items() if table.columns.empty}
    return {name: draw for name, draw in FIGURES.items() if name not in missing}
