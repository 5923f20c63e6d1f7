# From a study file to its datasets and figures; the workflow itself is in workflow/Snakefile.
#   snakemake -j2                                    the paper's study (config/paper.yaml)
#   snakemake -j2 --configfile config/test.yaml      the same pipeline in small
#   snakemake -j2 --configfile my_study.yaml         a study of your own: docs/studies.md
include: "workflow/Snakefile"


# What an included file makes by default is not the default of the file that includes it.
workflow.default_target = "all"
