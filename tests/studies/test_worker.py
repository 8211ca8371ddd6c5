"""A job leaves what its study asks for now, and is remembered under the configuration that it was run with."""

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from quadlab.analysis.study_results import StudyResults
from quadlab.studies import jobs, worker
from quadlab.studies.condition import conditions
from quadlab.studies.config import StudyConfig
from quadlab.studies.files import StudyFolder, configuration_hash
from quadlab.studies.rows import DIRECTORY, Row
from quadlab.studies.work import Work, remembered
from quadlab.studies.worker import do_work
from quadlab.trials.composer import Composer

STANDING = {
    "title": "A robot that stands",
    "blocks": [{"overrides": ["gait=stand", "command=in_place", "duration_s=1.2"], "factors": {"seed": [0, 1]}}],
    "traces": [{"name": "first", "where": {"seed": 0}, "columns": ["state.base_position_*"], "rate_hz": 50}],
    "report_by": ["seed"],
}
OTHER_COLUMNS = [{**STANDING["traces"][0], "columns": ["state.base_quat_?"]}]  # type: ignore[dict-item]
NO_SUCH_COLUMN = [{**STANDING["traces"][0], "columns": ["state.base_quat_u"]}]  # type: ignore[dict-item]


def _work(results: Path, seed: int = 0, configuration: str | None = None, **changes: object) -> Work:
    study = StudyConfig.model_validate({**STANDING, **changes})
    condition = next(condition for condition in conditions(study) if condition.levels["seed"] == seed)
    return Work(study, StudyFolder(results / "standing"), condition, configuration or configuration_hash())


def _job(monkeypatch: pytest.MonkeyPatch, job: Callable[[], Row]) -> None:
    """Make ``job: fake`` something that studies can ask for."""

    def run(overrides: Sequence[str], folder: Path, composer: Composer) -> Row:
        return job()

    monkeypatch.setitem(jobs.JOBS, "fake", run)


def test_yaml_is_composed_anew_for_another_configuration(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen = []

    def run(overrides: Sequence[str], folder: Path, composer: Composer) -> Row:
        seen.append(composer)
        return {"status": "error"}

    monkeypatch.setitem(jobs.JOBS, "fake", run)
    for configuration in ("before", "before", "edited"):
        monkeypatch.setattr(worker, "configuration_hash", lambda now=configuration: now)
        do_work(_work(tmp_path, job="fake", configuration=configuration))
    assert seen[0] is seen[1]
    assert seen[1] is not seen[2]


def _rows(results: Path) -> list[Path]:
    return list((results / "standing").glob("rows/*"))


def test_row_is_remembered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _job(monkeypatch, lambda: {"status": "solved"})
    work = _work(tmp_path, job="fake", traces=[])
    assert do_work(work) == remembered(work) == {"status": "solved"}


def test_job_of_another_configuration_than_the_studys_is_not_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _job(monkeypatch, lambda: pytest.fail("it ran"))
    row = do_work(_work(tmp_path, job="fake", configuration="of when the study began"))
    assert row == {
        "status": "error",
        "status_reason": "the configuration was changed while the study ran; run it again",
    }
    assert not _rows(tmp_path)


def test_row_of_a_job_in_which_the_configuration_was_changed_is_not_remembered(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def job() -> Row:
        monkeypatch.setattr(worker, "configuration_hash", lambda: "edited")
        return {"status": "solved"}

    _job(monkeypatch, job)
    assert do_work(_work(tmp_path, job="fake"))["status"] == "error"
    assert not _rows(tmp_path)


def test_error_does_not_take_the_place_of_what_was_remembered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _job(monkeypatch, lambda: {"status": "solved"})
    do_work(_work(tmp_path, job="fake", traces=[]))
    content = _rows(tmp_path)[0].read_bytes()
    _job(monkeypatch, lambda: {"status": "error"})
    assert do_work(_work(tmp_path, job="fake", traces=[])) == {"status": "error"}
    assert _rows(tmp_path)[0].read_bytes() == content


def test_curves_of_a_trial_whose_log_was_deleted_are_made_by_running_it_again(tmp_path: Path) -> None:
    first = do_work(_work(tmp_path))
    log = tmp_path / "standing" / first[DIRECTORY] / "trial.mcap"
    log.unlink()
    again = do_work(_work(tmp_path, traces=OTHER_COLUMNS))
    assert (again["status"], again["log_sha256"]) == ("completed", first["log_sha256"])
    assert log.is_file()
    kept = StudyResults(tmp_path).trace("standing", "first")
    assert list(kept.columns) == [f"state.base_quat_{axis}" for axis in "wxyz"]


def test_hash_of_a_log_that_was_deleted_stays_in_the_row(tmp_path: Path) -> None:
    first = do_work(_work(tmp_path, seed=1))
    assert first["log_sha256"]
    log = tmp_path / "standing" / first[DIRECTORY] / "trial.mcap"
    log.unlink()
    assert do_work(_work(tmp_path, seed=1, traces=[])) == first
    assert not log.exists()  # nobody needs it


def test_pictures_of_an_earlier_form_of_a_trace_go(tmp_path: Path) -> None:
    do_work(_work(tmp_path))
    (tmp_path / "standing" / "traces" / "first.02.png").touch()
    assert do_work(_work(tmp_path, traces=OTHER_COLUMNS))["status"] == "completed"
    assert not StudyResults(tmp_path).snapshots("standing", "first")


def test_curves_stay_if_new_ones_cannot_be_made(tmp_path: Path) -> None:
    do_work(_work(tmp_path))
    before = StudyResults(tmp_path).trace("standing", "first")
    assert do_work(_work(tmp_path, traces=NO_SUCH_COLUMN))["status"] == "error"
    assert StudyResults(tmp_path).trace("standing", "first").equals(before)


def _touch_kept(results: Path) -> list[Path]:
    """Return files as an earlier form of the study left them."""
    names = ("traces/first.parquet", "traces/first.events.csv", "traces/first.00.png", "plans/first.npz")
    paths = [results / "standing" / name for name in (*names, "plans/alone.npz")]
    for path in paths:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    return paths


@pytest.mark.parametrize(("status", "stay"), [("planning_failed", False), ("error", True)])
def test_curves_and_plans_of_a_job_that_finds_no_plan_any_more_go(
    status: str, stay: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An error of the program says nothing about them."""
    paths = _touch_kept(tmp_path)
    other = tmp_path / "standing" / "plans" / "other.npz"
    other.touch()
    _job(monkeypatch, lambda: {"status": status})
    do_work(_work(tmp_path, job="fake", plans={"alone": {"seed": 0}, "other": {"seed": 1}}))
    assert [path.exists() for path in paths] == [stay] * len(paths)
    assert other.exists()
