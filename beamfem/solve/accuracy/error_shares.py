"""Where a mesh is too coarse: the share of each element in the discretisation error."""

import numpy as np

from beamfem.assembly.equations import predicted_stresses
from beamfem.assembly.system import system_of
from beamfem.results.solution import Solution, State
from beamfem.solve.accuracy.carried_state import carried_stresses, places


def error_shares(state: State, finer: Solution) -> list[np.ndarray]:
    """Return the share (ne,) [-] of each element of each beam in the error of a state; their sum is 1, or 0.

    finer: the equilibrium on the enriched space. The error is measured by the complementary energy of the stress
    resultants in which the two differ, 1/2 int dS C^-1 dS ds, with the diagonal of the section stiffness C.
    """
    system = system_of(finer.model, static=True)
    now = predicted_stresses(system, finer.p[0], np.zeros(finer.model.size), state.at)
    energies = []
    for block, before, after in zip(system.blocks, carried_stresses(state, finer.model), now, strict=True):
        stiffness = np.einsum("cqii->cqi", block.stiffness)
        flexibility = np.divide(1.0, stiffness, out=np.zeros_like(stiffness), where=stiffness > 0.0)
        change = (after - before) ** 2 * flexibility[block.kind]
        energies.append((change.sum(axis=-1) * block.weight[block.kind]).sum(axis=-1))
    shares = []
    for old, new in zip(state.model.meshes, finer.model.meshes, strict=True):
        own = energies[new.block][new.first_element : new.first_element + new.elements]
        parent = places(old, new, np.array([0.5]))[0][:, 0]
        shares.append(np.bincount(parent, own, minlength=old.elements))
    total = sum(float(share.sum()) for share in shares)
    return [share / total if total > 0.0 else share for share in shares]
