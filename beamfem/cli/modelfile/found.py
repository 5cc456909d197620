"""What every analysis of a model file offers, and what it finds."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from beamfem.model.model import Model
from beamfem.results.solution import Solution
from beamfem.solve.modes.modes import Modes
from beamfem.solve.stability.buckling import Buckling


@dataclass(frozen=True)
class Found:
    """States to draw, save and ask, and what the analysis found besides, by name."""

    solution: Solution
    values: dict[str, Any] = field(default_factory=dict)
    modes: Modes | Buckling | None = None


class Analysis(Protocol):
    """What every analysis offers; states: whether its states answer the outputs of a file.

    span: lowest and highest load factor or time [s] that it can have states at; at: those that are asked for, which get
    a state where the analysis is free to choose.
    """

    @property
    def states(self) -> bool: ...
    @property
    def moving(self) -> bool: ...
    @property
    def span(self) -> tuple[float, float]: ...
    def run(self, model: Model, at: Sequence[float]) -> Found: ...
