"""Compiled functions of a group of elements by their names, each compiled or loaded when it is first needed."""

from functools import cache

from beamfem.kernels import linear_law
from beamfem.kernels.block import GREEN_LAGRANGE
from beamfem.kernels.compiling import Routine
from beamfem.kernels.record import GroupRoutines, NodePasses
from beamfem.physics.compiled_elements import MEASURE_PASSES, NODE_PASSES

Sizes = tuple[tuple[str, int], ...]  # arguments of kernels by their names


class Routines:
    """The routines for a strain measure, each set when a task first needs it.

    sizes: arguments that are constants for the compiler, since they are the same for all elements; law: address of the
    section law that replaces the linear one, 0 for none.
    """

    def __init__(self, measures: int, sizes: Sizes, law: int = 0) -> None:
        self.record = GroupRoutines(nodes=[NodePasses() for _ in NODE_PASSES])
        self._sizes, self._measures, self._law = dict(sizes), measures, law
        self._ready = set[tuple[tuple[str, ...], tuple[int, ...]]]()

    def require(self, tasks: tuple[str, ...], kinds: tuple[int, ...]) -> None:
        """Compile or load the routines of tasks; kinds: nodes with an angle, indices in `physics.kinematics.KINDS`."""
        if (tasks, kinds) in self._ready:
            return
        for task in tasks:
            for name, called in GroupRoutines.called.items():
                if task in called.tasks:
                    setattr(self.record, name, self._own(name))
            for name, called in NodePasses.called.items():
                for kind in kinds if task in called.tasks else ():
                    setattr(self.record.nodes[kind], name, NODE_PASSES[kind][name])
        self._ready.add((tasks, kinds))

    def _own(self, name: str) -> Routine | int:
        """Return the routine of these elements, or its address."""
        if name == "law" and (self._law or self._measures == GREEN_LAGRANGE):
            return self._law or linear_law.six_resultants
        own = MEASURE_PASSES[self._measures].get(name)
        return own or GroupRoutines.called[name].routine.fixed(**self._sizes)


@cache
def routines(measures: int, sizes: Sizes) -> Routines:
    """Return the routines for a strain measure, an index in `physics.measures.MEASURES`, and some sizes."""
    return Routines(measures, sizes)
