"""The imperfection of a model file: axes displaced by a mode of the perfect model."""

from dataclasses import dataclass
from typing import Literal

from beamfem.cli.modelfile.starts import Start, start, state_of
from beamfem.cli.modelfile.table import Table, build
from beamfem.model.model import Model
from beamfem.solve.modes.modes import solve_modes
from beamfem.solve.stability.buckling import solve_buckling
from beamfem.validation import count, one_of, positive


@dataclass(frozen=True)
class Imperfection:
    """The largest displacement of an axis, `size` [m], by a mode, counted from 1, of buckling or of vibration.

    about: the equilibrium of the perfect model about which the mode is computed.
    """

    size: float
    mode: int = 1
    of: Literal["buckling", "modes"] = "buckling"
    about: Start = None

    def __post_init__(self) -> None:
        positive("size", self.size)
        count("mode", self.mode)
        one_of("of", self.of, ("buckling", "modes"))

    def of_model(self, model: Model) -> Model:
        """Return the imperfect model. Raises InputError, ConvergenceError."""
        solve = solve_buckling if self.of == "buckling" else solve_modes
        return model.with_imperfection(solve(model, self.mode, state_of(self.about, model)), self.size, self.mode - 1)


def imperfection(root: Table) -> Imperfection | None:
    """Return the imperfection of a file, None if it has none. Raises ModelFileError."""
    if "imperfection" not in root.values:
        return None
    result: Imperfection = build(root.table("imperfection"), Imperfection, {"about": start})
    return result
