"""Loads in a drawing: forces and moments as arrows, distributed forces as rows of them, gravity in a corner."""

from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.element.coordinates import across
from beamfem.model.load import factor, functions_along
from beamfem.model.loads import Gravity, ImposedStrain, LineLoad, Load, PointForce, PointMoment, Pressure
from beamfem.model.mesh import BeamMesh
from beamfem.model.reference import length_points
from beamfem.results.loading import loading
from beamfem.view import symbols
from beamfem.view.frames import one_row
from beamfem.view.held import Stamps
from beamfem.view.imposed import draw_imposed

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

FORCE = "#CC3311"
_LONGEST = 30.0  # arrow of the largest force [points of print]
_SHORTEST = 14.0
_ROW_OF_ARROWS = 11


def draw_loads(axes: Any, solution: "Solution", rows: np.ndarray) -> list[Any]:
    """Draw each load on that of the rows where it is largest, the last of equals; return what was drawn."""
    system, at = loading(solution)
    acting = []
    for load in solution.model.loads:
        weights = np.array([factor(load, float(at[row]), system.static) for row in rows])
        best = len(rows) - 1 - int(np.abs(weights[::-1]).argmax())
        if weights[best]:
            acting.append((load, float(weights[best]), int(rows[best])))
    forces = [item for item in acting if isinstance(item[0], PointForce)]
    drawn = _forces(axes, solution, forces) if forces else []
    imposed = [(load, weight, row) for load, weight, row in acting if isinstance(load, ImposedStrain)]
    drawn += draw_imposed(axes, solution, imposed, FORCE)
    stamps = Stamps()
    for load, weight, row in acting:
        if isinstance(load, PointMoment):
            span = 1.5 * np.pi * np.sign(load.moment * weight)
            at = one_row(solution, row).position(load.point)[0]
            arc, head = symbols.turn(0.25 * np.pi, span=float(span))
            stamps.add(at, arc, FORCE, 1.5)
            stamps.add(at, head, FORCE, 0.5, FORCE)
        elif isinstance(load, LineLoad):
            drawn += _distributed(axes, solution, load, weight, row)
        elif isinstance(load, Gravity):
            drawn += _gravity(axes, np.sign(weight) * np.array(load.vector))
    return [*drawn, *stamps.draw(axes, 18.0, 5.0)]


def _arrows(axes: Any, at: np.ndarray, vector: np.ndarray, pivot: str, width: float = 1.5) -> Any:
    """Draw arrows at places (n, 2) [m] of vectors (n, 2) [points of print]."""
    return axes.quiver(
        *at.T,
        *(vector / 72.0).T,
        angles="uv",
        units="inches",
        scale=1.0,
        scale_units="inches",
        width=width / 72.0,
        headwidth=4.5,
        headlength=5.5,
        headaxislength=5.0,
        minlength=0.1,
        color=FORCE,
        pivot=pivot,
        zorder=5.0,
    )


def force_at(only: "Solution", load: PointForce, weight: float) -> tuple[np.ndarray, np.ndarray, bool]:
    """Return place [m] and vector [N] of a force in a solution of one row, and whether an arrow's tip touches there."""
    vector = weight * np.array(load.vector)
    if load.follower:
        vector = _turned_by(vector, float(only.rotation(load.point)[0]))
    return only.position(load.point)[0], vector, _pushes(only, load, vector)


def _forces(axes: Any, solution: "Solution", items: list[tuple[Load, float, int]]) -> list[Any]:
    found = [force_at(one_row(solution, row), load, weight) for load, weight, row in items]  # type: ignore[arg-type]
    at, vector, push = (np.array([own[part] for own in found]) for part in range(3))
    size = np.linalg.norm(vector, axis=1)
    there = size > 0.0
    if not there.any():
        return []
    at, vector, push, size = at[there], vector[there], push[there], size[there]
    length = np.maximum(_LONGEST * np.sqrt(size / size.max()), _SHORTEST)
    vector = vector / size[:, None] * length[:, None]
    groups = ((push, "tip"), (~push, "tail"))
    return [_arrows(axes, at[some], vector[some], pivot) for some, pivot in groups if some.any()]


def _pushes(solution: "Solution", load: PointForce, vector: np.ndarray) -> bool:
    """Tell whether the arrow's tip touches the beam: inside it, and where the force presses on an end."""
    share = load.point.fraction
    if 0.0 < share < 1.0:
        return True
    r_x = solution.fields(load.point).r_x[0]
    outward = r_x if share == 1.0 else -r_x
    return bool(vector @ outward < -0.3 * np.linalg.norm(vector) * np.linalg.norm(r_x))


def _turned_by(vector: np.ndarray, angle: Any) -> np.ndarray:
    """Turn (2,) or (n, 2) by angles () or (n,) [rad]."""
    return np.cos(angle)[..., None] * vector + np.sin(angle)[..., None] * across(vector)


def _shares(load: LineLoad, mesh: BeamMesh) -> np.ndarray:
    """Return where along the beam arrows stand: spread evenly, and where a load that varies is largest."""
    even, length = np.linspace(0.0, 1.0, _ROW_OF_ARROWS), load.beam.curve.length
    if not functions_along(load):
        return even
    arc = mesh.arc_length(*length_points(mesh)[:2])
    sizes = [np.abs(load.values(at)).reshape(len(at), -1).max(axis=1) for at in (arc, even * length)]
    largest = arc[sizes[0].argmax()] / length
    return np.union1d(even, largest) if sizes[0].max() > sizes[1].max() else even


def forces_along(only: "Solution", load: LineLoad, weight: float) -> tuple[np.ndarray, np.ndarray]:
    """Return places (n, 2) [m] of arrows of a load along a beam in a solution of one row, and its vectors [N/m]."""
    shares = _shares(load, only.model.mesh_of(load.beam.start))
    points = [load.beam.at(share) for share in shares]
    places = np.array([only.position(point)[0] for point in points])
    values = weight * load.values(shares * load.beam.curve.length)
    if isinstance(load, Pressure):
        slope = np.array([only.fields(point).r_x[0] for point in points])
        vector = values[:, None] * across(slope)
    elif load.follower:
        vector = _turned_by(values, np.array([float(only.rotation(point)[0]) for point in points]))
    else:
        vector = values
    return places, vector


def _distributed(axes: Any, solution: "Solution", load: LineLoad, weight: float, row: int) -> list[Any]:
    from matplotlib.transforms import ScaledTranslation

    places, vector = forces_along(one_row(solution, row), load, weight)
    size = np.linalg.norm(vector, axis=1).max()
    if size == 0.0:
        return []
    vector = 0.7 * _LONGEST * vector / size
    drawn = [_arrows(axes, places, vector, "tip", 1.0)]
    if not isinstance(load, Pressure) and not load.follower and not callable(load.vector):
        foot = axes.transData + ScaledTranslation(
            -vector[0, 0] / 72.0, -vector[0, 1] / 72.0, axes.figure.dpi_scale_trans
        )
        drawn += axes.plot(*places.T, color=FORCE, linewidth=1.0, transform=foot, zorder=5.0)
    return drawn


def _gravity(axes: Any, vector: np.ndarray) -> list[Any]:
    size = np.linalg.norm(vector)
    if size == 0.0:
        return []
    # to the left of the upper right corner, which is left to the arrow
    at, ahead = np.array([0.955, 0.9]), vector / size
    arrow = axes.quiver(
        *at,
        *(26.0 * ahead / 72.0),
        angles="uv",
        units="inches",
        scale=1.0,
        scale_units="inches",
        width=1.5 / 72.0,
        headwidth=4.5,
        headlength=5.5,
        headaxislength=5.0,
        color=FORCE,
        pivot="mid",
        transform=axes.transAxes,
        zorder=5.0,
    )
    offset = -9.0 * np.abs(across(ahead))
    name = axes.annotate(
        "g",
        at,
        offset,
        xycoords="axes fraction",
        textcoords="offset points",
        ha="center",
        va="center",
        color=FORCE,
        fontstyle="italic",
        zorder=5.0,
    )
    return [arrow, name]
