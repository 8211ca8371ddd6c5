"""The motions of the paper converge, and their minima keep what the program promises."""

import numpy as np
import pytest
from kinematic_cases import PAPER_MOTIONS, ROBOTS, Motion, mirrored, paper_minimum, perturbed, planner, problem, robot

from quadlab.planners.kinematic_sqp.sqp import minimise, objective_history

TABLE_I = [
    "com_consistency",
    "feet_consistency",
    "dynamic_stability",
    "travel_distance_transition",
    "travel_distance_periodic",
    "turning_angle_periodic",
    "smooth_base",
    "smooth_joints",
    "smooth_com",
    "smooth_feet",
]
GRAVITY = 9.81


@pytest.mark.parametrize("robot_name", ROBOTS)
@pytest.mark.parametrize("name", PAPER_MOTIONS)
def test_paper_motion_converges(robot_name: str, name: str) -> None:
    build, minimum = paper_minimum(robot_name, name)
    assert minimum.converged, minimum.reason
    assert len(minimum.steps) <= 12
    assert set(TABLE_I) <= set(minimum.history[-1])
    assert all(np.isfinite(cost) for costs in minimum.history for cost in costs.values())
    assert (np.diff(objective_history(minimum)) <= 1e-6).all()
    assert max(build.program.violations(minimum.p).values()) < 1e-6


@pytest.mark.parametrize("robot_name", ROBOTS)
@pytest.mark.parametrize("name", PAPER_MOTIONS)
def test_auxiliary_points_are_those_of_the_configuration(robot_name: str, name: str) -> None:
    build, minimum = paper_minimum(robot_name, name)
    assert max(build.program.consistency(minimum.p).values()) < 1.0  # [mm]


@pytest.mark.parametrize("name", PAPER_MOTIONS)
def test_command_is_followed(name: str) -> None:
    build, minimum = paper_minimum("anymal_b", name)
    layout, (first, second) = build.program.layout, build.program.grid.spans
    com, yaw = layout.value("com", minimum.p), layout.value("base_rotation", minimum.p)[:, 0]
    turned = np.array([yaw[span.last] - yaw[span.first] for span in (first, second)])
    travelled = np.array([com[span.last] - com[span.first] for span in (first, second)])
    asked = np.array(PAPER_MOTIONS[name].command)
    np.testing.assert_allclose(turned, np.deg2rad(asked[2]), atol=np.deg2rad(0.5))
    np.testing.assert_allclose(travelled[:, :2], [asked[:2], asked[:2]], atol=0.025)


@pytest.mark.parametrize("name", PAPER_MOTIONS)
def test_second_cycle_is_periodic(name: str) -> None:
    build, minimum = paper_minimum("anymal_b", name)
    joints = build.program.layout.value("joints", minimum.p)
    span = build.program.grid.spans[-1]
    np.testing.assert_allclose(joints[span.last], joints[span.first], atol=1e-12)


@pytest.mark.parametrize("name", PAPER_MOTIONS)
def test_cop_stays_at_the_weighted_feet(name: str) -> None:
    """Eq. (7) and (8) once more from the CoM samples alone; equal steps within a cycle."""
    build, minimum = paper_minimum("anymal_b", name)
    layout, grid = build.program.layout, build.program.grid
    span = grid.spans[-1]
    com, loads = layout.value("com", minimum.p), layout.value("loads", minimum.p)
    inner = np.arange(span.first + 1, span.last)
    acceleration = (com[inner + 1] - 2.0 * com[inner] + com[inner - 1]) / grid.periods_s[span.first] ** 2
    lever = com[inner, 2] / (acceleration[:, 2] + GRAVITY)
    cop = com[inner, :2] - lever[:, None] * acceleration[:, :2]
    weighted = np.einsum("ik,ikd->id", loads[inner], layout.feet(minimum.p)[inner])
    assert np.abs(weighted - cop).max() < 0.02  # soft: the start of a walk leaves the least time
    np.testing.assert_allclose(loads.sum(axis=1), 1.0, atol=1e-9)
    assert loads[~grid.support].max() == 0.0
    assert loads[grid.support].min() > 0.1 - 1e-6


def test_mirrored_trot_is_the_other_trot() -> None:
    """A trot that begins with the other diagonal is the reflection of the trot; the CoM is 0.7 mm off the middle."""
    build, minimum = paper_minimum("anymal_b", "trot")
    asked = problem("anymal_b", PAPER_MOTIONS["trot"])
    other = type(asked)(
        asked.start,
        asked.waypoints,
        type(asked.schedule)(asked.schedule.durations_s, asked.schedule.contacts[:, [1, 0, 3, 2]]),
        asked.model,
        asked.robot,
    )
    kinematic = planner()
    reflected = kinematic.build(other)
    found = minimise(reflected.program, kinematic.config.sqp)
    layout = build.program.layout
    np.testing.assert_allclose(layout.feet(found.p), mirrored(layout.feet(minimum.p)), atol=4e-3)
    flipped = layout.value("com", minimum.p) * np.array([1.0, -1.0, 1.0])
    np.testing.assert_allclose(layout.value("com", found.p), flipped, atol=4e-3)


@pytest.mark.parametrize("qp_solver", ["proxqp", "piqp"])
def test_qp_solvers_find_the_same_minimum(qp_solver: str) -> None:
    _, expected = paper_minimum("anymal_b", "trot")
    kinematic = planner(sqp={"qp_solver": qp_solver})
    found = minimise(kinematic.build(problem("anymal_b", PAPER_MOTIONS["trot"])).program, kinematic.config.sqp)
    assert objective_history(found)[-1] == pytest.approx(objective_history(expected)[-1], rel=1e-5)
    np.testing.assert_allclose(found.p, expected.p, atol=1e-3)


@pytest.mark.parametrize("seed", range(6))
def test_other_starts_and_commands_converge(seed: int) -> None:
    random = np.random.default_rng(seed)
    gaits = [("walk", "walk"), ("trot", "trot"), ("walk", "trot")][seed % 3]
    command = tuple(float(value) for value in random.uniform(-1.0, 1.0, 3) * np.array([0.2, 0.1, 20.0]))
    strides = tuple({"walk": 5.0, "trot": 0.8}[name] for name in gaits)
    motion = Motion(gaits, strides, (command[0], command[1], command[2]))
    kinematic = planner()
    build = kinematic.build(problem("anymal_b", motion, perturbed(robot("anymal_b"), random)))
    minimum = minimise(build.program, kinematic.config.sqp)
    assert minimum.converged, minimum.reason
    assert max(build.program.violations(minimum.p).values()) < 1e-4
