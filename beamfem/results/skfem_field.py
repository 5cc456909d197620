"""The field of a beam on a scikit-fem basis, for user-defined forms, with the states as its coefficients."""

from dataclasses import dataclass

import numpy as np
from skfem import Basis
from skfem.element import DiscreteField

from beamfem.errors import InputError
from beamfem.forms import axis_basis, beam_basis
from beamfem.model.beam import Beam
from beamfem.reprs import brief
from beamfem.results.postprocess import nodal_vectors
from beamfem.results.solution import Solution
from beamfem.validation import flag, number_below, shown

_ALIKE = 1e-9  # fraction of the longest element: tolerance between mesh lengths and arc lengths


@dataclass(frozen=True, eq=False)
class FieldOnBasis:
    """The body r(s, y) = r0(s) + y d(s) [m] of a beam in all states, on a scikit-fem basis.

    Parameters
    ----------
    basis : skfem.CellBasis
        Basis over the arc length s [m] and y [m].
    values : array, (steps, basis.N)
        Coefficients in each state.
    """

    basis: Basis
    values: np.ndarray

    __repr__ = brief

    def interpolate(self, row: int = -1) -> DiscreteField:
        """Return position r (2, ne, nq) [m] and gradient F = (dr/ds, dr/dy) (2, 2, ne, nq) [-] in a row, for forms.

        ne elements have nq quadrature points each. Raises InputError for a row that does not exist.

        Examples
        --------
        >>> r = bf.field_on_basis(solution, beam).interpolate(row=-1)
        >>> r.grad.shape[:2]
        (2, 2)
        """
        row = number_below("row of interpolate", row, len(self.values), -len(self.values))
        return self.basis.interpolate(self.values[row])


def field_on_basis(solution: Solution, beam: Beam, body: bool = True, piece: int | None = None) -> FieldOnBasis:
    """Return the field of a beam in all states of a solution on a scikit-fem basis.

    Raises InputError for a beam with corners without a piece, and for knot spans as elements.

    Parameters
    ----------
    solution : Solution
        States of a model.
    beam : Beam
        A beam of the model.
    body : bool, default True
        True: quadrature over the length and the section, with weights times width, for integrals over the volume [m^3].
        The weights are those of a straight body: with a curvature k of the reference, > 0 towards +y, multiply by
        1 - k y, the determinant of the gradient there.
        False: quadrature over the axis alone, for integrals over the length [m].
    piece : int, optional
        Number of a smooth piece, 0 at the start of the beam, for a beam with corners, where its field has two
        directions but a basis only one.

    References
    ----------
    Paper, eqs. (2) to (4).

    Examples
    --------
    >>> field = bf.field_on_basis(solution, beam)
    >>> round(float(field.basis.dx.sum()), 6)  # volume of the beam
    0.01
    """
    if not isinstance(solution, Solution):
        raise InputError(f"field_on_basis needs a Solution, such as solve_static returns, got {shown(solution)}")
    body = flag("body of field_on_basis", body)
    mesh, p = solution.model.meshes[solution.model.number_of(beam)], solution.p
    pieces = mesh.pieces
    if piece is None and len(pieces) > 1:
        raise InputError(
            f"{mesh.beam!r} has corners, where its field has two directions but a basis only one: ask for one of its "
            f"{len(pieces)} smooth pieces, such as piece=0"
        )
    elements = pieces[number_below("piece of field_on_basis", piece or 0, len(pieces), -len(pieces))]
    arc_lengths = np.diff(mesh.vertices)
    if np.abs(mesh.lengths - arc_lengths).max() > _ALIKE * arc_lengths.max():
        raise InputError(
            f"the elements of {mesh.beam!r} are the knot spans of a spline, but a basis needs arc lengths: set "
            "elements to a number"
        )
    basis = beam_basis(mesh, elements=elements) if body else axis_basis(mesh, elements)
    vectors, element = nodal_vectors(mesh, p), basis.elem
    values = np.empty((len(p), basis.N))
    for i, numbers in enumerate(basis.element_dofs):
        node, vector, axis = element.place(i)
        values[:, numbers] = vectors[:, mesh.node[elements, node], vector, axis]
    return FieldOnBasis(basis, values)
