# From a study file to its dataset, figures and claims:
#   snakemake -j2                                    the paper's named cases (config/paper.yaml)
#   snakemake -j2 --configfile config/test.yaml      the same pipeline in small
from snakemake.utils import min_version

min_version("9.27")


include: "workflow/rules/common.smk"
include: "workflow/rules/simulate.smk"
include: "workflow/rules/merge.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/claims.smk"


rule all:
    default_target: True
    input:
        rules.merge_cases.output,
        rules.check_claims.output,
        collect(rules.draw_figure.output, figure=STUDY.figures),
