"""The arrays that the compiled iteration of a band works on, kept for the next solve of the same model."""

from beamfem.assembly import scratch
from beamfem.assembly.arena import Arena
from beamfem.assembly.equations import STATICS
from beamfem.assembly.system import System
from beamfem.kernels import record
from beamfem.kernels.pointers import address_of

_KEPT = 100_000  # entries of a tangent up to which making arrays takes a part of a solve that anybody would notice


class BandSpace:
    """Space for one static solve of a model whose tangent is a band, and the tables that tell compiled code of it.

    addresses: of the equations, the unknowns and the routines, which compiled drivers take.
    """

    def __init__(self, system: System) -> None:
        n, unknown, half = system.model.size, len(system.free_dofs), system.layouts[0].half_width
        self.assembler = system.assembler(lent=True)
        self.assembler.weigh(STATICS)
        self.assembler.require("tangent", "prediction")
        self._room = Arena(
            {
                "p": (n,),
                "residual": (n,),
                record.STEP: (n,),
                record.PRESCRIBED_STEP: (n,),
                record.PRESCRIBED_FORCE: (n,),
                record.RIGHT: (unknown,),
                record.ROWS: (unknown, 2 * half + 1),
                record.LIMITS: (7,),
                record.FOUND: (9,),
                record.LINEAR: (n,),
            }
        )
        arrays, place = self._room.arrays, self._room.addresses
        self.p, self.residual, self.step, self.limits = (
            arrays[name] for name in ("p", "residual", record.STEP, record.LIMITS)
        )
        self.found, self.linear = arrays[record.FOUND], arrays[record.LINEAR]
        self.prescribed_step, self.prescribed_force = arrays[record.PRESCRIBED_STEP], arrays[record.PRESCRIBED_FORCE]
        states = place.pop("p"), place[record.STEP], place[record.STEP]
        self.assembler.place_at(states, place.pop("residual"), place[record.ROWS], arrays[record.ROWS].size)
        tables = system.solver_table.filled(place), system.solver_table.routines(moving=False)
        self._tables, self.addresses = tables, (self.assembler.address, *map(address_of, tables))
        self._entries = arrays[record.ROWS].size

    def give_back(self, system: System) -> None:
        """Leave it for the next solve, if it is small."""
        scratch.take_back(self._scratch)
        if self._entries <= _KEPT:
            system.spare.append(self)

    def take(self, lent: scratch.Scratch) -> None:
        """Take memory to work in until it is given back."""
        self._scratch = lent
        self.assembler.work_in(lent)


def band_space(system: System) -> BandSpace:
    """Return space that no other solve works in."""
    try:
        found: BandSpace = system.spare.pop()
    except IndexError:
        found = BandSpace(system)
    found.take(scratch.lend(found.assembler.scratch))
    return found
