"""sbatch, srun, sacct, squeue and scancel of a cluster that is this machine: ``fake_slurm.py <command> arguments``.

State lives in the folder FAKE_SLURM; the task FAKE_SLURM_KILL of an array is killed when it starts, and then in the
state FAKE_SLURM_KILLED, FAILED by default. The commands listed in FAKE_SLURM_BROKEN fail.
"""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

JOB = "1000"


def sbatch(script: str) -> None:
    """Run the tasks of the script in the background, all at once, and print the job's number."""
    text = Path(script).read_text()
    (STATE / "script.sh").write_text(text)
    array = re.search(r"#SBATCH --array=0-(\d+)", text)
    tasks = [str(number) for number in range(int(array[1]) + 1)] if array else [""]
    for task in tasks:
        (STATE / _name(task)).write_text("PENDING")
        command = [sys.executable, __file__, "task", script, task]
        subprocess.Popen(command, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    sys.stdout.write(f"Submitted batch job {JOB}\n")


def task(script: str, number: str) -> None:
    """Run one task as a node would and note how it ended."""
    state = STATE / _name(number)
    if state.read_text() == "CANCELLED":
        return
    state.write_text(f"RUNNING {os.getpid()}")
    array = {"SLURM_ARRAY_JOB_ID": JOB, "SLURM_ARRAY_TASK_ID": number} if number else {}
    one = dict.fromkeys(("SLURM_NTASKS", "SLURM_JOB_NUM_NODES"), "1")
    zero = dict.fromkeys(("SLURM_PROCID", "SLURM_LOCALID", "SLURM_NODEID"), "0")
    node = {"SLURM_JOB_ID": JOB, "SLURM_JOB_NODELIST": "localhost", **array, **one, **zero}
    code = subprocess.run(["bash", script], env={**os.environ, **node}, check=False).returncode
    state.write_text(os.environ.get("FAKE_SLURM_KILLED", "FAILED") if code else "COMPLETED")


def srun(*arguments: str) -> None:
    """Run the command among the arguments."""
    number = os.environ.get("SLURM_ARRAY_TASK_ID", "")
    if number and number == os.environ.get("FAKE_SLURM_KILL"):
        os.kill(os.getpid(), signal.SIGKILL)
    command = arguments[arguments.index(sys.executable) :]
    with (STATE / f"output_{number}").open("w") as output:
        sys.exit(subprocess.run(command, stdout=output, stderr=output, check=False).returncode)


def sacct(*_: str) -> None:
    """Print the state of all tasks as accounting does."""
    lines = [f"{task}|{state}|localhost" for task, state in _states()]
    sys.stdout.write("\n".join(["JobID|State|NodeList", *lines]) + "\n")


def squeue(*_: str) -> None:
    """Print the state of all tasks as the scheduler does."""
    sys.stdout.writelines(f"{task} {state}\n" for task, state in _states())


def scancel(job: str, *_: str) -> None:
    """Kill the tasks of a job that wait or run and all that they started."""
    for path in STATE.glob(f"{job}*"):
        words = path.read_text().split()
        if words[0] in ("PENDING", "RUNNING"):
            path.write_text("CANCELLED")
        if words[0] == "RUNNING":
            os.killpg(int(words[1]), signal.SIGKILL)


def _states() -> list[tuple[str, str]]:
    return [(path.name, path.read_text().split()[0]) for path in STATE.glob(f"{JOB}*")]


def _name(number: str) -> str:
    return f"{JOB}_{number}" if number else JOB


COMMANDS: dict[str, Callable[..., None]] = {
    command.__name__: command for command in (sbatch, task, srun, sacct, squeue, scancel)
}

if __name__ == "__main__":
    STATE = Path(os.environ["FAKE_SLURM"])
    if sys.argv[1] in os.environ.get("FAKE_SLURM_BROKEN", "").split():
        sys.exit("slurm_load_jobs error: Unable to contact slurm controller")
    COMMANDS[sys.argv[1]](*sys.argv[2:])
