"""Time the vertex-ZMP planner on Table I of Winkler 2017 and on random problems, beside the times of the paper.

    python experiments/bench_planners.py --random 300

Build, first solve and repeated solve are apart; loading and compiling of the solver happens once and is counted apart
too. Times are CPU times of one thread.
"""

import argparse
import statistics
import sys
import time
from collections import Counter
from collections.abc import Callable
from functools import partial
from typing import Any

from quadlab.planners.planner import PlanningStatus
from quadlab.planners.vertex_zmp.fast.solver.kkt import forget_plans
from quadlab.planners.vertex_zmp.planner import VertexZmpPlanner
from quadlab.planners.vertex_zmp.random_problems import RandomProblem, random_problem
from quadlab.planners.vertex_zmp.table_one import TABLE_ONE, TableOneCase, table_one_changes, table_one_problem
from quadlab.trials.compose import compose_trial

_COLUMNS = ("paper", "build", "first", "repeat", "ratio", "varied", "ratio", "build", "repeat", "ratio")


def main() -> None:
    """Run the benchmark and print one line a case."""
    parser = argparse.ArgumentParser(description="Benchmark of the vertex-ZMP planner.")
    parser.add_argument("--random", type=int, default=100, help="number of random problems")
    parser.add_argument("--repeats", type=int, default=11, help="solves of which the median counts")
    arguments = parser.parse_args()
    composed: Any = compose_trial(["planner=vertex_zmp"]).planner
    settings = composed.model_dump()
    _warm_up(settings)
    sys.stdout.write("CPU times in [ms]; paper: Ipopt, Intel Core i7, 2.8 GHz, 2017\n")
    sys.stdout.write("columns 2 to 7: fast (varied: random starts and goals, median); 8 to 10: paper\n")
    sys.stdout.write(f"{'case':9s}" + "".join(f"{name:>9s}" for name in _COLUMNS) + "\n")
    for case in TABLE_ONE:
        sys.stdout.write(_case_line(case, settings, arguments.repeats))
        sys.stdout.flush()
    _random_problems(settings, arguments.random)


def _planner(settings: dict[str, Any], changes: dict[str, object]) -> VertexZmpPlanner:
    return VertexZmpPlanner(VertexZmpPlanner.Config.model_validate({**settings, **changes}))


def _warm_up(settings: dict[str, Any]) -> None:
    """Load both solvers; compile the fast one if its machine code is not on disk yet."""
    for transcription in ("fast", "paper"):
        planner = _planner(settings, table_one_changes(TABLE_ONE[3], transcription))
        _, elapsed = _timed(partial(_build_and_solve, planner))
        sys.stdout.write(f"loading {transcription}: {elapsed:.0f} ms (compiling included if it had to be)\n")


def _build_and_solve(planner: VertexZmpPlanner) -> None:
    planner.solve(planner.build(table_one_problem(TABLE_ONE[3])))


def _timed(action: Callable[[], Any]) -> tuple[Any, float]:
    """Return the result of ``action`` and its CPU time in [ms]."""
    begin = time.process_time()
    return action(), 1e3 * (time.process_time() - begin)


def _median(action: Callable[[], Any], repeats: int) -> float:
    return statistics.median(_timed(action)[1] for _ in range(repeats))


def _case_line(case: TableOneCase, settings: dict[str, Any], repeats: int) -> str:
    problem, reported = table_one_problem(case), 1e3 * case.paper_ipopt_s
    fast = _planner(settings, table_one_changes(case, "fast"))
    forget_plans()
    build, build_ms = _timed(partial(fast.build, problem))
    _, first_ms = _timed(build.solve)
    repeat_ms = _median(build.solve, repeats)
    if fast.solve(build).status is not PlanningStatus.SOLVED:
        return f"{case.name:9s} not solved\n"
    varied_ms = statistics.median(
        _median(fast.build(table_one_problem(case, seed)).solve, 3) for seed in range(1, repeats + 1)
    )
    paper = _planner(settings, table_one_changes(case, "paper"))
    ipopt, ipopt_build_ms = _timed(partial(paper.build, problem))
    ipopt_ms = _median(ipopt.solve, 3)
    values = [reported, build_ms, first_ms, repeat_ms, reported / repeat_ms, varied_ms, reported / varied_ms]
    values += [ipopt_build_ms, ipopt_ms, reported / ipopt_ms]
    return f"{case.name:9s}" + "".join(f"{value:9.2f}" for value in values) + "\n"


def _random_problems(settings: dict[str, Any], count: int) -> None:
    """Solve random problems; where the fast program has no answer that of the paper's formulation is asked as well."""
    outcomes: Counter[str] = Counter()
    times: dict[str, list[float]] = {}
    for seed in range(count):
        case = random_problem(seed)
        planner = _planner(settings, {**case.changes, "transcription": "fast"})
        build, build_ms = _timed(partial(planner.build, case.problem))
        outcome = planner.solve(build)
        times.setdefault("build", []).append(build_ms)
        if outcome.plan is None:
            outcomes[f"{outcome.status.value}, Ipopt: {_second_opinion(settings, case)}"] += 1
        else:
            outcomes[outcome.status.value] += 1
            times.setdefault(case.gait, []).append(outcome.plan.report.solve_ms)
    sys.stdout.write(f"{count} random problems, fast: {dict(outcomes)}\n")
    for name, values in sorted(times.items()):
        sys.stdout.write(f"  {name:6s} median {statistics.median(values):6.2f} ms, longest {max(values):6.2f} ms\n")


def _second_opinion(settings: dict[str, Any], case: RandomProblem) -> str:
    planner = _planner(settings, {**case.changes, "transcription": "paper"})
    return planner.solve(planner.build(case.problem)).status.value


if __name__ == "__main__":
    main()
