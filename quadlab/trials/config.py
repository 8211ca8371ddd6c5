"""The configuration of one trial: all groups together, and what must hold between them."""

import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from typing import Annotated, Protocol, Self

from pydantic import Field, StringConstraints, model_validator

from quadlab.configuration import PartOf, Positive, StrictModel
from quadlab.controllers import hierarchical as _hierarchical  # noqa: F401
from quadlab.controllers import projected_inverse_dynamics as _projected_inverse_dynamics  # noqa: F401
from quadlab.controllers import weighted as _weighted  # noqa: F401
from quadlab.errors import ConfigurationError
from quadlab.estimation import ekf as _ekf  # noqa: F401
from quadlab.estimation import truth as _truth  # noqa: F401
from quadlab.gaits.gait import GaitConfig, stride_counts
from quadlab.planners.command import CommandConfig
from quadlab.planners.kinematic_sqp import planner as _kinematic_sqp  # noqa: F401
from quadlab.planners.vertex_zmp import planner as _vertex_zmp  # noqa: F401
from quadlab.planners.zmp_spline import planner as _zmp_spline  # noqa: F401
from quadlab.robots.config import RobotConfig
from quadlab.robots.description import load_urdf_text
from quadlab.simulation.push import BASE_BODY
from quadlab.simulation.scenario import ScenarioConfig
from quadlab.simulation.simulator import SimulationConfig
from quadlab.simulation.timing import check_period
from quadlab.trials.failure import FailureConfig
from quadlab.trials.problems import suggestion
from quadlab.trials.recording.config import LogConfig
from quadlab.trials.replanning import ReplanningConfig
from quadlab.yaml_text import dump_yaml

Tag = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$")]
"""A folder name: letters, digits, dot, dash, underscore."""


class PartConfig(Protocol):
    """What the configurations of all exchangeable parts have in common."""

    @property
    def kind(self) -> str:
        """Under which the part is registered."""
        ...


class NamedPartConfig(PartConfig, Protocol):
    """A part of which several files may be of one kind."""

    @property
    def name(self) -> str:
        """What results call it."""
        ...


class ControllerConfig(NamedPartConfig, Protocol):
    """What the configurations of all controllers have in common."""

    @property
    def rate_hz(self) -> float:
        """Control rate in [1/s]."""
        ...


class TrialConfig(StrictModel):
    """One trial, complete: equal configurations give equal trials.

    The one exception is a planner that its clock ends, ``planner.max_wall_time_s`` of ``vertex_zmp`` with Ipopt or
    ``planner.sqp.max_wall_time_s`` of ``kinematic_sqp``: that depends on the machine, and the outcome's reason says so.

    Attributes:
        robot, gait, command, scenario, simulation, log, failure: see their classes.
        replanning: whether the motion is planned again on the way.
        planner, controller, estimator: the ``Config`` of the part that is registered under their ``kind``.
        duration_s: length of the motion, standing at both ends included, in [s].
        seed: of everything random.
        tag: folder below the results directory; no part of the trial's identity.
    """

    robot: RobotConfig
    gait: GaitConfig
    command: CommandConfig
    planner: Annotated[NamedPartConfig, PartOf("planner")]
    controller: Annotated[ControllerConfig, PartOf("controller")]
    estimator: Annotated[PartConfig, PartOf("estimator")]
    scenario: ScenarioConfig
    simulation: SimulationConfig
    replanning: ReplanningConfig
    failure: FailureConfig
    log: LogConfig
    duration_s: Positive
    seed: Annotated[int, Field(ge=0)]
    tag: Tag

    def to_yaml(self) -> str:
        """Return it as the text of a file."""
        return dump_yaml(self.model_dump(mode="json"))

    @model_validator(mode="after")
    def _parts_fit_together(self) -> Self:
        if problems := list(cross_field_problems(self)):
            raise ConfigurationError("\n".join(problems))
        return self


class RunOptions(StrictModel):
    """How to run a trial; none of it changes what happens in the trial.

    Attributes:
        force: run it even if its result is there.
        results_dir: where results go, relative to the working directory.
    """

    force: bool
    results_dir: str


def cross_field_problems(config: TrialConfig) -> Iterator[str]:
    """Yield one line for each thing that no group can know alone."""
    timestep_s = config.simulation.timestep_s
    yield from _refused("", stride_counts, config.gait, config.duration_s)
    yield from _refused("controller.rate_hz: ", check_period, 1.0 / config.controller.rate_hz, timestep_s)
    links = {link.get("name", "") for link in ET.fromstring(load_urdf_text(config.robot)).iter("link")}
    for number, push in enumerate(config.scenario.pushes):
        where = f"scenario.pushes[{number}]"
        if push.body not in links | {BASE_BODY}:
            yield f"{where}.body: unknown link '{push.body}'; {suggestion(push.body, links | {BASE_BODY})}"
        if push.start_s >= config.duration_s:
            yield f"{where}.start_s: {push.start_s:g} s is not before the end of the trial at {config.duration_s:g} s"
        yield from _refused(f"{where}.duration_s: ", check_period, push.duration_s, timestep_s)


def _refused(where: str, check: Callable[..., object], *arguments: object) -> Iterator[str]:
    """Yield the line with which ``check`` refuses its arguments, if it does."""
    try:
        check(*arguments)
    except ConfigurationError as error:
        yield f"{where}{error}"
