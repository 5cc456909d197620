"""Pictures, pages and animations of a solution; a room above offers what draws them."""

from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Unpack

from beamfem.model.beam import Point
from beamfem.registry import offered
from beamfem.results.drawing_options import FilmOptions, PageOptions, PictureOptions, ShapeOptions, WindowOptions


class Pictures:
    """Methods of a `Solution`, which derives from this class, that draw it."""

    def to_html(self, path: str | PathLike[str], **options: Unpack[PageOptions]) -> Path:
        """Write an HTML page with a slider over the steps: a single file that works offline.

        The body moves with its supports, optionally coloured by a section force [N, N m], rotation [rad], displacement
        [m] or speed [m/s]; a curve of the largest displacement and the statistics are shown beside it. The file is
        smaller than 1 MB: for large models only the axes and fewer steps are drawn.

        Parameters
        ----------
        path : path
            File to write, .html.
        title : str, optional
            Heading of the page.
        frames : int, default 60
            Largest number of steps.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        InputError
            For another suffix.

        Examples
        --------
        >>> page = solution.to_html("cantilever.html", title="Cantilever")
        """
        return offered(Pictures.to_html)(self, path, **options)

    def plot(self, path: str | PathLike[str] | None = None, **options: Unpack[ShapeOptions]) -> Any:
        """Draw the deformed body, at several steps later ones darker.

        Parameters
        ----------
        path : path, optional
            File to write (PNG, SVG, PDF); folders are created.
        colour : str, optional
            By default the time or load factor; or a field along the beams, whose extreme value is marked: "moment"
            [N m], "normal", "shear" [N], "rotation" [rad], "displacement" [m], "speed" [m/s], "axial_strain" [-]
            (Green strain xx of the axis), "shear_angle" [rad]; of the stress [Pa] "stress" or "von_mises" (von Mises
            stress over the height), of each section "upper", "lower" (faces), "outer" (the larger of both),
            "tension", "compression", "shear_stress" (extremes); or "utilisation" [-] of the strength, over the height.
        shapes : int, optional
            Number of steps, one of them the last; by default the last alone, of motions and paths 9.
        undeformed : bool, default True
            Whether to draw the reference axes dashed.
        supports, loads : bool, default True
            Whether to draw their symbols, each load on the shape at which it is largest.

        Returns
        -------
        matplotlib.figure.Figure
            The figure.

        Raises
        ------
        InputError
            For an unknown option or value.
        MissingPackageError
            Without matplotlib.

        Examples
        --------
        >>> figure = solution.plot("cantilever.png", colour="moment", loads=False)
        """
        return offered(Pictures.plot)(self, path, **options)

    def plot_history(
        self,
        point: Point | Sequence[Point] | None = None,
        quantity: str = "displacement",
        path: str | PathLike[str] | None = None,
    ) -> Any:
        """Plot a quantity at one or several points against time or load factor.

        Parameters
        ----------
        point : Point or sequence of Point, optional
            Where to evaluate the quantity.
        quantity : str, default "displacement"
            "displacement", "ux", "uy", "position" [m], "velocity" [m/s], "rotation" [rad]; at supports "force" [N] and
            "reaction_moment" [N m]; without a point "energy" [J].
        path : path, optional
            File to write (PNG, SVG, PDF).

        Returns
        -------
        matplotlib.figure.Figure
            The figure.

        Raises
        ------
        InputError
            For an unknown quantity, or one that needs a point.
        MissingPackageError
            Without matplotlib.

        Examples
        --------
        >>> figure = solution.plot_history(beam.end, "uy", "tip.png")
        """
        return offered(Pictures.plot_history)(self, point, quantity, path)

    def plot_curve(self, x: Any, y: Any, path: str | PathLike[str] | None = None) -> Any:
        """Plot one quantity against another, one point per row.

        A quantity is a pair of a name and a point, such as ("uy", beam.end), with the names "ux", "uy", "x", "y" [m],
        "rotation" [rad], "vx", "vy" [m/s], "normal", "shear" [N], "moment" [N m], those of stresses in `plot` [Pa] and,
        at supports, "fx", "fy" [N] and "m" [N m]; or "load_factor" or "time" [s]; or "kinetic", "strain", "potential"
        or "total" energy [J]; or a pair of a label and numbers (steps,); or numbers. Where two elements meet or a load
        acts, a section is that on the side towards the beam's end.

        Parameters
        ----------
        x, y : tuple, str or array
            Quantities along the horizontal and the vertical axis.
        path : path, optional
            File to write (PNG, SVG, PDF).

        Returns
        -------
        matplotlib.figure.Figure
            The figure.

        Raises
        ------
        InputError
            For an unknown quantity.
        MissingPackageError
            Without matplotlib.

        Examples
        --------
        >>> figure = solution.plot_curve(("uy", beam.end), ("fy", beam.start), "curve.png")
        """
        return offered(Pictures.plot_curve)(self, x, y, path)

    def plot_load_displacement(
        self, point: Point, quantity: str = "uy", path: str | PathLike[str] | None = None
    ) -> Any:
        """Plot the load factor against a displacement or rotation of a point.

        Limit points (circles) and bifurcations (diamonds) of a `Path` are marked, each with its load factor.

        Parameters
        ----------
        point : Point
            A point of a beam.
        quantity : str, default "uy"
            "ux", "uy" [m] or "rotation" [rad].
        path : path, optional
            File to write (PNG, SVG, PDF).

        Returns
        -------
        matplotlib.figure.Figure
            The figure.

        Raises
        ------
        InputError
            For another quantity, or a motion.
        MissingPackageError
            Without matplotlib.

        Examples
        --------
        >>> figure = solution.plot_load_displacement(beam.end, "uy", "path.png")
        """
        return offered(Pictures.plot_load_displacement)(self, point, quantity, path)

    def animate(self, path: str | PathLike[str], **options: Unpack[FilmOptions]) -> Path:
        """Write an animation as GIF or MP4, according to the suffix of `path`.

        About fps * seconds rows are shown, equally spaced in time (in statics by row); with fewer rows each is shown
        longer. Loads are drawn in each frame with their current amplitude.

        Parameters
        ----------
        path : path
            File to write, .gif or .mp4; folders are created.
        fps : float, default 15.0
            Frames per second.
        seconds : float, [s], default 4.0
            Duration.
        colour : str, optional
            A field along the beams, see `plot`.
        undeformed : bool, default True
            Whether to draw the reference axes dashed.
        supports, loads : bool, default True
            Whether to draw their symbols.
        dpi : int, default 100
            Pixels per inch, of a frame 4 to 8 inches wide.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        InputError
            For another suffix.
        MissingPackageError
            Without matplotlib; for .mp4 without imageio-ffmpeg.

        Examples
        --------
        >>> film = solution.animate("cantilever.gif", seconds=1.0, colour="moment")
        """
        return offered(Pictures.animate)(self, path, **options)

    def show(self, **options: Unpack[WindowOptions]) -> Any:
        """Open a window with the solid body and a slider over the steps, and wait until it is closed.

        Without a display, or if VTK cannot render, a warning is given and a matplotlib figure is returned instead.

        Parameters
        ----------
        colour : str, optional
            A field along the beams, see `plot`.
        size : (int, int), default (1400, 900)
            Width and height in pixels.

        Returns
        -------
        pyvista.Plotter or matplotlib.figure.Figure
            What was shown.

        Raises
        ------
        InputError
            For an invalid option.

        Examples
        --------
        >>> window = solution.show(colour="moment")  # doctest: +SKIP
        """
        return offered(Pictures.show)(self, **options)

    def picture(self, path: str | PathLike[str], **options: Unpack[PictureOptions]) -> Path:
        """Write a picture of the solid body in a row, without opening a window.

        Rendering is tried in a child process first; if VTK cannot render, matplotlib draws the same row in the plane
        and a warning is given.

        Parameters
        ----------
        path : path
            File to write, .png; folders are created.
        colour : str, optional
            A field along the beams, see `plot`.
        size : (int, int), default (1400, 900)
            Width and height in pixels.
        row : int, default -1
            Row of the solution, the last by default.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        InputError
            For another suffix or an invalid option.

        Examples
        --------
        >>> picture = solution.picture("body.png", row=-1, colour="stress")  # doctest: +SKIP
        """
        return offered(Pictures.picture)(self, path, **options)
