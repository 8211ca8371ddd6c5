"""The outcome of a trial as one flat, typed row."""

import json
from enum import StrEnum
from pathlib import Path
from typing import Literal

from pydantic import ValidationError

from quadlab.configuration import Fraction, NonNegative, StrictModel
from quadlab.errors import LogError
from quadlab.trials.files import write_json

RESULT_FILE = "result.json"
SCHEMA_VERSION: Literal[1] = 1


class TrialStatus(StrEnum):
    """How a trial ended; every one of them is a row in the table."""

    COMPLETED = "completed"
    FELL = "fell"
    NO_PROGRESS = "no_progress"
    """Upright to the end, but not where the plan went."""
    DIVERGED = "diverged"
    """The physics produced numbers that are not finite."""
    PLANNING_FAILED = "planning_failed"
    ERROR = "error"
    """The program raised; ``error.json`` holds the traceback."""


class TrialResult(StrictModel):
    """What one trial amounts to; a metric that does not exist (no motion, no plan) is null.

    Attributes:
        schema_version: version of this list of fields.
        trial_id: see ``identity.trial_id``.
        status, status_reason: how it ended and one line why.
        robot, gait, planner, controller, estimator, scenario: names or kinds of the parts.
        seed: of the trial.
        duration_s: of the motion that was asked for, in [s].
        survived_s: until the fall or the end, in [s].
        distance_m: horizontal distance of the base from start to end, in [m].
        mean_speed_mps: distance over survived time in [m/s].
        com_error_rms_mm, com_error_max_mm: horizontal distance of the true CoM from its aligned reference, in [mm]; if
            the state is estimated, its drift included.
        base_height_rms_mm: error of the true base height, in [mm]; if the state is estimated, its drift included.
        roll_pitch_rms_deg: error of roll and pitch together, in [deg].
        foot_slip_max_mm: farthest that a standing foot slid in one stance, in [mm].
        torque_max_nm: largest joint torque in [N m].
        torque_limit_share: share of control ticks in which a torque was at its limit.
        limit_residual_max: largest unmet part of a level of torque or contact-force limits in a tick, in [N m] or [N];
            null for controllers without such levels.
        cost_of_transport: mechanical energy over weight times distance.
        planning_build_ms, planning_solve_ms: wall time in [ms].
        planning_iterations: of the planner's solver.
        replannings, replanning_failures: how often a plan was asked for on the way, and not found; null if not at all.
        replanning_median_ms: wall time of building and solving of the plans found on the way, in [ms].
        control_tick_median_us, control_tick_p99_us: computing time of a control tick in [us].
        control_fallbacks: ticks in which the controller's solver failed and the fallback was used.
        com_error_believed_rms_mm, com_error_believed_max_mm: the CoM error that the controller believed in, in [mm];
            like all that follow to ``estimate_update_median_us`` null if it was given the truth.
        base_height_believed_rms_mm: error of the base height that the controller believed in, in [mm]: that of the
            height over the ground under the feet, whose height in the world it cannot know.
        estimate_position_drift_mm, estimate_yaw_drift_deg: of the estimate at the end, in [mm] and [deg]; position and
            heading cannot be observed.
        estimate_roll_pitch_rms_deg, estimate_roll_pitch_max_deg: error of estimated roll and pitch together, in [deg].
        estimate_velocity_rms_mps: error of the estimated base velocity in base axes, in [m/s].
        estimate_innovation_ratio: mean normalised innovation squared over its degrees of freedom; 1 if consistent.
        estimate_outliers: measurements of standing feet that the filter refused.
        estimate_update_median_us: computing time of an update in [us].
        real_time_factor: simulated over wall time of the whole loop.
        state_sha256: hash of the physical state after every tick, equal for two runs exactly if they are identical.
    """

    schema_version: Literal[1] = SCHEMA_VERSION
    trial_id: str
    status: TrialStatus
    status_reason: str
    robot: str
    gait: str
    planner: str
    controller: str
    estimator: str
    scenario: str
    seed: int
    duration_s: NonNegative
    survived_s: NonNegative | None = None
    distance_m: float | None = None
    mean_speed_mps: float | None = None
    com_error_rms_mm: NonNegative | None = None
    com_error_max_mm: NonNegative | None = None
    base_height_rms_mm: NonNegative | None = None
    roll_pitch_rms_deg: NonNegative | None = None
    foot_slip_max_mm: NonNegative | None = None
    torque_max_nm: NonNegative | None = None
    torque_limit_share: Fraction | None = None
    limit_residual_max: NonNegative | None = None
    cost_of_transport: float | None = None
    planning_build_ms: NonNegative | None = None
    planning_solve_ms: NonNegative | None = None
    planning_iterations: int | None = None
    replannings: int | None = None
    replanning_failures: int | None = None
    replanning_median_ms: NonNegative | None = None
    control_tick_median_us: NonNegative | None = None
    control_tick_p99_us: NonNegative | None = None
    control_fallbacks: int | None = None
    com_error_believed_rms_mm: NonNegative | None = None
    com_error_believed_max_mm: NonNegative | None = None
    base_height_believed_rms_mm: NonNegative | None = None
    estimate_position_drift_mm: NonNegative | None = None
    estimate_yaw_drift_deg: NonNegative | None = None
    estimate_roll_pitch_rms_deg: NonNegative | None = None
    estimate_roll_pitch_max_deg: NonNegative | None = None
    estimate_velocity_rms_mps: NonNegative | None = None
    estimate_innovation_ratio: NonNegative | None = None
    estimate_outliers: int | None = None
    estimate_update_median_us: NonNegative | None = None
    real_time_factor: NonNegative | None = None
    state_sha256: str | None = None


def write_result(directory: Path, result: TrialResult) -> Path:
    """Write ``result.json`` into ``directory`` in one step and return its path."""
    path = directory / RESULT_FILE
    write_json(path, result.model_dump(mode="json"))
    return path


def read_result(directory: Path) -> TrialResult:
    """Return the result that a finished trial left in ``directory``.

    Raises:
        LogError: if there is none, or if it is not one that this version understands.
    """
    path = directory / RESULT_FILE
    if not path.is_file():
        raise LogError(f"{path}: not found; a trial writes it when it has finished")
    try:
        return TrialResult.model_validate(json.loads(path.read_text(encoding="utf-8")))
    except OSError as error:
        raise LogError(f"{path}: {error.strerror}") from error
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(map(str, first["loc"]))
        raise LogError(f"{path}: not a result of schema {SCHEMA_VERSION} ({key}: {first['msg']})") from error
    except ValueError as error:  # no JSON, or not even text
        raise LogError(f"{path}: not JSON ({error})") from error
