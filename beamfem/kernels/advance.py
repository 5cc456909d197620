"""Time steps of the generalized-alpha method, many in one compiled call."""

import numpy as np
from numba import njit

from beamfem.kernels.assemble import assemble
from beamfem.kernels.band import factor, solve
from beamfem.kernels.loads import assemble_point_loads
from beamfem.kernels.springs import assemble_springs
from beamfem.kernels.turned import hold_normals, turn_back, turn_in


@njit(cache=True, error_model="numpy")
def advance(blocks, loads, springs, layout, free, held, turned, state, inputs, rule, limits, scale, saved, statistics):
    """March through the steps of `inputs`; return how many were completed.

    turned: numbers (nt,) and normals (nt, 2) of inclined rollers. state: p, p', p'', auxiliary acceleration (4, n),
    advanced in place. inputs: held values (steps, 3, nh), body (steps, beams, 4), point values a tuple of
    (steps, nl, 3). rule: step, alpha_m, alpha_f, gamma, beta. limits: tolerance of the correction relative to
    `scale` (n,), largest number of iterations.
    saved (steps, 3, n). statistics (4,): iterations, most iterations in a step, last correction, worst pivot ratio.
    Chung and Hulbert 1993; in the form of Arnold and Bruels 2007 the equations hold at the end of each step.
    """
    held_values, body, point_values = inputs
    h, alpha_m, alpha_f, gamma, beta = rule[0], rule[1], rule[2], rule[3], rule[4]
    steps, n, unknown = held_values.shape[0], state.shape[1], free.shape[0]
    width = 2 * layout.half_width + 1
    matrix = np.empty(unknown * width)
    residual, right = np.empty(n), np.empty(unknown)
    none = np.empty((0, 0, 0))
    to_velocity = gamma / (h * beta)
    to_acceleration = (1.0 - alpha_m) / (h * h * beta * (1.0 - alpha_f))
    coefficients = np.array([1.0, to_velocity, to_acceleration])
    before = state.copy()
    for step in range(steps):
        before[:] = state
        p, v, a, aux = state[0], state[1], state[2], state[3]
        for i in range(n):
            new = (before[2, i] - alpha_m * before[3, i]) / (1.0 - alpha_m)
            p[i] += h * before[1, i] + h * h * ((0.5 - beta) * before[3, i] + beta * new)
            v[i] += h * ((1.0 - gamma) * before[3, i] + gamma * new)
        for i in range(held.shape[0]):
            p[held[i]] = held_values[step, 0, i]
            v[held[i]] = held_values[step, 1, i]
            a[held[i]] = held_values[step, 2, i]
        done = False
        for iteration in range(int(limits[1])):
            residual[:] = 0.0
            matrix[:] = 0.0
            for i in range(len(blocks)):
                assemble(blocks[i], layout, p, v, a, body[step], coefficients, none, residual, matrix)
                if loads[i].element.shape[0] > 0:
                    values = point_values[i][step]
                    assemble_point_loads(blocks[i], loads[i], layout, p, values, 1.0, residual, matrix)
            assemble_springs(springs, p, 1.0, residual, matrix)
            for i in range(unknown):
                right[i] = -residual[free[i]]
            lu = matrix.reshape(unknown, width)
            hold_normals(lu, turned[0], turned[1])
            turn_in(right, turned[0], turned[1])
            statistics[3] = min(statistics[3], factor(lu))
            solve(lu, right)
            turn_back(right, turned[0], turned[1])
            largest = 0.0
            for i in range(unknown):
                dof = free[i]
                p[dof] += right[i]
                v[dof] += to_velocity * right[i]
                a[dof] += to_acceleration * right[i]
                size = abs(right[i]) / scale[dof]
                if not size <= largest:
                    largest = size
            statistics[0] += 1
            statistics[1] = max(statistics[1], iteration + 1)
            statistics[2] = largest
            if not np.isfinite(largest):
                break
            if largest <= limits[0]:
                done = True
                break
        if not done:
            state[:] = before
            return step
        for i in range(n):
            aux[i] = ((1.0 - alpha_f) * a[i] + alpha_f * before[2, i] - alpha_m * before[3, i]) / (1.0 - alpha_m)
        for i in range(held.shape[0]):
            aux[held[i]] = a[held[i]]
        saved[step, 0] = p
        saved[step, 1] = v
        saved[step, 2] = a
    return steps
