"""The compiled kernels against the readable scikit-fem forms, to round-off."""

from dataclasses import dataclass

import numpy as np
import pytest

from beamfem import ContinuumMechanics, Element, Gravity, Line, Material, Model, Pin, Section
from beamfem.element.coordinates import Gradients, Rotation, labels
from beamfem.element.fields import Cubic, Field, Lagrange
from beamfem.equations.equations import INERTIA, STATICS, energies_of_beams, linearise, residual
from beamfem.equations.system import System
from beamfem.forms import (
    beam_basis,
    elastic_force,
    elastic_tangent,
    gravity_load,
    mass,
    mass_basis,
    nodal_numbers,
    strain_energy,
)
from beamfem.kernels.block import ROTATION
from beamfem.model.beam import Beam
from beamfem.results.postprocess import strain_energies

GRAVITY = (1.3, -9.81)
FIELDS = [Cubic(), Lagrange(1), Lagrange(2), Lagrange(3)]
STATES = [0.0, 0.2]  # size of the random change of the coordinates

each_field = pytest.mark.parametrize("field", FIELDS, ids=lambda field: field.name)
each_state = pytest.mark.parametrize("size", STATES, ids=["reference", "deformed"])
each_law = pytest.mark.parametrize("plane_stress", [False, True], ids=["solid", "plane_stress"])
each_integration = pytest.mark.parametrize("integration", ["full", "reduced"])


def make_system(element: Element) -> System:
    """An oblique beam whose pin splits one of three equal elements, so that element lengths differ."""
    section, material = Section(2e-3, 1.1e-6), Material(2.1e9, 0.3, 7800.0)
    beam = Beam(Line((0.3, -0.2), (1.6, 0.7)), 3, element, section, material)
    return System(Model([beam], [Pin(beam.at(0.42))], [Gravity(GRAVITY)]), static=False)


def random_state(system: System, size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    random = np.random.default_rng(7)
    change, v, a = random.uniform(-1.0, 1.0, (3, system.model.size))
    return system.reference + size * change, 3.0 * v, 20.0 * a


def dense(system: System, rows: np.ndarray) -> np.ndarray:
    n, width = rows.shape
    half = width // 2
    matrix = np.zeros((n, n))
    for row in range(n):
        for column in range(max(row - half, 0), min(row + half + 1, n)):
            matrix[row, column] = rows[row, half + column - row]
    return matrix


def tangent_of(system: System, p: np.ndarray, v: np.ndarray, a: np.ndarray, coefficients: tuple) -> np.ndarray:
    """Tangent of the unknown coordinates."""
    return dense(system, linearise(system, p, v, a, 0.0, coefficients)[1].rows)


def assert_equal_to_round_off(actual: np.ndarray, expected: np.ndarray, scale: float | None = None) -> None:
    scale = np.abs(expected).max() if scale is None else scale
    np.testing.assert_allclose(actual, expected, rtol=0.0, atol=1e-12 * scale)


@dataclass
class Oracle:
    """Forms of the only beam of a system in the numbering of e."""

    system: System

    def __post_init__(self) -> None:
        mesh = self.system.model.meshes[0]
        beam = mesh.beam
        self.basis, self.mass_basis = beam_basis(mesh), mass_basis(mesh)
        self.numbers = nodal_numbers(self.basis)
        law = beam.element.forces.plane_stress
        self.lame = {"lam": beam.material.lame_lambda(law), "mu": beam.material.shear_modulus}
        self.density = beam.material.density

    def _vector(self, assembled: np.ndarray) -> np.ndarray:
        result = np.empty(len(assembled))
        result[self.numbers] = assembled
        return result

    def _matrix(self, assembled) -> np.ndarray:
        result = np.empty(assembled.shape)
        result[np.ix_(self.numbers, self.numbers)] = assembled.toarray()
        return result

    def force(self, e: np.ndarray) -> np.ndarray:
        return self._vector(elastic_force.assemble(self.basis, u=e[self.numbers], **self.lame))

    def stiffness(self, e: np.ndarray) -> np.ndarray:
        return self._matrix(elastic_tangent.assemble(self.basis, u=e[self.numbers], **self.lame))

    def energy(self, e: np.ndarray) -> float:
        return strain_energy.assemble(self.basis, u=e[self.numbers], **self.lame)

    def mass(self) -> np.ndarray:
        return self._matrix(mass.assemble(self.mass_basis, density=self.density))

    def weight(self) -> np.ndarray:
        gx, gy = GRAVITY
        return self._vector(gravity_load.assemble(self.mass_basis, density=self.density, gx=gx, gy=gy))

    def scale(self) -> float:
        """Largest force that a nodal change of order 1 causes, the yardstick where elastic forces cancel."""
        return float(np.abs(self.stiffness(self.system.reference)).max())


@dataclass
class RotatedOracle:
    """e(p), B and B' of paper, eqs. (5) to (7), written out; angles are theta plus the slope of the beam."""

    system: System
    per_node: int

    def angles(self, p: np.ndarray) -> np.ndarray:
        line = self.system.model.beams[0].curve
        slope = np.arctan2(line.end[1] - line.start[1], line.end[0] - line.start[0])
        return p.reshape(-1, self.per_node)[:, -1] + slope

    def e(self, p: np.ndarray) -> np.ndarray:
        linear, t = p.reshape(-1, self.per_node)[:, :-1], self.angles(p)
        return np.column_stack([linear, -np.sin(t), np.cos(t)]).ravel()

    def _per_node(self, identity: float, columns: np.ndarray) -> np.ndarray:
        nodes, n = len(columns), self.per_node
        result = np.zeros((nodes * (n + 1), nodes * n))
        for node, column in enumerate(columns):
            row, col = node * (n + 1), node * n
            result[row : row + n - 1, col : col + n - 1] = identity * np.eye(n - 1)
            result[row + n - 1 : row + n + 1, col + n - 1] = column
        return result

    def b(self, p: np.ndarray) -> np.ndarray:
        t = self.angles(p)
        return self._per_node(1.0, np.column_stack([-np.cos(t), -np.sin(t)]))

    def b_dot(self, p: np.ndarray, v: np.ndarray) -> np.ndarray:
        t, rate = self.angles(p), v.reshape(-1, self.per_node)[:, -1]
        return self._per_node(0.0, np.column_stack([np.sin(t) * rate, -np.cos(t) * rate]))

    def b_transposed_slope(self, p: np.ndarray, f: np.ndarray) -> np.ndarray:
        """d(B^T)/dp f: (sin t, -cos t) . f on the diagonal of each angle."""
        t, pairs = self.angles(p), f.reshape(-1, self.per_node + 1)[:, -2:]
        diagonal = np.zeros(p.shape).reshape(-1, self.per_node)
        diagonal[:, -1] = np.sin(t) * pairs[:, 0] - np.cos(t) * pairs[:, 1]
        return np.diag(diagonal.ravel())

    def acceleration_slopes(self, p: np.ndarray, v: np.ndarray, a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """d(B a + B' v)/dp and d(B' v)/dv."""
        t = self.angles(p)
        rate, turn = v.reshape(-1, self.per_node)[:, -1], a.reshape(-1, self.per_node)[:, -1]
        x = np.sin(t) * turn + np.cos(t) * rate**2
        y = -np.cos(t) * turn + np.sin(t) * rate**2
        return self._per_node(0.0, np.column_stack([x, y])), 2.0 * self.b_dot(p, v)


@each_field
@each_law
@each_integration
@each_state
def test_gradients_force_and_tangent(field: Field, plane_stress: bool, integration, size: float):
    system = make_system(Element(field, Gradients(), ContinuumMechanics(plane_stress), integration))
    oracle = Oracle(system)
    e, _, _ = random_state(system, size)
    still = np.zeros(len(e))
    kernel = residual(system, e, still, still, 0.0)
    assert_equal_to_round_off(kernel, oracle.force(e) - oracle.weight(), None if size else oracle.scale())
    free = system.free_dofs
    assert_equal_to_round_off(tangent_of(system, e, still, still, STATICS), oracle.stiffness(e)[np.ix_(free, free)])


@each_field
def test_gradients_inertia(field: Field):
    system = make_system(Element(field, Gradients(), ContinuumMechanics()))
    oracle = Oracle(system)
    e, v, a = random_state(system, 0.2)
    free, m = system.free_dofs, oracle.mass()
    assert_equal_to_round_off(tangent_of(system, e, v, a, INERTIA), m[np.ix_(free, free)])
    assert_equal_to_round_off(residual(system, e, v, a, 0.0), m @ a + oracle.force(e) - oracle.weight())


@each_field
@each_law
@each_state
def test_rotation_force_and_tangent(field: Field, plane_stress: bool, size: float):
    system = make_system(Element(field, Rotation(), ContinuumMechanics(plane_stress)))
    oracle = Oracle(make_system(Element(field, Gradients(), ContinuumMechanics(plane_stress))))
    rotated = RotatedOracle(system, len(labels(ROTATION, field.vectors)))
    p, _, _ = random_state(system, size)
    still = np.zeros(len(p))
    e, b = rotated.e(p), rotated.b(p)
    f = oracle.force(e) - oracle.weight()
    assert_equal_to_round_off(residual(system, p, still, still, 0.0), b.T @ f, None if size else oracle.scale())
    expected = b.T @ oracle.stiffness(e) @ b + rotated.b_transposed_slope(p, f)
    free = system.free_dofs
    assert_equal_to_round_off(tangent_of(system, p, still, still, STATICS), expected[np.ix_(free, free)])


@each_field
def test_rotation_inertia(field: Field):
    system = make_system(Element(field, Rotation(), ContinuumMechanics()))
    oracle = Oracle(make_system(Element(field, Gradients(), ContinuumMechanics())))
    rotated = RotatedOracle(system, len(labels(ROTATION, field.vectors)))
    p, v, a = random_state(system, 0.2)
    e, b, m = rotated.e(p), rotated.b(p), oracle.mass()
    free = np.ix_(system.free_dofs, system.free_dofs)
    assert_equal_to_round_off(tangent_of(system, p, v, a, INERTIA), (b.T @ m @ b)[free])

    still = np.zeros(len(p))
    inertia = m @ (b @ a + rotated.b_dot(p, v) @ v)
    difference = residual(system, p, v, a, 0.0) - residual(system, p, still, still, 0.0)
    f = oracle.force(e) - oracle.weight()
    assert_equal_to_round_off(difference, b.T @ inertia, np.abs(b.T @ f).max())

    ck, cv, ca = 1.0, 50.0, 4000.0
    by_p, by_v = rotated.acceleration_slopes(p, v, a)
    elastic = b.T @ oracle.stiffness(e) @ b + rotated.b_transposed_slope(p, f + inertia)
    expected = ck * elastic + b.T @ m @ (ck * by_p + cv * by_v + ca * b)
    assert_equal_to_round_off(tangent_of(system, p, v, a, (ck, cv, ca)), expected[free])


@each_field
@pytest.mark.parametrize("moving", [0.0, 1.0], ids=["weight", "inertia"])
def test_inertia_and_weight_of_the_kernel_alone(field: Field, moving: float):
    """Material too soft for its elastic forces to hide the others."""
    beam = Beam(
        Line((0.0, 0.0), (0.0, 2.0)),
        2,
        Element(field, Rotation(), ContinuumMechanics()),
        Section(2e-3, 1.1e-6),
        Material(1e-12, 0.3, 7800.0),
    )
    system = System(Model([beam], loads=[Gravity(GRAVITY)]), static=False)
    rotated = RotatedOracle(system, len(labels(ROTATION, field.vectors)))
    p, v, a = random_state(system, 0.2)
    v, a, b, oracle = moving * v, moving * a, rotated.b(p), Oracle(system)
    inertia = oracle.mass() @ (b @ a + rotated.b_dot(p, v) @ v)
    assert_equal_to_round_off(residual(system, p, v, a, 0.0), b.T @ (inertia - oracle.weight()))


@each_field
def test_energies(field: Field):
    system = make_system(Element(field, Gradients(), ContinuumMechanics()))
    oracle = Oracle(system)
    e, v, _ = random_state(system, 0.2)
    assert_equal_to_round_off(strain_energies(system.model.meshes[0], e[None])[0, 0], oracle.energy(e))
    numbers, _ = energies_of_beams(system, e[None], v[None], np.empty((1, 0)))
    assert_equal_to_round_off(numbers[0, 0, :2], np.array([0.5 * v @ oracle.mass() @ v, oracle.energy(e)]))


@each_field
def test_forms_are_derivatives_of_the_energy(field: Field):
    oracle = Oracle(make_system(Element(field, Gradients(), ContinuumMechanics())))
    e, direction, _ = random_state(oracle.system, 0.2)
    step = 1e-6 * direction
    power = (oracle.energy(e + step) - oracle.energy(e - step)) / 2e-6
    assert power == pytest.approx(oracle.force(e) @ direction, rel=1e-7)
    change = (oracle.force(e + step) - oracle.force(e - step)) / 2e-6
    exact = oracle.stiffness(e) @ direction
    np.testing.assert_allclose(change, exact, rtol=0.0, atol=1e-8 * np.abs(exact).max())


@each_field
def test_mass_integration_is_exact(field: Field):
    mesh = make_system(Element(field, Gradients(), ContinuumMechanics())).model.meshes[0]
    finer = beam_basis(mesh, field.degree + 3)
    assert_equal_to_round_off(
        mass.assemble(mass_basis(mesh), density=2.0).toarray(), mass.assemble(finer, density=2.0).toarray()
    )
