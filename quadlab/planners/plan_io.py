"""Motion plans as files: a NumPy archive with a JSON header, exact to the last bit."""

import io
import json
import zipfile
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from quadlab.errors import LogError
from quadlab.gaits.schedule import ContactSchedule
from quadlab.geometry.curve import Curve
from quadlab.geometry.lip_curve import LipCurve
from quadlab.geometry.rotations import Array
from quadlab.geometry.splines import PiecewisePolynomial
from quadlab.planners.plan import BaseMotion, MotionPlan, PlanReport, PlanVerdict
from quadlab.robots.legs import foot_names

FORMAT = "quadlab motion plan"
VERSION = 1
_CURVES = ("com", "heading", "cop")
_BASE = ("times_s", "positions", "quats_wxyz")


def save_plan(plan: MotionPlan, path: Path | str) -> None:
    """Write ``plan`` to ``path``, whatever its suffix."""
    Path(path).write_bytes(plan_to_bytes(plan))


def load_plan(path: Path | str) -> MotionPlan:
    """Return the plan that ``save_plan`` wrote to ``path``.

    Raises:
        LogError: if the file is missing or is not a whole motion plan of this version.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise LogError(f"{path}: cannot be read ({error.strerror})") from error
    return bytes_to_plan(data, str(path))


def plan_to_bytes(plan: MotionPlan) -> bytes:
    """Return the content of a plan file; equal plans give equal bytes."""
    header = {"format": FORMAT, "version": VERSION, "report": asdict(plan.report), "verdict": asdict(plan.verdict)}
    arrays: dict[str, Any] = {
        "header": np.frombuffer(json.dumps(header).encode(), dtype=np.uint8),
        "durations_s": plan.schedule.durations_s,
        "contacts": plan.schedule.contacts,
    }
    for name in _CURVES:
        arrays |= _curve_arrays(name, getattr(plan, name))
    for leg, footholds in zip(foot_names(len(plan.footholds)), plan.footholds, strict=True):
        arrays[f"footholds_{leg}"] = footholds
    for leg, yaws in zip(foot_names(len(plan.foot_yaws)), plan.foot_yaws, strict=True):
        arrays[f"yaws_{leg}"] = yaws
    if plan.base is not None:
        arrays |= {f"base_{name}": getattr(plan.base, name) for name in _BASE}
    buffer = io.BytesIO()
    np.savez(buffer, **arrays)
    return buffer.getvalue()


def bytes_to_plan(data: bytes, source: str = "plan") -> MotionPlan:
    """Return the plan in the content of a plan file.

    Args:
        data: what ``plan_to_bytes`` returned.
        source: what error messages call the data.

    Raises:
        LogError: if it is not a whole motion plan of this version.
    """
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
        header = json.loads(arrays["header"].tobytes())
        if not isinstance(header, dict) or header.get("format") != FORMAT:
            raise LogError(f"{source}: not a {FORMAT}")
        if header["version"] != VERSION:
            raise LogError(f"{source}: {FORMAT} of version {header['version']}, expected {VERSION}")
        return _plan(arrays, header)
    except (ValueError, KeyError, TypeError, AttributeError, EOFError, OSError, zipfile.BadZipFile) as error:
        raise LogError(f"{source}: not a whole {FORMAT} ({type(error).__name__}: {error})") from error


def _plan(arrays: dict[str, Array], header: dict[str, Any]) -> MotionPlan:
    feet = foot_names(arrays["contacts"].shape[1])
    com, heading, cop = (_curve(name, arrays) for name in _CURVES)
    return MotionPlan(
        schedule=ContactSchedule(arrays["durations_s"], arrays["contacts"].astype(bool)),
        com=com,
        heading=heading,
        cop=cop,
        footholds=tuple(arrays[f"footholds_{leg}"] for leg in feet),
        report=PlanReport(**header["report"]),
        verdict=PlanVerdict(**header["verdict"]),
        foot_yaws=tuple(arrays[f"yaws_{leg}"] for leg in feet if f"yaws_{leg}" in arrays),
        base=BaseMotion(*(arrays[f"base_{name}"] for name in _BASE)) if "base_times_s" in arrays else None,
    )


def _curve_arrays(name: str, curve: Curve) -> dict[str, Array]:
    """Return the arrays of one curve; what it consists of follows from which of them there are."""
    match curve:
        case PiecewisePolynomial():
            return {f"{name}_knots": curve.knots, f"{name}_coefficients": curve.coefficients}
        case LipCurve():
            rate = np.array(curve.rate)
            return {f"{name}_knots": curve.knots, f"{name}_pendulum": curve.coefficients, f"{name}_rate": rate}
    raise TypeError(f"{name}: a {type(curve).__name__} cannot be written, only PiecewisePolynomial and LipCurve")


def _curve(name: str, arrays: dict[str, Array]) -> Curve:
    if f"{name}_rate" in arrays:
        return LipCurve(arrays[f"{name}_knots"], arrays[f"{name}_pendulum"], float(arrays[f"{name}_rate"]))
    return PiecewisePolynomial(arrays[f"{name}_knots"], arrays[f"{name}_coefficients"])
