"""What a solution says of beams and of the whole model: forces, stresses, energies, momenta."""

import numpy as np

from beamfem.curves import BSpline, spline_through_hermite, without_removable_knots
from beamfem.errors import InputError
from beamfem.model.beam import Beam
from beamfem.once import cached_property
from beamfem.results import postprocess
from beamfem.results.beam_stress import BeamStress, Part, Peak, beam_stress, peak_stress
from beamfem.results.connected import kinetic_of_connectors, momenta_of_connectors
from beamfem.results.energies import Energy, dissipated, potential
from beamfem.results.energy_drift import EnergyDrift, energy_drift
from beamfem.results.imposed import imposed_measures
from beamfem.results.last_digits import remainders
from beamfem.results.point_quantities import PointQuantities
from beamfem.results.reactions import support_forces
from beamfem.results.section_forces import SectionForces, section_forces
from beamfem.validation import number_below


class Quantities(PointQuantities):
    """Quantities of a `Solution`, which derives from this class, at points, along beams and of the whole model."""

    def __len__(self) -> int:
        return len(self.p)

    @cached_property
    def support_forces(self) -> np.ndarray:
        """Generalized forces of all supports and springs (steps, n) [N, N m]."""
        return support_forces(self._whole)

    @cached_property
    def remainders(self) -> np.ndarray:
        """Corrections (steps, n) of the coordinates of a static solution that are smaller than their last digit.

        In a stiff part of a model they may change the forces noticeably; zero where they do not, and for a motion.
        """
        return remainders(self._whole)

    def section_forces(self, beam: Beam) -> SectionForces:
        """Return normal force, shear force and moment along a beam.

        Parameters
        ----------
        beam : Beam
            A beam of the model.

        Returns
        -------
        SectionForces
            The forces, (steps, stations).

        Raises
        ------
        InputError
            For a beam of another model.

        Examples
        --------
        >>> forces = solution.section_forces(beam)
        >>> round(float(forces.moment[-1, 0]), -1)  # at the clamp
        -20000.0
        """
        self.model.number_of(beam)  # rejects beams of other models
        return section_forces(self._whole, beam)

    def stresses(self, beam: Beam) -> BeamStress:
        """Return the extreme stresses of the sections along a beam.

        Parameters
        ----------
        beam : Beam
            A beam of the model.

        Returns
        -------
        BeamStress
            The stresses, (steps, stations).

        Raises
        ------
        InputError
            For a beam of another model.

        Examples
        --------
        >>> stress = solution.stresses(beam)
        >>> round(stress.peak("von_mises").value / 1e6)  # MPa
        240
        """
        self.model.number_of(beam)
        return beam_stress(self._whole, beam)

    def peak_stress(self, part: Part = "von_mises") -> Peak:
        """Return the peak of a stress over all beams and rows.

        Parameters
        ----------
        part : str, default "von_mises"
            See `BeamStress.peak`.

        Returns
        -------
        Peak
            The peak, with its beam; nan if no value is known.

        Warns
        -----
        UnknownStressWarning
            If sections of some beams define no stress, such as moments without a height.

        Examples
        --------
        >>> peak = solution.peak_stress()
        >>> round(peak.value / 1e6), peak.beam is beam  # MPa
        (240, True)
        """
        return peak_stress(self._whole, part)

    @cached_property
    def _momenta(self) -> tuple[postprocess.Momenta, ...]:
        return tuple(postprocess.momenta(mesh, self.p, self.v) for mesh in self.model.meshes)

    def energy(self) -> Energy:
        """Return kinetic, strain, potential, total and dissipated energy, see `Energy`.

        The potential is zero in the reference configuration.

        Returns
        -------
        Energy
            Energies [J], (steps,).

        Examples
        --------
        >>> energy = solution.energy()
        >>> energy.strain.round(1)
        array([  0. , 152.6])
        """
        kinetic = sum((m.kinetic for m in self._momenta), kinetic_of_connectors(self._whole))
        imposed = ((mesh, imposed_measures(self._whole, mesh)) for mesh in self.model.meshes)
        parts = (postprocess.strain_energies(mesh, self.p, measures) for mesh, measures in imposed)
        strain, lost = sum(parts, np.zeros((len(self), 2))).T
        acting = potential(self._whole, [m.first_moment for m in self._momenta])
        return Energy(kinetic, strain, acting, dissipated(self._whole, lost), self.model.unit("J"))

    @cached_property
    def energy_drift(self) -> EnergyDrift | None:
        """Change of the total energy [J] over a motion on which no work is done: an error of the time steps.

        None for a static solution, and for a motion on which work is done.
        """
        return energy_drift(self._whole) if len(self) else None

    def linear_momentum(self) -> np.ndarray:
        """Return the linear momentum.

        Returns
        -------
        array, [kg m/s], (steps, 2)
            Momentum in x and y.

        Examples
        --------
        >>> motion = bf.simulate(model, duration=0.02, step=0.001)
        >>> motion.linear_momentum()[-1].round(1)
        array([ -1.5, -58.4])
        """
        return np.asarray(sum(m.linear for m in self._momenta) + momenta_of_connectors(self._whole)[:, :2])

    def angular_momentum(self) -> np.ndarray:
        """Return the angular momentum about the origin.

        Returns
        -------
        array, [kg m^2/s], (steps,)
            Angular momentum.

        Examples
        --------
        >>> motion = bf.simulate(model, duration=0.02, step=0.001)
        >>> round(float(motion.angular_momentum()[-1]), 1)
        -86.1
        """
        return np.asarray(sum(m.angular for m in self._momenta) + momenta_of_connectors(self._whole)[:, 2])

    def spline(self, beam: Beam, row: int = -1) -> BSpline:
        """Return the exact deformed axis of a beam of cubic elements as a cubic B-spline.

        Its knots are those of the beam's own spline, or arc lengths.

        Parameters
        ----------
        beam : Beam
            A beam of cubic elements.
        row : int, default -1
            Row of the solution.

        Returns
        -------
        BSpline
            The deformed axis.

        Raises
        ------
        InputError
            For other elements.

        Examples
        --------
        >>> cubic = bf.Beam(bf.Line((0, 0), (2, 0)), 4, bf.ShearRigid(), bf.Rectangle(0.05, 0.1), steel)
        >>> bent = bf.solve_static(bf.Model([cubic], [bf.Clamp(cubic.start)], [bf.PointForce(cubic.end, (0.0, -1e4))]))
        >>> bent.spline(cubic).degree
        3
        """
        mesh = self.model.meshes[self.model.number_of(beam)]
        if "r_x" not in mesh.vectors or mesh.nodes != len(mesh.parameter):
            raise InputError(
                f"the axis of {beam.element.name} elements is no cubic spline; use cubic elements such as ANCF"
            )
        number = number_below("row", row, len(self), -len(self))
        e = postprocess.nodal_vectors(mesh, self.p[number][None])[0]
        return without_removable_knots(spline_through_hermite(mesh.parameter, e[:, 0], mesh.rate * e[:, 1]))
