"""Made-up studies for the figures of grids."""

from tests.studies.conftest import fake_motions, fold_map, plane, speeds, sweep

__all__ = ["fake_motions", "fold_map", "plane", "speeds", "sweep"]
