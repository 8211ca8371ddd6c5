"""One trial from its configuration to the files beside it; used by the command line and by scripts alike."""

import sys
import traceback
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

from threadpoolctl import threadpool_limits

from quadlab.errors import ConfigurationError, LogError, MissingDependencyError, one_line
from quadlab.trials.config import RunOptions, TrialConfig
from quadlab.trials.files import write_json, write_text
from quadlab.trials.identity import trial_id
from quadlab.trials.lock import running
from quadlab.trials.manifest import MANIFEST_FILE, collect_manifest
from quadlab.trials.progress import TrialProgress
from quadlab.trials.recording.topics import LOG_FILE, PART_SUFFIX
from quadlab.trials.result import RESULT_FILE, TrialResult, TrialStatus, read_result, write_result
from quadlab.trials.runner import run_trial

CONFIG_FILE = "config.yaml"
ERROR_FILE = "error.json"


@dataclass(frozen=True)
class JobOutcome:
    """What came of a job.

    Attributes:
        directory: where the trial's files are.
        result: of the trial; None if the program failed, see ``failure``.
        skipped: whether the result was there before.
        failure: one line about the exception, None if there was none.
    """

    directory: Path
    result: TrialResult | None
    skipped: bool = False
    failure: str | None = None


class ErrorRecord:
    """A context in which an unexpected exception becomes ``error.json`` instead of ending the program.

    This is the border of one trial: a sweep goes on with the next one. A configuration that is wrong, a package that is
    missing and interrupts pass through.

    Attributes:
        failure: one line about the exception that was recorded.
    """

    def __init__(self, directory: Path) -> None:
        self.failure: str | None = None
        self._path = directory / ERROR_FILE

    def __enter__(self) -> "ErrorRecord":
        self._path.unlink(missing_ok=True)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        if not isinstance(error, Exception) or isinstance(error, (ConfigurationError, MissingDependencyError)):
            return False
        message = one_line(str(error))
        self.failure = f"{type(error).__name__}: {message} (traceback in {self._path})"
        lines = traceback.format_exception(kind, error, trace)
        content = {"type": type(error).__name__, "message": message, "traceback": lines, "argv": sys.argv}
        write_json(self._path, content)
        return True


def trial_directory(config: TrialConfig, options: RunOptions) -> Path:
    """Return ``<results_dir>/<tag>/<trial_id>``."""
    return Path(options.results_dir) / config.tag / trial_id(config)


def finished_before(config: TrialConfig, options: RunOptions) -> JobOutcome | None:
    """Return the outcome of a trial whose result is there, None if it has to be run.

    Raises:
        LogError: if the result cannot be read.
    """
    directory = trial_directory(config, options)
    if options.force or not (directory / RESULT_FILE).is_file():
        return None
    try:
        return JobOutcome(directory, read_result(directory), skipped=True)
    except LogError as error:  # nobody asked to replace it
        raise LogError(f"{error}; remove it, or add force=true to run the trial again") from error


def run_job(config: TrialConfig, options: RunOptions, progress: TrialProgress) -> JobOutcome:
    """Run the trial, unless its result is there and ``force`` is not set, and leave its files in its directory.

    If another process runs the same trial into the same directory, this one waits and takes its result.

    Raises:
        LogError: if the result is there and cannot be read.
        QuadlabError: if the configuration names something that does not exist.
        OSError: if files cannot be written.
    """
    before = finished_before(config, options)
    if before is not None:
        return before
    directory = trial_directory(config, options)
    with running(directory):
        return finished_before(config, options) or _run(config, directory, progress)


def forget_trial(directory: Path) -> None:
    """Remove result and log, if there are any: what a trial leaves from now on shall not stand beside older files."""
    for name in (RESULT_FILE, LOG_FILE, LOG_FILE + PART_SUFFIX):
        (directory / name).unlink(missing_ok=True)


def _run(config: TrialConfig, directory: Path, progress: TrialProgress) -> JobOutcome:
    forget_trial(directory)
    write_text(directory / CONFIG_FILE, config.to_yaml())
    result: TrialResult | None = None
    status = "interrupted"
    try:
        with ErrorRecord(directory) as record, threadpool_limits(1):
            write_json(directory / MANIFEST_FILE, collect_manifest(config))
            result = run_trial(config, directory, progress)
            write_result(directory, result)
        status = TrialStatus.ERROR if result is None else result.status
    finally:
        progress.finish(status)
    return JobOutcome(directory, result, failure=record.failure)


def record_failure(config: TrialConfig, options: RunOptions, kind: str, message: str, output: str) -> JobOutcome:
    """Leave ``error.json`` for a trial whose process ended without doing so, and return its outcome.

    Args:
        config, options: of the trial.
        kind: a word for what happened.
        message: one line.
        output: what the process printed last.
    """
    directory = trial_directory(config, options)
    content = {"type": kind, "message": message, "traceback": output.splitlines(), "argv": sys.argv}
    try:
        write_text(directory / CONFIG_FILE, config.to_yaml())
        write_json(directory / ERROR_FILE, content)
    except OSError as error:  # a full disk, say, which may be why the process ended
        return JobOutcome(directory, None, failure=f"{message} ({ERROR_FILE} cannot be written: {error})")
    return JobOutcome(directory, None, failure=f"{message} (see {directory / ERROR_FILE})")
