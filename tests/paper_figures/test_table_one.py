"""Table I says which constraints of the program here the paper does not have."""

from paper_figures.winkler2017.table1_nlp import LONGEST, additions
from quadlab.planners.vertex_zmp.config import VertexZmpConfig
from quadlab.planners.vertex_zmp.paper.transcription import transcribe
from quadlab.planners.vertex_zmp.table_one import table_one_changes, table_one_problem
from quadlab.trials.compose import compose_trial


def test_added_constraints_are_those_of_the_program() -> None:
    settings = compose_trial(["planner=vertex_zmp"]).planner
    assert isinstance(settings, VertexZmpConfig)
    assert settings.reach_margin_m == 0.005, "as the note below the table says"
    config = settings.model_copy(update=table_one_changes(LONGEST, "paper"))
    program = transcribe(table_one_problem(LONGEST), config)
    sizes = {constraint.name: len(constraint.lower) for constraint in program.constraints}
    total, boxes = sum(sizes.values()), sizes["range_of_motion_m"] // 2
    assert (total, sizes["load_between_nodes"], boxes) == (2004, 192, 512)
    assert additions(total) == (
        "Of the 2004 constraints of walk 16 here, 192 that keep loads from being negative between nodes and 512 of the "
        "boxes, at the middles of polynomials, are additions."
    )
