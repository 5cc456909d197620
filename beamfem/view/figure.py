"""Figures that show themselves in notebooks, whatever backend matplotlib has there."""

from io import BytesIO

from matplotlib.figure import Figure

_DOTS_PER_INCH = 110


class ShownFigure(Figure):
    """A figure that a notebook shows at the end of a cell."""

    def _repr_png_(self) -> bytes:
        """Return the picture, as notebooks ask for it."""
        out = BytesIO()
        self.savefig(out, format="png", dpi=_DOTS_PER_INCH)
        return out.getvalue()
