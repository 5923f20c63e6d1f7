"""Sources on which each kind of result depends.

A kind is named after the rule that makes it, or after the quantity; further kinds hold common sources.  If a list
differs from the imports, `tests/data/test_sources.py` fails: a new import must be added here, or to its `BESIDES`.
"""

from typing import NamedTuple


class Kind(NamedTuple):
    """Dependencies of a kind of result.

    sources : names of other kinds, of modules and packages of `disc_model`, and, with a slash, of further files
    version : number whose increase makes all results of the kind outdated
    """

    sources: str
    version: int = 1


_GRID = "benchmarks.grid benchmarks/variables.toml"
_BENCHMARK = (
    f"case {_GRID} benchmarks.methods benchmarks.registry benchmarks/rivals.toml benchmarks.hardware benchmarks.scenes"
)
_REFERENCES = (
    "benchmarks/data/benchmark_reference.json benchmarks/data/separating_start.json benchmarks/data/answers.json"
)
_QUESTIONS = (
    "truncation benchmarks.answers.questions benchmarks.answers.simulated analysis.classify "
    "analysis.sobol " + _REFERENCES
)
_TEXTS = "benchmarks.texts benchmarks/texts.yaml data.texts"
_ANSWERS = "benchmarks.answers.measure benchmarks.answers.modelled benchmarks.truncation continuation " + _QUESTIONS

KINDS = {
    # shared
    "dataset": Kind("data.dataset data.variables errors parameters plate flexibility"),
    "case": Kind(
        "dataset engine simulation.api simulation.case simulation.recorder simulation.ramps simulation.result"
    ),
    "cycle": Kind("case stability.cycle stability.return_map stability.sliding"),
    "settled": Kind("cycle stability.attractor stability.lyapunov analysis.classify"),
    "continuation": Kind("cycle stability.branch stability.continuation stability.grazing"),
    "point": Kind("dataset simulation.case simulation.ramps studies.grids.points studies.grids.run truncation"),
    "figure": Kind("dataset simulation.case simulation.ramps figures.kinds figures.parts figures/disc_model.mplstyle"),
    "catalogue": Kind("figures.paper.catalogue figures/paper/catalogue.yaml"),
    "modes_by_motion": Kind("cycle mode_choice truncation"),
    # named cases
    "simulate_case": Kind("case"),
    "merge_cases": Kind("dataset studies.cases"),
    "describe_study": Kind("check_claims"),
    # grids, with a quantity each
    "compute_batch": Kind("point"),
    "compute_motions": Kind("point case studies.grids.motions"),
    "merge_batches": Kind("point studies.rules studies.grids.merge studies.grids.summaries analysis.sobol"),
    "outcome": Kind("point settled studies.grids.quantities.outcome"),
    "regions": Kind("point settled stability.resonances studies.grids.quantities.regions"),
    "critical_speed": Kind("point settled studies.grids.quantities.critical_speed"),
    "floquet": Kind("point cycle studies.grids.quantities.floquet"),
    "hysteresis": Kind("point settled studies.grids.quantities.hysteresis"),
    "ramps": Kind("point case studies.grids.quantities.ramps"),
    "basins": Kind("point settled analysis.sobol studies.grids.quantities.basins"),
    "bifurcation": Kind("point settled stability.bifurcation studies.grids.quantities.bifurcation"),
    "lyapunov": Kind("point case stability.lyapunov stability.return_map studies.grids.quantities.lyapunov"),
    "stability_curves": Kind(
        "point continuation stability.curves stability.resonances studies.grids.quantities.stability_curves"
    ),
    "branches": Kind("point settled continuation studies.grids.quantities.branches"),
    "sensitivity": Kind("point settled studies.grids.quantities.sensitivity"),
    "campbell": Kind("floquet stability.campbell studies.grids.quantities.campbell"),
    # pictures and pages; a figure's own module is named beside its kind
    "draw_figure": Kind(
        "figure analysis catalogue figures.grids.cells figures.grids.growth_map "
        "figures.grids.stability_map stability.resonances"
    ),
    "draw_benchmark": Kind("figures.benchmark figures/benchmark.yaml"),
    "check_claims": Kind("cycle analysis claims/ data.texts config/paper.yaml"),
    "compare_normalisations": Kind("check_claims"),
    "judge_survival": Kind("check_claims"),
    "make_table": Kind("check_claims"),
    "build_explorer": Kind("figure explorer explorer/static"),
    # the benchmark
    "measure_work_precision": Kind(f"{_BENCHMARK} {_TEXTS} benchmarks.table benchmarks.work_precision {_REFERENCES}"),
    "measure": Kind(f"{_BENCHMARK} {_ANSWERS} benchmarks.failure_maps"),
    "merge_answers": Kind(f"{_BENCHMARK} {_ANSWERS} {_TEXTS} benchmarks.answers.report"),
    "report_truncation": Kind(f"dataset {_GRID} benchmarks.truncation_pages {_TEXTS}"),
}
"""The kinds by name."""
