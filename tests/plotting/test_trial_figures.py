"""One call draws a trial; the same log gives the same bytes; what cannot be drawn says why in one line."""

from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from plotting_cases import gait_schedule, scheduled_tick, straight_plan, write_trial
from synthetic_records import CONTROL_PERIOD, write_interrupted_log, write_log

from quadlab.controllers.telemetry import LegMode
from quadlab.errors import LogError
from quadlab.geometry.rotations import Array
from quadlab.plotting import trial_figures
from quadlab.plotting.figure_files import save_figure
from quadlab.plotting.trial.base import draw_base_angle
from quadlab.plotting.trial.com import draw_com_error
from quadlab.plotting.trial.feet import draw_foot_height
from quadlab.plotting.trial.forces import draw_normal_force
from quadlab.plotting.trial.overview import overview_figure, title
from quadlab.plotting.trial.torques import draw_torques
from quadlab.plotting.trial_figures import FIGURES, figures_of, plot_trial
from quadlab.plotting.trial_view import TrialView, load_trial_view
from quadlab.robots.catalogue import robot_config, robot_names
from quadlab.robots.legs import LEG_JOINTS, LEGS
from quadlab.robots.model import load_robot
from quadlab.trials.result import TrialResult, TrialStatus, write_result

STANDING = (LegMode.STANCE,) * 4
ALL_FIGURES = {**FIGURES, "overview": overview_figure}


def _result(status: TrialStatus, reason: str) -> TrialResult:
    return TrialResult(
        trial_id="0123456789abcdef",
        status=status,
        status_reason=reason,
        robot="anymal_b",
        gait="trot",
        planner="synthetic",
        controller="hierarchical",
        estimator="truth",
        scenario="plank",
        seed=0,
        duration_s=1.0,
        survived_s=0.25,
    )


def _write(directory: Path, *, robot: str = "anymal_b", ticks: int = 100, wall_times: bool = True) -> Path:
    schedule = gait_schedule("trot")
    records = [scheduled_tick(index, schedule, CONTROL_PERIOD, STANDING) for index in range(ticks)]
    return write_trial(directory, records, straight_plan(schedule), robot=robot, wall_times=wall_times)


@pytest.fixture(scope="module")
def directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return _write(tmp_path_factory.mktemp("trial"))


@pytest.fixture(scope="module")
def view(directory: Path) -> TrialView:
    return load_trial_view(directory)


@pytest.fixture(scope="module")
def drawn(directory: Path) -> list[Path]:
    return plot_trial(directory)


def test_every_figure_is_written_beside_the_log(directory: Path, drawn: list[Path]) -> None:
    names = {"overview.png"} | {f"{name}.{kind}" for name in FIGURES for kind in ("png", "pdf")}
    assert {path.relative_to(directory / "plots").as_posix() for path in drawn} == names
    starts = {".png": b"\x89PNG", ".pdf": b"%PDF"}
    assert all(path.read_bytes().startswith(starts[path.suffix]) for path in drawn)


@pytest.mark.parametrize("name", ALL_FIGURES)
def test_a_second_drawing_has_the_same_bytes_whatever_the_user_has_set(
    name: str, view: TrialView, drawn: list[Path], tmp_path: Path
) -> None:
    first = {path.name: path.read_bytes() for path in drawn if path.stem == name}
    with mpl.rc_context({"font.size": 20.0, "lines.linewidth": 9.0, "pdf.fonttype": 3, "axes.grid": False}):
        again = save_figure(ALL_FIGURES[name](view), tmp_path, name, [file.rsplit(".")[-1] for file in first])
        assert mpl.rcParams["font.size"] == 20.0
    assert {path.name: path.read_bytes() for path in again} == first


@pytest.mark.parametrize("draw", [FIGURES["com"], FIGURES["plan_top_down"]])
def test_vector_graphics_for_the_web_have_the_same_bytes_too(
    draw: Callable[[TrialView], Figure], view: TrialView, tmp_path: Path
) -> None:
    first, second = (save_figure(draw(view), tmp_path / part, "figure", ["svg"])[0] for part in "ab")
    assert first.read_bytes() == second.read_bytes()


def test_a_log_without_computing_times_has_no_figure_of_them(tmp_path: Path) -> None:
    view = load_trial_view(_write(tmp_path, ticks=5, wall_times=False))
    assert set(figures_of(view)) == set(FIGURES) - {"timing"}


def drawn_lines(draw: Callable[..., None], *arguments: object) -> dict[str, Array]:
    """What a function draws into axes, by label."""
    axes = Figure().subplots()
    draw(axes, *arguments)
    return {str(line.get_label()): np.asarray(line.get_ydata(), float) for line in axes.lines}


def test_curves_have_the_units_and_the_legs_that_their_axes_name(view: TrialView) -> None:
    state, control = view.log.state, view.log.control
    errors_mm = drawn_lines(draw_com_error, view)
    for axis in "xyz":
        expected = 1e3 * (control[f"com_{axis}"] - control[f"com_reference_{axis}"])
        np.testing.assert_allclose(errors_mm[axis], expected, atol=1e-3)
    pitch_deg = drawn_lines(draw_base_angle, view, "pitch")
    np.testing.assert_allclose(np.sin(np.radians(pitch_deg["measured"])), np.sin(control["base_pitch"]), atol=1e-6)
    assert np.ptp(pitch_deg["measured"]) > 10.0
    for joint, name in enumerate(LEG_JOINTS):
        torques, limit = drawn_lines(draw_torques, view, joint), view.torque_limits[joint]
        for leg in LEGS:
            np.testing.assert_array_equal(torques[leg], state[f"joint_torque_{leg}_{name}"])
        np.testing.assert_array_equal(torques["limit"], limit)
    for number, leg in enumerate(LEGS):
        forces, heights = (drawn_lines(draw, view, number) for draw in (draw_normal_force, draw_foot_height))
        np.testing.assert_array_equal(forces["desired"], control[f"contact_force_desired_{leg}_z"])
        np.testing.assert_array_equal(heights["measured"], control[f"foot_position_{leg}_z"])


def test_figures_go_where_they_are_wanted(directory: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trial_figures, "FIGURES", {"com": FIGURES["com"]})
    written = plot_trial(directory, tmp_path / "new" / "folder")
    assert [path.relative_to(tmp_path / "new" / "folder").as_posix() for path in written] == [
        "overview.png",
        "com.png",
        "com.pdf",
    ]


def test_title_tells_the_outcome(directory: Path) -> None:
    assert "no result" in title(load_trial_view(directory))
    path = write_result(directory, _result(TrialStatus.FELL, "base below half its height"))
    try:
        text = title(load_trial_view(directory))
    finally:
        path.unlink()
    for word in ("anymal_b", "trot", "synthetic", "hierarchical", "plank", "fell", "half its height", "0.25 s"):
        assert word in text


@pytest.mark.parametrize("robot", robot_names())
def test_torque_limits_are_those_of_the_robot_in_the_log(robot: str, tmp_path: Path) -> None:
    limits = load_trial_view(_write(tmp_path, robot=robot, ticks=1)).torque_limits
    assert limits.tolist() == load_robot(robot_config(robot)).torque_limits.tolist()


def test_directory_without_a_log_is_named_with_what_it_holds(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").touch()
    with pytest.raises(LogError, match=r"no trial\.mcap .* found notes\.txt$"):
        plot_trial(tmp_path)
    with pytest.raises(LogError, match="no such directory"):
        plot_trial(tmp_path / "nowhere")


def test_an_interrupted_trial_is_pointed_to_the_rescue(tmp_path: Path) -> None:
    part = write_interrupted_log(tmp_path / "trial.mcap", ticks=5)
    with pytest.raises(LogError, match=rf"quadlab recover .*{part.name}'$"):
        plot_trial(tmp_path)


def test_a_trial_without_a_plan_says_that_nothing_was_recorded(tmp_path: Path) -> None:
    write_result(tmp_path, _result(TrialStatus.PLANNING_FAILED, "infeasible"))
    with pytest.raises(LogError, match=r"planning_failed \(infeasible\)"):
        plot_trial(tmp_path)


def test_a_log_of_something_else_is_refused_in_one_line(tmp_path: Path) -> None:
    write_log(tmp_path / "trial.mcap", ticks=2)
    with pytest.raises(LogError, match="does not describe a trial") as error:
        plot_trial(tmp_path)
    assert "\n" not in str(error.value)


def test_a_log_without_ticks_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="nothing to draw"):
        plot_trial(_write(tmp_path, ticks=0))
