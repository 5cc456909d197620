"""Section laws with history, as users write them: each a dataclass beside the package."""

from dataclasses import dataclass

import numpy as np

import beamfem as bf
from beamfem.section.moments import StiffnessSection


@dataclass(frozen=True)
class Plastic(StiffnessSection):
    """Bends elastically up to a moment [N m], then with linear kinematic hardening [N m^2] of the plastic curvature.

    Return mapping (Simo and Hughes 1998, 1.4.3). History: plastic curvature [1/m], dissipated energy per length [J/m].
    """

    limit: float = 1.0
    hardening: float = 0.0
    memory = (0.0, 0.0)
    beyond = 1.0 + 1e-9  # of the limit: where a step has just yielded, the section is elastic

    def _flow(self, strain, history):
        """Return how the plastic curvature changes."""
        over = self.bending * (strain[:, 2] - history[:, 0]) - self.hardening * history[:, 0]
        sign = np.sign(over.real)
        yields = sign * over.real > self.limit * self.beyond
        return np.where(yields, (over - sign * self.limit) / (self.bending + self.hardening), 0.0)

    def resultants(self, strain, material, history, dt):
        moment = self.bending * (strain[:, 2] - history[:, 0] - self._flow(strain, history))
        return np.stack([self.axial * strain[:, 0], self.shear * strain[:, 1], moment], axis=-1)

    def remember(self, strain, material, history, dt):
        flow = self._flow(strain, history)
        return history + np.stack([flow, self.limit * np.abs(flow)], axis=-1)

    def energy(self, strain, material, history):
        elastic = strain - history[:, :1] * np.array([0.0, 0.0, 1.0])
        stored = elastic**2 @ np.array([self.axial, self.shear, self.bending]) + self.hardening * history[:, 0] ** 2
        return np.stack([0.5 * stored, history[:, 1]], axis=-1)


@dataclass(frozen=True)
class Creeping(StiffnessSection):
    """Maxwell's section: all strains creep with a relaxation time [s], by the backward Euler method.

    History: the three creep strains, dissipated energy per length [J/m].
    """

    relaxation: float = 1.0
    memory = (0.0, 0.0, 0.0, 0.0)

    @property
    def moduli(self):
        return np.array([self.axial, self.shear, self.bending])

    def _crept(self, strain, history, dt):
        return (self.relaxation * history[:, :3] + dt * strain) / (self.relaxation + dt)

    def resultants(self, strain, material, history, dt):
        return self.moduli * (strain - self._crept(strain, history, dt))

    def remember(self, strain, material, history, dt):
        crept = self._crept(strain, history, dt)
        lost = ((crept - history[:, :3]) * (strain - crept)) @ self.moduli
        return np.column_stack([crept, history[:, 3] + lost])

    def energy(self, strain, material, history):
        return np.stack([0.5 * (strain - history[:, :3]) ** 2 @ self.moduli, history[:, 3]], axis=-1)


@dataclass(frozen=True)
class Viscous(StiffnessSection):
    """Kelvin and Voigt's section C (eps + t eps') with a retardation time t [s], eps' by backward differences.

    History: the three strains, the three viscous resultants, dissipated energy per length [J/m].
    """

    retardation: float = 1.0
    memory = (0.0,) * 7

    @property
    def moduli(self):
        return np.array([self.axial, self.shear, self.bending])

    def _viscous(self, strain, history, dt):
        return self.retardation * self.moduli * (strain - history[:, :3]) / dt if dt > 0.0 else history[:, 3:6]

    def resultants(self, strain, material, history, dt):
        return self.moduli * strain + self._viscous(strain, history, dt)

    def remember(self, strain, material, history, dt):
        viscous = self._viscous(strain, history, dt)
        lost = (viscous * (strain - history[:, :3])).sum(axis=1) if dt > 0.0 else 0.0
        return np.column_stack([strain, viscous, history[:, 6] + lost])

    def energy(self, strain, material, history):
        return np.stack([0.5 * strain**2 @ self.moduli, history[:, 6]], axis=-1)


SECTION = {"axial": 1e6, "shear": 4e5, "bending": 100.0, "mass": 1.0, "rotary_inertia": 1e-4}
LIGHT = {**SECTION, "mass": 1e-5, "rotary_inertia": 1e-9}
YIELDING = Plastic(**SECTION, limit=40.0, hardening=25.0)
NEVER = Plastic(**SECTION, limit=1e30, hardening=25.0)
LAWS = [YIELDING, Creeping(**SECTION, relaxation=0.3), Viscous(**SECTION, retardation=0.3)]
ids = {"ids": lambda law: type(law).__name__}


def arm(section, loads=lambda beam: [], order=3, elements=8, length=1.0, material=None):
    beam = bf.Beam(bf.Line((0, 0), (length, 0)), elements, bf.CRBF(order=order), section, material)
    return beam, bf.Model([beam], [bf.Clamp(beam.start)], loads(beam))


def there_and_back(at):
    """From 0 to 1, to -1 and back to 1, in five equal parts."""
    return float(np.interp(at, [0.0, 0.2, 0.6, 1.0], [0.0, 1.0, -1.0, 1.0]))


def bent_there_and_back(section, **options):
    """A short arm under a moment of 90 N m, that of the limit and of the hardening of 2 /m."""
    load = lambda beam: [bf.PointMoment(beam.end, 90.0, amplitude=there_and_back, scale=False)]  # noqa: E731
    return arm(section, load, length=0.1, **options)
