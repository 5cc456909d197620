"""The numerical data of a model: coordinates, blocks of elements, prescribed coordinates and loads at a time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum, auto
from typing import Any, TypeVar

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.equations import equation_numbering as layout
from beamfem.equations.applied_loads import Loads, pressures_have_potential
from beamfem.equations.assembler import Assembler, Equations
from beamfem.equations.blocks import build_block
from beamfem.equations.connectors import Connectors, connectors_of
from beamfem.equations.element_group import make_group
from beamfem.equations.equation_numbering import Unknowns
from beamfem.equations.history_variables import History
from beamfem.equations.model_coordinates import (
    PrescribedCoordinate,
    inclined_normals,
    prescribed_coordinates,
    stress_free,
)
from beamfem.equations.parts_at_points import Alike, PartsInPython, by_kind, springs_to_ground
from beamfem.equations.redundant_conditions import (
    Coordinates,
    dependent_on_others,
    gradients_of,
    in_words,
    unmet,
    with_least_norm,
)
from beamfem.equations.strain_rates import StrainRates, strain_rates
from beamfem.errors import InputError
from beamfem.kernels.block import Block, Layout, Stations
from beamfem.model.model import Model
from beamfem.model.time_functions import Interpolated, kinks_of
from beamfem.physics.stations import FOLLOWING
from beamfem.precision.roundoff_bounds import residual_errors, stress_errors
from beamfem.validation import shown

_Table = TypeVar("_Table", covariant=True)
_NO_MOVEMENT = 1e300  # scale of history variables: no change of them counts as movement


class Proven(Enum):
    """Properties of a system found by earlier solves."""

    LOSES_DIGITS = auto()  # the tangent, unless stress resultants are unknowns of their own
    KEEPS_DIGITS = auto()
    NOTHING_ACTS_AT_ZERO = auto()  # at load factor 0
    CONSTANT_LOADS = auto()  # they neither follow the beam nor impose strains


class shared_table(cached_property[_Table]):
    """A property of a system that does not depend on the size of loads, kept among its `tables`."""

    def __get__(self, instance: Any, owner: type[Any] | None = None) -> Any:
        if instance is None:
            return self
        name, tables = self.attrname, instance.tables
        if name not in tables:
            tables.setdefault(name, self.func(instance))
        value = instance.__dict__[name] = tables[name]
        return value


@dataclass(frozen=True, eq=False)
class System:
    """All data of a model that solvers need; `system_of` creates it once.

    Systems of models that differ only in the size of their loads have their tables in common, see `Model.with_loads`.
    released: whether the coordinates that supports move count as unknown; proven: properties found by earlier
    solves.
    """

    model: Model
    static: bool
    released: bool = False
    proven: set[Proven] = field(default_factory=set)

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle the model only."""
        return system_of, (self.model, self.static)

    @cached_property
    def tables(self) -> dict[Any, Any]:
        """The tables by name, in common with the systems of models that `with_loads` has made."""
        tables: dict[Any, Any] = self.model.tables.setdefault((self.static, self.released), {})
        return tables

    def table(self, build: Callable[["System"], _Table]) -> _Table:
        """Return build(system), kept among the tables; it must not depend on the size of loads."""
        if build not in self.tables:
            self.tables.setdefault(build, build(self))
        found: _Table = self.tables[build]
        return found

    def spare(self, kind: type) -> list[Any]:
        """Return the unused workspaces of a kind."""
        spare: list[Any] = self.tables.setdefault(kind, [])
        return spare

    @shared_table
    def reference(self) -> np.ndarray:
        """Coordinates of the stress-free state (n,)."""
        p = stress_free(self.model, self.blocks)
        p[self.history.numbers] = self.history.start
        return p

    @shared_table
    def blocks(self) -> tuple[Block, ...]:
        numbered = list(enumerate(self.model.meshes))
        return tuple(
            build_block(element, [(i, mesh) for i, mesh in numbered if mesh.block == number], self.model.imposing)
            for number, element in enumerate(self.model.groups)
        )

    @shared_table
    def damped(self) -> bool:
        """Whether beams resist rates other than by a section law with history."""
        return any(block.mass_damping or block.damping.any() for block in self.blocks)

    @shared_table
    def equations(self) -> Equations:
        """The equations in the form that compiled code expects."""
        return self.equations_of(self.blocks)

    @shared_table
    def without_stiffness(self) -> Equations:
        """The equations with zero section stiffness."""
        return self.equations_of([block.resisting(np.zeros_like(block.stiffness)) for block in self.blocks])

    @shared_table
    def strain_rates(self) -> tuple[StrainRates, ...]:
        """Strains of each block and their derivatives by the unknowns."""
        return tuple(strain_rates(block, self.unknowns.free) for block in self.blocks)

    def equations_of(self, blocks: Sequence[Block]) -> Equations:
        """Return the equations with other blocks in place of those of the system."""
        groups = [make_group(*parts) for parts in zip(blocks, self.layouts, self.stations, strict=True)]
        return Equations(groups, self.model.size, [each.record for each in self.parts], self.called)

    @shared_table
    def parts(self) -> tuple[Alike | PartsInPython, ...]:
        """The parts at points, by kind, as compiled code takes them."""
        springs = (self.springs,) if len(self.springs.numbers) else ()
        places = iter(self.unknowns.coupled)
        placed = [(item, [next(places) for _ in item.rows]) for item in self.connectors.items]
        return (*springs, *by_kind(placed, self.model.size))

    @property
    def called(self) -> tuple[PartsInPython, ...]:
        """Those of them that Python evaluates."""
        return tuple(each for each in self.parts if isinstance(each, PartsInPython))

    @cached_property
    def declared_jumps(self) -> np.ndarray:
        """Times (k,) [s], in order, of the kinks at which amplitudes of loads and functions of connectors may jump."""
        amplitudes = [load.amplitude for load in self.model.loads if not isinstance(load.amplitude, Interpolated)]
        functions = [*amplitudes, *(each.item for each in self.connectors.items)]
        return np.array(sorted({kink for each in functions for kink in kinks_of(each)}))

    @shared_table
    def kinked(self) -> tuple[Alike, ...]:
        """Parts whose forces have kinks, such as cables, stops and friction."""
        p, v = self.reference[None], np.zeros((1, self.model.size))
        places = ((each, each.numbers, each.history) for each in self.parts if isinstance(each, Alike))
        return tuple(
            each for each, at, kept in places if each.kinks(p[:, at], v[:, at], p[:, kept], v[:, kept] > 0.0).size
        )

    def assembler(self, shared: bool = False) -> Assembler:
        """Return the equations with a new workspace; shared: see `Assembler`."""
        return Assembler(self.equations, shared=shared)

    @shared_table
    def solver_fields(self) -> dict[str, Any]:
        """The fields of `kernels.model_record.Solver` for a band that are no workspace."""
        unknowns, (first, normals), half = self.unknowns, self.rotated, self.layouts[0].half_width
        return {
            "size": self.model.size,
            "unknown": len(unknowns.dofs),
            "free_dofs": np.ascontiguousarray(unknowns.dofs, dtype=np.int64),
            "first_free": unknowns.first,
            "half": half,
            "width": 2 * half + 1,
            "rollers": len(first),
            "roller_first": first,
            "roller_normal": normals,
            "scale": self.scale,
            "inverse_scale": 1.0 / self.scale,
            "reach": unknowns.reach,
        }

    @shared_table
    def residual_errors(self) -> np.ndarray:
        """Residual (2, n) per unit relative error: in positions of 1 m [1/m], and in directions."""
        vectors = [element.field.vectors for element in self.model.groups]
        errors = residual_errors(self.blocks, vectors, self.stations, self.model.size)
        np.add.at(errors[0], self.springs.numbers[:, 0], self.springs.data[:, 0])
        return errors + self.connectors.errors

    @shared_table
    def stress_errors(self) -> tuple[np.ndarray, ...]:
        """Stress resultants (2, nc, nq, ns) of each block per unit relative error, as `residual_errors`."""
        vectors = [element.field.vectors for element in self.model.groups]
        return tuple(stress_errors(*parts) for parts in zip(self.blocks, vectors, strict=True))

    @shared_table
    def positions(self) -> np.ndarray:
        """Mask (n,) of the coordinates that are positions [m]."""
        result = np.zeros(self.model.size, dtype=bool)
        for block in self.blocks:
            result[block.dof[:, :2]] = True
        return result

    @cached_property
    def loads(self) -> Loads:
        return Loads(self.model, self.static, self.tables)

    @shared_table
    def stations(self) -> tuple[Stations, ...]:
        """Stations of each block, in the order of `LoadsAt.points`."""
        return tuple(actions.stations for actions in self.loads.unloaded)

    @property
    def steady(self) -> bool:
        """Whether no function of time or of the load factor acts."""
        return self.loads.proportional and not self.moved

    @shared_table
    def springs(self) -> Alike:
        """Springs of single coordinates to the ground, unstressed in the reference."""
        return springs_to_ground(self.model, self.unknowns, self.reference)

    @shared_table
    def symmetric(self) -> bool:
        """Whether the tangent is symmetric: no load follows the sections, and all else has a potential."""
        following = any((stations.kind == FOLLOWING).any() for stations in self.stations)
        directed = [dof for dof, _ in self.inclined]
        fixed = {*self.prescribed_dofs.tolist(), *directed}
        return not following and self.connectors.conservative and pressures_have_potential(self.model, fixed)

    @shared_table
    def prescribed(self) -> tuple[PrescribedCoordinate, ...]:
        """Prescribed coordinates, ordered by number. Raises InputError if two supports prescribe the same one."""
        found = prescribed_coordinates(self.model)
        return tuple(item for item in found if not callable(item.value)) if self.released else found

    @cached_property
    def driven(self) -> tuple[PrescribedCoordinate, ...]:
        """The coordinates that supports move, if they count as unknown."""
        found = prescribed_coordinates(self.model) if self.released else ()
        return tuple(item for item in found if callable(item.value))

    @shared_table
    def prescribed_dofs(self) -> np.ndarray:
        return np.array([item.dof for item in self.prescribed], dtype=np.int64)

    def prescribed_values(self, time: float) -> np.ndarray:
        """Return the values of the prescribed coordinates at a time, in statics at a load factor."""
        start = self.reference[self.prescribed_dofs]
        return start + self.prescribed_changes(time) if self.moved else start

    def prescribed_changes(self, time: float) -> np.ndarray:
        """Return the changes (nh,) of the prescribed coordinates from the reference at a time or load factor."""
        return np.array([item.change(time, self.static) for item in self.prescribed], dtype=float)

    def prescribed_course(self, times: np.ndarray) -> np.ndarray:
        """Return the changes (n, nh) of the prescribed coordinates from the reference at times (n,) of a motion."""
        return np.column_stack([np.empty((len(times), 0)), *(item.course(times) for item in self.prescribed)])

    @shared_table
    def moved(self) -> bool:
        """Whether a prescribed value may differ from the reference."""
        return any(callable(item.value) or item.value != 0.0 for item in self.prescribed)

    def largest_turn(self, before: float, after: float) -> float:
        """Return the largest change [rad] of a prescribed rotation between two times.

        Gradients elsewhere on the beam cannot distinguish a full turn from none, so a large change needs several steps.
        """
        static = self.static
        return max((abs(dof.change(after, static) - dof.change(before, static)) for dof in self._rotated), default=0.0)

    @shared_table
    def _rotated(self) -> tuple[PrescribedCoordinate, ...]:
        """Prescribed rotations that may differ from the reference."""
        return tuple(item for item in self.prescribed if item.rotation and (callable(item.value) or item.value != 0.0))

    @shared_table
    def unknowns(self) -> Unknowns:
        """The order of the coordinates that are not prescribed."""
        connectors, joined = self.connectors, bool(self.model.shared_joints)
        coupled = [numbers for item in connectors.items for numbers in item.coupled]
        multipliers = connectors.multipliers.tolist()
        border: int | None = layout.WIDEST_BORDER
        if self.inclined:
            border = 0 if self.static else None
        known = np.concatenate((self.prescribed_dofs, self.history.numbers, connectors.left_out))
        constrained = [*self.prescribed_dofs.tolist(), *(dof for dof, _ in self.inclined)] if self.static else []
        couplings = layout.Couplings(coupled, multipliers, border, connectors.bodies)
        order = self.blocks, self.model.size, known, joined, couplings
        return layout.order_unknowns(*order, np.array(constrained, dtype=np.int64))

    @cached_property
    def connectors(self) -> Connectors:
        """User-defined contributions of the model. Raises InputError for a force that is not analytic."""
        found = connectors_of(self.model, self.static)
        return found if self.model.redundant_conditions == "error" else replace(found, left_out=self._left_out)

    @shared_table
    def _left_out(self) -> np.ndarray:
        """Multipliers of conditions that depend on others in the reference."""
        found, start = connectors_of(self.model, self.static), stress_free(self.model, self.blocks)
        start[found.memory] = found.start
        return dependent_on_others(gradients_of(found, start, self.held))[0]

    @shared_table
    def held(self) -> Coordinates:
        """Natural units of the coordinates, and what supports hold."""
        return Coordinates(np.where(self.positions, self.extent, 1.0), self.prescribed_dofs, self.inclined)

    def forget_digits(self) -> None:
        """Forget what earlier solves have found of lost digits, on which further ones must not depend."""
        self.proven.difference_update((Proven.LOSES_DIGITS, Proven.KEEPS_DIGITS))

    def finished(self, states: np.ndarray, times: Sequence[float]) -> np.ndarray:
        """Return states p (m, n) with multipliers of least norm where conditions are redundant.

        Raises InputError if one of these is not met at one of the times or load factors.
        """
        if not len(self.connectors.left_out):
            return states
        for p, time in zip(states, times, strict=True):
            if parts := unmet(self.connectors, p, time, self.extent):
                raise InputError(
                    f"conditions of connectors ({in_words(parts)}) are redundant in the reference, but not at "
                    f"{'load factor' if self.static else 'time'} {time:g}, where they are not met: draw the model in a "
                    "state in which they are independent"
                )
        found = [with_least_norm(self.connectors, p, self.held, self.extent) for p in states]
        return np.array(found).reshape(states.shape)

    @cached_property
    def history(self) -> History:
        """History variables of connectors and section laws."""
        return History(self.connectors, self.blocks, self.loads)

    @property
    def layouts(self) -> tuple[Layout, ...]:
        """Positions of the element matrices of each block in the matrix."""
        return self.unknowns.layouts

    @shared_table
    def inclined(self) -> tuple[tuple[int, np.ndarray], ...]:
        """First coordinate of r and unit normal of each roller whose normal is not along x or y."""
        return inclined_normals(self.model, set(self.prescribed_dofs.tolist()))

    @shared_table
    def rotated(self) -> tuple[np.ndarray, np.ndarray]:
        """Equation number of x (nt,) and unit normal (nt, 2) of each inclined roller."""
        first = np.array([self.unknowns.free[dof] for dof, _ in self.inclined], dtype=np.int64)
        return first, np.array([normal for _, normal in self.inclined], dtype=float).reshape(-1, 2)

    def along_free(self, residual: np.ndarray) -> np.ndarray:
        """Return the residual of the unknowns without the reactions of inclined rollers."""
        result = residual[self.unknowns.chosen].copy()
        for first, normal in zip(*self.rotated, strict=True):
            result[first : first + 2] -= normal * (normal @ result[first : first + 2])
        return result

    @property
    def free_dofs(self) -> np.ndarray:
        """The unknown coordinates (unknown,) in the order of the equations."""
        return self.unknowns.dofs

    @shared_table
    def extent(self) -> float:
        """Size of the model [m]: its longest beam, or twice the largest distance of a node from their mean."""
        position = np.concatenate([mesh.position for mesh in self.model.meshes])
        x, y = (position - position.sum(axis=0) / len(position)).T
        reach = float(np.hypot(x, y).max())
        return max(2.0 * reach, *(beam.curve.length for beam in self.model.beams))

    @shared_table
    def scale(self) -> np.ndarray:
        """Scale (n,) of the change of each coordinate: the size of the model for positions [m], 1 for the rest.

        Multipliers [N] are scaled by a force that strains an element by one, so that path lengths measure movement.
        """
        result, multipliers = self.held.scale.copy(), self.connectors.multipliers
        if len(multipliers):
            result[multipliers] = self.extent * self.residual_errors[0].max()
        result[self.history.numbers] = _NO_MOVEMENT
        return result

    @shared_table
    def strain_scale(self) -> np.ndarray:
        """Change of a coordinate that strains an element by about one (n,): its length for positions [m], else 1."""
        length = min(float(block.weight.sum(axis=1).min()) for block in self.blocks)
        return np.where(self.positions, length, 1.0)


def system_of(model: Model, static: bool) -> System:
    """Return the system of a model, which is created once since models do not change. Raises InputError."""
    if not isinstance(model, Model):
        raise InputError(f"a Model is asked for, such as Model([beam], supports=[...]), got {shown(model)}")
    systems: dict[bool, System] = model.__dict__.setdefault("_systems", {})
    if static not in systems:
        systems[static] = System(model, static)
    return systems[static]
