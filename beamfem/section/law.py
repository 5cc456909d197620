"""Section laws: resultants that are nonlinear functions of the strains, with or without history."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol, cast, runtime_checkable

import numpy as np

from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.validation import called, finite, fulfils, items

COMPLEX_STEP = 1e-30  # may be this small, because nothing is subtracted


@runtime_checkable
class SectionLaw(Protocol):
    """Additional members of a section (`CrossSection`) whose resultants are nonlinear functions of its strains.

    `rigidity` must be the stiffness at zero strain. Tangents are complex-step derivatives of `resultants`, exact to
    round-off, so `resultants` and `energy` must consist of analytic functions of arrays: `np.tanh`, `x**2`, not `abs`.
    Cases are distinguished by real parts, `np.where(strain[:, 0].real < 0.0, ...)`. This is tested when a beam is made.
    """

    def resultants(self, strain: np.ndarray, material: Material | None) -> np.ndarray:
        """Return normal force [N], shear force [N] and moment [N m] (n, 3), which are zero at zero strain.

        strain (n, 3), real or complex: stretch, shear and change of curvature [1/m] from the stress-free state.
        """
        ...

    def energy(self, strain: np.ndarray, material: Material | None) -> np.ndarray:
        """Return the strain energy per length (n,) [J/m] for these strains; `resultants` is its derivative."""
        ...


@runtime_checkable
class RememberingLaw(Protocol):
    """Members of a section law with history, such as plasticity or creep, instead of those of `SectionLaw`.

    strain (n, 3), material: see `SectionLaw`; history (n, k): committed history variables of the same points, from the
    last accepted step; dt [s]: time since then, 0 in statics and whenever an accepted state is evaluated again. History
    variables are part of the state: a rejected step restores them, and a result has them row by row. A state must
    therefore determine its resultants: with the history that `remember` returns and dt = 0, `resultants` must be those
    of the step and the derivative of the stored energy at this history, whose second derivative is the tangent. This is
    tested when a beam is made. Simo and Hughes 1998, chapter 1.
    """

    @property
    def memory(self) -> Sequence[float]:
        """The initial history variables (k,) of a point."""
        ...

    def resultants(self, strain: np.ndarray, material: Material | None, history: np.ndarray, dt: float) -> np.ndarray:
        """Return normal force [N], shear force [N] and moment [N m] (n, 3), an analytic function of the strain."""
        ...

    def remember(self, strain: np.ndarray, material: Material | None, history: np.ndarray, dt: float) -> np.ndarray:
        """Return the history variables (n, k) after an accepted step to these strains."""
        ...

    def energy(self, strain: np.ndarray, material: Material | None, history: np.ndarray) -> np.ndarray:
        """Return the stored energy, and the energy dissipated since the start, per length (n, 2) [J/m]."""
        ...


@dataclass(frozen=True, eq=False)
class ConstitutiveLaw:
    """A section law and the material of the section; without history, k = 0."""

    section: SectionLaw | RememberingLaw
    material: Material | None

    @property
    def name(self) -> str:
        return type(self.section).__name__

    @cached_property
    def remembers(self) -> bool:
        """Whether resultants depend on history. Raises InputError if parts of `RememberingLaw` are missing."""
        found, parts = fulfils(self.section, RememberingLaw), ("memory", "remember")
        if not found and any(hasattr(self.section, part) for part in parts):
            raise InputError(
                f"{self.name} has a memory or remember(strain, material, history, dt), but not both: a section law "
                "with history needs its initial values and how a step changes them"
            )
        return found

    @cached_property
    def start(self) -> np.ndarray:
        """The initial history variables (k,) of a point. Raises InputError."""
        if not self.remembers:
            return np.empty(0)
        name = f"memory of {self.name}"
        memory = items(name, cast(RememberingLaw, self.section).memory)
        if not memory:
            raise InputError(f"{name} is empty: a section law without history needs neither memory nor remember")
        return np.array([finite(name, value) for value in memory], dtype=float)

    def at_start(self, count: int) -> np.ndarray:
        """Return the initial history (count, k) of points."""
        return np.tile(self.start, (count, 1))

    def resultants(self, strain: np.ndarray, history: np.ndarray, dt: float = 0.0) -> np.ndarray:
        """Return the resultants (n, 3) for strains (n, 3), real or complex. Raises InputError for an invalid result."""
        past = (history, dt) if self.remembers else ()
        with np.errstate(all="ignore"):  # far from equilibrium a law may overflow; the iteration recovers from it
            found = self._called("resultants", strain, *past)
        return self._checked("resultants", found, strain.shape)

    def linearised(self, strain: np.ndarray, history: np.ndarray, dt: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Return resultants (n, 3) and consistent tangent (n, 3, 3), made symmetric, at real strains (n, 3)."""
        count = len(strain)
        moved = np.tile(strain.astype(complex), (3, 1))
        for column in range(3):
            moved[column * count : (column + 1) * count, column] += 1j * COMPLEX_STEP
        past = np.tile(history, (3, 1)) if self.remembers else history
        found = self.resultants(moved, past, dt).reshape(3, count, 3)
        tangent = np.moveaxis(found.imag / COMPLEX_STEP, 0, -1)
        return found[0].real, 0.5 * (tangent + np.swapaxes(tangent, 1, 2))

    def remember(self, strain: np.ndarray, history: np.ndarray, dt: float = 0.0) -> np.ndarray:
        """Return the history (n, k) after an accepted step to strains (n, 3). Raises InputError for invalid values."""
        found = self._checked("remember", self._called("remember", strain, history, dt), history.shape)
        if found.dtype.kind == "c" or not np.isfinite(found).all():
            raise InputError(f"remember of {self.name} must return finite numbers, real ones for real strains")
        return found

    def energy(self, strain: np.ndarray, history: np.ndarray) -> np.ndarray:
        """Return stored and dissipated energy per length (n, 2) [J/m]. Raises InputError for an invalid result."""
        if self.remembers:
            return self._checked("energy", self._called("energy", strain, history), (len(strain), 2))
        stored = self._checked("energy", self._called("energy", strain), (len(strain),))
        return np.stack([stored, np.zeros(len(strain))], axis=-1)

    def _called(self, name: str, strain: np.ndarray, *past: Any) -> np.ndarray:
        return np.asarray(called(f"{name} of {self.name}", getattr(self.section, name), strain, self.material, *past))

    def _checked(self, what: str, found: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
        if found.shape != shape or found.dtype.kind not in "fic":
            raise InputError(
                f"{what} of {self.name} must return numbers of the shape {shape} for strains ({shape[0]}, 3), "
                f"got {found.dtype} {found.shape}"
            )
        return found

    @cached_property
    def stiffness(self) -> np.ndarray:
        """The stiffness (3, 3) at zero strain."""
        return self.linearised(np.zeros((1, 3)), self.at_start(1))[1][0]


def law_of(section: object, material: Material | None) -> ConstitutiveLaw | None:
    """Return the law of a section, None if it has none."""
    return ConstitutiveLaw(cast(SectionLaw, section), material) if fulfils(section, SectionLaw) else None
