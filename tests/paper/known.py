"""Cases of the paper that know what a statement asks for, and nothing else."""

from types import SimpleNamespace
from typing import Any

from disc_model.analysis.classify import Motion
from disc_model.data.variables import Outcome
from disc_model.parameters import Parameters
from workflow.paper.measures import Range


class Known(SimpleNamespace):
    """A case whose scalars are items, and whose other members are as they were given."""

    scalars: dict[str, float]

    def __getitem__(self, name: str) -> float:
        return self.scalars[name]


def known(scalars: dict[str, float] | None = None, **members: Any) -> Known:
    """Return a case that keeps contact, with some of its scalars and members changed."""
    usual = {
        "N": 400.0,
        "Omega": 15.0,
        "h": 0.002,
        "k": 5e4,
        "k_p": 2e4,
        "m": 0.1,
        "u_0": 0.0,
        "first_separation": float("nan"),
        "time_reached": 100.0,
    }
    given: dict[str, Any] = {
        "name": "known",
        "place": "here",
        "contact": "so long",
        "fate": "It ends.",
        "motion": "periodic",
        "node": (),
        "parameters": Parameters(N=400, Omega=15),
        "separates": False,
        "from_rest": True,
        "early": Range(395.0, 405.0),
        "late": Range(395.0, 405.0),
        "disc": Range(-0.001, 0.001),
        "late_motion": Motion(Outcome.OTHER_CYCLE, 1),
    }
    return Known(scalars={**usual, **(scalars or {})}, **{**given, **members})
