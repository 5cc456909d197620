"""What tests of meshes share: a section, a material, files written and read back."""

import meshio
import numpy as np

import beamfem as bf
from beamfem.io.line_mesh import read_mesh

SECTION = bf.Rectangle(0.1, 0.1)
STEEL = bf.Material(2e11, 0.3, 7850.0)
THREE = [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)]


def frame(mesh, elements=1, element=None, **options):
    return mesh.frame(elements, element or bf.CRBF(2), options.pop("section", SECTION), STEEL, **options)


def written(path, points, cells, **data):
    """Write a file with meshio and read it back."""
    options = {"file_format": "gmsh22", "binary": True} if path.suffix == ".msh" else {}
    meshio.write(path, meshio.Mesh(np.array(points, dtype=float), cells, **data), **options)
    return read_mesh(path)


def ends(mesh):
    """Corners of each line, whichever way it runs, in order."""
    return sorted(sorted(map(tuple, mesh.nodes[cell[:2]].tolist())) for cell in mesh.cells)
