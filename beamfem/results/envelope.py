"""Envelopes of several solutions, such as load cases: smallest and largest section forces and stresses along beams."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.errors import InputError
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.beam import Beam, names
from beamfem.model.model import Model
from beamfem.reprs import brief
from beamfem.results.axis_fields import quantity
from beamfem.results.axis_points import AxisPoints
from beamfem.results.extremes import extreme
from beamfem.results.section_forces import stations
from beamfem.results.solution import Solution
from beamfem.tables import as_html, as_pandas, as_text, few
from beamfem.validation import flag, items, shown

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame

_LISTED = ("normal", "shear", "moment", "tension", "compression", "von_mises", "utilisation")
_BOTH = (("smallest", -1.0), ("largest", 1.0))
_SIDES = {"compression": _BOTH[:1]} | dict.fromkeys(("tension", "von_mises", "shear_stress", "utilisation"), _BOTH[1:])
_SHOWN = 30  # rows at a prompt
_DIGITS = 10  # of fractions of a beam that count as one station
_BESIDE = 1e-9  # fraction of a beam, from a station to a point of the element before or after it
_END = 1e-5  # xi this close to the end of an element is the end


@dataclass(frozen=True, eq=False)
class EnvelopeCurve:
    """Smallest and largest values of a quantity along a beam, and those of each case.

    Parameters
    ----------
    arc_length : array, [m], (stations,)
        Stations of all meshes of the beam, each twice: just before and just after it.
    smallest, largest : array, (stations,)
        The smallest and the largest value of all cases.
    cases : dict of str to array, (2, stations)
        The smallest and the largest value of each case.
    """

    arc_length: np.ndarray
    smallest: np.ndarray
    largest: np.ndarray
    cases: dict[str, np.ndarray] = field(repr=False)

    __repr__ = brief


@dataclass(frozen=True, eq=False)
class Envelope:
    """Smallest and largest section forces and stresses of several solutions, see `envelope`.

    Parameters
    ----------
    cases : dict of str to Solution
        The solutions by name, with the rows that count.
    """

    cases: dict[str, Solution]

    def __repr__(self) -> str:
        header, rows = self.table()
        return f"Envelope of {', '.join(self.cases)}\n{as_text(header, few(rows, _SHOWN))}"

    def _repr_html_(self) -> str:
        return as_html(*self.table())

    def along(self, beam: Beam, name: str = "moment") -> EnvelopeCurve:
        """Return the envelope of a quantity along a beam; name: one of `colour` in `Solution.plot`.

        Raises InputError for an unknown quantity or beam.
        """
        return along_with(self, beam, name)

    def table(self, quantities: Sequence[str] = _LISTED) -> tuple[list[str], list[list[Any]]]:
        """Return header and rows: beam, quantity, "smallest" or "largest", value, arc length and case.

        Values are extremes at and between stations. Of tension, von Mises stress, shear stress and utilisation only the
        largest are listed, of compression only the smallest; quantities that are not known of a beam are left out.
        Raises InputError for an unknown quantity.
        """
        model = next(iter(self.cases.values())).model
        rows: list[list[Any]] = []
        for beam, called in zip(_beams(model), names(model.beams), strict=True):
            for name in items("quantities of an envelope", quantities):
                unit = model.unit(quantity(name).unit)
                for word, sign in _SIDES.get(name, _BOTH):
                    value, place, case = max(self._extremes(beam, name, sign), key=lambda found: found[0])
                    if np.isfinite(value):
                        rows.append([called, f"{name} [{unit}]", word, sign * value, place, case])
        return ["beam", "quantity", "extreme", "value", f"at [{model.unit('m')}]", "case"], rows

    def _extremes(self, beam: Beam, name: str, sign: float) -> Iterator[tuple[float, float, str]]:
        """Yield the largest value times `sign` of each case, with arc length [m] and case; -inf if it is not known."""
        values = quantity(name).values
        for case, solution in self.cases.items():
            mesh, points = _mesh(solution, beam), stations(_mesh(solution, beam))

            def at(
                row: int, element: np.ndarray, xi: np.ndarray, solution: Solution = solution, mesh: BeamMesh = mesh
            ) -> np.ndarray:
                return values(AxisPoints(mesh, element, xi), solution, np.array([row]))[0]

            own = points.by_element(values(points, solution, slice(None)))
            value, row, element, xi = extreme(*own, lambda found: sign * found, at)
            place = float(mesh.arc_length(np.array([element]), np.array([xi]))[0]) if row >= 0 else np.nan
            yield (sign * value if row >= 0 else -np.inf), place, case

    def to_pandas(self) -> "DataFrame":
        """Return the table as a pandas.DataFrame. Raises MissingPackageError without pandas."""
        return as_pandas(*self.table())

    def plot(
        self, beam: Beam, name: str = "moment", path: str | PathLike[str] | None = None, *, ax: Any = None
    ) -> "Figure":
        """Draw the envelope of a quantity along a beam, with the curves of its cases, and return the figure.

        path: file to write (PNG, SVG, PDF); ax: axes to draw in, see `Solution.plot`. Raises InputError for an unknown
        quantity or beam, MissingPackageError without matplotlib.
        """
        from beamfem.view.quantity_curve import plot_envelope

        return plot_envelope(self, beam, name, path, ax)


def envelope(solutions: Sequence[Solution] | Mapping[str, Solution], every_row: bool = False) -> Envelope:
    """Return the smallest and largest section forces and stresses of several solutions of the same beams.

    Statics count with their last row, motions with all rows. Raises InputError for anything else than solutions, or
    solutions of different beams.

    Parameters
    ----------
    solutions : sequence of Solution, or dict of str to Solution
        The solutions, such as load cases, and their names; by default "case 0", "case 1" and so on.
    every_row : bool, default False
        Whether all rows of statics count too, such as the load steps of a path.

    Examples
    --------
    >>> wind = bf.solve_static(model.with_loads([bf.DistributedLoad(beam, (0.0, 4e3))]))
    >>> both = bf.envelope({"tip load": solution, "wind": wind})
    >>> curve = both.along(beam, "moment")
    >>> float(curve.smallest[0].round(-1)), float(curve.largest[0].round(-1))  # at the clamp
    (-20000.0, 8000.0)
    """
    every = flag("every_row of envelope", every_row)
    if isinstance(solutions, Mapping):
        cases = {str(name): solution for name, solution in solutions.items()}
    else:
        cases = {f"case {number}": solution for number, solution in enumerate(items("solutions", solutions))}
    if not cases or not all(isinstance(solution, Solution) for solution in cases.values()):
        raise InputError(f"an envelope needs solutions such as solve_static returns, got {shown(solutions)}")
    beams = _beams(next(iter(cases.values())).model)
    for solution in cases.values():
        if len(_beams(solution.model)) != len(beams):
            raise InputError("the solutions of an envelope must be of the same beams: use model.with_loads(...)")
        for beam in beams:
            solution.model.number_of(beam)
    return Envelope(
        {name: solution[-1:] if solution.static and not every else solution for name, solution in cases.items()}
    )


def along_with(envelope: Envelope, beam: Beam, name: str, fractions: Iterable[float] = ()) -> EnvelopeCurve:
    """Return the envelope of a quantity at the stations of a beam and at further fractions of its length."""
    values = quantity(name).values
    meshes = [_mesh(solution, beam) for solution in envelope.cases.values()]
    arcs = np.concatenate([stations(mesh).arc_length for mesh in meshes]) / beam.curve.length
    at = np.repeat(np.unique(np.round([*arcs, *fractions], _DIGITS)), 2)
    beside = np.clip(at + np.where(np.arange(len(at)) % 2, _BESIDE, -_BESIDE), 0.0, 1.0).tolist()
    curves = {}
    for (case, solution), mesh in zip(envelope.cases.items(), meshes, strict=True):
        near = AxisPoints.at(mesh, beside)
        xi = np.where(near.xi < _END, 0.0, np.where(near.xi > 1.0 - _END, 1.0, near.xi))
        found = values(AxisPoints(mesh, near.element, xi), solution, slice(None))
        curves[case] = np.stack([found.min(axis=0), found.max(axis=0)])
    low, high = (np.stack([curve[side] for curve in curves.values()]) for side in (0, 1))
    return EnvelopeCurve(at * beam.curve.length, low.min(axis=0), high.max(axis=0), curves)


def _beams(model: Model) -> Sequence[Beam]:
    """Return the beams as the user made them, also of a model with refined meshes."""
    return tuple(getattr(model, "original", ()) or model.beams)


def _mesh(solution: Solution, beam: Beam) -> BeamMesh:
    return solution.model.meshes[solution.model.number_of(beam)]
