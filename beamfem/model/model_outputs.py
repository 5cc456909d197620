"""Methods of a model that upper rooms implement: its picture and the model with an imperfection."""

from os import PathLike
from typing import TYPE_CHECKING, Any

from beamfem.registry import offered

if TYPE_CHECKING:
    from beamfem.model.model import Model


class ModelOutputs:
    """Base class of `Model` with the methods that upper rooms implement."""

    def with_imperfection(self, modes: Any, size: float, mode: int = 0) -> "Model":
        """Return the model with its axes displaced by a mode and stress-free in the new shape.

        Parameters
        ----------
        modes : Buckling, Modes or array
            Result of `solve_buckling` or `solve_modes`, or an increment (n,) of all coordinates.
        size : float, [m]
            Largest displacement.
        mode : int, default 0
            Index of the mode.

        Returns
        -------
        Model
            The model with the imperfection.

        Raises
        ------
        InputError
            If the modes do not fit the model or move no axis.

        Examples
        --------
        >>> column = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1e3, 0.0))])
        >>> crooked = column.with_imperfection(bf.solve_buckling(column), size=0.002)
        """
        return offered(ModelOutputs.with_imperfection)(self, modes, size, mode)

    def plot(self, path: str | PathLike[str] | None = None) -> Any:
        """Draw the undeformed model with its supports and loads.

        Nothing is solved, so mechanisms and overloaded models can be drawn too.

        Parameters
        ----------
        path : path, optional
            File to write (PNG, SVG, PDF).

        Returns
        -------
        matplotlib.figure.Figure
            The figure.

        Raises
        ------
        MissingPackageError
            Without matplotlib.

        Examples
        --------
        >>> figure = model.plot("model.png")
        """
        return offered(ModelOutputs.plot)(self, path)
