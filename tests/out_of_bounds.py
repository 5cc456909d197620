"""Kernels that leave their arrays, and a whole solve; run with BEAMFEM_CHECK=1, prints how each call ends."""

import json
import math
from typing import Annotated

import numpy as np

import beamfem as bf
from beamfem.kernels.compiler.bounds_checks import CheckError
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.pointers import at, room, wholes
from beamfem.kernels.records import Reals, Record, Several, Wholes, address_of, calls
from beamfem.kernels.simd import as_rows


@routine("nr")
def write(place, values):
    values[place[0]] = 1.0


@routine("nr")
def write_after_a_step(place, values):
    later = at(values, 4)
    later[place[0]] += 1.0


@inlined
def set_entry(entries, index):
    entries[index] = 1.0


@routine("nr")
def write_inlined(place, values):
    set_entry(values, place[0])


@routine("nr", "d")
def read_lanes(place, values):
    lanes = as_rows(values)
    lanes[place[0]] = lanes[place[0]] + 1.0
    return 5.0


@routine("nr", "d")
def read_stack(place, values):
    own = room(3)
    for i in range(3):
        own[i] = 7.0
    return own[place[0]]


@routine("nr")
def read_address(place, values):
    short = wholes(place[1])
    values[0] = short[place[0]]


class Callee(Record):
    write = calls(write)


@routine()
def call_and_go_on(callee: Callee, place: Wholes, values: Reals) -> None:
    own = room(2)
    callee.write(place, own)
    values[1] = 3.0


class Drawer(Record):
    number: int
    own: Reals


class Shelf(Record):
    drawers: Annotated[Several, Drawer]


@routine()
def read_drawer(shelf: Shelf, place: Wholes, values: Reals) -> None:
    drawer = shelf.drawers[place[0]]
    numbers = drawer.own
    values[0] = numbers[place[1]]


@routine("nr")
def divide(place, values):
    values[0] = 7 // place[0]


@routine("dr")
def whole(x, values):
    values[0] = int(x)


def ended(kernel, *arguments):
    """Return the result of a kernel, or the error that has ended it, and the array afterwards."""
    memory = np.zeros(40)
    values = memory[8:18].copy()
    try:
        result = kernel(*arguments, values)
    except CheckError as error:
        result = str(error)
    return [result, values.tolist()]


def solved():
    """Return the displacement of the end of a cantilever under a static load, and in motion."""
    steel = bf.Material(2e11, 0.3, 7800.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.CRBF(order=2), bf.Rectangle(0.01, 0.01), steel)
    model = bf.Model([beam], supports=[bf.Clamp(beam.start)], loads=[bf.PointForce(beam.end, (0.0, -20.0))])
    return bf.solve_static(model).displacement(beam.end)[-1].tolist()


def main():
    """Print the ends of all calls as JSON."""
    table = np.arange(4, dtype=np.int64)
    odd = np.zeros(81, dtype=np.uint8)[1:].view(np.float64)
    ends = {f"write {i}": ended(write, np.array([i])) for i in (0, 9, 10, -1, 2**61)}
    ends |= {f"step {i}": ended(write_after_a_step, np.array([i])) for i in (-4, 5, -5, 6)}
    ends |= {f"inlined {i}": ended(write_inlined, np.array([i])) for i in (9, 12)}
    ends |= {f"lanes {i}": ended(read_lanes, np.array([i])) for i in (2, 3)}
    ends |= {f"stack {i}": ended(read_stack, np.array([i])) for i in (2, 3)}
    ends |= {f"address {i}": ended(read_address, np.array([i, address_of(table)])) for i in (3, 4)}
    ends["null"] = ended(read_address, np.array([0, 0]))
    ends |= {f"call {i}": ended(call_and_go_on, Callee(write=write), np.array([i])) for i in (1, 2)}
    stored = np.arange(3.0)
    drawers = np.array([[0, 0], [0, address_of(stored)]])
    shelf = Shelf(drawers=drawers)
    ends |= {f"drawer {i} {j}": ended(read_drawer, shelf, np.array([i, j])) for i, j in ((1, 2), (1, 3), (2, 0))}
    ends |= {f"divide {i}": ended(divide, np.array([i])) for i in (2, 0)}
    ends |= {f"whole {x}": ended(whole, x) for x in (2.5, math.nan, 1e19)}
    try:
        ends["odd"] = [write(np.array([0]), odd), []]
    except CheckError as error:
        ends["odd"] = [str(error), []]
    ends["solved"] = [None, solved()]
    print(json.dumps(ends))


if __name__ == "__main__":
    main()
