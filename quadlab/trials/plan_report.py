"""What the terminal shows of a plan."""

from collections.abc import Iterator, Mapping

from quadlab.planners.plan import MotionPlan, PlanVerdict
from quadlab.trials.plan_job import PlanJobOutcome

_LABEL_WIDTH = 34


def plan_report(job: PlanJobOutcome) -> str:
    """Return status, size, times, costs, residuals and verdict by name, and the place of the files, ready to print."""
    outcome = job.outcome
    lines = [f"{outcome.status}: {outcome.reason}"]
    if outcome.plan is not None:
        lines += _plan_lines(outcome.plan)
    return "\n".join([*lines, _row("files", str(job.directory))]) + "\n"


def _plan_lines(plan: MotionPlan) -> Iterator[str]:
    report = plan.report
    yield _row("planner", report.planner)
    yield _row("duration", f"{plan.duration_s:g} s")
    yield _row("footholds", str(sum(len(footholds) - 1 for footholds in plan.footholds)))
    yield _row("variables / constraints", f"{report.variables} / {report.constraints}")
    yield _row("build / solve", f"{report.build_ms:.1f} / {report.solve_ms:.1f} ms")
    yield _row("iterations", str(report.iterations))
    yield from _named("costs", report.costs)
    yield from _named("residuals", report.residuals)
    yield from _verdict(plan.verdict)


def _named(title: str, values: Mapping[str, float]) -> Iterator[str]:
    yield f"  {title}"
    yield from (_row(f"  {name}", f"{value:.4g}") for name, value in values.items())


def _verdict(verdict: PlanVerdict) -> Iterator[str]:
    yield "  verdict of the checker (value, tolerance)"
    for name, value in verdict.values.items():
        yield _row(f"  {name}", f"{value:<10.3g} {verdict.tolerances[name]:g}")


def _row(label: str, value: str) -> str:
    return f"  {label + ':':{_LABEL_WIDTH}} {value}"
