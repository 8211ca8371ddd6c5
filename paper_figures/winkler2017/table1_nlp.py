"""Winkler 2017, Table I: size of the nonlinear program and time to solve it, eight motions."""

import pandas as pd
from matplotlib.figure import Figure

from paper_figures.study_origin import processor
from quadlab.analysis.artefact import Artefact, Claim, verdict
from quadlab.analysis.study_results import StudyResults
from quadlab.planners.vertex_zmp.grid import time_grid
from quadlab.planners.vertex_zmp.table_one import TABLE_ONE, table_one_schedule
from quadlab.plotting.style import paper_style
from quadlab.plotting.table_figure import TableText, table_figure

STUDY = "winkler2017_table1"
CAPTION = (
    "Sizes of the nonlinear programs and wall times of solving them, the paper's beside ours in both transcriptions. "
    "Horizon T, duration of a CoM polynomial and cost term are the paper's and those of its formulation here, which "
    "has additions. Ours was never solved with Snopt. Nothing is simulated."
)
ARTEFACT = Artefact(
    "W-TAB1", "Winkler 2017, Table I", "Sizes and solve times of the nonlinear programs", (STUDY,), CAPTION
)
PAPER_PROCESSOR = "Intel Core i7, 2.8 GHz, four cores"
PROGRAMS = ("printed", "paper", "fast")
"""What the paper prints, its formulation with additions here, and ours."""
SOLVERS = ("p. Ipopt", "p. Snopt", "Ipopt", "reduced")
LONGEST = TABLE_ONE[0]
"""The motion whose constraints are counted by origin."""
EVEN_LOADS, NO_COST = r"$J_\lambda$", "-"
SLOWER = "Another machine; compare with bench_planners.py on a quiet one."


@paper_style()
def draw(results: StudyResults) -> Figure:
    """Return the table: problems, sizes and solve times, the printed ones first, then ours in both transcriptions."""
    from quadlab.studies.jobs_table_one import REPETITIONS  # noqa: PLC0415 - loads the planners

    header = (
        ("", "", "", "", "variables", "", "", "constraints", "", "", "solve [ms]", "", "", ""),
        ("motion", "$T$ [s]", "step [ms]", "cost", *(("paper", "here", "reduced") * 2), *SOLVERS),
    )
    notes = (
        "step: duration of a CoM polynomial, $t_{k+1} - t_k$. paper, p. Ipopt, p. Snopt: as printed, "
        f"{PAPER_PROCESSOR}.",
        "here, Ipopt: the formulation of the paper, with additions, by CasADi and Ipopt. Loads are not constant but",
        f"parabolas over polynomials, {load_nodes()}.",
        "Additions: loads not negative between nodes; boxes of feet at middles of polynomials too, all 5 mm smaller.",
        f"reduced: ours, with its own solver. Wall times without building, medians of {REPETITIONS}, "
        f"{processor(STUDY, results)}.",
    )
    return table_figure(TableText(header, tuple(_cells(row) for _, row in numbers(results).iterrows()), notes=notes))


def _cells(row: pd.Series) -> tuple[str, ...]:
    """Return a line of the table; the paper prints its times to 10 ms."""
    return (
        row["case"],
        f"{row['horizon_s']:.1f}",
        f"{1e3 * row['polynomial_s']:.0f}",
        row["cost"],
        *(f"{row[f'{size}_{name}']:.0f}" for size in ("variables", "constraints") for name in PROGRAMS),
        *(f"{1e3 * row[f'solve_s_{name}']:.0f}" for name in ("printed", "printed_snopt")),
        *(f"{1e3 * row[f'solve_s_{name}']:.1f}" for name in ("paper", "fast")),
    )


def load_nodes() -> str:
    """Return where the nodes of the loads are, which the paper puts every 20 ms."""
    from quadlab.planners.vertex_zmp.paper.transcription import NODES_PER_POLYNOMIAL  # noqa: PLC0415 - loads CasADi

    gaits = {case.gait: 1e3 * case.polynomial_s / (NODES_PER_POLYNOMIAL - 1) for case in TABLE_ONE}
    return f"load nodes every {', '.join(f'{period:g} ms ({gait})' for gait, period in gaits.items())} instead of 20 ms"


def additions(constraints: int) -> str:
    """Return how many of the ``constraints`` of the longest walk the paper does not have."""
    from quadlab.planners.vertex_zmp.paper.transcription import NODES_PER_POLYNOMIAL  # noqa: PLC0415 - loads CasADi

    grid = time_grid(table_one_schedule(LONGEST.gait, LONGEST.steps), LONGEST.polynomial_s, NODES_PER_POLYNOMIAL)
    loads = int(grid.node_contacts[grid.nodes[:, 0]].sum())
    boxes = 2 * grid.count * grid.node_contacts.shape[1]
    return (
        f"Of the {constraints} constraints of {LONGEST.name} here, {loads} that keep loads from being negative between "
        f"nodes and {boxes} of the boxes, at the middles of polynomials, are additions."
    )


def numbers(results: StudyResults) -> pd.DataFrame:
    """Return one row a motion: what is printed, then sizes and times of both transcriptions here."""
    table = results.table(STUDY)
    rows = []
    for case in TABLE_ONE:
        row: dict[str, object] = {
            "case": case.name,
            "horizon_s": table_one_schedule(case.gait, case.steps).duration_s,
            "polynomial_s": case.polynomial_s,
            "cost": EVEN_LOADS if case.with_cost else NO_COST,
            "variables_printed": case.paper_variables,
            "constraints_printed": case.paper_constraints,
            "solve_s_printed": case.paper_ipopt_s,
            "solve_s_printed_snopt": case.paper_snopt_s,
        }
        for name in ("paper", "fast"):
            ours = table[(table["case"] == case.name) & (table["transcription"] == name)]
            row |= {f"{key}_{name}": ours[key].iloc[0] for key in ("variables", "constraints")}
            row[f"solve_s_{name}"] = 1e-3 * float(ours["solve_ms"].iloc[0])
            row[f"iterations_{name}"] = int(ours["iterations"].iloc[0])
        rows.append(row)
    return pd.DataFrame(rows)


def claims(results: StudyResults) -> list[Claim]:
    """Return that all motions are solved, and times and counts beside the printed ones."""
    table, every = numbers(results), results.table(STUDY)
    solved = int((every["status"] == "solved").sum())
    ours = f"{solved} of {len(every)}, a biped among them"
    text = "motions that are solved, both transcriptions"
    return [
        Claim(text, f"{len(table)}", ours, verdict(holds=solved == len(every))),
        _times(table, "its formulation with additions, by Ipopt", "paper", "Building it is not counted. " + SLOWER),
        _times(table, "reduced program", "fast", SLOWER),
        *(_sizes(table, size) for size in ("variables", "constraints")),
    ]


def _sizes(table: pd.DataFrame, size: str) -> Claim:
    """Return in how many motions the paper's formulation has as many variables, or constraints, as are printed."""
    printed, ours = table[f"{size}_printed"], table[f"{size}_paper"]
    same = int((ours == printed).sum())
    ratio = ours / printed
    text = f"{size}: motions with the printed number, its formulation with additions"
    why = f"The printed counts do not follow from load nodes every 20 ms; the program here has {load_nodes()}."
    if size == "constraints":
        why += f" {additions(int(table.loc[table['case'] == LONGEST.name, 'constraints_paper'].iloc[0]))}"
    found = verdict(holds=same == len(table), partly=same > 0)
    return Claim(text, f"{len(table)}", f"{same}; {ratio.min():.2f} to {ratio.max():.2f} of the printed", found, why)


def _times(table: pd.DataFrame, name: str, key: str, why: str) -> Claim:
    """Return the times beside the printed ones; what Newton's method solves in one step tells nothing of a program."""
    iterated = table[table[f"iterations_{key}"] > 1]
    ratio = iterated["solve_s_printed"] / iterated[f"solve_s_{key}"]
    faster = int((ratio >= 1.0).sum())
    single = ", ".join(table.loc[table[f"iterations_{key}"] <= 1, "case"])
    text = f"solve time of the paper / ours, {name}"
    ours = f"{ratio.min():.3g} to {ratio.max():.3g}, faster in {faster} of {len(ratio)}"
    ours += f"; {single} not counted: one step of Newton's method" if single else ""
    holds = faster == len(ratio)
    return Claim(text, "1", ours, verdict(holds=holds, partly=faster > 0), "" if holds else why)
