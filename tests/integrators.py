"""Integrators beside the package: one with stages, one with a force between two states."""

from dataclasses import dataclass, replace

import numpy as np

STEP = 1e-11  # of the model: a correction that ends an iteration


@dataclass(frozen=True)
class Radau:
    """Radau IIA with two stages, of third order, L-stable; Hairer and Wanner 1996, table IV.5.5.

    Unknowns are the accelerations of the stages: p_i = p + c_i h v + h^2 (A^2)_ij a_j, v_i = v + h A_ij a_j.
    """

    table: tuple[tuple[float, float], ...] = ((5.0 / 12.0, -1.0 / 12.0), (3.0 / 4.0, 1.0 / 4.0))

    def step(self, motion, begin, end):
        h, table, free = end - begin.at, np.array(self.table), motion.free
        of_p, of_v, at = h**2 * table @ table, h * table, begin.at + h * table.sum(axis=1)
        a = np.tile(begin.a, (2, 1))

        def stages():
            return begin.p + np.outer(at - begin.at, begin.v) + of_p @ a, begin.v + of_v @ a

        def linearise():
            states = [(*state, float(time)) for *state, time in zip(*stages(), a, at, strict=True)]
            left = np.array([motion.residual(*state) for state in states])
            weights = [[(of_p[i, j], of_v[i, j], float(i == j)) for j in (0, 1)] for i in (0, 1)]
            return left, [[motion.tangent(*states[i], weights[i][j]) for j in (0, 1)] for i in (0, 1)]

        def move(change):
            a[:, free] += change
            return of_p @ change

        motion.iterate(linearise, move, STEP)
        p, v = stages()
        return replace(begin, p=p[1], v=v[1], a=a[1], at=end)


@dataclass(frozen=True)
class EnergyMomentum:
    """The midpoint rule with a discrete gradient, which keeps the energy; Gonzalez 1996.

    For coordinates with a constant mass: M (v1 - v0) / h + f = 0, p1 - p0 = h (v0 + v1) / 2, where
    f = grad V(middle) + (V1 - V0 - grad V(middle) . d) d / (d . d), d = p1 - p0 in the scale of the coordinates.
    """

    iterations: int = 50

    def step(self, motion, begin, end):
        h, free, scale = end - begin.at, motion.free, motion.scale
        rest, middle_time = np.zeros_like(begin.p), 0.5 * (begin.at + end)
        mass = motion.tangent(begin.p, rest, rest, end, (0.0, 0.0, 1.0))
        before = motion.energy(begin.p, begin.at)
        p = begin.p + h * begin.v

        def linearise():
            moved = p - begin.p
            middle = 0.5 * (begin.p + p)
            gradient = motion.residual(middle, rest, rest, middle_time)
            d = moved[free] / scale**2
            missing = motion.energy(p, end) - before - float(gradient @ moved[free])
            between = gradient + missing * d / max(float(d @ moved[free]), 1e-300)
            left = mass @ (2.0 * moved / h - 2.0 * begin.v)[free] / h + between
            return left, [[motion.tangent(middle, rest, rest, middle_time, (0.5, 0.0, 2.0 / h**2))]]

        def move(change):
            p[free] += change[0]
            return change

        motion.iterate(linearise, move, STEP, self.iterations)
        v = 2.0 * (p - begin.p) / h - begin.v
        return replace(begin, p=p, v=v, a=2.0 * (v - begin.v) / h - begin.a, at=end)
