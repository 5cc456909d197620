"""Stress of a fibre as a function of its strain, with or without history."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.validation import convert, items, not_negative, positive, shown

_JUST_YIELDED = 1.0 + 1e-9  # of the yield stress: where a step has just yielded, a fibre is elastic
_PROOF_STRAIN = 0.002  # of the proof stress of Ramberg and Osgood
_MOST = 100  # iterations


@runtime_checkable
class FibreLaw(Protocol):
    """A law whose stress is a function of the strain; both are analytic, as tangents are found by complex steps."""

    @property
    def material(self) -> Material:
        """Moduli at zero strain and the density."""
        ...

    def stress(self, strain: np.ndarray) -> np.ndarray:
        """Return the stress [Pa] for strains, real or complex, (n, fibres)."""
        ...

    def energy(self, strain: np.ndarray) -> np.ndarray:
        """Return the strain energy per volume [J/m^3], (n, fibres)."""
        ...


@runtime_checkable
class FibreLawWithHistory(Protocol):
    """A law whose stress depends on history variables as well, see `RememberingLaw`; history: (n, fibres, k)."""

    @property
    def material(self) -> Material:
        """Moduli at zero strain and the density."""
        ...

    @property
    def memory(self) -> Sequence[float]:
        """Initial history variables (k,) of a fibre."""
        ...

    def stress(self, strain: np.ndarray, history: np.ndarray, dt: float) -> np.ndarray:
        """Return the stress [Pa] for strains, real or complex, (n, fibres); dt [s]: time since the history."""
        ...

    def remember(self, strain: np.ndarray, history: np.ndarray, dt: float) -> np.ndarray:
        """Return the history variables (n, fibres, k) after an accepted step."""
        ...

    def energy(self, strain: np.ndarray, history: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the stored and the dissipated energy per volume [J/m^3], (n, fibres) each."""
        ...


class _Elastic:
    """A law that begins with the moduli of an isotropic material."""

    youngs_modulus: float
    poisson_ratio: float
    density: float

    @property
    def material(self) -> Material:
        """The moduli of a sudden strain from zero, and the density."""
        return Material(self.youngs_modulus, self.poisson_ratio, self.density)


@dataclass(frozen=True)
class ElasticPlastic(_Elastic):
    """Yields at a stress, with linear kinematic hardening: a bilinear stress-strain curve.

    s = E (e - ep), |s - H ep| <= sy, integrated by return mapping (Simo and Hughes 1998, 1.4.3). Raises InputError for
    an invalid value.

    Parameters
    ----------
    youngs_modulus : float, [Pa]
        Young's modulus E.
    yield_stress : float, [Pa]
        Yield stress sy.
    poisson_ratio : float, [-]
        Poisson's ratio, for the elastic shear stiffness.
    density : float, [kg/m^3]
        Density.
    hardening : float, [Pa], default 0
        Hardening modulus H >= 0 by plastic strain; beyond yield the slope is E H / (E + H).

    Examples
    --------
    >>> mild = bf.ElasticPlastic(youngs_modulus=2.1e11, yield_stress=2.5e8, poisson_ratio=0.3, density=7850.0)
    >>> bar = bf.Fibres(bf.Rectangle(0.01, 0.01), mild)
    >>> yielding = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), bar)
    """

    youngs_modulus: float
    yield_stress: float
    poisson_ratio: float
    density: float
    hardening: float = 0.0

    def __post_init__(self) -> None:
        convert(self, positive, "yield_stress")
        convert(self, not_negative, "hardening")
        _ = self.material

    @property
    def memory(self) -> tuple[float, float]:
        """Plastic strain [-] and dissipated energy [J/m^3]."""
        return 0.0, 0.0

    def _flow(self, strain: np.ndarray, history: np.ndarray) -> np.ndarray:
        """Return the change of the plastic strain."""
        plastic = history[..., 0]
        trial = self.youngs_modulus * (strain - plastic) - self.hardening * plastic
        sign = np.sign(trial.real)
        flow = (trial - sign * self.yield_stress) / (self.youngs_modulus + self.hardening)
        return np.where(sign * trial.real > self.yield_stress * _JUST_YIELDED, flow, 0.0)

    def stress(self, strain: np.ndarray, history: np.ndarray, dt: float) -> np.ndarray:
        """Return the stress [Pa]."""
        return self.youngs_modulus * (strain - history[..., 0] - self._flow(strain, history))

    def remember(self, strain: np.ndarray, history: np.ndarray, dt: float) -> np.ndarray:
        """Return plastic strain and dissipated energy after a step."""
        flow = self._flow(strain, history)
        return history + np.stack([flow, self.yield_stress * np.abs(flow)], axis=-1)

    def energy(self, strain: np.ndarray, history: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the stored and the dissipated energy [J/m^3]."""
        plastic, lost = history[..., 0], history[..., 1]
        return 0.5 * (self.youngs_modulus * (strain - plastic) ** 2 + self.hardening * plastic**2), lost


@dataclass(frozen=True)
class RambergOsgood(_Elastic):
    """A smooth stress-strain curve without history: e = s / E + 0.002 (s / s0)^n.

    Raises InputError for an invalid value.

    Parameters
    ----------
    youngs_modulus : float, [Pa]
        Young's modulus E.
    proof_stress : float, [Pa]
        Stress s0 with 0.2 % of inelastic strain.
    exponent : float, [-]
        Exponent n >= 1.
    poisson_ratio : float, [-]
        Poisson's ratio, for the elastic shear stiffness.
    density : float, [kg/m^3]
        Density.

    Examples
    --------
    >>> stainless = bf.RambergOsgood(2e11, proof_stress=2.1e8, exponent=7, poisson_ratio=0.3, density=7900.0)
    >>> bar = bf.Fibres(bf.Rectangle(0.01, 0.01), stainless)
    """

    youngs_modulus: float
    proof_stress: float
    exponent: float
    poisson_ratio: float
    density: float

    def __post_init__(self) -> None:
        convert(self, positive, "proof_stress", "exponent")
        if self.exponent < 1.0:
            raise InputError(f"exponent of RambergOsgood must be at least 1, got {self.exponent:g}")
        _ = self.material

    def stress(self, strain: np.ndarray) -> np.ndarray:
        """Return the stress [Pa], by Newton's method from above, where the strain is a convex function of it."""
        size, n = np.abs(strain.real), self.exponent
        found = np.minimum(self.youngs_modulus * size, self.proof_stress * (size / _PROOF_STRAIN) ** (1.0 / n))
        for _ in range(_MOST):
            step = (self._strain(found) - size) / self._slope(found)
            found = found - step
            if np.all(np.abs(step) <= 1e-15 * found):
                break
        sign = np.where(strain.real < 0.0, -1.0, 1.0)
        return sign * (found - (self._strain(found) - sign * strain) / self._slope(found))  # exact for a complex step

    def _strain(self, stress: np.ndarray) -> np.ndarray:
        ratio = np.maximum(stress, 0.0) / self.proof_stress
        return stress / self.youngs_modulus + _PROOF_STRAIN * ratio**self.exponent

    def _slope(self, stress: np.ndarray) -> np.ndarray:
        ratio = np.maximum(stress, 0.0) / self.proof_stress
        inelastic = _PROOF_STRAIN / self.proof_stress * self.exponent * ratio ** (self.exponent - 1.0)
        return 1.0 / self.youngs_modulus + inelastic

    def energy(self, strain: np.ndarray) -> np.ndarray:
        """Return the strain energy [J/m^3]: s e less the complementary energy."""
        stress = self.stress(strain)
        ratio = np.where(stress.real < 0.0, -stress, stress) / self.proof_stress
        inelastic = _PROOF_STRAIN * self.proof_stress * ratio ** (self.exponent + 1.0) / (self.exponent + 1.0)
        return stress * strain - 0.5 * stress**2 / self.youngs_modulus - inelastic


@dataclass(frozen=True)
class Maxwell(_Elastic):
    """A spring beside Maxwell elements: a stress that relaxes by a Prony series.

    s = E (1 - sum g_i) e + sum g_i E (e - a_i), t_i da_i/dt = e - a_i, integrated exactly for a strain that is linear
    in time within a step. Time passes in motions only; a static solve is that of the sudden load, with E. Raises
    InputError for an invalid value, or shares that sum to more than 1.

    Parameters
    ----------
    youngs_modulus : float, [Pa]
        Young's modulus E of a sudden strain.
    branches : sequence of (float, float), [-, s]
        Share g_i of E and relaxation time t_i of each Maxwell element; the shares sum to 1 at most.
    poisson_ratio : float, [-]
        Poisson's ratio, for the shear stiffness, which does not relax.
    density : float, [kg/m^3]
        Density.

    Examples
    --------
    >>> nylon = bf.Maxwell(2e9, branches=[(0.3, 0.01), (0.2, 1.0)], poisson_ratio=0.4, density=1150.0)
    >>> rod = bf.Fibres(bf.Circle(0.01), nylon, points=8)
    """

    youngs_modulus: float
    branches: Sequence[tuple[float, float]]
    poisson_ratio: float
    density: float

    def __post_init__(self) -> None:
        rows = []
        for branch in items("branches of Maxwell", self.branches):
            pair = items("a branch of Maxwell", branch)
            if len(pair) != 2:
                raise InputError(f"each of the branches of Maxwell is (share, time), got {shown(branch)}")
            rows.append((positive("share of Maxwell", pair[0]), positive("time of Maxwell", pair[1])))
        total = sum(share for share, _ in rows)
        if not rows or total > 1.0 + 1e-12:
            raise InputError(f"branches of Maxwell need shares that sum to 1 at most, got {total:g}")
        object.__setattr__(self, "branches", tuple(rows))
        _ = self.material

    @property
    def memory(self) -> tuple[float, ...]:
        """Strain, strain of the dashpot of each branch [-], and dissipated energy [J/m^3]."""
        return (0.0,) * (len(self.branches) + 2)

    def _crept(self, strain: np.ndarray, history: np.ndarray, dt: float) -> list[np.ndarray]:
        """Return the strain of each dashpot after a step."""
        before, change = history[..., 0], strain - history[..., 0]
        crept = []
        for number, (_, time) in enumerate(self.branches, start=1):
            kept = np.exp(-dt / time)
            lag = -np.expm1(-dt / time) * time / dt if dt > 0.0 else 1.0
            crept.append(strain - kept * (before - history[..., number]) - lag * change)
        return crept

    def stress(self, strain: np.ndarray, history: np.ndarray, dt: float) -> np.ndarray:
        """Return the stress [Pa]."""
        crept = self._crept(strain, history, dt)
        relaxed = sum(share * part for (share, _), part in zip(self.branches, crept, strict=True))
        return self.youngs_modulus * (strain - relaxed)

    def remember(self, strain: np.ndarray, history: np.ndarray, dt: float) -> np.ndarray:
        """Return strain, strains of the dashpots and dissipated energy after a step."""
        crept, lost = self._crept(strain, history, dt), history[..., -1].copy()
        if dt > 0.0:
            rate = (strain - history[..., 0]) / dt
            for number, (share, time) in enumerate(self.branches, start=1):
                kept, final = np.exp(-dt / time), time * rate  # the spring's strain is start exp(-t / time) + final
                start = history[..., 0] - history[..., number] - final
                squared = 0.5 * time * (1.0 - kept**2) * start**2 + 2.0 * time * (1.0 - kept) * start * final
                lost += self.youngs_modulus * share / time * (squared + dt * final**2)
        return np.stack([strain, *crept, lost], axis=-1)

    def energy(self, strain: np.ndarray, history: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the stored and the dissipated energy [J/m^3]."""
        stored = (1.0 - sum(share for share, _ in self.branches)) * strain**2
        for number, (share, _) in enumerate(self.branches, start=1):
            stored = stored + share * (strain - history[..., number]) ** 2
        return 0.5 * self.youngs_modulus * stored, history[..., -1]
