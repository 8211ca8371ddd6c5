"""Motion plans as bytes that can be attached to a log."""

import io
import json
import zipfile
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from quadlab.errors import LogError
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.plan import MotionPlan, PlanReport, PlanVerdict
from quadlab.robots.legs import LEGS

_CURVES = ("com", "heading", "cop")


def pack_plan(plan: MotionPlan, *, wall_times: bool = True) -> bytes:
    """Return ``plan`` as an .npz archive; equal plans give equal bytes.

    Args:
        plan: what is packed.
        wall_times: False sets build and solve time, which differ between runs, to 0.
    """
    report = plan.report if wall_times else replace(plan.report, build_ms=0.0, solve_ms=0.0)
    arrays: dict[str, Any] = {
        "schedule_durations_s": plan.schedule.durations_s,
        "schedule_contacts": plan.schedule.contacts,
        "report": np.array(json.dumps(asdict(report), sort_keys=True)),
        "verdict": np.array(json.dumps(asdict(plan.verdict), sort_keys=True)),
    }
    for name in _CURVES:
        curve: PiecewisePolynomial = getattr(plan, name)
        arrays |= {f"{name}_knots": curve.knots, f"{name}_coefficients": curve.coefficients}
    arrays |= {f"footholds_{leg}": rows for leg, rows in zip(LEGS, plan.footholds, strict=True)}
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **arrays)
    return buffer.getvalue()


def unpack_plan(data: bytes) -> MotionPlan:
    """Return the plan in ``data``.

    Raises:
        LogError: if ``data`` was not made by ``pack_plan``.
    """
    try:
        with np.load(io.BytesIO(data)) as archive:
            arrays = dict(archive)
        curves = {
            name: PiecewisePolynomial(arrays[f"{name}_knots"], arrays[f"{name}_coefficients"]) for name in _CURVES
        }
        return MotionPlan(
            schedule=ContactSchedule(arrays["schedule_durations_s"], arrays["schedule_contacts"]),
            footholds=tuple(arrays[f"footholds_{leg}"] for leg in LEGS),
            report=PlanReport(**json.loads(str(arrays["report"]))),
            verdict=PlanVerdict(**json.loads(str(arrays["verdict"]))),
            **curves,
        )
    except (KeyError, TypeError, ValueError, zipfile.BadZipFile) as error:
        raise LogError(f"not a motion plan of quadlab ({type(error).__name__}: {error})") from error
