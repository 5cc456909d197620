"""A model in numbers: coordinates, blocks of elements, held coordinates and loads at a time."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamfem.errors import InputError
from beamfem.kernels.block import Block, Layout, PointLoads
from beamfem.model.blocks import build_block, locate_loads
from beamfem.model.loads import factor
from beamfem.model.model import Model
from beamfem.model.supports import Roller, Support, Value
from beamfem.validation import function_value


@dataclass(frozen=True)
class Held:
    """A coordinate that a support prescribes: value = start + factor(time)."""

    dof: int
    value: Value
    # derivatives of (r_y)^x or (r_y)^y with a rotation where the coordinates are gradients
    turned: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class System:
    """Everything a solver needs of a model; made once a solve."""

    model: Model
    static: bool

    @cached_property
    def reference(self) -> np.ndarray:
        """Coordinates of the stress-free state (n,)."""
        p = np.zeros(self.model.size)
        for mesh in self.model.meshes:
            arc = mesh.node_arc_lengths()
            position, tangent = mesh.beam.curve.position(arc), mesh.beam.curve.tangent(arc)
            normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
            values = {"r": position, "r_x": tangent, "r_y": normal}
            labels = mesh.beam.element.coordinates.labels(mesh.beam.element.field.vectors)
            table = p[mesh.first_dof : mesh.first_dof + mesh.size].reshape(mesh.nodes, -1)
            for column, label in enumerate(labels):
                if label != "theta":
                    name, axis = label.split("^")
                    table[:, column] = values[name][:, "xy".index(axis)]
        return p

    @cached_property
    def blocks(self) -> tuple[Block, ...]:
        numbered = list(enumerate(self.model.meshes))
        return tuple(
            build_block(element, [(i, mesh) for i, mesh in numbered if mesh.block == number])
            for number, element in enumerate(self.model.groups)
        )

    @cached_property
    def point_loads(self) -> tuple[PointLoads, ...]:
        """Point loads of each block, in the order of `point_values`."""
        result = []
        for number, (block, element) in enumerate(zip(self.blocks, self.model.groups, strict=True)):
            points = [load.point for load in self._loads_of(number)]
            result.append(locate_loads(block, element, [self.model.mesh_of(point) for point in points], points))
        return tuple(result)

    def _loads_of(self, block: int) -> list:
        return [load for load in self.model.point_loads if self.model.mesh_of(load.point).block == block]

    def point_values(self, time: float) -> tuple[np.ndarray, ...]:
        """Forces and moments (nl, 3) [N, N, N m] of each block at a time."""
        return tuple(
            np.array(
                [np.array(load.value) * factor(load, time, self.static) for load in self._loads_of(number)]
            ).reshape(-1, 3)
            for number in range(len(self.blocks))
        )

    def body(self, time: float) -> np.ndarray:
        """Acceleration [m/s^2] and load per length [N/m] of each beam (beams, 4) at a time."""
        result = np.zeros((len(self.model.beams), 4))
        for load in self.model.gravity:
            result[:, :2] += np.array(load.vector) * factor(load, time, self.static)
        for spread in self.model.distributed:
            row = next(i for i, beam in enumerate(self.model.beams) if beam is spread.beam)
            result[row, 2:] += np.array(spread.vector) * factor(spread, time, self.static)
        return result

    @cached_property
    def held(self) -> tuple[Held, ...]:
        """Held coordinates, ordered by number. Raises InputError where two supports hold the same one."""
        held: dict[int, Held] = {}
        for support in self.model.supports:
            mesh = self.model.mesh_of(support.point)
            node = mesh.node_at(support.point.fraction)
            dofs = mesh.dofs_of_node(node)
            labels = mesh.beam.element.coordinates.labels(mesh.beam.element.field.vectors)
            for direction, value in support.held().items():
                new = _held_coordinates(support, direction, value, dict(zip(labels, dofs, strict=True)), self.reference)
                for item in new:
                    if item.dof in held:
                        name = type(support).__name__
                        raise InputError(f"{name} at {support.point}: another support already holds {direction} there")
                    held[item.dof] = item
        return tuple(held[dof] for dof in sorted(held))

    @cached_property
    def held_dofs(self) -> np.ndarray:
        return np.array([item.dof for item in self.held], dtype=np.int64)

    def held_values(self, time: float) -> np.ndarray:
        """Values of the held coordinates at a time, in statics at a load factor."""
        return np.array([self._held_value(item, time) for item in self.held], dtype=float)

    def _given(self, item: Held, time: float) -> float:
        if callable(item.value):
            return function_value("prescribed value", item.value, time)
        return item.value * (time if self.static else 1.0)

    def _held_value(self, item: Held, time: float) -> float:
        value = self._given(item, time)
        if item.turned is None:
            return self.reference[item.dof] + value
        return float(np.cos(value) * item.turned[0] + np.sin(value) * item.turned[1])

    def largest_turn(self, before: float, after: float) -> float:
        """Return the largest change [rad] of a rotation that is prescribed through gradients, between two times.

        Their held values are a cosine and a sine, which cannot tell a full turn from none.
        """
        turned = [item for item in self.held if item.turned is not None]
        return max((abs(self._given(item, after) - self._given(item, before)) for item in turned), default=0.0)

    @cached_property
    def layout(self) -> Layout:
        """Numbers of the unknown coordinates and the half width of their band."""
        free = np.full(self.model.size, -1, dtype=np.int64)
        mask = np.ones(self.model.size, dtype=bool)
        mask[self.held_dofs] = False
        free[mask] = np.arange(mask.sum())
        widest = max(block.dof.shape[1] - 1 for block in self.blocks)
        return Layout(free, widest, np.empty((0, 0, 0), dtype=np.int64))

    @cached_property
    def inclined(self) -> tuple[tuple[int, np.ndarray], ...]:
        """First coordinate of r and unit normal of each roller that neither x nor y describes."""
        found = []
        for support in self.model.supports:
            if isinstance(support, Roller) and _axis_of(support) is None:
                mesh = self.model.mesh_of(support.point)
                found.append((int(mesh.dofs_of_node(mesh.node_at(support.point.fraction))[0]), support.direction))
        if len({dof for dof, _ in found}) < len(found):
            raise InputError("two inclined Rollers stand at the same point; a Pin holds both directions")
        for dof, _ in found:
            if self.layout.free[dof] < 0 or self.layout.free[dof + 1] < 0:
                raise InputError("an inclined Roller stands where another support already holds a displacement")
        return tuple(found)

    @cached_property
    def turned(self) -> tuple[np.ndarray, np.ndarray]:
        """Numbers among the unknown (nt,) and unit normals (nt, 2) of inclined rollers."""
        first = np.array([self.layout.free[dof] for dof, _ in self.inclined], dtype=np.int64)
        return first, np.array([normal for _, normal in self.inclined], dtype=float).reshape(-1, 2)

    def along_free(self, residual: np.ndarray) -> np.ndarray:
        """Return the residual of the unknown directions: reactions of inclined rollers are taken out."""
        result = residual[self.free_dofs]
        for first, normal in zip(*self.turned, strict=True):
            result[first : first + 2] -= normal * (normal @ result[first : first + 2])
        return result

    @cached_property
    def free_dofs(self) -> np.ndarray:
        return np.flatnonzero(self.layout.free >= 0)


def _held_coordinates(
    support: Support, direction: str, value: Value, dofs: dict[str, int], reference: np.ndarray
) -> list[Held]:
    """The coordinates that hold one direction of a support."""
    if direction in ("ux", "uy"):
        return [Held(dofs[f"r^{direction[1]}"], value)]
    if direction == "rotation":
        if "theta" in dofs:
            return [Held(dofs["theta"], value)]
        x, y = reference[dofs["r_y^x"]], reference[dofs["r_y^y"]]
        return [Held(dofs["r_y^x"], value, (x, -y)), Held(dofs["r_y^y"], value, (y, x))]
    assert isinstance(support, Roller)
    along = _axis_of(support)
    return [] if along is None else [Held(dofs[f"r^{along}"], 0.0)]


def _axis_of(support: Roller) -> str | None:
    """Name the axis that the normal of a roller is along, if any."""
    nx, ny = np.abs(support.direction)
    if ny < 1e-12:
        return "x"
    return "y" if nx < 1e-12 else None
