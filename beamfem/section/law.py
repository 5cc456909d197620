"""Section laws: resultants that are nonlinear functions of the strains, with or without history.

Laws of one stress, such as plasticity, are in `fibre_laws`.
"""

from collections.abc import Sequence
from ctypes import CFUNCTYPE, c_double, c_void_p
from dataclasses import dataclass
from typing import Any, Protocol, cast, runtime_checkable

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.validation import called, finite, fulfils, items

THICKNESS = 3  # number of the thickness stretch among the strain measures
COMPLEX_STEP = 1e-30  # may be this small, because nothing is subtracted


@runtime_checkable
class SectionLaw(Protocol):
    """The additional methods of a section (`CrossSection`) whose section forces are not linear in its strains.

    Its `rigidity` is its stiffness at zero strain. Tangents are complex-step derivatives of `resultants`, exact to
    round-off. Both methods must therefore consist of analytic functions and evaluate many strains at once:
    `np.tanh` and `x**2`, not `abs`. Cases are distinguished by real parts, `np.where(strain[:, 0].real < 0.0, ...)`.
    `beamfem.testing.check_law` tests this.

    A law may also be a C function, which is called in iterations in place of `resultants`: an optional method
    `compiled(material)` returns its address and its numbers, see the page on section laws.
    """

    def resultants(self, strain: np.ndarray, material: Material | None) -> np.ndarray:
        """Return normal force [N], shear force [N] and moment [N m] (n, 3), zero at zero strain.

        strain (n, 3), real or complex: stretch [-], shear [-] and change of curvature [1/m] from the stress-free state;
        material: that of the beam.
        """

    def energy(self, strain: np.ndarray, material: Material | None) -> np.ndarray:
        """Return the strain energy per reference length (n,) [J/m], of which `resultants` is the derivative."""


@runtime_checkable
class RememberingLaw(Protocol):
    """The methods of a section with a history-dependent law, such as plasticity or creep, in place of `SectionLaw`.

    The history variables are part of the state: a rejected step restores them, and a solution has them in every row. A
    state must therefore determine its section forces: with the history that `remember` returns and dt = 0, these are
    the section forces of the step and the derivative of the stored energy at this history, and the tangent is the
    second derivative of that energy. `beamfem.testing.check_law` tests this. Source: Simo and Hughes 1998, chapter 1.
    """

    @property
    def memory(self) -> Sequence[float]:
        """Initial history variables (k,) of a point of the beam."""

    def resultants(self, strain: np.ndarray, material: Material | None, history: np.ndarray, dt: float) -> np.ndarray:
        """Return the section forces (n, 3), an analytic function of the strains, see `SectionLaw.resultants`.

        history (n, k): after the last accepted step; dt [s]: time since then, 0 in statics, and when an accepted state
        is evaluated again.
        """

    def remember(self, strain: np.ndarray, material: Material | None, history: np.ndarray, dt: float) -> np.ndarray:
        """Return the history variables (n, k) after an accepted step to strains (n, 3).

        history (n, k): before the step; dt [s]: its duration, 0 in statics.
        """

    def energy(self, strain: np.ndarray, material: Material | None, history: np.ndarray) -> np.ndarray:
        """Return the energy (n, 2) [J/m] stored, and that dissipated since the start, per reference length."""


@dataclass(frozen=True, eq=False)
class ConstitutiveLaw:
    """A section with a nonlinear law, and the material of its beam; a law without history has k = 0 variables."""

    section: SectionLaw | RememberingLaw
    material: Material | None

    @cached_property
    def compiled(self) -> tuple[int, np.ndarray] | None:
        """Address of the law as a C function, and its numbers, None if it has none. Raises InputError."""
        if not hasattr(self.section, "compiled"):
            return None
        name = f"compiled of {self.name}"
        address, *others = items(name, called(name, self.section.compiled, self.material)) or [None]
        if not isinstance(address, int) or address <= 0 or len(others) != 1:
            raise InputError(f"{name} must return the address of a C function, an int, and numbers, got {address!r}")
        return address, np.array([finite(name, number) for number in items(name, others[0])], dtype=float)

    @property
    def name(self) -> str:
        """Name of the class of the section."""
        return type(self.section).__name__

    @cached_property
    def remembers(self) -> bool:
        """Whether the law depends on history. Raises InputError if it has only part of what `RememberingLaw` needs."""
        complete, parts = fulfils(self.section, RememberingLaw), ("memory", "remember")
        if not complete and any(hasattr(self.section, part) for part in parts):
            raise InputError(
                f"{self.name} has a memory or remember(strain, material, history, dt), but not both: a section law "
                "with history needs its initial values and how a step changes them"
            )
        return complete

    @cached_property
    def start(self) -> np.ndarray:
        """Initial history variables (k,) of a point. Raises InputError if `memory` of the section is invalid."""
        if not self.remembers:
            return np.empty(0)
        name = f"memory of {self.name}"
        memory = items(name, cast(RememberingLaw, self.section).memory)
        if not memory:
            raise InputError(f"{name} is empty: a section law without history needs neither memory nor remember")
        return np.array([finite(name, value) for value in memory], dtype=float)

    def at_start(self, count: int) -> np.ndarray:
        """Return the initial history variables (count, k) of `count` points."""
        return np.tile(self.start, (count, 1))

    def resultants(self, strain: np.ndarray, history: np.ndarray, dt: float = 0.0) -> np.ndarray:
        """Return the section forces (n, 3) [N, N, N m] for strains (n, 3) [-, -, 1/m], both real or complex.

        history (n, k): of the same points; dt [s]: time since. Raises InputError if the law returns anything else.
        """
        past = (history, dt) if self.remembers else ()
        with np.errstate(all="ignore"):  # far from equilibrium a law may overflow; the iteration recovers from it
            values = self._called("resultants", strain, *past)
        return self._checked("resultants", values, strain.shape)

    def linearised(self, strain: np.ndarray, history: np.ndarray, dt: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Return section forces (n, 3) at real strains (n, 3), and the consistent tangent (n, 3, 3)."""
        count, moved = len(strain), np.empty((3, *strain.shape), dtype=complex)
        moved[:] = strain
        for column in range(3):
            moved[column, :, column] += 1j * COMPLEX_STEP
        past = np.concatenate([history] * 3) if self.remembers else history
        forces = self.resultants(moved.reshape(-1, 3), past, dt).reshape(3, count, 3)
        tangent = forces.imag.transpose(1, 2, 0) / COMPLEX_STEP
        return forces[0].real, 0.5 * (tangent + tangent.transpose(0, 2, 1))

    def linearised_in_c(self, strain: np.ndarray, history: np.ndarray, dt: float) -> tuple[np.ndarray, np.ndarray]:
        """Return what the C function of the law gives, as `linearised` does."""
        assert self.compiled is not None
        (address, numbers), forces, tangent = self.compiled, np.empty(strain.shape), np.empty((*strain.shape, 3))
        function = CFUNCTYPE(None, c_void_p, c_void_p, c_double, *[c_void_p] * 3)(address)
        for row in zip(*map(np.ascontiguousarray, (strain, history)), forces, tangent, strict=True):
            own, past, resultants, slopes = (each.ctypes.data for each in row)
            function(own, past, dt, numbers.ctypes.data, resultants, slopes)
        return forces, tangent

    def remember(self, strain: np.ndarray, history: np.ndarray, dt: float = 0.0) -> np.ndarray:
        """Return the history variables (n, k) after an accepted step to strains (n, 3).

        Raises InputError if the law returns anything but finite real numbers of this shape.
        """
        updated = self._checked("remember", self._called("remember", strain, history, dt), history.shape)
        if updated.dtype.kind == "c" or not np.isfinite(updated).all():
            raise InputError(f"remember of {self.name} must return finite numbers, real ones for real strains")
        return updated

    def energy(self, strain: np.ndarray, history: np.ndarray) -> np.ndarray:
        """Return the stored and the dissipated energy per length (n, 2) [J/m]; dissipated is 0 without history.

        Raises InputError if the law returns anything else.
        """
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
        """Stiffness (3, 3) at zero strain: the tangent of N [N], Q [N] and M [N m]."""
        return self.linearised(np.zeros((1, 3)), self.at_start(1))[1][0]


def law_of(section: object, material: Material | None) -> ConstitutiveLaw | None:
    """Return the law of a section, None if it has none."""
    return ConstitutiveLaw(cast(SectionLaw, section), material) if fulfils(section, SectionLaw) else None
