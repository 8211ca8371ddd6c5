"""The command ``quadlab plan``: a plan and its figures, without a trial."""

import logging
from collections.abc import Sequence
from pathlib import Path

from quadlab.planners.plan import MotionPlan
from quadlab.sweeps.main import with_sweep_checked
from quadlab.trials.main import plan_document, run_jobs


def main(arguments: Sequence[str] | None = None) -> int:
    """Plan what the arguments say, print what came of it, leave files and return the exit code.

    Args:
        arguments: overrides and Hydra's flags; those of the process by default.
    """
    return run_jobs(arguments, with_sweep_checked(lambda document: plan_document(document, draw_plan)))


def draw_plan(plan: MotionPlan, folder: Path) -> list[Path]:
    """Write the figures of ``plan``, from above with its course over time and in space, and return their paths."""
    from quadlab.plotting.figure_files import save_figure  # noqa: PLC0415  matplotlib takes long to load
    from quadlab.plotting.plan_figure import plan_figure  # noqa: PLC0415
    from quadlab.plotting.plan_space_figure import plan_space_figure  # noqa: PLC0415

    logging.getLogger("fontTools").setLevel(logging.WARNING)  # Hydra lets everybody talk
    return [*save_figure(plan_figure(plan), folder, "plan"), *save_figure(plan_space_figure(plan), folder, "plan_3d")]
