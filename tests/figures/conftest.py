"""Made-up studies for the figures of grids."""

from tests.studies.conftest import fake_motions, plane, speeds, sweep, toy

__all__ = ["fake_motions", "plane", "speeds", "sweep", "toy"]
