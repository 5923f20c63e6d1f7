# From a study file to its dataset, figures and claims:
#   snakemake -j2                                    the paper's named cases (config/paper.yaml)
#   snakemake -j2 --configfile config/test.yaml      the same pipeline in small
from itertools import chain

from snakemake.utils import min_version

min_version("9.27")


include: "workflow/rules/common.smk"
include: "workflow/rules/cases.smk"
include: "workflow/rules/grids.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/claims.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/explorer.smk"
include: "workflow/rules/benchmark.smk"
include: "workflow/rules/housekeeping.smk"


PRODUCTS = [
    *collect(rules.make_table.output, table=TABLES),
    *collect(rules.draw_figure.output, figure=[*STUDY.figures, *STUDY.plots]),
    *collect(rules.publish_study.output, study=ASKED),
    *chain.from_iterable(
        collect(rules.draw_plot.output, study=name, plot=GRIDS[name].plots)
        for name in ASKED
    ),
]
if STUDY.specs:
    PRODUCTS += [*rules.merge_cases.output, *rules.describe_study.output]
if STUDY.claims:
    PRODUCTS += rules.check_claims.output
if HAS_FIGURE_15:
    PRODUCTS += rules.show_figure_15.output
refuse_unrecorded([*map(case_file, STUDY.specs), *PRODUCTS])


rule all:
    default_target: True
    input:
        PRODUCTS,
