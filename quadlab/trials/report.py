"""What the terminal shows when a trial is over."""

from quadlab.trials.job import JobOutcome
from quadlab.trials.result import TrialResult

_KEY_NUMBERS = (
    ("survived", "survived_s", "{:.2f} s"),
    ("distance", "distance_m", "{:.2f} m"),
    ("mean speed", "mean_speed_mps", "{:.3f} m/s"),
    ("CoM error rms / max", ("com_error_rms_mm", "com_error_max_mm"), "{:.1f} / {:.1f} mm"),
    ("base height error rms", "base_height_rms_mm", "{:.1f} mm"),
    ("roll and pitch error rms", "roll_pitch_rms_deg", "{:.2f} deg"),
    ("largest torque", "torque_max_nm", "{:.1f} N m"),
    ("cost of transport", "cost_of_transport", "{:.2f}"),
    ("planning build / solve", ("planning_build_ms", "planning_solve_ms"), "{:.0f} / {:.0f} ms"),
    ("replannings / failed", ("replannings", "replanning_failures"), "{:d} / {:d}"),
    ("control tick median / p99", ("control_tick_median_us", "control_tick_p99_us"), "{:.0f} / {:.0f} us"),
    ("control fallbacks", "control_fallbacks", "{:d}"),
    ("real-time factor", "real_time_factor", "{:.2f}"),
)


def key_numbers(result: TrialResult) -> list[tuple[str, str]]:
    """Return (what, value with unit) of the metrics that exist."""
    rows = []
    for label, fields, layout in _KEY_NUMBERS:
        values = [getattr(result, field) for field in ([fields] if isinstance(fields, str) else fields)]
        if None not in values:
            rows.append((label, layout.format(*values)))
    return rows


def job_report(outcome: JobOutcome) -> str:
    """Return status, key numbers and place of a job that has a result, ready to print.

    Raises:
        ValueError: if it has none.
    """
    result = outcome.result
    if result is None:
        raise ValueError("the job has no result to report")
    if outcome.skipped:
        return f"{outcome.directory}: finished before ({result.status}); add force=true to run it again\n"
    lines = [f"{result.trial_id}: {result.status}" + (f" ({result.status_reason})" if result.status_reason else "")]
    lines += [f"  {label + ':':27}{value}" for label, value in key_numbers(result)]
    return "\n".join([*lines, f"  {'files:':27}{outcome.directory}"]) + "\n"
