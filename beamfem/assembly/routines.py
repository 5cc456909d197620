"""Compiled functions of a group of elements by their numbers, each compiled or loaded when it is first needed."""

from functools import cache

import numpy as np

from beamfem.kernels import (
    band_assembly,
    element_matrices,
    element_passes,
    field,
    gathering,
    linear_law,
    model_passes,
    node_passes,
    nodes,
    point_loads,
    record,
    reduction,
)
from beamfem.kernels import element_stiffness as stiffness
from beamfem.kernels import imposed_strain_pass as imposed_strains
from beamfem.kernels import inertia_forces as inertia
from beamfem.kernels.compiling import Routine
from beamfem.kernels.generated import elastic_line_pass as elastic_line
from beamfem.kernels.generated import green_lagrange_pass as green_lagrange
from beamfem.kernels.generated import rotation_node, shear_rigid_node, stretch_node
from beamfem.kernels.generated import structural_pass as structural

MEASURE_PASSES = green_lagrange, structural, elastic_line
_KINDS = rotation_node, stretch_node, shear_rigid_node

# the routines of a task that do not depend on the strain measure
_TASKS: dict[str, dict[int, Routine]] = {
    "forces": {
        record.COLLECT: gathering.collect,
        record.SCATTER: gathering.scatter,
        record.INTERPOLATE: field.interpolate,
        record.DISTRIBUTE: field.distribute,
        record.ADD_INERTIA: inertia.add_inertia,
        record.COPY: nodes.copy,
        record.CLEAR: nodes.clear,
        record.PLACE_NODES: node_passes.place_nodes,
        record.ADD_ELEMENTS: element_passes.add_elements,
        record.FINISH_NODES: node_passes.finish_nodes,
    },
    "tangent": {
        record.COLUMNS: stiffness.columns,
        record.PRODUCTS: stiffness.products,
        record.STORE: stiffness.store,
        record.MIRROR: stiffness.mirror,
        record.FORM_MATRICES: element_matrices.form_matrices,
        record.ADD_MATRICES: element_matrices.add_matrices,
    },
    "mass": {record.ADD_SCALED: inertia.add_scaled, record.ADD_MASS: inertia.add_mass},
    "prediction": {record.NODE_RATES: model_passes.add_node_rates, record.RATE_NODES: model_passes.rate_nodes},
    "damping": {
        record.NODE_RATES: model_passes.add_node_rates,
        record.RATE_NODES: model_passes.rate_nodes,
        record.VISCOUS: linear_law.add_viscous,
    },
    "imposed": {record.RELEASE: imposed_strains.release},
    "band": {record.ADD_TO_BAND: band_assembly.add_to_band},
    "sparse": {record.ADD_TO_SPARSE: reduction.add_to_sparse},
    "angles": {record.ROTATE_FRAME: nodes.rotate_frame},
    "rotated": {record.ROTATE: nodes.rotate},
    "rotation tangent": {record.COMBINE: stiffness.combine, record.ADD_CURVATURE: reduction.add_curvature},
    "loads": {record.ADD_LOADS: point_loads.add_loads, record.LOAD_FORCES: point_loads.load_forces},
    "load tangent": {record.REDUCE: element_matrices.reduce_and_add},
    "rotation load tangent": {
        record.REDUCE_COLUMNS: reduction.reduce_columns,
        record.REDUCE_ROWS: reduction.reduce_rows,
    },
}
# and those that do, by name
_PASSES: dict[str, dict[int, str]] = {
    "forces": {record.STRAINS: "strains", record.FORCES: "forces"},
    "tangent": {record.HESSIAN: "hessian"},
    "prediction": {record.RATES: "rates"},
    "damping": {record.RATES: "rates"},
}
# the routine of a task for each kind of node with an angle: name, and offset among those of the kind
_OF_KINDS = {"forces": ("place", 0), "mass": ("convect", 1), "tangent": ("curve", 2)}

Sizes = tuple[tuple[str, int], ...]  # arguments of kernels by their names


class Routines:
    """Table of the addresses of routines for a strain measure; entries are filled when a task first needs them.

    sizes: arguments that are constants for the compiler, since they are the same for all elements; law: address of the
    section law that replaces the linear one, 0 for none.
    """

    def __init__(self, measures: int, sizes: Sizes, law: int = 0) -> None:
        self._sizes = dict(sizes)
        self.addresses = np.zeros(record.ROUTINE_COUNT, dtype=np.int64)
        self._measures, self._law, self._ready = measures, law, set[tuple[tuple[str, ...], tuple[int, ...]]]()

    def require(self, tasks: tuple[str, ...], kinds: tuple[int, ...]) -> None:
        """Compile or load the routines of tasks; kinds: nodes with an angle, indices in `physics.kinematics.KINDS`."""
        if (tasks, kinds) in self._ready:
            return
        for task in tasks:
            for kind in (-1, *kinds):
                self._fill(task, kind)
        self._ready.add((tasks, kinds))

    def _fill(self, task: str, kind: int) -> None:
        passes = MEASURE_PASSES[self._measures]
        by_number = dict(_TASKS[task]) if kind < 0 else {}
        if kind < 0:
            by_number |= {number: getattr(passes, name) for number, name in _PASSES.get(task, {}).items()}
            if task == "forces":
                linear = linear_law.six_resultants if passes is green_lagrange else linear_law.four_resultants
                self.addresses[record.LAW] = self._law or linear.address
        elif task in _OF_KINDS:
            name, step = _OF_KINDS[task]
            by_number[record.PLACE_KIND + 3 * kind + step] = getattr(_KINDS[kind], name)
        for number, routine in by_number.items():
            self.addresses[number] = routine.fixed(**self._sizes).address


@cache
def routines(measures: int, sizes: Sizes) -> Routines:
    """Return the table for a strain measure, an index in `physics.measures.MEASURES`, and some sizes."""
    return Routines(measures, sizes)
