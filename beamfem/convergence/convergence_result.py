"""The result of a convergence study, as tables, Markdown, CSV, picture and page."""

import textwrap
from dataclasses import dataclass, field
from html import escape
from numbers import Real
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from beamfem import tables as tabulate
from beamfem.convergence.refinement_curve import Curve
from beamfem.extras import needed_for
from beamfem.results.solution import Solution
from beamfem.sweeps.workers import Failure
from beamfem.validation import flag

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

    @property
    def _counted(self) -> str:
        points = sum(len(curve.refinement) for curve in self.curves)
        curves = "1 curve" if len(self.curves) == 1 else f"{len(self.curves)} curves"
        return f"{curves} of {points} points, {len(self.failures)} failed"

    def __repr__(self) -> str:
        return f"Convergence({self.quantity} over {self.refine}: {self._counted})"

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
            fit = curve.fit
            over = f"{curve.refinement[fit.first]} to {curve.refinement[fit.last]}" if fit else ""
            rows.append(
                [
                    curve.label,
                    f"{fit.order:.3f}" if fit else "",
                    f"± {fit.band:.3f}" if fit and not np.isnan(fit.band) else "",
                    over,
                    f"{curve.limit:.12g}",
                    _short(curve.estimated_error, ".2e"),
                    "; ".join(curve.notes),
                ]
            )
        return header, rows

    def to_markdown(self) -> str:
        """Return the tables of points and curves, with explanation and failures, as Markdown text."""
        points, curves = tabulate.as_markdown(*self.points(rounded=True)), tabulate.as_markdown(*self.summary())
        failed = "\n".join(f"- {failure}" for failure in self.failures)
        return "\n\n".join(part for part in (points, curves, EXPLANATION, failed) if part) + "\n"

    def to_csv(self, path: str | PathLike[str]) -> None:
        """Write the table of points with all digits; nan if there is no error or order. Raises FileError."""
        tabulate.write_csv(path, *self.points())

    def to_pandas(self) -> Any:
        """Return the table of points, without solutions, as a pandas.DataFrame. Raises MissingPackageError."""
        return tabulate.as_pandas(*self.points())

    def to_xarray(self) -> Any:
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

    def plot(self, path: str | PathLike[str] | None = None) -> Any:
        """Plot the error against the refinement on logarithmic axes, one line per curve.

        Hollow markers are errors at round-off, which the fitted order leaves out. path: file to write (PNG, SVG, PDF).
        Returns the figure. Raises InputError for another suffix, MissingPackageError without matplotlib.

        Examples
        --------
        >>> study = bf.converge(lambda n: 1.0 + 1.0 / n**2, refine="n", n=[4, 8, 16, 32], reference=1.0)
        >>> figure = study.plot("convergence.png")
        """
        from beamfem.convergence.convergence_page import plot_errors

        return plot_errors(self, path)

    def to_html(self, path: str | PathLike[str]) -> Path:
        """Write an HTML page with picture and tables, a single file that works offline, and return its path.

        Raises MissingPackageError without matplotlib.
        """
        from beamfem.convergence.convergence_page import write_study

        return write_study(self, path)


def _short(number: float, form: str) -> str:
    return "" if np.isnan(number) else f"{number:{form}}"
