"""Sections that are elastic but not linear: resultants by a law of their own."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol, cast, runtime_checkable

import numpy as np

from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.section.protocol import CrossSection, Rigidity
from beamfem.validation import called, fulfils

_COMPLEX_STEP = 1e-30  # nothing is subtracted, so it may be as small as this
_STEP = 1e-4  # of a sample: differences of fourth order then agree to about 1e-11
_AGREE = 1e-6  # of the largest part of a stiffness
_SAMPLES = np.array([[1.0, 0.7, -0.4], [-0.6, 0.3, 0.9], [0.2, -0.8, 0.5]])
_SIZES = (1e-5, 1e-3, 3e-2)  # strains of the outer fibre at which a law is looked at


@runtime_checkable
class SectionLaw(Protocol):
    """What a section (`CrossSection`) has besides if its resultants are no linear functions of its strains.

    Its `rigidity` is its stiffness at zero strain. Tangents are derivatives of `resultants` by complex steps, exact to
    round-off, so that both must consist of analytic functions of many strains at once: `np.tanh`, `x**2`, not `abs`.
    Cases are told apart by real parts, `np.where(strain[:, 0].real < 0.0, ...)`. This is tested when a beam is made.
    """

    def resultants(self, strain: np.ndarray, material: Material | None) -> np.ndarray:
        """Return normal force [N], shear force [N] and moment [N m] (n, 3), which are zero at zero strain.

        strain (n, 3), real or complex: stretch, shear and change of curvature [1/m] from the state without stress.
        """
        ...

    def energy(self, strain: np.ndarray, material: Material | None) -> np.ndarray:
        """Return the strain energy per length (n,) [J/m] of the same strains; `resultants` is its derivative."""
        ...


@dataclass(frozen=True, eq=False)
class ElasticLaw:
    """A section with a law of its own and its material."""

    section: SectionLaw
    material: Material | None

    @property
    def name(self) -> str:
        return type(self.section).__name__

    def resultants(self, strain: np.ndarray) -> np.ndarray:
        """Return the resultants (n, 3) of strains (n, 3), both real or complex. Raises InputError for what are none."""
        with np.errstate(all="ignore"):  # far from equilibrium a law may overflow; then the iteration goes back
            found = np.asarray(called(f"resultants of {self.name}", self.section.resultants, strain, self.material))
        return self._checked("resultants", found, strain.shape)

    def linearised(self, strain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return resultants (n, 3) and their derivatives (n, 3, 3) at real strains (n, 3)."""
        count = len(strain)
        moved = np.tile(strain.astype(complex), (3, 1))
        for column in range(3):
            moved[column * count : (column + 1) * count, column] += 1j * _COMPLEX_STEP
        found = self.resultants(moved).reshape(3, count, 3)
        tangent = np.moveaxis(found.imag / _COMPLEX_STEP, 0, -1)
        return found[0].real, 0.5 * (tangent + np.swapaxes(tangent, 1, 2))

    def energy(self, strain: np.ndarray) -> np.ndarray:
        """Return the strain energy per length (n,) [J/m] of strains (n, 3). Raises InputError for what is none."""
        found = np.asarray(called(f"energy of {self.name}", self.section.energy, strain, self.material))
        return self._checked("energy", found, strain.shape[:1])

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
        return self.linearised(np.zeros((1, 3)))[1][0]


def law_of(section: object, material: Material | None) -> ElasticLaw | None:
    """Return the law of a section that has one, or None."""
    return ElasticLaw(cast(SectionLaw, section), material) if fulfils(section, SectionLaw) else None


def require_law(law: ElasticLaw) -> None:
    """Raise InputError if a law is not what `SectionLaw` asks for."""
    zero = np.zeros((1, 3))
    section = cast(Any, law.section)
    if not fulfils(section, CrossSection):
        raise InputError(f"{law.name} has resultants, but is no section: it lacks members of CrossSection")
    if np.any(law.resultants(zero) != 0.0) or np.any(law.energy(zero) != 0.0):
        raise InputError(
            f"resultants and energy of {law.name} must be zero at zero strain: a beam is free of stress along its curve"
        )
    low, high = section.bounds
    lengths = np.array([1.0, 1.0, 2.0 / (high - low)])
    for size in _SIZES:
        _require_consistent(law, size * lengths * _SAMPLES, size * lengths)
    _require_rigidity(law, section.rigidity(law.material), lengths)


def _require_consistent(law: ElasticLaw, strain: np.ndarray, unit: np.ndarray) -> None:
    """Raise InputError if derivatives by complex steps, differences and the energy of a law disagree."""
    found, tangent = law.linearised(strain)
    moved = law.resultants(strain.astype(complex)).imag
    whole, work = tangent * unit[:, None] * unit, found * unit
    largest = np.abs(whole).max(initial=0.0)
    if not np.isfinite(whole).all() or not np.isfinite(work).all() or np.any(moved != 0.0):
        raise InputError(f"resultants of {law.name} must be finite and real at strains such as {strain[0].tolist()}")
    for column in range(3):
        step = np.zeros(3)
        step[column] = _STEP * unit[column]
        slope = _difference(lambda at: law.resultants(at).real, strain, step) * unit
        by_energy = law.energy(strain + 1j * _COMPLEX_STEP * step).imag / (_COMPLEX_STEP * _STEP)
        if np.abs(slope - whole[..., column]).max() > _AGREE * largest:
            raise InputError(
                f"resultants of {law.name} are not analytic, or not symmetric, at strains such as "
                f"{strain[0].tolist()}: their derivatives by complex steps and by differences disagree (abs, hypot, "
                f"linalg.norm or conj lose complex steps)"
            )
        if np.abs(by_energy - work[:, column]).max() > _AGREE * max(np.abs(work).max(), largest):
            raise InputError(
                f"energy of {law.name} does not belong to its resultants at strains such as {strain[0].tolist()}: they "
                f"must be its derivatives by stretch, shear and curvature"
            )


def _difference(function: Any, at: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Return the derivative along a step, by differences of fourth order, for a step as long as 1 / _STEP of it."""
    near = function(at + step) - function(at - step)
    far = function(at + 2.0 * step) - function(at - 2.0 * step)
    return np.asarray((8.0 * near - far) / (12.0 * _STEP))


def _require_rigidity(law: ElasticLaw, rigidity: Rigidity, lengths: np.ndarray) -> None:
    """Raise InputError if a law does not begin with the stiffness of its section."""
    own = np.diag([rigidity.axial, rigidity.shear, rigidity.bending])
    own[0, 2] = own[2, 0] = rigidity.coupling
    units = lengths[:, None] * lengths
    if np.abs((law.stiffness - own) * units).max() > _AGREE * np.abs(own * units).max():
        raise InputError(
            f"the law of {law.name} begins with the stiffness {law.stiffness.tolist()}, but its rigidity is "
            f"{own.tolist()}: rigidity(material) must be the stiffness at zero strain"
        )
