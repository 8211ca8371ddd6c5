"""What the scripts of the comparison share: its study, its questions, names and colours."""

from dataclasses import dataclass

from quadlab.analysis.artefact import Artefact
from quadlab.plotting.style import SERIES

STUDY = "comparison"
PLANNERS = ("kinematic_sqp", "vertex_zmp", "zmp_spline")
"""The last one plans walks alone."""
CONTROLLERS = ("weighted", "hierarchical", "projected_inverse_dynamics")
SHORT = {"projected_inverse_dynamics": "projected"}
"""Names where there is little room."""
COLOURS = dict(zip(PLANNERS, SERIES[1:], strict=True))


@dataclass(frozen=True)
class Question:
    """Which of two variants is better; differences are second minus first.

    Attributes:
        factor: that the two are levels of.
        first, second: the two.
        other: the other factor.
        over: levels of the other factor, of which each condition takes the mean.
    """

    factor: str
    first: str
    second: str
    other: str
    over: tuple[str, ...]

    @property
    def text(self) -> str:
        """The difference in words."""
        return f"{short(self.second)} minus {short(self.first)}"


QUESTIONS = (
    Question("controller", "weighted", "hierarchical", "planner", PLANNERS[:2]),
    Question("controller", "projected_inverse_dynamics", "hierarchical", "planner", PLANNERS[:2]),
    Question("planner", "kinematic_sqp", "vertex_zmp", "controller", CONTROLLERS),
    Question("planner", "zmp_spline", "vertex_zmp", "controller", CONTROLLERS),
)


def short(name: str) -> str:
    """Return the name of a planner or controller for where there is little room."""
    return SHORT.get(name, name)


def artefact(part: str, title: str, caption: str) -> Artefact:
    """Return the description of one figure of the comparison, of which ``part`` tells it from the others."""
    return Artefact(f"X-S1 {part}", "comparison", title, (STUDY,), caption)
