"""One evaluation of all equations of a model: a state and weights in, residual and tangent out."""

from collections.abc import Sequence

import numpy as np

from beamfem.assembly.sheet import Sheet, Work
from beamfem.kernels import element_passes, model_passes, node_passes, record
from beamfem.kernels.block import Springs

Stresses = Sequence[np.ndarray]


class Assembler:
    """The equations of groups of elements and springs, with space of their own: one for each solve and thread.

    stresses: resultants (ne, nq, ns) of each group for the geometric part of the tangent.
    """

    def __init__(self, sheets: Sequence[Sheet], springs: Springs, size: int, stresses: Stresses | None = None) -> None:
        given = [None] * len(sheets) if stresses is None else stresses
        self.works = tuple(Work(sheet, stress) for sheet, stress in zip(sheets, given, strict=True))
        self.size = size
        self._springs = tuple(
            np.ascontiguousarray(values, dtype=kind)
            for values, kind in zip(springs, (np.int64, float, float, np.int64), strict=True)
        )
        self._groups = np.array([work.table.ctypes.data for work in self.works], dtype=np.int64)
        self._values = np.zeros(len(sheets), dtype=np.int64)
        self._factors = np.zeros(3)
        self._acting: tuple[np.ndarray, ...] = ()
        self.table = table = np.zeros(record.SYSTEM_FIELDS, dtype=np.int64)
        table[record.GROUPS], table[record.SIZE] = len(sheets), size
        table[record.GROUP_RECORDS], table[record.VALUES] = self._groups.ctypes.data, self._values.ctypes.data
        table[record.FACTORS], table[record.SPRINGS] = self._factors.ctypes.data, len(self._springs[0])
        for number, values in enumerate(self._springs):
            table[record.SPRING_DOF + number] = values.ctypes.data

    @property
    def stresses(self) -> tuple[np.ndarray, ...]:
        """Resultants (ne, nq, ns) of each group that the last step predicts, for the geometric part of the tangent."""
        return tuple(work.stress for work in self.works)

    @property
    def values(self) -> tuple[np.ndarray, ...]:
        """Values of point loads of each group, as they were taken."""
        return self._acting[1:]

    @property
    def tables(self) -> tuple[np.ndarray, ...]:
        """The arrays whose addresses the table of the equations holds."""
        return (self._groups, self._values, self._factors, *self._springs, *self._acting)

    def load(self, body: np.ndarray, values: Sequence[np.ndarray]) -> None:
        """Take body forces (..., beams, 4) and point loads (..., nl, 3) of each group; time steps may come first."""
        self._acting = tuple(np.ascontiguousarray(each, dtype=float) for each in (body, *values))
        self.table[record.BODY] = self._acting[0].ctypes.data
        self.table[record.LOADED] = int(self._acting[0].any())
        self._values[:] = [each.ctypes.data for each in self._acting[1:]]

    def weigh(self, coefficients: Sequence[float]) -> None:
        """Take the weights ck, cv, ca of p, p', p'' in the tangent; ca = 0 leaves inertia out of the residual too."""
        self._factors[:] = coefficients
        self.table[record.MOVING] = int(coefficients[2] != 0.0)

    def require(self, *tasks: str) -> None:
        """Have everything compiled that compiled drivers will call: forces always, "tangent", "prediction"."""
        moving = self.table[record.MOVING] != 0 and "tangent" in tasks
        for work in self.works:
            work.sheet.require("forces", *tasks, *(("mass",) if moving else ()))

    def place(self, p: np.ndarray, v: np.ndarray, a: np.ndarray, residual: np.ndarray, matrix: np.ndarray) -> None:
        """Take the arrays (n,) of a state and where results go; who calls keeps them alive."""
        for number, values in enumerate((p, v, a)):
            self.table[record.COORDINATES_P + number] = _address(values, self.size)
        self.table[record.RESIDUAL] = _address(residual, self.size)
        self.table[record.MATRIX], self.table[record.ENTRIES] = _address(matrix), matrix.size

    def balance(
        self, p: np.ndarray, v: np.ndarray, a: np.ndarray, residual: np.ndarray, matrix: np.ndarray, predicted: bool
    ) -> None:
        """Fill the residual (n,) and, unless it is empty, the flat matrix.

        predicted: take the geometric part of the tangent from `stresses`.
        """
        self.require(*(("tangent",) if matrix.size else ()))
        self.place(p, v, a, residual, matrix)
        self.table[record.TANGENT] = int(matrix.size > 0)
        self.table[record.PREDICTED] = int(predicted and matrix.size > 0)
        model_passes.balance(self.table)

    def predict(self, p: np.ndarray, step: np.ndarray) -> None:
        """Fill `stresses` with those after a linearised step (n,) from p (n,)."""
        self.require("prediction")
        self.table[record.COORDINATES_P], self.table[record.COORDINATES_V] = (
            _address(p, self.size),
            _address(step, self.size),
        )
        for work in self.works:
            model_passes.predict_resultants(work.table, self.table)

    def elastic(self, p: np.ndarray, v: np.ndarray, a: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return e, e'' and elastic forces (N, per_node) of the only group in a state p, p', p'' (n,)."""
        (work,), table, nothing = self.works, self.table, np.zeros(self.size)
        self.place(p, v, a, nothing, np.empty(0))
        self.weigh((1.0, 0.0, 0.0))
        table[[record.TANGENT, record.PREDICTED, record.LOADED]] = 0
        self.require()
        node_passes.place_nodes(work.table, table, 1)
        model_passes.clear_forces(work.table)
        element_passes.add_elements(work.table, table)
        size, force = 2 * int(work.table[record.VECTORS]), int(work.table[record.FORCE])
        return work.rows(0, size), work.rows(size, size), work.rows(force, size)

    def nodal_vectors(self, p: np.ndarray) -> list[np.ndarray]:
        """Return the vectors e (N, per_node) of the nodes of each group in a state (n,)."""
        self.require()
        self.table[record.COORDINATES_P] = _address(p, self.size)
        found = []
        for work in self.works:
            node_passes.place_nodes(work.table, self.table, 0)
            found.append(work.rows(0, 2 * int(work.table[record.VECTORS])))
        return found

    def smallest_jacobian(self, p: np.ndarray) -> float:
        """Return the smallest r0' x d of all quadrature points in a state (n,); negative inside out."""
        self.require()
        self.table[record.COORDINATES_P] = _address(p, self.size)
        smallest = 1.0
        for work in self.works:
            node_passes.place_nodes(work.table, self.table, 0)
            smallest = min(smallest, model_passes.smallest_jacobian(work.table))
        return smallest


def _address(values: np.ndarray, size: int | None = None) -> int:
    """Return the address of plain numbers (size,)."""
    if values.dtype != np.float64 or not values.flags.c_contiguous or (size is not None and values.size != size):
        raise ValueError(f"compiled code takes {size} contiguous floats, got {values.dtype} {values.shape}")
    return int(values.ctypes.data)
