"""The compiled functions that a group of elements needs, by their numbers; compiled, or loaded, when first asked for."""

from functools import cache

import numpy as np

from beamfem.kernels import (
    element_matrices,
    element_passes,
    field,
    gathering,
    inertia,
    linear_law,
    model_passes,
    node_passes,
    nodes,
    point_loads,
    record,
    reduction,
    stiffness,
)
from beamfem.kernels.generated import elastic_line, green_lagrange, rotation_node, shear_rigid_node, stretch_node, structural

_MEASURES = green_lagrange, structural, elastic_line
_KINDS = rotation_node, stretch_node, shear_rigid_node


@cache
def routines(measures: int) -> np.ndarray:
    """Return the table of addresses for a strain measure, given by its number in `physics.measures.MEASURES`."""
    own = _MEASURES[measures]
    found = {
        record.GATHER: gathering.gather,
        record.SCATTER: gathering.scatter,
        record.FILL_TABLES: gathering.fill_tables,
        record.FILL_BODY: gathering.fill_body,
        record.INTERPOLATE: field.interpolate,
        record.SPREAD: field.spread,
        record.COLUMNS: stiffness.columns,
        record.PRODUCTS: stiffness.products,
        record.MIRROR: stiffness.mirror,
        record.ADD_INERTIA: inertia.add_inertia,
        record.ADD_MASS: inertia.add_mass,
        record.ADD_SCALED: inertia.add_scaled,
        record.COMBINE: stiffness.combine,
        record.STORE: stiffness.store,
        record.FORM_MATRICES: element_matrices.form_matrices,
        record.ADD_MATRICES: element_matrices.add_matrices,
        record.REDUCE_COLUMNS: reduction.reduce_columns,
        record.REDUCE_ROWS: reduction.reduce_rows,
        record.ADD_TO_BAND: reduction.add_to_band,
        record.ADD_TO_SPARSE: reduction.add_to_sparse,
        record.ADD_NODE_FORCES: reduction.add_node_forces,
        record.ADD_CURVATURE: reduction.add_curvature,
        record.TAKE: nodes.take,
        record.TURN: nodes.turn,
        record.ROTATE: nodes.rotate,
        record.COPY: nodes.copy,
        record.CLEAR: nodes.clear,
        record.STRAINS: own.strains,
        record.FORCES: own.forces,
        record.RATES: own.rates,
        record.HESSIAN: own.hessian,
        record.LAW: linear_law.six_resultants if own is green_lagrange else linear_law.four_resultants,
        record.LOAD_FORCES: point_loads.load_forces,
        record.PLACE_NODES: node_passes.place_nodes,
        record.ADD_ELEMENTS: element_passes.add_elements,
        record.ADD_LOADS: point_loads.add_loads,
        record.FINISH_NODES: node_passes.finish_nodes,
        record.REDUCE: element_matrices.reduce_and_add,
        record.CLEAR_FORCES: model_passes.clear_forces,
        record.NODE_RATES: model_passes.add_node_rates,
    }
    for number, kind in enumerate(_KINDS):
        for step, name in enumerate(("place", "convect", "curve")):
            found[record.PLACE_KIND + 3 * number + step] = getattr(kind, name)
    table = np.zeros(record.ROUTINE_COUNT, dtype=np.int64)
    for number, each in found.items():
        table[number] = each.address
    return table
