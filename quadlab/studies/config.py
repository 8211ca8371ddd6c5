"""What a study is: the file ``conf/study/<name>.yaml``."""

import hashlib
from typing import Annotated, Self, TypeAlias

import yaml
from pydantic import Field, ValidationError, model_validator

from quadlab.configuration import Positive, StrictModel
from quadlab.errors import ConfigurationError, one_line
from quadlab.paths import CONF_DIR
from quadlab.trials.problems import suggestion, validation_problems

Level: TypeAlias = str | int | float
"""A label or value that a factor takes."""

Factor: TypeAlias = tuple[Level, ...] | dict[Level, tuple[str, ...]]
"""Values of the configuration key that the factor is named after, or labels with the overrides that they stand for."""


class SearchConfig(StrictModel):
    """The largest value of a key at which the trial still completes, found by bisection on a grid.

    Attributes:
        key: dotted key of the configuration, e.g. ``scenario.pushes.0.force_n``.
        lowest, step, highest: of the grid, in the key's unit.
        confirm: how many grid values just below the limit are tried as well, as limits need not be monotone.
        factor: from a grid value to the value of the key, e.g. -1 for the depth of a step down.
        name: of the grid value in tables; the key if not given.
    """

    key: str
    lowest: float
    step: Positive
    highest: float
    confirm: Annotated[int, Field(ge=0)]
    factor: float = 1.0
    name: str | None = None

    @model_validator(mode="after")
    def _grid_has_values(self) -> Self:
        if self.highest < self.lowest:
            raise ValueError(f"highest: {self.highest:g} is below lowest, {self.lowest:g}")
        return self

    @property
    def label(self) -> str:
        """What tables call the grid value."""
        return self.name or self.key


class BlockConfig(StrictModel):
    """All combinations of some factors.

    Attributes:
        overrides: of ``conf/trial.yaml``, for all of them.
        factors: by name; their product is run. A name with a list of values is a configuration key.
        search: for each combination, if given; else each is one job.
    """

    overrides: tuple[str, ...] = ()
    factors: Annotated[dict[str, Factor], Field(min_length=1)]
    search: SearchConfig | None = None


class TraceConfig(StrictModel):
    """Curves of one trial that are kept, so that figures can be drawn without its log.

    Attributes:
        name: of the files.
        where: levels of the factors that pick the job.
        columns: patterns such as ``control.com_*`` over the tables state, estimate, control and levels.
        rate_hz: at most; every n-th tick is kept.
        snapshots_s: times of rendered pictures in [s].
    """

    name: str
    where: dict[str, Level]
    columns: tuple[str, ...]
    rate_hz: Positive
    snapshots_s: tuple[float, ...] = ()


class StudyConfig(StrictModel):
    """A study.

    Attributes:
        title: one line for people.
        job: what one combination is, see ``quadlab.studies.jobs``.
        blocks: run one after the other; their rows form one table.
        traces: curves to keep.
        plans: names of plans to keep, with the levels that pick their jobs.
        report_by: factors whose combinations are the lines of the report.
        report_columns: result columns of which the report shows median and largest value.
    """

    title: str
    job: str = "trial"
    blocks: Annotated[tuple[BlockConfig, ...], Field(min_length=1)]
    traces: tuple[TraceConfig, ...] = ()
    plans: dict[str, dict[str, Level]] = Field(default_factory=dict)
    report_by: tuple[str, ...]
    report_columns: tuple[str, ...] = ()

    @property
    def kept_hash(self) -> str:
        """A hash of which curves and plans are kept: files that were made for others are made again."""
        kept = self.model_dump_json(include={"traces", "plans"})
        return hashlib.sha256(kept.encode()).hexdigest()


def study_names() -> list[str]:
    """Return the names of all studies, sorted."""
    return sorted(path.stem for path in (CONF_DIR / "study").glob("*.yaml"))


def load_study(name: str) -> StudyConfig:
    """Return the study in ``conf/study/<name>.yaml``.

    Raises:
        ConfigurationError: if there is none of that name, or with one line for each mistake in it.
    """
    path = CONF_DIR / "study" / f"{name}.yaml"
    if not path.is_file():
        raise ConfigurationError(f"unknown study '{name}'; {suggestion(name, set(study_names()))}")
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except UnicodeDecodeError as error:
        raise ConfigurationError(f"study/{name}.yaml: not UTF-8 ({error})") from error
    except yaml.MarkedYAMLError as error:
        line = f", line {error.problem_mark.line + 1}" if error.problem_mark else ""
        raise ConfigurationError(f"study/{name}.yaml{line}: not YAML ({error.problem})") from error
    except yaml.YAMLError as error:
        raise ConfigurationError(f"study/{name}.yaml: not YAML ({one_line(str(error))})") from error
    if not isinstance(content, dict):
        raise ConfigurationError(f"study/{name}.yaml: {_kind(content)}; expected keys such as title and blocks")
    try:
        return StudyConfig.model_validate(content)
    except ValidationError as error:
        lines = validation_problems(StudyConfig, error)
        raise ConfigurationError("\n".join(f"study/{name}.yaml: {line}" for line in lines)) from error


def _kind(content: object) -> str:
    return "empty" if content is None else f"a {type(content).__name__}"
