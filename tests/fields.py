"""Fields as users write them beside the package, and what is wrong with others."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Equidistant:
    """Polynomials of one order in r and in r_y through equidistant nodes."""

    order: int = 2
    vectors = ("r", "r_y")

    @property
    def name(self):
        return f"equidistant{self.order}"

    @property
    def degree(self):
        return self.order

    @property
    def director_degree(self):
        return self.order

    @property
    def nodes(self):
        return np.linspace(0.0, 1.0, self.order + 1)

    def centreline(self, xi, derivative=0):
        columns = []
        for own in self.nodes:
            others = self.nodes[self.nodes != own]
            shape = np.poly1d(others, r=True) / np.prod(own - others)
            columns.append(np.polyval(shape.deriv(derivative), xi) * np.ones_like(xi))
        return np.stack(columns, axis=-1)

    def director(self, xi, derivative=0):
        return self.centreline(xi, derivative)

    def director_rule(self):
        points, weights = np.polynomial.legendre.leggauss(self.order + 1)
        return self.nodes, 0.5 * weights @ self.director(0.5 + 0.5 * points)


@dataclass(frozen=True)
class Quintic:
    """Hermite polynomials in r and r_x at three nodes, quadratic in r_y."""

    name = "quintic"
    vectors = ("r", "r_x", "r_y")
    degree, director_degree = 5, 2

    @property
    def nodes(self):
        return np.array([0.0, 0.5, 1.0])

    def centreline(self, xi, derivative=0):
        powers = np.arange(6)
        values = self.nodes[:, None] ** powers
        slopes = powers * self.nodes[:, None] ** np.maximum(powers - 1, 0)
        shapes = np.linalg.inv(np.stack([values, slopes], axis=1).reshape(6, 6))
        return np.stack([np.polyval(np.poly1d(column[::-1]).deriv(derivative), xi) for column in shapes.T], axis=-1)

    def director(self, xi, derivative=0):
        return Equidistant(2).centreline(xi, derivative)

    def director_rule(self):
        return Equidistant(2).director_rule()


class Scaled(Equidistant):
    def centreline(self, xi, derivative=0):
        return 1.01 * super().centreline(xi, derivative)


class DirectorScaled(Equidistant):
    def director(self, xi, derivative=0):
        return 1.01 * self.centreline(xi, derivative)


class Inside(Equidistant):
    nodes = np.linspace(0.1, 0.9, 3)


class Downward(Equidistant):
    nodes = np.linspace(1.0, 0.0, 3)


class DirectorFirst(Equidistant):
    vectors = ("r_y", "r")


class Bumps(Equidistant):
    """Right at the nodes, but not between."""

    def centreline(self, xi, derivative=0):
        found = super().centreline(xi, derivative)
        phase = 2.0 * np.pi * xi + 0.5 * np.pi * derivative
        found[:, 0] += 0.01 * (2.0 * np.pi) ** derivative * np.sin(phase)
        return found


class Bent(Bumps):
    """A rigid translation is represented, but no constant stretch."""

    def centreline(self, xi, derivative=0):
        found = super().centreline(xi, derivative)
        found[:, 1] -= found[:, 0] - Equidistant.centreline(self, xi, derivative)[:, 0]
        return found


class SlopeOfAnother(Equidistant):
    def centreline(self, xi, derivative=0):
        return (1.0 + 0.1 * (derivative == 1)) * super().centreline(xi, derivative)


class FlatCurvature(Equidistant):
    def centreline(self, xi, derivative=0):
        return super().centreline(xi, derivative) * (derivative < 2)


class SlopesPerNothing(Quintic):
    def centreline(self, xi, derivative=0):
        return super().centreline(xi, derivative) * np.tile([1.0, 2.0], 3)


class OneColumnLess(Equidistant):
    def centreline(self, xi, derivative=0):
        return super().centreline(xi, derivative)[:, 1:]


class HeavyRule(Equidistant):
    def director_rule(self):
        return self.nodes, np.ones(3)


class RuleElsewhere(Equidistant):
    def director_rule(self):
        return np.array([0.1, 0.5, 0.9]), np.ones(3) / 3


class Raising(Equidistant):
    def director(self, xi, derivative=0):
        raise KeyError("no such table")


class Fractional(Equidistant):
    degree = 1.5
