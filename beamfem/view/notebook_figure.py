"""Figures that notebooks display once, with any backend of matplotlib."""

import sys
from io import BytesIO

from matplotlib.figure import Figure

_DOTS_PER_INCH = 110


class ShownFigure(Figure):
    """A figure that a notebook displays at the end of a cell."""

    def _repr_png_(self) -> bytes:
        """Return the picture, as notebooks ask for it."""
        out = BytesIO()
        self.savefig(out, format="png", dpi=_DOTS_PER_INCH)
        return out.getvalue()

    def _ipython_display_(self) -> None:
        """Display the figure as the value of a cell; pyplot, which displays its figures after a cell, lets it go."""
        from IPython.display import display

        display({"image/png": self._repr_png_(), "text/plain": repr(self)}, raw=True)
        if "matplotlib.pyplot" in sys.modules:
            sys.modules["matplotlib.pyplot"].close(self)
