"""Run a list of trials, keep what is done, and write their rows as a table; shared by the scripts beside it."""

import argparse
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import pandas as pd

from quadlab.trials.compose import compose_trial
from quadlab.trials.config import RunOptions
from quadlab.trials.job import run_job
from quadlab.trials.progress import SilentProgress
from quadlab.trials.result import TrialStatus

Overrides = tuple[str, ...]
COLUMNS = [
    "robot",
    "gait",
    "planner",
    "controller",
    "estimator",
    "scenario",
    "seed",
    "status",
    "survived_s",
    "distance_m",
    "com_error_rms_mm",
    "com_error_max_mm",
    "base_height_rms_mm",
    "roll_pitch_rms_deg",
    "foot_slip_max_mm",
    "torque_max_nm",
    "control_fallbacks",
    "replannings",
    "replanning_failures",
    "replanning_median_ms",
    "state_sha256",
    "status_reason",
]


def run_row(folder: Path, overrides: Overrides) -> dict[str, object]:
    """Run one trial below ``folder``, unless its result is there already, and return its row."""
    options = RunOptions(force=False, results_dir=str(folder))
    outcome = run_job(compose_trial([*overrides, "tag=trials"]), options, SilentProgress())
    if outcome.result is None:
        return {"status": TrialStatus.ERROR.value, "status_reason": outcome.failure}
    return outcome.result.model_dump(mode="json")


def run_table(
    name: str, trials: Sequence[Overrides], report: Callable[[pd.DataFrame], str], description: str | None
) -> int:
    """Run ``trials`` into ``results/<name>``, write ``table.csv`` and ``report.md`` there, return the exit code.

    Args:
        name: of the folder.
        trials: overrides of each trial.
        report: makes the text of ``report.md`` of the table.
        description: of the script, for ``--help``.
    """
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--jobs", type=int, default=2, help="trials at a time")
    folder = Path("results") / name
    rows = []
    with ProcessPoolExecutor(parser.parse_args().jobs) as pool:
        for overrides, row in zip(trials, pool.map(partial(run_row, folder), trials), strict=True):
            rows.append(row)
            sys.stdout.write(f"{' '.join(overrides)}: {row['status']}, {row['status_reason']}\n")
            sys.stdout.flush()
    table = pd.DataFrame(rows).reindex(columns=COLUMNS)
    table.to_csv(folder / "table.csv", index=False, float_format="%.4g")
    (folder / "report.md").write_text(report(table), encoding="utf-8")
    completed = int((table["status"] == TrialStatus.COMPLETED).sum())
    sys.stdout.write(f"{completed} of {len(table)} trials completed; see {folder}/table.csv and report.md\n")
    return 0 if completed == len(table) else 1


def row_table(table: pd.DataFrame, columns: Sequence[str]) -> str:
    """Return a Markdown table with one line a trial: ``columns``, status and tracking errors."""
    lines = [
        f"| {' | '.join(columns)} | status | CoM rms / max [mm] | height rms [mm] | roll, pitch [deg] | torque [N m] |",
        f"|{'---|' * len(columns)}---|--:|--:|--:|--:|",
    ]
    for _, row in table.iterrows():
        status = row["status"] if row["status"] == TrialStatus.COMPLETED else row["status_reason"]
        if pd.isna(row["com_error_rms_mm"]):
            numbers = "| | | |"
        else:
            numbers = (
                f"{row['com_error_rms_mm']:.1f} / {row['com_error_max_mm']:.1f} | {row['base_height_rms_mm']:.1f} "
                f"| {row['roll_pitch_rms_deg']:.2f} | {row['torque_max_nm']:.0f} |"
            )
        lines.append(f"| {' | '.join(str(row[column]) for column in columns)} | {status} | {numbers}")
    return "\n".join(lines) + "\n"
