"""A rectangle of elastic-plastic fibres, as a user writes it, and its moment by hand."""

from dataclasses import dataclass

import numpy as np

import beamfem as bf

STEEL = bf.Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0)
SIDE = 0.01  # [m] of the square


@dataclass(frozen=True)
class Fibres(bf.Section):
    """Fibres of equal area that yield at a stress [Pa], with linear kinematic hardening [Pa] (return mapping).

    History: plastic strain of each fibre, dissipated energy per length [J/m].
    """

    fibres: int = 21
    limit: float = 2.5e8
    hardening: float = 0.0

    @property
    def memory(self):
        return (0.0,) * (self.fibres + 1)

    @property
    def places(self):
        return self.height * ((np.arange(self.fibres) + 0.5) / self.fibres - 0.5)

    def _strain(self, strain):
        return strain[:, :1] - self.places * strain[:, 2:]

    def _flow(self, strain, material, history):
        plastic, stiffness = history[:, :-1], material.youngs_modulus
        trial = stiffness * (self._strain(strain) - plastic) - self.hardening * plastic
        sign = np.sign(trial.real)
        flow = (trial - sign * self.limit) / (stiffness + self.hardening)
        return np.where(np.abs(trial.real) > self.limit * (1 + 1e-9), flow, 0.0)

    def resultants(self, strain, material, history, dt):
        elastic = self._strain(strain) - history[:, :-1] - self._flow(strain, material, history)
        stress, part = material.youngs_modulus * elastic, self.area / self.fibres
        shear = self.rigidity(material).shear * strain[:, 1]
        return np.stack([part * stress.sum(axis=1), shear, -part * stress @ self.places], axis=-1)

    def remember(self, strain, material, history, dt):
        flow = self._flow(strain, material, history)
        lost = self.limit * np.abs(flow).sum(axis=1) * self.area / self.fibres
        return np.column_stack([history[:, :-1] + flow, history[:, -1] + lost])

    def energy(self, strain, material, history):
        plastic = history[:, :-1]
        elastic = material.youngs_modulus * (self._strain(strain) - plastic) ** 2
        stored = (elastic + self.hardening * plastic**2).sum(axis=1) * self.area / self.fibres
        stored = stored + self.rigidity(material).shear * strain[:, 1] ** 2
        return np.stack([0.5 * stored, history[:, -1]], axis=-1)


def square(fibres, **options):
    """Return a square of fibres, with the second moment of area that they have."""
    second_moment = SIDE**4 / 12 * (1 - 1 / fibres**2)
    return Fibres(area=SIDE**2, second_moment=second_moment, height=SIDE, fibres=fibres, **options)


def moment(section, curvature):
    """Return the moment [N m] of fibres without hardening that are bent once, by hand."""
    stress = np.clip(STEEL.youngs_modulus * curvature * section.places, -section.limit, section.limit)
    return float(stress @ section.places) * section.area / section.fibres
