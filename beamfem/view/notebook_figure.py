"""Figures that are displayed in notebooks with any matplotlib backend."""

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
