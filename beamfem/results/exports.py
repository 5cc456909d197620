"""Files and tables of a solution; a room above offers what writes them."""

from collections.abc import Sequence
from os import PathLike
from typing import Any, Literal

from beamfem.model.beam import Beam
from beamfem.registry import offered


class Exports:
    """Methods of a `Solution`, which derives from this class, that write or tabulate it."""

    def to_vtk(
        self,
        path: str | PathLike[str],
        *,
        geometry: Literal["deformed", "reference"] = "deformed",
        fields: Sequence[str] | None = None,
        single: bool = False,
    ) -> None:
        """Write solids, centrelines, supports and loads for ParaView.

        The body is written into `path`; centrelines, and supports and loads, into <stem>_centreline and <stem>_boundary
        beside it. Names and units of the fields are listed in docs/paraview.md.

        Parameters
        ----------
        path : path
            .vtkhdf (the default suffix): all steps in one file, for ParaView 5.12 or newer; .pvd: a collection of .vtu
            files, one per step, in the folder <stem>.
        geometry : {"deformed", "reference"}, default "deformed"
            "reference" writes the reference positions of the points, to be warped by `displacement`.
        fields : sequence of str, optional
            Names of the fields to write, by default all but the stress tensors of bodies: VTK draws curved cells with
            at most 18 numbers at a point and drops what is more.
        single : bool, default False
            Whether to write numbers of four bytes: half the size, seven digits.

        Raises
        ------
        InputError
            For another suffix and for unknown fields.
        BeamfemError
            For .vtkhdf without h5py.

        Warns
        -----
        UnknownStressWarning
            If the shape of a section, and so its stress, is not known.

        Examples
        --------
        >>> solution.to_vtk("cantilever.pvd", fields=["displacement"])
        """
        offered(Exports.to_vtk)(self, path, geometry=geometry, fields=fields, single=single)

    def to_xarray(self, beam: Beam | None = None) -> Any:
        """Return the results along a beam, or along all beams, over the steps as a labelled dataset.

        Parameters
        ----------
        beam : Beam, optional
            A beam of the model, by default all beams in succession.

        Returns
        -------
        xarray.Dataset
            Positions, rotations, section forces, stresses if sections have them, and energies; the statistics are its
            attributes. Of one beam the arc length is a dimension: at an end that two elements share, the station before
            it stands one last digit lower, so that both sides are kept.

        Raises
        ------
        InputError
            For a beam of another model.
        MissingPackageError
            Without xarray.

        Examples
        --------
        >>> data = solution.to_xarray(beam)
        >>> data["uy"].dims
        ('load_factor', 'arc_length')
        """
        return offered(Exports.to_xarray)(self, beam)

    def to_pandas(self, beam: Beam | None = None) -> Any:
        """Return the results along a beam, or along all beams, over the steps as a table.

        Parameters
        ----------
        beam : Beam, optional
            A beam of the model, by default all beams.

        Returns
        -------
        pandas.DataFrame
            One row for each step and station, with time [s] or load_factor, number of the beam and arc_length [m] as
            index. Both sides of an end that two elements share have a row: the arc length of the one before it, like
            the load factor of the row before a jump, is smaller by one last digit, so that no row of the index is
            there twice.

        Raises
        ------
        InputError
            For a beam of another model.
        MissingPackageError
            Without pandas.

        Examples
        --------
        >>> table = solution.to_pandas(beam)
        >>> list(table.index.names)
        ['load_factor', 'beam', 'arc_length']
        """
        return offered(Exports.to_pandas)(self, beam)

    def save(self, path: str | PathLike[str]) -> None:
        """Write model and states to one HDF5 file with checksums.

        Folders in the path are created. An earlier file is replaced when the new one is complete.

        Parameters
        ----------
        path : path
            File to write; `load` reads it.

        Raises
        ------
        InputError
            For a model with parts that cannot be saved.
        FileError
            If the system refuses to write.
        MissingPackageError
            Without h5py.

        Examples
        --------
        >>> solution.save("cantilever.h5")
        """
        offered(Exports.save)(self, path)
