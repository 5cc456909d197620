"""Interface of the analyses of a model file, and their results."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from beamfem.model.model import Model
from beamfem.results.solution import Solution
from beamfem.solve.modes.modes import Modes
from beamfem.solve.stability.buckling import Buckling


@dataclass(frozen=True)
class Found:
    """States to draw, save and evaluate, and further results of the analysis by name."""

    solution: Solution
    values: dict[str, Any] = field(default_factory=dict)
    modes: Modes | Buckling | None = None


class Analysis(Protocol):
    """Interface of an analysis; states: whether it has states for the outputs of a file.

    span: lowest and highest load factor or time [s] of its states; at: the requested ones, at which the analysis has a
    state if it can choose its steps.
    """

    @property
    def states(self) -> bool: ...
    @property
    def moving(self) -> bool: ...
    @property
    def span(self) -> tuple[float, float]: ...
    def run(self, model: Model, at: Sequence[float]) -> Found: ...
