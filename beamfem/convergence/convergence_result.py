"""The result of a convergence study, as tables, Markdown, CSV, picture and page."""

import textwrap
from dataclasses import dataclass, field
from html import escape
from numbers import Real
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem import tables as tabulate
from beamfem.convergence.refinement_curve import Curve
from beamfem.extras import needed_for
from beamfem.results.solution import Solution
from beamfem.sweeps.workers import Failure
from beamfem.validation import flag, require_known, shown
from beamfem.view.html_page import Entry, Part, Table, write_page
from beamfem.view.labels import note_beside
from beamfem.view.notebook_paths import file_to_write
from beamfem.view.plots import COLOURS, MARKERS, new_figure, save_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame
    from xarray import Dataset

WORK = "accuracy or elements"  # refinement of studies that compare the work of fixed and adaptive meshes
EXPLANATION = (
    "Order between a value and the one before it; order of a curve: slope of the least-squares line of log error over "
    "log h through its asymptotic part (the finest points above round-off, as far back as the orders between "
    "neighbours stay within 15 % of the finest one), with the 95 % confidence interval of the slope, which does not "
    "hold the uncertainty of the limit. GCI: grid convergence index of Roache with safety factor 1.25, an estimate of "
    "the relative error that needs no reference but takes the order of three values as it is. Estimated error: of the "
    "finest value; it trusts an order only where four values agree on it, else it is the change between levels. "
    "Effectivity: estimate of the error that the function returns, over the error."
)


@dataclass(frozen=True, eq=False)
class Convergence:
    """Curves of a convergence study, one for each combination of the parameters that are not refined.

    Parameters
    ----------
    function : str
        Name of the function.
    quantity : str
        Name of the quantity whose error is studied.
    refine : str
        Name of the parameter of refinement.
    reference : float or None
        The given limit, None if each curve is extrapolated.
    curves : tuple
        Curves of the study, each a `beamfem.convergence.refinement_curve.Curve`.
    failures : tuple of Failure
        The calls that failed.

    Examples
    --------
    >>> study = bf.converge(lambda n: 1.0 + 1.0 / n**2, refine="n", n=[4, 8, 16, 32], reference=1.0)
    >>> round(study.curves[0].fit.order, 3)
    2.0
    """

    function: str
    quantity: str
    refine: str
    reference: float | None
    curves: tuple[Curve, ...]
    failures: tuple[Failure, ...] = field(default=())

    @property
    def error_name(self) -> str:
        """Name of the errors: "relative error", or "error" if the limit of a curve is zero."""
        return "relative error" if all(curve.relative for curve in self.curves) else "error"

    def __repr__(self) -> str:
        points, number = sum(len(curve.refinement) for curve in self.curves), len(self.curves)
        counted = f"{number} curve{'s' * (number != 1)} of {points} points, {len(self.failures)} failed"
        return f"Convergence({self.quantity} over {self.refine}: {counted})"

    def __str__(self) -> str:
        return self.report()

    def report(self) -> str:
        """Return all points and curves as tables, an explanation of the columns, and every failure, as text."""
        points = tabulate.as_text(*self.points(rounded=True), title=self.title)
        curves = tabulate.as_text(*self.summary())
        return "\n\n".join([points, curves, textwrap.fill(EXPLANATION, 110), *map(str, self.failures)])

    def _repr_html_(self) -> str:
        points, curves = (tabulate.as_html(*table) for table in (self.points(rounded=True), self.summary()))
        return f"<b>{escape(self.title)}</b>{points}{curves}"

    @property
    def title(self) -> str:
        """Title of the study, such as "Convergence of deflection over elements"."""
        return f"Convergence of {self.quantity} over {self.refine}"

    def points(self, rounded: bool = False) -> tuple[list[str], list[list[Any]]]:
        """Return header and rows of the table of points, without solutions, which `curves` holds.

        Columns: parameters, refinement, value, error, order, GCI, effectivity if the function returns estimates of the
        error, other numbers and seconds [s]; rounded: values,
        errors and orders as short text instead of numbers. Raises InputError if it is not a bool.
        """
        names = list(dict.fromkeys(name for curve in self.curves for name in curve.texts))
        values = [pair for curve in self.curves for pair in curve.others.items()]
        whole = {name for name, column in values if any(isinstance(value, Solution) for value in column)}
        others = [name for name in dict.fromkeys(name for name, _ in values) if name not in whole]
        flag("rounded", rounded)
        given = ["effectivity"] if f"{self.quantity}_error" in others else []
        header = [*names, self.refine, self.quantity, self.error_name, "order", "GCI", *given, *others, "seconds"]
        rows = []
        for curve in self.curves:
            for i, refinement in enumerate(curve.refinement):
                numbers = [curve.error[i], curve.order[i], curve.gci[i]]
                if given:
                    numbers.append(self._effectivity(curve, i))
                judged = [_short(x, form) for x, form in zip(numbers, (".2e", ".2f", ".2e", ".2f"), strict=False)]
                rows.append(
                    [
                        *(curve.texts[name] for name in names),
                        refinement,
                        f"{curve.value[i]:.10g}" if rounded else float(curve.value[i]),
                        *(judged if rounded else map(float, numbers)),
                        *(curve.others[name][i] if name in curve.others else None for name in others),
                        f"{curve.seconds[i]:.3g}" if rounded else float(curve.seconds[i]),
                    ]
                )
        return header, rows

    def _effectivity(self, curve: Curve, i: int) -> float:
        """Return the estimate of the error that the function returned over the error; nan if that is not known."""
        change = curve.limit - curve.value[i]
        estimate = curve.others.get(f"{self.quantity}_error", {i: None})[i]
        known = estimate is not None and change != 0.0 and not np.isnan(curve.error[i])
        return float(estimate / change) if known else np.nan

    def summary(self) -> tuple[list[str], list[list[str]]]:
        """Return header and rows, as text, of the table of curves.

        Columns: curve, order, its 95 % confidence band, fitted range, limit, estimated error, remark.
        """
        header = ["curve", "order", "95 % band", f"fitted over {self.refine}", "limit", "estimated error", "remark"]
        rows = []
        for curve in self.curves:
            row, fit = [curve.label, "", "", ""], curve.fit
            if fit:
                over = f"{curve.refinement[fit.first]} to {curve.refinement[fit.last]}"
                row[1:] = [f"{fit.order:.3f}", _short(fit.band, ".3f", "± "), over]
            rows.append([*row, f"{curve.limit:.12g}", _short(curve.estimated_error, ".2e"), "; ".join(curve.notes)])
        return header, rows

    def to_markdown(self) -> str:
        """Return the tables of points and curves, with explanation and failures, as Markdown text."""
        points, curves = tabulate.as_markdown(*self.points(rounded=True)), tabulate.as_markdown(*self.summary())
        failed = "\n".join(f"- {failure}" for failure in self.failures)
        return "\n\n".join(part for part in (points, curves, EXPLANATION, failed) if part) + "\n"

    def to_csv(self, path: str | PathLike[str]) -> None:
        """Write the table of points with all digits; nan if there is no error or order. Raises FileError."""
        tabulate.write_csv(path, *self.points())

    def to_pandas(self) -> "DataFrame":
        """Return the table of points, without solutions, as a pandas.DataFrame. Raises MissingPackageError."""
        return tabulate.as_pandas(*self.points())

    def to_xarray(self) -> "Dataset":
        """Return the numbers of the study over curves and refinement as an xarray.Dataset. Raises MissingPackageError.

        Value, error, order, GCI, seconds [s] and the other numbers (curve, refinement), nan where a curve has no such
        point; fitted_order, limit and estimated_error (curve,).
        """
        with needed_for("to_xarray"):
            import xarray
        sizes = {value: size for curve in self.curves for value, size in zip(curve.refinement, curve.size, strict=True)}
        refinement = sorted(sizes, key=lambda value: -sizes[value])  # from coarse to fine
        header, rows = self.points()
        shape = len(self.curves), len(refinement)
        places = [
            (number, refinement.index(value)) for number, curve in enumerate(self.curves) for value in curve.refinement
        ]
        data: dict[str, Any] = {
            "fitted_order": ("curve", [curve.fit.order if curve.fit else np.nan for curve in self.curves]),
            "limit": ("curve", [curve.limit for curve in self.curves]),
            "estimated_error": ("curve", [curve.estimated_error for curve in self.curves]),
        }
        for name, column in zip(header, zip(*rows, strict=True), strict=True):
            if name != self.refine and all(value is None or isinstance(value, Real) for value in column):
                grid = np.full(shape, np.nan)
                for index, value in zip(places, column, strict=True):
                    grid[index] = np.nan if value is None else value
                title = f"{name} (result)" if name in data or name == "curve" else name
                data[title] = ("curve", self.refine), grid
        coordinates = {"curve": [curve.label for curve in self.curves], self.refine: refinement}
        return xarray.Dataset(data, coordinates, {"function": self.function, "quantity": self.quantity})

    def plot(self, path: str | PathLike[str] | None = None, *, against: str | None = None, ax: Any = None) -> "Figure":
        """Plot the error against the refinement on logarithmic axes, one line per curve.

        against: another number that the function returns, such as that of unknowns, or "seconds", which are the default
        where fixed and adaptive meshes are compared. Hollow markers are errors at round-off, which the fitted order
        leaves out. path: file to write (PNG, SVG, PDF); ax: axes to draw in, see `Solution.plot`. Returns the figure.
        Raises InputError for another suffix or an unknown number, MissingPackageError without matplotlib.

        Examples
        --------
        >>> study = bf.converge(lambda n: 1.0 + 1.0 / n**2, refine="n", n=[4, 8, 16, 32], reference=1.0)
        >>> figure = study.plot("convergence.png")
        """
        against = "seconds" if against is None and self.refine == WORK else against
        if against is not None:
            names = ["seconds", *(name for curve in self.curves[:1] for name in curve.others)]
            require_known(f"the study has no number {shown(against)}", against, names)
        figure, axes = new_figure(7.2, 5.0, ax, pyplot=path is None)
        axes.set_xscale("log")
        axes.set_yscale("log")
        # one triangle for each whole order, at the lowest curve, where there is room for it
        triangles: dict[int, tuple[Curve, str]] = {}
        for i, curve in enumerate(self.curves):
            colour, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
            along = curve.refinement if against is None else {"seconds": curve.seconds, **curve.others}[against]
            x, y = np.array(along, dtype=float), curve.error
            positive = y > 0.0
            label = curve.label
            if curve.fit is not None and against is None:
                band = "" if np.isnan(curve.fit.band) else f" ± {curve.fit.band:.2f}"
                label = f"{label}: order {curve.fit.order:.2f}{band}"
            axes.plot(x[positive], y[positive], color=colour, marker=marker, markersize=5, linewidth=1.4, label=label)
            if curve.fit is None or against is not None:
                continue
            noise = positive & (np.arange(len(x)) > curve.fit.last)
            axes.plot(x[noise], y[noise], marker, markersize=5, color=colour, markerfacecolor="white")
            other = triangles.get(round(curve.fit.order))
            if other is None or np.nanmin(y) < np.nanmin(other[0].error):
                triangles[round(curve.fit.order)] = curve, colour
        for curve, colour in triangles.values():
            _triangle(axes, curve, colour)
        axes.set(xlabel=against or self.refine, ylabel=f"{self.error_name} of {self.quantity}")
        ticks = sorted({value for curve in self.curves for value in curve.refinement})
        if against is None and len(ticks) <= 12:
            axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
            axes.minorticks_off()
        if self.curves:
            axes.legend(frameon=False, fontsize=9)
        return save_figure(figure, path)

    def to_html(self, path: str | PathLike[str] | None = None) -> Path:
        """Write an HTML page with picture and tables, a single file that works offline, and return its path.

        path: by default a temporary file; notebooks display the path that is returned. Raises InputError for another
        suffix, MissingPackageError without matplotlib.
        """
        target = file_to_write(path, "a page", ".html", example="convergence.html")
        with TemporaryDirectory() as folder:
            picture = Path(folder) / "errors.svg"
            self.plot(picture)
            reference = "Richardson extrapolation" if self.reference is None else f"the reference {self.reference!r}"
            found = f"Errors against {reference}. {EXPLANATION}"
            entry = Entry(self.error_name.capitalize(), picture, claim="", found=found)
            named = (("Curves", self.summary()), ("Points", self.points(rounded=True)))
            tables = [Table(title, header, tabulate.cells(rows)) for title, (header, rows) in named]
            if self.failures:
                rows = [(failure.label, failure.error) for failure in self.failures]
                tables.append(Table("Failed calls", ("parameters", "error"), rows))
            text = f"{self.function}() called with {self.refine} refined; {len(self.failures)} calls failed."
            return write_page(target, self.title, [Part("Picture", text, [entry]), Part("Numbers", "", tables=tables)])


def _short(number: float, form: str, before: str = "") -> str:
    return "" if np.isnan(number) else f"{before}{number:{form}}"


def _triangle(axes: Any, curve: Curve, colour: str) -> None:
    """Below the last fitted interval: its legs are one step of refinement and the fall that the order promises."""
    fit = curve.fit
    assert fit is not None
    left, right = float(curve.refinement[fit.last - 1]), float(curve.refinement[fit.last])
    ratio = (curve.size[fit.last] / curve.size[fit.last - 1]) ** fit.order
    # the middle half of the interval, below the curve
    a, b = left * (right / left) ** 0.25, left * (right / left) ** 0.75
    top = curve.error[fit.last - 1] * ratio**0.25 / 2.0
    bottom = top * ratio**0.5
    axes.fill([a, b, a], [top, bottom, bottom], facecolor=colour, alpha=0.25, edgecolor=colour, linewidth=0.8)
    note_beside(axes, f"{fit.order:.1f}", (a, np.sqrt(top * bottom)), (-3, 0), ha="right", fontsize=8)
