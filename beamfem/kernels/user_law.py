"""A user's section law, a C function that is called by its address at one point after the other."""

from beamfem.kernels.compiling import routine
from beamfem.kernels.model_record import ROW, Group, System
from beamfem.kernels.point import RESULTANT, STIFFNESS, STRAIN
from beamfem.kernels.pointers import at, room
from beamfem.kernels.records import Reals

MOST_HISTORY = 256  # history variables of a point
_THICKNESS = 9  # stiffness against thickness stretch, in an upper triangle of four measures


@routine()
def user_resultants(
    group: Group,
    system: System,
    first: int,
    number: int,
    count: int,
    tangent: int,
    weight: Reals,
    c: Reals,
    reference: Reals,
    x: Reals,
) -> None:
    """Do the same as `linear_law.four_resultants`; thickness stretch, which the law does not have, is linear."""
    strain, forces, slopes, past = room(3), room(3), room(9), room(MOST_HISTORY)
    s, stiffness, variables, p = at(x, RESULTANT * ROW), at(x, STIFFNESS * ROW), group.variables, system.p
    for i in range(count):
        w = weight[i]
        thickness = w * c[_THICKNESS * ROW + i] if group.thickens != 0 else 0.0
        s[i], s[ROW + i], s[2 * ROW + i] = 0.0, 0.0, 0.0
        s[3 * ROW + i] = thickness * (x[(STRAIN + 3) * ROW + i] - reference[3 * ROW + i])
        if tangent != 0:
            for k in range(_THICKNESS):
                stiffness[k * ROW + i] = 0.0
            stiffness[_THICKNESS * ROW + i] = thickness
        if number < group.law_acts:
            for k in range(3):
                strain[k] = x[(STRAIN + k) * ROW + i] - reference[k * ROW + i]
            for k in range(variables):
                past[k] = p[group.history[((first + i) * group.law_points + number) * variables + k]]
            if tangent != 0:
                group.user_law(strain, past, system.since_committed, group.law_data, forces, slopes)
                for row in range(3):
                    for column in range(row, 3):
                        to = at(stiffness, (4 * row - row * (row - 1) // 2 + column - row) * ROW)
                        to[i] = w * slopes[3 * row + column]
            else:
                group.user_law(strain, past, system.since_committed, group.law_data, forces, None)
            for k in range(3):
                s[k * ROW + i] = w * forces[k]
