"""Make the mesh files of this folder; see README.md for what each is and where its numbers come from."""

from collections.abc import Mapping
from pathlib import Path

import meshio
import numpy as np

FOLDER = Path(__file__).parent


def gmsh(path: Path, points: np.ndarray, curves: Mapping[str, np.ndarray], places: Mapping[str, list[int]]) -> None:
    """Write a binary Gmsh file (2.2) with physical groups of curves (cells (m, 2 or 3)) and of points."""
    cells, tags, names = [], [], {}
    for number, (name, table) in enumerate(curves.items(), start=1):
        cells.append(("line3" if table.shape[1] == 3 else "line", table))
        tags.append(np.full(len(table), number, dtype=np.int32))
        names[name] = np.array([number, 1])
    for number, (name, nodes) in enumerate(places.items(), start=1):
        cells.append(("vertex", np.array(nodes)[:, None]))
        tags.append(np.full(len(nodes), number, dtype=np.int32))
        names[name] = np.array([number, 0])
    spatial = np.column_stack([points, np.zeros(len(points))])
    data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
    meshio.write(path, meshio.Mesh(spatial, cells, cell_data=data, field_data=names), "gmsh22", binary=True)


def row(nodes: list[int]) -> np.ndarray:
    """Return the lines from node to node (m, 2)."""
    return np.column_stack([nodes[:-1], nodes[1:]])


def portal(path: Path) -> None:
    """Portal frame 4 m high and 6 m wide; each column in 2 lines, the beam in 4."""
    points = [(0, 0), (0, 2), (0, 4), (1.5, 4), (3, 4), (4.5, 4), (6, 4), (6, 2), (6, 0)]
    curves = {"columns": np.vstack([row([0, 1, 2]), row([8, 7, 6])]), "beam": row([2, 3, 4, 5, 6])}
    gmsh(path, np.array(points, dtype=float), curves, {"feet": [0, 8], "corners": [2, 6], "midspan": [4]})


def lee_frame(path: Path) -> None:
    """Lee's frame [cm]: column and beam of 120, the load 24 from the corner."""
    points = np.array([(0, 0), (0, 120), (24, 120), (120, 120)], dtype=float)
    gmsh(path, points, {"column": row([0, 1]), "beam": row([1, 2, 3])}, {"hinges": [0, 3], "load": [2]})


def arch(path: Path, lines: int = 48) -> None:
    """Circular arch of 215 degrees and R = 1 about the origin, from its left foot over the crown, in parabolas."""
    turn = np.radians(215.0)
    angle = 0.5 * np.pi + turn * (0.5 - np.arange(2 * lines + 1) / (2 * lines))
    points = np.column_stack([np.cos(angle), np.sin(angle)])
    first = 2 * np.arange(lines)
    curves = {"arch": np.column_stack([first, first + 2, first + 1])}
    gmsh(path, points, curves, {"left": [0], "crown": [lines], "right": [2 * lines]})


def lattice(path: Path, columns: int = 41, rows: int = 41) -> None:
    """Square lattice of columns x rows cells of 1 m with one diagonal each, which alternates."""
    number = np.arange((columns + 1) * (rows + 1)).reshape(rows + 1, columns + 1)
    points = np.column_stack([number.ravel() % (columns + 1), number.ravel() // (columns + 1)]).astype(float)
    rising = (np.add.outer(np.arange(rows), np.arange(columns)) % 2).astype(bool)
    diagonals = [
        np.column_stack([number[:-1, :-1][rising], number[1:, 1:][rising]]),
        np.column_stack([number[:-1, 1:][~rising], number[1:, :-1][~rising]]),
    ]
    kinds = [
        np.column_stack([number[:, :-1].ravel(), number[:, 1:].ravel()]),
        np.column_stack([number[:-1].ravel(), number[1:].ravel()]),
        np.vstack(diagonals),
    ]
    edge = np.zeros(len(points), dtype=np.int32)
    edge[number[0]], edge[number[-1]] = 1, 2
    mesh = meshio.Mesh(
        np.column_stack([points, np.zeros(len(points))]),
        [("line", np.vstack(kinds))],
        cell_data={"direction": [np.repeat(np.arange(1, 4, dtype=np.int32), [len(kind) for kind in kinds])]},
        point_data={"edge": edge},
    )
    meshio.write(path, mesh, "vtu", binary=True, compression="zlib")


def main() -> None:
    """Write all files."""
    portal(FOLDER / "portal.msh")
    lee_frame(FOLDER / "lee_frame.msh")
    arch(FOLDER / "arch215.msh")
    lattice(FOLDER / "lattice.vtu")


if __name__ == "__main__":
    main()
