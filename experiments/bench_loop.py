"""Where the time of a whole trial goes: planning, model terms, references, solve, physics, log and the rest.

    python experiments/bench_loop.py [--robot anymal_b] [--duration 10]

A trial with its log is run once to load and compile everything and then again. Processor time of one core, so that
other processes on the machine count less; the parts are wall time within it and are printed as shares of the loop.
"""

import argparse
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from threadpoolctl import threadpool_limits

from quadlab.analysis.log_reader import read_log
from quadlab.controllers.tracking_controller import TrackingController
from quadlab.simulation.simulator import Simulator
from quadlab.trials.compose import compose_trial
from quadlab.trials.config import TrialConfig
from quadlab.trials.metrics import TrialMetrics
from quadlab.trials.observer import Observer
from quadlab.trials.progress import SilentProgress
from quadlab.trials.recording.recorder import TrialRecorder
from quadlab.trials.recording.topics import LOG_FILE
from quadlab.trials.runner import ClosedLoop, run_trial

ESTIMATORS = ("truth", "ekf")
GAITS = ("trot", "walk")
PARTS: dict[str, tuple[type, str]] = {
    "loop": (ClosedLoop, "run"),
    "controller": (TrackingController, "tick"),
    "estimator": (Observer, "observe"),
    "physics": (Simulator, "advance"),
    "state": (Simulator, "read"),
    "log": (TrialRecorder, "record"),
    "metrics": (TrialMetrics, "add"),
}
"""Methods that are timed, none of them within another but the loop."""


@dataclass
class Clock:
    """Time that was spent in a method so far, in [s]."""

    spent_s: float = 0.0


@contextmanager
def timed(owner: type, name: str) -> Iterator[Clock]:
    """Measure all calls of the method ``name`` of ``owner`` while the context lasts."""
    clock, original = Clock(), getattr(owner, name)

    def measured(*arguments: Any, **options: Any) -> Any:
        began = time.perf_counter()
        try:
            return original(*arguments, **options)
        finally:
            clock.spent_s += time.perf_counter() - began

    setattr(owner, name, measured)
    try:
        yield clock
    finally:
        setattr(owner, name, original)


def measure(config: TrialConfig, run: Callable[[TrialConfig, Path], Any]) -> str:
    """Return one line on a trial."""
    with TemporaryDirectory() as folder, ExitStack() as stack:
        clocks = {part: stack.enter_context(timed(*method)) for part, method in PARTS.items()}
        began = time.process_time()
        result = run(config, Path(folder))
        processor_s = time.process_time() - began
        timing = read_log(Path(folder) / LOG_FILE).timing
    spent = {part: clock.spent_s for part, clock in clocks.items()}
    parts = {"planning": 1e-3 * ((result.planning_build_ms or 0.0) + (result.planning_solve_ms or 0.0))}
    parts |= {name: 1e-6 * float(timing[f"{name}_us"].sum()) for name in ("model", "reference", "solve")}
    parts |= {part: spent[part] for part in PARTS if part not in ("loop", "controller")}
    whole = spent["loop"] + parts["planning"]
    shares = "  ".join(f"{name} {100.0 * value / whole:.0f}" for name, value in parts.items())
    rest = 100.0 * (1.0 - sum(parts.values()) / whole)
    return f"{result.gait:6}{result.estimator:7}{processor_s:6.2f} s  {whole:6.2f} s  {shares}  rest {rest:.0f}"


def _run(config: TrialConfig, folder: Path) -> Any:
    return run_trial(config, folder, SilentProgress())


def main() -> int:
    """Print all measurements."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robot", default="anymal_b", help="name in conf/robot")
    parser.add_argument("--duration", type=float, default=10.0, help="of the trials in [s]")
    arguments = parser.parse_args()
    sys.stdout.write(
        f"trials of {arguments.duration:g} s with log: processor time, plan and loop, shares of these in %\n"
    )
    with threadpool_limits(1):
        for estimator, gait in product(ESTIMATORS, GAITS):
            overrides = [f"robot={arguments.robot}", f"gait={gait}", f"estimator={estimator}"]
            config = compose_trial([*overrides, f"duration_s={arguments.duration:g}"])
            measure(config, _run)
            sys.stdout.write(f"  {measure(config, _run)}\n")
            sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
