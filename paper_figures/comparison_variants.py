"""What the scripts of the comparison share: its study, names and colours."""

from quadlab.analysis.artefact import Artefact

STUDY = "comparison"
PLANNERS = ("kinematic_sqp", "vertex_zmp")
CONTROLLERS = ("weighted", "hierarchical")
"""Differences are second minus first."""
FACTORS = {"planner": PLANNERS, "controller": CONTROLLERS}
COLOURS = {"kinematic_sqp": "#0072b2", "vertex_zmp": "#d55e00"}
DASHES = {"hierarchical": "-", "weighted": "--"}


def artefact(part: str, title: str, caption: str) -> Artefact:
    """Return the description of one figure of the comparison, of which ``part`` tells it from the others."""
    return Artefact(f"X-S1 {part}", "comparison", title, (STUDY,), caption)
