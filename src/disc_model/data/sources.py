"""Sources on which each kind of result depends.

A kind is named after the rule that makes it, or after the quantity; further kinds hold common sources.  A list has
names of other kinds, of modules and packages of `disc_model`, and, with a slash, of further files.  If it differs from
the imports, `tests/data/test_sources.py` fails: a new import must be added here, or to its `BESIDES`.
"""

VERSIONS: dict[str, int] = {}
"""Versions of kinds, 1 where none stands here: to raise one makes all results of the kind outdated."""

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
_ANSWERS = "benchmarks.answers.measure benchmarks.answers.modelled benchmarks.truncation continuation " + _QUESTIONS

KINDS = {
    # shared
    "dataset": "data.dataset data.variables errors parameters plate flexibility",
    "case": "dataset engine simulation.api simulation.case simulation.recorder simulation.ramps simulation.result",
    "cycle": "case stability.cycle stability.return_map stability.sliding",
    "settled": "cycle stability.attractor stability.lyapunov analysis.classify",
    "continuation": "cycle stability.branch stability.continuation",
    "point": "dataset simulation.case simulation.ramps studies.grids.points studies.grids.run truncation",
    "figure": "dataset simulation.case simulation.ramps figures.kinds figures.drawing figures/drawing.mplstyle",
    "catalogue": "figures.paper.catalogue figures/paper/catalogue.yaml",
    "modes_by_motion": "cycle mode_choice truncation",
    # named cases
    "simulate_case": "case",
    "merge_cases": "dataset studies.cases",
    "describe_study": "check_claims",
    # grids, with a quantity each
    "compute_batch": "point",
    "compute_motions": "point case studies.grids.motions",
    "merge_batches": "point studies.rules studies.grids.merge studies.grids.summaries analysis.sobol",
    "outcome": "point settled studies.grids.quantities.outcome",
    "regions": "point settled stability.resonances studies.grids.quantities.regions",
    "critical_speed": "point settled studies.grids.quantities.critical_speed",
    "floquet": "point cycle studies.grids.quantities.floquet",
    "hysteresis": "point settled studies.grids.quantities.hysteresis",
    "ramps": "point case studies.grids.quantities.ramps",
    "basins": "point settled analysis.sobol studies.grids.quantities.basins",
    "bifurcation": "point settled studies.grids.quantities.bifurcation",
    "lyapunov": "point case stability.lyapunov stability.return_map studies.grids.quantities.lyapunov",
    "stability_curves": "point continuation stability.curves stability.resonances "
    "studies.grids.quantities.stability_curves",
    "branches": "point settled continuation studies.grids.quantities.branches",
    "sensitivity": "point settled studies.grids.quantities.sensitivity",
    "campbell": "floquet stability.campbell studies.grids.quantities.campbell",
    # pictures and pages; a figure's own module is named beside its kind
    "draw_figure": "figure analysis catalogue figures.cells figures.growth_map "
    "figures.stability_map stability.resonances",
    "draw_benchmark": "figure benchmarks.figures benchmarks/figures.yaml",
    "check_claims": "cycle analysis paper/ data.texts config/paper.yaml",
    "compare_normalisations": "check_claims",
    "judge_survival": "check_claims",
    "make_table": "check_claims",
    "build_explorer": "figure explorer explorer/static",
    # the benchmark
    "measure_work_precision": f"{_BENCHMARK} benchmarks.table benchmarks.work_precision {_REFERENCES}",
    "measure": f"{_BENCHMARK} {_ANSWERS} benchmarks.failure_maps",
    "merge_answers": f"{_BENCHMARK} {_ANSWERS}",
}
"""The sources of each kind, by its name."""
