"""Time steps of models whose tangent is a narrow band: many in one compiled call."""

import numpy as np

from beamfem.assembly.arena import Arena
from beamfem.assembly.system import System
from beamfem.kernels import record
from beamfem.kernels.march import march
from beamfem.kernels.pointers import address_of

Saving = tuple[np.ndarray, int, int, np.ndarray, np.ndarray, np.ndarray]


class BandMotion:
    """Marches through time steps; keeps tangent and differences of the acceleration from one call to the next.

    rule: step, alpha_m, alpha_f, gamma, beta; limits: tolerance of the correction relative to the scale of a
    coordinate, largest number of iterations; statistics (8,): see `kernels.march.march`.
    """

    def __init__(self, system: System, rule: np.ndarray, limits: np.ndarray, statistics: np.ndarray) -> None:
        self._system = system
        size, unknown, half = system.model.size, len(system.free_dofs), system.layouts[0].half_width
        h, alpha_m, alpha_f, gamma, beta = rule
        self._assembler = system.assembler()
        self._assembler.weigh((1.0, gamma / (h * beta), (1.0 - alpha_m) / (h * h * beta * (1.0 - alpha_f))))
        self._assembler.require("tangent")
        nodes = sum(len(block.dof) for block in system.blocks)
        room = Arena(
            {
                "residual": (size,),
                record.ROWS: (unknown, 2 * half + 1),
                record.RIGHT: (unknown,),
                record.STEP: (max(size, unknown) + 1,),
                record.BEFORE: (4, size),
                record.DIFFERENCES: (3, size),
                record.INVERSE_SCALE: (size,),
                record.KEPT: (nodes, 2),
                record.TURNS: (nodes, 2),
            }
        )
        for name in (record.ROWS, record.DIFFERENCES, record.INVERSE_SCALE, record.KEPT, record.TURNS):
            room.arrays[name][:] = 0.0
        room.arrays[record.INVERSE_SCALE][system.free_dofs] = 1.0 / system.scale[system.free_dofs]
        self._room, self._kept = room, (rule, limits, statistics, system.turning, system.prescribed_dofs)
        places = {name: place for name, place in room.addresses.items() if name != "residual"}
        fields = record.RULE, record.LIMITS, record.STATISTICS, record.PAIR_TABLE, record.PRESCRIBED_DOFS
        places |= {field: address_of(array) for field, array in zip(fields, self._kept, strict=True)}
        self._solver = system.solver_table.filled(places)
        self._solver[[record.PAIRS, record.PRESCRIBED]] = len(system.turning), len(system.prescribed_dofs)

    def advance(self, state: np.ndarray, held: np.ndarray, times: np.ndarray, saving: Saving) -> int:
        """March p, p', p'' and the auxiliary acceleration (4, n) in place; return how many steps were completed.

        held (steps, 3, nh): values of the held coordinates and their rates at the times (steps,) [s]; saving: rows
        (steps, 3, n), number of the first step, and how many steps make a row; then x and y (m, 2) of vectors whose
        turning is counted, how far they have turned (m,) [rad] and that of the rows (steps, m).
        """
        saved, first, every, counted, turned_by, saved_turns = saving
        body, values, imposing = _sample_loads(self._system, times)
        assembler, solver, varying = self._assembler, self._solver, len(body) > 1
        places = assembler.load(body, values)
        natural = np.array(assembler.impose(imposing), dtype=np.int64)
        given = np.array(places[1:], dtype=np.int64)
        n, place, room = state.shape[1], address_of(state), self._room
        states = place, place + 8 * n, place + 16 * n
        rows = room.arrays[record.ROWS]
        assembler.place_at(states, room.addresses["residual"], room.addresses[record.ROWS], rows.size)
        solver[[record.STATE, record.BODIES, record.LOAD_VALUES]] = place, places[0], address_of(given)
        for field, array in (
            (record.PRESCRIBED_VALUES, held),
            (record.SAVED, saved),
            (record.TURN_TABLE, counted),
            (record.TURNED_BY, turned_by),
            (record.SAVED_TURNS, saved_turns),
        ):
            if not array.flags.c_contiguous:
                raise ValueError("compiled code takes contiguous arrays")
            solver[field] = address_of(array)
        solver[[record.STEPS, record.FIRST_STEP, record.EVERY]] = len(held), first, every
        solver[[record.TURN_COUNT, record.LOADS_VARY]] = len(counted), int(varying)
        solver[[record.NATURALS, record.NATURALS_VARY]] = address_of(natural), int(varying)
        solver[record.BODY_STRIDE] = body[0].size if varying else 0
        done = int(march(assembler.address, solver, self._system.solver_table.routines(moving=True)))
        assembler.raise_errors()
        return done


def _sample_loads(system: System, times: np.ndarray) -> tuple[np.ndarray, tuple[np.ndarray, ...], np.ndarray]:
    """Body forces (steps, beams, 4), point values of each block (steps, nl, 3), factors (steps, k) of imposed strains.

    One row where nothing varies.
    """
    if not system.varying:
        times = times[:1]
    loads = [system.loads_at(now) for now in times]
    points = tuple(np.array([own.points[i] for own in loads]) for i in range(len(system.blocks)))
    return np.array([own.body for own in loads]), points, np.array([own.imposing for own in loads])
