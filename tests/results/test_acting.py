"""Forces on elements cut free, from which section forces follow, against the residual of compiled code."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.equations import residual
from beamfem.equations.system import System
from beamfem.results.axis_points import nodal_vectors
from beamfem.results.free_bodies import acting_on, rows_of
from beamfem.results.solution import Solution
from beamfem.results.status import Statistics

SECTION, RUBBER = bf.Rectangle(0.02, 0.1), bf.Material(5e5, 0.3, 1000.0)
ELEMENTS = [bf.ANCF(), bf.BilinearANCF(), bf.Element(bf.Lagrange(3), bf.Gradients(), bf.Structural())]
LOADS = {
    "weight": lambda beam: bf.Gravity((1.0, -9.81)),
    "dead": lambda beam: bf.DistributedLoad(beam, (2.0, -3.0)),
    "varying": lambda beam: bf.DistributedLoad(beam, lambda s: (np.sin(s), 1.0 + s**2)),
    "follower": lambda beam: bf.DistributedLoad(beam, (2.0, -3.0), follower=True),
    "pressure": lambda beam: bf.Pressure(beam, 5.0),
    "foundation": None,
    "inertia": None,
}


@pytest.mark.parametrize("name", LOADS)
@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: element.name)
@pytest.mark.parametrize("curve", [bf.Line((0, 0), (1, 0.3)), bf.Arc((0, 0), 1.0, 0.2, 1.2)], ids=["line", "arc"])
def test_what_acts_on_elements_is_what_the_residual_contains(name, element, curve, rng):
    """The coordinates are the nodal vectors, so that both are forces on these."""
    beam = bf.Beam(curve, 3, element, SECTION, RUBBER)
    loads = [LOADS[name](beam)] if LOADS[name] is not None else []
    supports = [bf.Foundation(beam, stiffness=(50.0, 80.0))] if name == "foundation" else []
    model, alone = bf.Model([beam], supports, loads), bf.Model([beam])
    p = System(model, static=False).reference + 0.05 * rng.standard_normal(model.size)
    zeros = np.zeros(model.size)
    a = rng.standard_normal(model.size) if name == "inertia" else zeros
    solution = Solution(model, False, np.array([0.4]), p[None], zeros[None], a[None], Statistics(0, 0, 0, ""))
    (mesh,) = model.meshes
    nodal = [nodal_vectors(mesh, values[None])[:, mesh.node] for values in (p, a)]
    e, acceleration = (values.reshape(1, mesh.elements, -1, 2) for values in nodal)
    acting = acting_on(rows_of(solution, slice(None)), mesh, np.arange(mesh.elements), e, acceleration)
    found, forces = np.zeros(model.size), acting.nodal(mesh.elements)[0]
    np.add.at(found, mesh.kinematics.dof[mesh.node].reshape(mesh.elements, -1), forces.reshape(mesh.elements, -1))
    elastic = residual(System(alone, static=False), p, zeros, zeros, 0.4)
    expected = elastic - residual(System(model, static=False), p, zeros, a, 0.4)
    assert np.abs(expected).max() > 0.1
    assert found == pytest.approx(expected, abs=1e-10 * np.abs(elastic).max())
