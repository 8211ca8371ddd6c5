"""Whether the jobs of studies can be run: a mistake in one is told before the first of them begins."""

from collections.abc import Iterable

from quadlab.errors import ConfigurationError
from quadlab.studies.jobs import check_named
from quadlab.studies.open_study import PendingJob
from quadlab.trials.composer import Composer


def check_jobs(waiting: Iterable[PendingJob]) -> None:
    """Compose and validate all jobs; of a search only the probe that comes next is known.

    Raises:
        ConfigurationError: with one line for each different mistake.
    """
    composer = Composer()
    problems: dict[str, None] = {}
    for study, _, job in waiting:
        try:
            check_named(study.config.job)(job.overrides, composer)
        except ConfigurationError as error:
            problems |= dict.fromkeys(f"study/{study.name}.yaml: {line}" for line in str(error).splitlines())
    if problems:
        raise ConfigurationError("\n".join(problems))
