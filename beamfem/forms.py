"""The physics of a straight beam as readable scikit-fem forms: the oracle that the compiled kernels are tested against.

All forms live on a basis of `beam_basis`; u is the position r(s, y) [m], so grad(u) is the deformation gradient F.
Strain E = (F^T F - 1) / 2 and stress S = lambda tr(E) 1 + 2 mu E of St. Venant-Kirchhoff; paper, section 3.3.
"""

from typing import Any

import numpy as np
from skfem import Basis, BilinearForm, Functional, LinearForm
from skfem.helpers import ddot, dot, eye, grad, identity, mul, trace, transpose

from beamfem.element.fields import BeamMapping, FieldElement
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import sections_at
from beamfem.quadrature import gauss

_ALL = slice(None)


def beam_basis(mesh: BeamMesh, points: int | None = None, elements: slice = _ALL) -> Basis:
    """Return the basis of a beam, quadrature (s, y) over its length and the strips of its sections where they are.

    points: Gauss points along an element; without it those of the beam's elastic forces; elements: a smooth piece.
    """
    formulation, chosen = mesh.beam.element, np.arange(mesh.elements)[elements]
    xi, along = formulation.quadrature() if points is None else gauss(points)
    element, at = np.repeat(chosen, len(xi)), np.tile(xi, len(chosen))
    sections = sections_at(mesh, element, at)
    strips = [section.strips(mesh.beam.material) for section in sections] * (len(at) // len(sections))
    y, across = (np.array([np.concatenate([part[n] for part in parts]) for parts in strips]) for n in (1, 2))
    shape = (len(chosen), -1)
    X = np.stack([np.repeat(at[:, None], y.shape[1], axis=1).reshape(shape), y.reshape(shape)])
    W = (np.tile(along, len(chosen))[:, None] * across).reshape(shape)
    line = mesh.skfem(elements)
    return Basis(line, FieldElement(formulation.field), mapping=BeamMapping(line), quadrature=(X, W))


def mass_basis(mesh: BeamMesh) -> Basis:
    """Return the basis of a beam with the quadrature that integrates mass and gravity exactly."""
    field = mesh.beam.element.field
    return beam_basis(mesh, max(field.degree, field.director_degree) + 1)


def axis_basis(mesh: BeamMesh, elements: slice = _ALL) -> Basis:
    """Return the basis of a beam with points on its axis alone, which integrates over the length.

    elements: those of a smooth piece.
    """
    field = mesh.beam.element.field
    xi, weights = gauss(max(field.degree, field.director_degree) + 1)
    line = mesh.skfem(elements)
    points = np.stack([xi, np.zeros_like(xi)])
    return Basis(line, FieldElement(field), mapping=BeamMapping(line), quadrature=(points, weights))


def nodal_numbers(basis: Basis) -> np.ndarray:
    """Return the number (N,) of each degree of freedom in e, the nodal vectors of all nodes along the beam."""
    element = basis.elem
    intervals = len(element.field.nodes) - 1
    numbers = np.empty(basis.N, dtype=np.int64)
    for i, dofs in enumerate(basis.element_dofs):
        node, vector, axis = element.place(i)
        along = np.arange(basis.nelems) * intervals + node
        numbers[dofs] = along * element.nodal_dofs + 2 * vector + axis
    return numbers


def strain(F: np.ndarray) -> np.ndarray:
    """Return the Green-Lagrange strain E = (F^T F - 1) / 2 [-] (2, 2, ...); paper, section 3.3."""
    return 0.5 * (mul(transpose(F), F) - identity(F))


def stress(E: np.ndarray, lam: float, mu: float) -> np.ndarray:
    """Return the second Piola-Kirchhoff stress S = lambda tr(E) 1 + 2 mu E [Pa] (2, 2, ...); paper, section 3.3."""
    return lam * eye(trace(E), 2) + 2.0 * mu * E


@Functional
def strain_energy(w: Any) -> np.ndarray:
    """Strain energy, the integral of S : E / 2 [J]; of u, lam, mu [Pa]."""
    E = strain(grad(w.u))
    return 0.5 * ddot(stress(E, w.lam, w.mu), E)


@LinearForm
def elastic_force(v: Any, w: Any) -> np.ndarray:
    """Elastic force, the integral of P : grad(v) with P = F S [N, N m]; of u, lam, mu [Pa]."""
    F = grad(w.u)
    P = mul(F, stress(strain(F), w.lam, w.mu))
    return ddot(P, grad(v))


@BilinearForm
def elastic_tangent(du: Any, v: Any, w: Any) -> np.ndarray:
    """Derivative of `elastic_force` in the direction du: (dF S + F dS) : grad(v), dE = sym(F^T dF)."""
    F, dF = grad(w.u), grad(du)
    S = stress(strain(F), w.lam, w.mu)
    dE = 0.5 * (mul(transpose(F), dF) + mul(transpose(dF), F))
    dP = mul(dF, S) + mul(F, stress(dE, w.lam, w.mu))
    return ddot(dP, grad(v))


@BilinearForm
def mass(u: Any, v: Any, w: Any) -> np.ndarray:
    """Mass, the integral of density u . v [kg, kg m, kg m^2]; of density [kg/m^3]."""
    return w.density * dot(u, v)


@LinearForm
def gravity_load(v: Any, w: Any) -> np.ndarray:
    """Weight, the integral of density g . v [N, N m]; of density [kg/m^3], gx, gy [m/s^2]."""
    return w.density * (w.gx * v[0] + w.gy * v[1])


@LinearForm
def pressure_load(v: Any, w: Any) -> np.ndarray:
    """Pressure on the axis, the integral of p (-y', x') . v [N, N m]; of u, pressure [N/m], on an `axis_basis`."""
    F = grad(w.u)
    return w.pressure * (F[0, 0] * v[1] - F[1, 0] * v[0])
