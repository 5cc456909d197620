"""The solid body with PyVista: a picture without a window, or a window with a slider over the steps."""

from collections.abc import Sequence
from importlib.util import find_spec
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from beamfem.atomic_write import whole
from beamfem.cached_properties import cached_property
from beamfem.errors import InputError, warn
from beamfem.mesh.reference import sections_at
from beamfem.progress import in_notebook
from beamfem.results.axis_points import AxisPoints
from beamfem.results.solution import Solution
from beamfem.validation import count, items, number_below, shown
from beamfem.view.animation import slider
from beamfem.view.deformed_shapes import FIELD_COLOURS, Shapes
from beamfem.view.drawing import plot_shapes
from beamfem.view.frames import moment_of, spread_rows
from beamfem.view.notebook_paths import file_to_write
from beamfem.view.player import write_player
from beamfem.view.rendering import ADVICE, can_render, has_display, no_display_needed

_POINTS = 6000  # of all beams
_ROWS = 400  # that the slider knows
_LARGEST_SIDE = 16384  # [pixels], of what graphics cards render
_NOTHING = 1e-9  # of the largest value: round-off of a zero
_PLAIN = "#6699BB"
_STRONG, _PALE = (0x66, 0x99, 0xBB), (0xC4, 0xD6, 0xE3)  # of layers in turn


def picture(
    solution: Solution,
    path: str | PathLike[str] | None = None,
    row: int = -1,
    colour: str | None = None,
    size: tuple[int, int] = (1400, 900),
) -> Path:
    """Write a picture (.png) of the solid body in a row, off screen; return its path, see `Solution.picture`."""
    target = file_to_write(path, "a picture of the body", ".png", example="body.png")
    number = number_below("row", row, len(solution), -len(solution)) % len(solution)
    _require_size(size)
    if not can_render():
        warn(f"VTK cannot render here, so {target} is drawn flat by matplotlib; {ADVICE}")
        plot_shapes(solution[number : number + 1], target, colour)
        return target
    scene = _Scene(Shapes(solution, np.array([number]), colour, _POINTS), off_screen=True, size=size)
    scene.show_row(0)
    scene.look()
    with whole(target) as partial:
        scene.plotter.screenshot(str(partial))
    scene.plotter.close()
    return target


def show(solution: Solution, colour: str | None = None, size: tuple[int, int] = (1400, 900)) -> Any:
    """Open a window with the solid body and a slider over the steps, and wait until it is closed: `Solution.show`."""
    if len(solution) == 0:
        raise InputError("the solution has no rows, so there is nothing to show")
    _require_size(size)
    if in_notebook():
        return _below_cell(solution, colour, size)
    reason = "there is no display" if not has_display() else "" if can_render() else f"VTK cannot render; {ADVICE}"
    if reason:
        warn(f"no window can be opened: {reason}. A figure is returned; to_html writes a page with a slider")
        return plot_shapes(solution, colour=colour)
    plotter = slider_scene(solution, colour, size, off_screen=False)
    plotter.show()
    return plotter


def _below_cell(solution: Solution, colour: str | None, size: tuple[int, int]) -> Any:
    """Return a view for a notebook: of PyVista, pictures with a slider of ipywidgets, or a page with a slider."""
    if find_spec("pyvista"):
        import pyvista

        # since version 0.48, the backend is a package of its own
        backend = "trame_pyvista" if hasattr(pyvista, "register_jupyter_backend") else "trame_vtk"
        if find_spec(backend) and can_render():
            scene = slider_scene(solution, colour, size, off_screen=True)
            return scene.show(jupyter_backend="server", return_viewer=True)
    return slider(solution, colour) if find_spec("ipywidgets") else write_player(solution, colour=colour)


def slider_scene(solution: Solution, colour: str | None, size: tuple[int, int], off_screen: bool) -> Any:
    """Return a plotter of PyVista with the body and a slider over the steps."""
    rows = spread_rows(solution, _ROWS)
    scene = _Scene(Shapes(solution, rows, colour, _POINTS), off_screen, size)
    scene.show_row(len(rows) - 1)
    scene.look()
    if len(rows) > 1:
        scene.plotter.add_slider_widget(
            lambda value: scene.show_row(round(value)),
            (0, len(rows) - 1),
            value=len(rows) - 1,
            title="step",
            fmt="%.0f",
            pointa=(0.25, 0.08),
            pointb=(0.75, 0.08),
            style="modern",
            interaction_event="always",
        )
    return scene.plotter


class _Scene:
    """A plotter with one surface whose points follow the row that is shown."""

    def __init__(self, shapes: Shapes, off_screen: bool, size: tuple[int, int]) -> None:
        import pyvista

        self.shapes = shapes
        self.surface = pyvista.PolyData(
            self._points(0), _faces(shapes.points, [len(parts) for parts in self._parts(0)])
        )
        with no_display_needed():
            self.plotter = pyvista.Plotter(off_screen=off_screen, window_size=list(size))
        self.plotter.set_background("white")
        self.plotter.enable_anti_aliasing("ssaa")
        options: dict[str, Any] = {"color": _PLAIN}
        if shapes.quantity is None and any(len(layers) > 1 for layers in shapes.layers):
            # neighbouring layers differ in strength
            numbers = [np.repeat(np.arange(len(layers)), 4 * layers[0].shape[1]) for layers in shapes.layers]
            self.surface["layer"] = np.array([_STRONG, _PALE], dtype=np.uint8)[np.concatenate(numbers) % 2]
            options = {"scalars": "layer", "rgb": True}
        if shapes.quantity is not None:
            self.surface["field"] = self._values(0)
            title = f"{shapes.label}\n"  # away from the topmost number
            least = _NOTHING * max(map(abs, shapes.limits))
            clim = [0.0 if abs(limit) < least else shapes.factor * limit for limit in shapes.limits]
            bar = {"title": title, "color": "black", "vertical": True, "position_x": 0.88, "position_y": 0.25,
                   "height": 0.5, "width": 0.05, "n_labels": 5, "fmt": "%.4g", "title_font_size": 18,
                   "label_font_size": 16}  # fmt: skip
            options = {"scalars": "field", "cmap": FIELD_COLOURS, "clim": clim, "scalar_bar_args": bar}
        self.plotter.add_mesh(self.surface, smooth_shading=False, specular=0.2, ambient=0.25, **options)

    @cached_property
    def widths(self) -> list[np.ndarray]:
        """Width out of the plane at each point of each beam (points,) [m]."""
        return [_width(points) for points in self.shapes.points]

    def show_row(self, order: int) -> None:
        """Move the surface to a row and name it in the corner."""
        self.surface.points = self._points(order)
        if self.shapes.quantity is not None:
            self.surface["field"] = self._values(order)
        text = moment_of(self.shapes.solution, int(self.shapes.rows[order]))
        # notebooks have their buttons on the left
        self.plotter.add_text(text, name="row", position="upper_edge", color="black", font_size=11)

    def look(self) -> None:
        """Look at the plane of the beams from slightly above and beside, at every row in full."""
        low, high = self.shapes.box
        width = max(float(np.concatenate(self.widths).max()), 1e-6 * float(np.max(high - low)))
        bounds = (low[0], high[0], low[1], high[1], -width, width)
        self.plotter.enable_parallel_projection()
        self.plotter.view_vector((0.25, 0.35, 1.0), viewup=(0.0, 1.0, 0.0))
        self.plotter.reset_camera(bounds=bounds)
        self.plotter.camera.zoom(1.3 if self.shapes.quantity is None else 1.1)  # a colour bar stands beside the body
        self.plotter.add_axes(color="black", zlabel="")

    def _parts(self, order: int) -> list[list[np.ndarray]]:
        """Two faces (points, 2 faces, 2) [m] of the parts of each beam: layers, or the strips of a field."""
        if self.shapes.quantity is None:
            return [[faces[order] for faces in layers] for layers in self.shapes.layers]
        return [[faces for faces, _ in strips] for strips in self.shapes.strips(order)]

    def _points(self, order: int) -> np.ndarray:
        """Four corners of the section at each point: below and above, behind and before (points * 4, 3)."""
        parts = self._parts(order)
        flat = np.concatenate([faces for of_beam in parts for faces in of_beam])
        widths = [np.tile(width, len(of_beam)) for width, of_beam in zip(self.widths, parts, strict=True)]
        z = 0.5 * np.concatenate(widths)[:, None, None] * np.array([-1.0, 1.0])
        corners = np.empty((len(flat), 2, 2, 3))
        corners[..., :2], corners[..., 2] = flat[:, :, None], z
        return corners.reshape(-1, 3)

    def _values(self, order: int) -> np.ndarray:
        """The field at these corners (points * 4,)."""
        fields = [field.ravel() for strips in self.shapes.strips(order) for _, field in strips]
        return self.shapes.factor * np.repeat(np.concatenate(fields), 2)


def _width(points: AxisPoints) -> np.ndarray:
    """Return the width out of the plane [m]: area over height, or the height for sections without an area."""
    height = points.faces[:, 1] - points.faces[:, 0]
    sections = sections_at(points.mesh, points.element, points.xi)
    area = np.array([getattr(section, "area", 0.0) for section in sections])
    return np.where(area > 0.0, area / height, height)


def _faces(points: Sequence[AxisPoints], counts: Sequence[int]) -> np.ndarray:
    """Quadrilaterals of the surface as PyVista counts them: four sides of each piece of a part, and its caps."""
    faces = []
    first = 0
    parts = [own for own, count in zip(points, counts, strict=True) for _ in range(count)]
    # corners of a section: 0 below behind, 1 below before, 2 above behind, 3 above before
    sides = np.array([(0, 1, 5, 4), (2, 6, 7, 3), (1, 3, 7, 5), (0, 4, 6, 2)])
    for own in parts:
        number = len(own.xi)
        within = np.arange(number - 1)
        # two points stand at the common end of two elements
        start = within[(within + 1) % (own.pieces + 1) != 0]
        faces.append((4 * (first + start)[:, None, None] + sides).reshape(-1, 4))
        last = 4 * (first + number - 1)
        faces.append(np.add([[4 * first], [last]], [(0, 2, 3, 1), (0, 1, 3, 2)]))
        first += number
    table = np.concatenate(faces)
    return np.column_stack([np.full(len(table), 4), table]).ravel()


def _require_size(size: Any) -> None:
    """Raise InputError unless the size is a width and a height that can be rendered."""
    sides = [count("size", side) for side in items("size", size)]
    if len(sides) != 2 or max(sides) > _LARGEST_SIDE:
        raise InputError(f"size is a width and a height of at most {_LARGEST_SIDE} pixels, got {shown(size)}")
