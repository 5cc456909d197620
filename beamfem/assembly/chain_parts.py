"""Parts of a single chain of elements as separate blocks."""

from typing import TYPE_CHECKING

import numpy as np

from beamfem.assembly.blocks import classes_of, homes
from beamfem.kernels.block import Block, PointLoads

if TYPE_CHECKING:
    from beamfem.assembly.system import System


def is_chain(system: "System") -> bool:
    """Return whether a model is a single beam with a band matrix, without joints, inclined rollers,
    connectors or history."""
    model = system.model
    single = len(model.beams) == 1 and not model.joints and not system.inclined and not len(system.history.numbers)
    return single and system.unknowns.pattern is None and not system.connectors.items


def block_of(whole: Block, elements: slice, first_dof: int = 0) -> Block:
    """Return some elements of a chain as a block, whose coordinates are numbered from `first_dof`."""
    node = whole.node[elements]
    nodes = slice(int(node[0, 0]), int(node[-1, -1]) + 1)
    dof, node = whole.dof[nodes], node - nodes.start
    return whole._replace(
        **classes_of(whole, elements),
        home=homes(node, len(dof)),
        imposed=None if whole.imposed is None else whole.imposed.of(elements),
        history=whole.history_of(elements),
        node=node,
        dof=np.where(dof >= 0, dof - first_dof, -1),
        beam=whole.beam[elements],
        **{name: getattr(whole, name)[nodes] for name in ("node_kind", "frame")},
    )


def loads_of(whole: PointLoads, elements: slice) -> tuple[PointLoads, np.ndarray]:
    """Return the loads on some elements of a chain, which are numbered from the first, and the indices of the loads."""
    loaded = np.flatnonzero((whole.element >= elements.start) & (whole.element < elements.stop))
    points = PointLoads(*(column[loaded] for column in whole))
    return points._replace(element=points.element - elements.start), loaded
