"""The demonstration: ANYmal trots over a plank that it does not know of and is pushed; log, figures and video.

The same as three commands::

    quadlab run robot=anymal_b gait=trot planner=vertex_zmp controller=hierarchical scenario=plank_and_push tag=demo
    quadlab plot results/demo/<trial_id>
    quadlab render results/demo/<trial_id>
"""

import argparse
import shutil
import sys
from collections.abc import Iterable
from pathlib import Path

from quadlab.command_line import EXIT_FAILED, complain, exit_code
from quadlab.plotting.trial_figures import plot_trial
from quadlab.plotting.trial_video import render_trial_log
from quadlab.trials.compose import compose_document, split_document
from quadlab.trials.job import run_job
from quadlab.trials.progress import terminal_progress
from quadlab.trials.report import job_report

PICTURE = Path("results/demo/strip.png")
OVERRIDES = (
    "robot=anymal_b",
    "gait=trot",
    "planner=vertex_zmp",
    "controller=hierarchical",
    "scenario=plank_and_push",
    "force=true",
)


def main() -> int:
    """Run, draw and film the demonstration; return 0 unless the program failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tag", default="demo", help="folder below results/")
    parser.add_argument("--picture", action="store_true", help="replace the picture in README.md by the new strip")
    arguments = parser.parse_args()
    return exit_code(lambda: run_demo(arguments.tag, arguments.picture))


def run_demo(tag: str, replace_picture: bool) -> int:
    """Run the demonstration into ``results/<tag>`` and print status, key numbers and paths."""
    outcome = run_job(*split_document(compose_document([*OVERRIDES, f"tag={tag}"])), terminal_progress())
    if outcome.failure:
        complain(outcome.failure)
        return EXIT_FAILED
    sys.stdout.write(job_report(outcome))
    show(plot_trial(outcome.directory))
    rendered = render_trial_log(outcome.directory)
    if replace_picture:
        shutil.copyfile(rendered.strip, PICTURE)
    show([rendered.video, rendered.strip])
    return 0


def show(paths: Iterable[Path]) -> None:
    """Print where files are."""
    sys.stdout.writelines(f"  {path}\n" for path in paths)
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
