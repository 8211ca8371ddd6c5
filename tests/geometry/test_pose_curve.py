"""A pose curve passes through its samples, and its derivatives are those of the curve."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quadlab.errors import QuadlabError
from quadlab.geometry.pose_curve import PoseMotion, pose_curve
from quadlab.geometry.rotations import Array, quat_to_matrix, rotation_log, rotation_zyx

RNG = np.random.default_rng(3)
TIMES = np.array([0.2, 0.5, 0.6, 1.0, 1.3, 1.9])  # [s]
POSITIONS = RNG.normal(size=(6, 3))  # [m]
TURNS = Rotation.from_rotvec(RNG.uniform(-0.9, 0.9, (6, 3)))
STEP = 1e-5  # [s]
INNER = [0.21, 0.33, 0.49, 0.55, 0.7, 0.99, 1.1, 1.5, 1.88]


def quats_of(turns: Rotation) -> Array:
    return turns.as_quat(scalar_first=True)


CURVE = pose_curve(TIMES, POSITIONS, quats_of(TURNS))


def assert_same(motion: PoseMotion, other: PoseMotion, atol: float = 1e-12) -> None:
    for part, expected in zip(motion, other, strict=True):
        np.testing.assert_allclose(part, expected, atol=atol)


def assert_at_rest(motion: PoseMotion) -> None:
    for part in (motion.velocity, motion.acceleration, motion.angular_velocity, motion.angular_acceleration):
        np.testing.assert_array_equal(part, np.zeros(3))


@pytest.mark.parametrize("sample", range(6))
def test_curve_passes_through_its_samples(sample: int) -> None:
    motion = CURVE.motion(TIMES[sample])
    np.testing.assert_allclose(motion.position, POSITIONS[sample], atol=1e-12)
    np.testing.assert_allclose(motion.rotation, TURNS[sample].as_matrix(), atol=1e-12)


@pytest.mark.parametrize("time_s", INNER)
def test_derivatives_agree_with_finite_differences(time_s: float) -> None:
    motion, before, after = (CURVE.motion(time_s + step) for step in (0.0, -STEP, STEP))
    turn = rotation_log(after.rotation @ before.rotation.T)
    np.testing.assert_allclose(motion.velocity, (after.position - before.position) / (2 * STEP), atol=1e-6)
    np.testing.assert_allclose(motion.acceleration, (after.velocity - before.velocity) / (2 * STEP), atol=1e-6)
    np.testing.assert_allclose(motion.angular_velocity, turn / (2 * STEP), atol=1e-6)
    change = after.angular_velocity - before.angular_velocity
    np.testing.assert_allclose(motion.angular_acceleration, change / (2 * STEP), atol=1e-5)


@pytest.mark.parametrize("phase", [0.1, 0.5, 0.8])
@pytest.mark.parametrize("piece", range(5))
def test_orientation_is_the_hermite_quaternion_curve(piece: int, phase: float) -> None:
    """The product of Kim 1995 written down once more, from the angular velocities at the ends of the piece."""
    start, end, duration = TURNS[piece], TURNS[piece + 1], TIMES[piece + 1] - TIMES[piece]
    at_start, at_end = (CURVE.motion(TIMES[sample]).angular_velocity for sample in (piece, piece + 1))
    first = start.inv().apply(at_start) * duration / 3
    last = end.inv().apply(at_end) * duration / 3
    middle = (Rotation.from_rotvec(-first) * start.inv() * end * Rotation.from_rotvec(-last)).as_rotvec()
    basis = (1 - (1 - phase) ** 3, 3 * phase**2 - 2 * phase**3, phase**3)
    expected = start
    for weight, turn in zip(basis, (first, middle, last), strict=True):
        expected = expected * Rotation.from_rotvec(weight * turn)
    rotation = CURVE.motion(TIMES[piece] + phase * duration).rotation
    np.testing.assert_allclose(rotation, expected.as_matrix(), atol=1e-12)


@pytest.mark.parametrize("time_s", INNER)
def test_rotation_is_orthogonal(time_s: float) -> None:
    rotation = CURVE.motion(time_s).rotation
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1.0)


@pytest.mark.parametrize("time_s", TIMES[1:-1])
def test_velocities_are_continuous_at_the_samples(time_s: float) -> None:
    before, at, after = (CURVE.motion(time_s + step) for step in (-1e-9, 0.0, 1e-9))
    for motion in (before, after):
        for name in ("position", "velocity", "rotation", "angular_velocity"):
            np.testing.assert_allclose(getattr(motion, name), getattr(at, name), atol=1e-5)


def test_velocities_at_the_samples_are_those_of_parabolas() -> None:
    parabola = np.polynomial.Polynomial.fit(TIMES[1:4], POSITIONS[1:4, 0], 2)
    assert CURVE.motion(TIMES[2]).velocity[0] == pytest.approx(parabola.deriv()(TIMES[2]))
    before, after = (TURNS[2].inv() * TURNS[other] for other in (1, 3))
    parts = 0.4 * -before.as_rotvec() / 0.1 + 0.1 * after.as_rotvec() / 0.4
    np.testing.assert_allclose(CURVE.motion(TIMES[2]).angular_velocity, TURNS[2].apply(parts / 0.5), atol=1e-12)


@pytest.mark.parametrize("time_s", [0.2, 0.25, 0.37, 0.5, 0.61, 0.799])
def test_constant_velocities_are_reproduced_between_the_inner_samples(time_s: float) -> None:
    """Also when the turn goes on past half a turn in all."""
    start, spin, speed = (
        Rotation.from_euler("ZYX", [0.4, -0.3, 0.2]),
        np.array([2.0, -5.0, 7.0]),
        np.array([1.0, 2.0, 0.0]),
    )
    times = np.linspace(0.1, 0.9, 9)
    curve = pose_curve(times, times[:, None] * speed, quats_of(Rotation.from_rotvec(times[:, None] * spin) * start))
    expected = (Rotation.from_rotvec(time_s * spin) * start).as_matrix()
    motion = PoseMotion(time_s * speed, speed, np.zeros(3), expected, spin, np.zeros(3))
    assert_same(curve.motion(time_s), motion, atol=1e-10)


@pytest.mark.parametrize(("time_s", "sample"), [(-1.0, 0), (0.2 - 1e-9, 0), (1.9 + 1e-9, -1), (7.0, -1)])
def test_curve_stands_still_outside_its_span(time_s: float, sample: int) -> None:
    motion = CURVE.motion(time_s)
    np.testing.assert_allclose(motion.position, POSITIONS[sample], atol=1e-12)
    np.testing.assert_allclose(motion.rotation, TURNS[sample].as_matrix(), atol=1e-12)
    assert_at_rest(motion)


@pytest.mark.parametrize("time_s", [0.2, 1.9])
def test_curve_begins_and_ends_at_rest(time_s: float) -> None:
    motion = CURVE.motion(time_s)
    np.testing.assert_allclose(motion.velocity, np.zeros(3), atol=1e-12)
    np.testing.assert_allclose(motion.angular_velocity, np.zeros(3), atol=1e-12)


@pytest.mark.parametrize("time_s", INNER)
def test_curve_turns_with_its_samples(time_s: float) -> None:
    by = rotation_zyx(2.0, 0.6, -1.1)
    turned = pose_curve(TIMES, POSITIONS @ by.T, quats_of(Rotation.from_matrix(by) * TURNS)).motion(time_s)
    motion = CURVE.motion(time_s)
    assert_same(turned, PoseMotion(*(by @ part for part in motion)), atol=1e-9)


@pytest.mark.parametrize("signs", [[1, -1, 1, 1, -1, -1], [-1, -1, -1, 1, 1, 1]])
def test_signs_of_quaternions_do_not_matter(signs: list[int]) -> None:
    flipped = pose_curve(TIMES, POSITIONS, np.array(signs)[:, None] * quats_of(TURNS))
    for time in INNER:
        assert_same(flipped.motion(time), CURVE.motion(time))


@pytest.mark.parametrize("time_s", [0.0, 0.7, 2.0])
def test_single_sample_stands_still(time_s: float) -> None:
    quat = quats_of(TURNS)[:1]
    motion = pose_curve(np.array([0.7]), POSITIONS[:1], quat).motion(time_s)
    np.testing.assert_allclose(motion.position, POSITIONS[0])
    np.testing.assert_allclose(motion.rotation, quat_to_matrix(quat[0]), atol=1e-12)
    assert_at_rest(motion)


def test_two_samples_are_joined_from_rest_to_rest() -> None:
    curve = pose_curve(np.array([0.0, 2.0]), POSITIONS[:2], quats_of(TURNS)[:2])
    middle = (TURNS[0] * Rotation.from_rotvec(0.5 * (TURNS[0].inv() * TURNS[1]).as_rotvec())).as_matrix()
    np.testing.assert_allclose(curve.motion(1.0).position, POSITIONS[:2].mean(axis=0), atol=1e-12)
    np.testing.assert_allclose(curve.motion(1.0).rotation, middle, atol=1e-12)


def test_curve_keeps_its_own_samples() -> None:
    times, positions, quats = TIMES.copy(), POSITIONS.copy(), quats_of(TURNS)
    curve = pose_curve(times, positions, quats)
    for samples in (times, positions, quats):
        samples[:] = 0.0
    assert_same(curve.motion(0.7), CURVE.motion(0.7))


def _bent(samples: Array, index: int, value: float) -> Array:
    changed = samples.copy()
    changed[index] = value
    return changed


@pytest.mark.parametrize(
    ("times", "positions", "quats", "message"),
    [
        (_bent(TIMES, 2, 0.5), POSITIONS, quats_of(TURNS), "times must increase, found 0.5 s after 0.5 s"),
        (_bent(TIMES, 2, 0.4), POSITIONS, quats_of(TURNS), "times must increase, found 0.4 s after 0.5 s"),
        (_bent(TIMES, 2, np.nan), POSITIONS, quats_of(TURNS), "expected finite times and positions"),
        (TIMES, _bent(POSITIONS, 2, np.inf), quats_of(TURNS), "expected finite times and positions"),
        (TIMES, POSITIONS, _bent(quats_of(TURNS), 4, 0.50001), r"norm 1, that of sample 4 has 1\.00002"),
        (TIMES, POSITIONS, _bent(quats_of(TURNS), 4, np.nan), "norm 1, that of sample 4 has nan"),
        (TIMES[:5], POSITIONS, quats_of(TURNS), r"found \(5,\), \(6, 3\), \(6, 4\)"),
        (TIMES, POSITIONS[:, :2], quats_of(TURNS), r"found \(6,\), \(6, 2\), \(6, 4\)"),
        (TIMES, POSITIONS, quats_of(TURNS)[:, :3], r"found \(6,\), \(6, 3\), \(6, 3\)"),
        (TIMES[:, None], POSITIONS, quats_of(TURNS), r"found \(6, 1\), \(6, 3\), \(6, 4\)"),
        (TIMES[:0], POSITIONS[:0], quats_of(TURNS)[:0], r"found \(0,\), \(0, 3\), \(0, 4\)"),
    ],
)
def test_bad_samples_are_named_in_one_line(times: Array, positions: Array, quats: Array, message: str) -> None:
    with pytest.raises(QuadlabError, match=message) as caught:
        pose_curve(times, positions, quats)
    assert "\n" not in str(caught.value)
