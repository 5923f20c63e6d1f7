"""The tests that prove the answers import nothing of figures, studies, paper or benchmarks."""

import ast
from functools import cache
from pathlib import Path

TESTS = Path(__file__).parent
KEPT = """
contact_laws blocks references/* analysis/test_contact_loss
validation/test_[!m]* engine/test_saltation engine/test_roots engine/test_stick_propagator engine/full_system
stability/test_block stability/test_sliding stability/test_return_map stability/test_separating_cycles
stability/test_slipping_cycle stability/test_frequencies stability/test_linear_motion
stability/continuation/toy_maps stability/continuation/test_course stability/continuation/test_borders
disc/test_plate disc/test_flexibility disc/test_finite_elements
simulation/test_moving_surface simulation/test_pad simulation/test_cuts simulation/test_deflection simulation/test_start
studies/test_against_simulation workflow/test_determinism workflow/test_reruns workflow/test_faults
"""
OTHERS = {"figures", "studies", "paper", "benchmarks"}


@cache
def imported(path: Path) -> set[str]:
    """Modules that a file imports, directly or through helpers in tests/, and names from them."""
    found = set[str]()
    for node in ast.walk(ast.parse(path.read_text())):
        match node:
            case ast.Import():
                found |= {name.name for name in node.names}
            case ast.ImportFrom():
                found |= {f"{node.module}.{name.name}" for name in node.names}
    for name in [*found]:
        for helper in (name, name.rpartition(".")[0]):
            file = (TESTS.parent / helper.replace(".", "/")).with_suffix(".py")
            if helper.startswith("tests.") and file.is_file():
                found |= imported(file)
    return found


def test_proofs_stand_by_themselves() -> None:
    files = [file for name in KEPT.split() for file in sorted(TESTS.glob(f"{name}.py"))]
    assert len(files) >= 50
    for file in files:
        for name in imported(file):
            package, _, module = name.partition(".")
            tops = {package, module.partition(".")[0]}
            assert package == "tests" or not tops & OTHERS, (file, name)
