"""Sections with laws of their own, as users write them: each a dataclass beside the package."""

from dataclasses import dataclass

import numpy as np

from beamfem.section.moments import StiffnessSection

_ITERATIONS = 60


@dataclass(frozen=True)
class LinearLaw(StiffnessSection):
    """The linear section in the words of a law, which must not change any result."""

    def resultants(self, strain, material):
        stretch, shear, curvature = strain.T
        return np.stack(
            [
                self.axial * stretch + self.coupling * curvature,
                self.shear * shear,
                self.bending * curvature + self.coupling * stretch,
            ],
            axis=-1,
        )

    def energy(self, strain, material):
        return 0.5 * (strain * self.resultants(strain, material)).sum(axis=-1)


@dataclass(frozen=True)
class RambergOsgood(StiffnessSection):
    """Bends by the curvature M / EI + knee / EI (M / knee)^exponent, an odd exponent; stretch and shear are linear."""

    knee: float = 1.0
    exponent: int = 5

    def curvature(self, moment):
        return (moment + self.knee * (moment / self.knee) ** self.exponent) / self.bending

    def moment(self, curvature):
        x = curvature * self.bending / self.knee
        n, m = self.exponent, np.sign(x.real) * np.minimum(np.abs(x.real), np.abs(x.real) ** (1 / self.exponent))
        for _ in range(_ITERATIONS):
            step = (m + m**n - x) / (1 + n * m ** (n - 1))
            m = m - step
            if np.max(np.abs(step), initial=0.0) <= 1e-15 * np.max(np.abs(m), initial=1e-300):
                break
        return self.knee * m

    def resultants(self, strain, material):
        stretch, shear, curvature = strain.T
        return np.stack([self.axial * stretch, self.shear * shear, self.moment(curvature)], axis=-1)

    def energy(self, strain, material):
        stretch, shear, curvature = strain.T
        moment, n = self.moment(curvature), self.exponent
        complementary = (moment**2 / 2 + self.knee**2 * (moment / self.knee) ** (n + 1) / (n + 1)) / self.bending
        return 0.5 * self.axial * stretch**2 + 0.5 * self.shear * shear**2 + moment * curvature - complementary


@dataclass(frozen=True)
class Softening(StiffnessSection):
    """N = limit tanh(E A stretch / limit): a bar that gives way in tension and compression."""

    limit: float = 1.0

    def resultants(self, strain, material):
        stretch, shear, curvature = strain.T
        normal = self.limit * np.tanh(self.axial * stretch / self.limit)
        return np.stack([normal, self.shear * shear, self.bending * curvature], axis=-1)

    def energy(self, strain, material):
        stretch, shear, curvature = strain.T
        normal = self.limit**2 / self.axial * np.log(np.cosh(self.axial * stretch / self.limit))
        return normal + 0.5 * self.shear * shear**2 + 0.5 * self.bending * curvature**2
