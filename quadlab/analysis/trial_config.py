"""The configuration that a trial log carries."""

from pydantic import ValidationError

from quadlab.analysis.trial_log import TrialLog
from quadlab.errors import LogError
from quadlab.trials.config import TrialConfig
from quadlab.trials.recording.topics import CONFIG_ATTACHMENT
from quadlab.yaml_text import load_yaml


def logged_config(log: TrialLog) -> TrialConfig:
    """Return the validated configuration of the trial.

    Raises:
        LogError: if the log has none, or one that this version does not understand.
    """
    try:
        return TrialConfig.model_validate(load_yaml(log.attachment(CONFIG_ATTACHMENT)))
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(map(str, first["loc"]))
        raise LogError(f"{CONFIG_ATTACHMENT} of the log does not fit this version ({key}: {first['msg']})") from error
