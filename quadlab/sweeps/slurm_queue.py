"""What SLURM's queue says of the tasks of a job array, and taking them out of it."""

import os
import subprocess
from collections.abc import Iterable

from quadlab.sweeps.interrupts import interrupts_later
from quadlab.sweeps.progress import SweepProgress

_PATIENCE_S = 60.0  # [s] for a command of SLURM
_FINAL = frozenset(
    {"BOOT_FAIL", "CANCELLED", "COMPLETED", "DEADLINE", "FAILED", "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED", "TIMEOUT"}
)


class QueueWatch:
    """Finds tasks that are over and have not answered.

    It asks squeue. Accounting, which need not be there, calls a task PREEMPTED whether it is queued again or not.
    """

    def __init__(self, array: str, progress: SweepProgress) -> None:
        """Watch the job ``array``; ``progress`` is told if nothing can be found out."""
        self._array, self._progress = array, progress
        self._listed = self._told = False
        self._missed: set[str] = set()

    def gone(self, waiting: Iterable[str]) -> set[str]:
        """Return which of the tasks ``waiting`` were over the last two times.

        Not the first time: an answer takes a moment to be seen on a file system that is shared.
        """
        states = task_states(self._array)
        self._listed = self._listed or bool(states)
        if states is None or not self._listed:  # SLURM does not answer, or it is that of another cluster
            self._tell(f"squeue says nothing of job {self._array}: a task that dies without an answer is not noticed")
            self._missed = set()
            return set()
        missed = {task for task in waiting if states.get(task) in {None, *_FINAL}}
        gone, self._missed = missed & self._missed, missed
        return gone

    def _tell(self, text: str) -> None:
        if not self._told:
            self._progress.notice(text)
        self._told = True


def task_states(array: str) -> dict[str, str] | None:
    """Return the states of the tasks of a job by their ids, those that were over long ago left out; None if unknown."""
    command = ["squeue", "--noheader", "--array", "--states=all", "--format=%i %T", f"--jobs={array}"]
    plain = {name: value for name, value in os.environ.items() if not name.startswith("SQUEUE_")}
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False, env=plain, timeout=_PATIENCE_S)
    except (OSError, subprocess.TimeoutExpired):
        return None
    if done.returncode:
        return {} if "Invalid job id" in done.stderr else None
    rows = [line.split() for line in done.stdout.splitlines()]
    return {row[0]: row[1] for row in rows if len(row) == 2}


def cancel(array: str, progress: SweepProgress) -> None:
    """Cancel what is left of a job, and say so if that fails; Ctrl-C meanwhile counts afterwards."""
    command = ["scancel", array]
    with interrupts_later():
        try:
            done = subprocess.run(
                command, capture_output=True, check=False, timeout=_PATIENCE_S, start_new_session=True
            )
            failed = done.returncode != 0
        except (OSError, subprocess.TimeoutExpired):
            failed = True
        if failed:
            progress.notice(f"'{' '.join(command)}' failed; give it again, or tasks run on")
