"""Sizes that compiled code knows in advance, so that its loops are unrolled and foreign branches fall away."""

from typing import NamedTuple

from beamfem.kernels.band import ANY_WIDTH
from beamfem.kernels.block import STRUCTURAL
from beamfem.kernels.compiling import kernel


class Form(NamedTuple):
    """Sizes of a block's elements as lengths of tuples: each form is a type with compiled code of its own.

    nodes: nn; vectors: vpn; measures: one more than the code of the strain measures. All empty: read at run time.
    window: see `band.known_width`.
    """

    nodes: tuple[bool, ...] = ()
    vectors: tuple[bool, ...] = ()
    measures: tuple[bool, ...] = ()
    window: tuple[float, ...] = ANY_WIDTH


ANY = Form()


def known_form(nodes: int, vectors: int, measures: int, window: tuple[float, ...]) -> Form:
    """Return the form with these sizes; cubics and parabolas, with structural forces order 4, have one of their own."""
    if nodes > (5 if measures == STRUCTURAL else 3) or (nodes > 2 and vectors > 2):
        return ANY
    return Form((True,) * nodes, (True,) * vectors, (True,) * (1 + measures), window)


@kernel(forceinline=True)
def sizes(form, block):
    """Return nn, vpn and the code of the strain measures, constants where the form knows them."""
    if len(form.nodes) > 0:
        return len(form.nodes), len(form.vectors), len(form.measures) - 1
    nodes = block.node.shape[1]
    return nodes, block.scale.shape[1] // nodes, block.measures
