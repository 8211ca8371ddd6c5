"""The name of a trial: equal configurations have equal ids, on every machine and in every run."""

import hashlib
import json

from quadlab.trials.config import TrialConfig

NOT_PART_OF_IDENTITY = {"tag", "log"}
"""Where results go and what is logged does not change what happens."""

ID_LENGTH = 16  # hexadecimal digits


def canonical_json(config: TrialConfig) -> str:
    """Return the validated configuration without ``NOT_PART_OF_IDENTITY``, keys sorted, no blanks.

    Validation has made 50 and 50.0 the same number already.
    """
    values = config.model_dump(mode="json", exclude=NOT_PART_OF_IDENTITY)
    return json.dumps(values, sort_keys=True, separators=(",", ":"), allow_nan=False)


def trial_id(config: TrialConfig) -> str:
    """Return the first 16 hexadecimal digits of the SHA-256 of ``canonical_json``."""
    return hashlib.sha256(canonical_json(config).encode()).hexdigest()[:ID_LENGTH]
