"""Evaluation of whole curves at many times at once, from both sides of every knot."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quadlab.gaits.schedule import Swing
from quadlab.geometry.curve import Curve
from quadlab.geometry.rotations import Array
from quadlab.planners.plan import MotionPlan
from quadlab.planners.swing import swing_blend

_KNOT_TOLERANCE = 1e-9  # [s] knots closer than this are one


@dataclass(frozen=True)
class Samples:
    """Dense times; at a knot there is one sample that belongs to the interval before it and one after it.

    Attributes:
        times: (s,) in [s].
        inside: a time within the open interval between knots to which each sample belongs, (s,) in [s].
    """

    times: Array
    inside: Array


def dense_samples(knots: Sequence[Array], duration_s: float, period_s: float) -> Samples:
    """Return samples over [0, duration_s], at most ``period_s`` apart, each interval with both of its ends."""
    merged = np.sort(np.clip(np.concatenate([*knots, [0.0, duration_s]]), 0.0, duration_s))
    merged = merged[np.r_[True, np.diff(merged) > _KNOT_TOLERANCE]]
    counts = np.ceil(np.diff(merged) / period_s).astype(int) + 1
    times = [np.linspace(a, b, count) for a, b, count in zip(merged[:-1], merged[1:], counts, strict=True)]
    return Samples(np.concatenate(times), np.repeat(0.5 * (merged[:-1] + merged[1:]), counts))


def evaluate(curve: Curve, samples: Samples, derivative: int = 0) -> Array:
    """Return a curve or one of its time derivatives at all samples, (s, d); at rest outside its span."""
    piece = np.clip(np.searchsorted(curve.knots, samples.inside) - 1, 0, len(curve.knots) - 2)
    local = np.clip(samples.times, curve.knots[0], curve.knots[-1]) - curve.knots[piece]
    values = curve.on_pieces(piece, local, derivative)
    resting = (samples.inside < curve.knots[0]) | (samples.inside > curve.knots[-1])
    return np.where(resting[:, None], 0.0, values) if derivative else values


def largest_jump(curve: Curve, derivative: int) -> float:
    """Return the largest discontinuity of a time derivative at the inner knots of a curve."""
    if len(curve.knots) < 3:
        return 0.0
    before = np.arange(len(curve.knots) - 2)
    ends = curve.on_pieces(before, np.diff(curve.knots)[:-1], derivative)
    return largest_norm(curve.on_pieces(before + 1, np.zeros(len(before)), derivative) - ends)


def largest_norm(rows: Array) -> float:
    """Return the largest Euclidean norm of the rows of (s, d)."""
    return float(np.linalg.norm(rows, axis=1).max())


def foot_positions(plan: MotionPlan, leg: int, samples: Samples) -> Array:
    """Return one foot over the ground at all samples, (s, 2): standing or on the cubic between two footholds."""
    return foot_path(plan.footholds[leg], plan.schedule.swings[leg], samples)


def foot_path(footholds: Array, swings: Sequence[Swing], samples: Samples) -> Array:
    """Return where a foot with these ``footholds`` (swings + 1, 3) is over the ground at all samples, (s, 2)."""
    places = footholds[:, :2]
    if not swings:
        return np.repeat(places, len(samples.times), axis=0)
    starts = np.array([swing.start_s for swing in swings])
    ends = np.array([swing.end_s for swing in swings])
    begun, landed = np.searchsorted(starts, samples.inside), np.searchsorted(ends, samples.inside)
    swing = np.minimum(landed, len(swings) - 1)
    fraction = np.clip((samples.times - starts[swing]) / (ends - starts)[swing], 0.0, 1.0)
    blend = np.where(begun > landed, swing_blend(fraction), 0.0)[:, None]
    path: Array = (1.0 - blend) * places[landed] + blend * places[begun]
    return path


def turned_vertices(vertices: Array, yaws: Array) -> Array:
    """Return the vertices of a foot (v, 2) turned by ``yaws`` of any shape in [rad], (..., v, 2) in [m]."""
    cosine, sine = np.cos(yaws)[..., None], np.sin(yaws)[..., None]
    forward, left = vertices[:, 0], vertices[:, 1]
    return np.stack([cosine * forward - sine * left, sine * forward + cosine * left], axis=-1)
