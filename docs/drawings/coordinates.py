"""One bent element with its nodal vectors, for each choice of coordinates: what is free and what follows."""

import matplotlib.pyplot as plt
import numpy as np

import beamfem as bf

SOFT = bf.Material(youngs_modulus=1e6, poisson_ratio=0.3, density=1000.0)
BLUE, RED, INK = "#0077BB", "#CC3311", "#222222"
KINDS = (
    ("Gradients()", bf.ANCF(), "$\\mathbf{r}$, $\\mathbf{r}_x$, $\\mathbf{r}_y$"),
    ("Rotation()", bf.ANCFCRBF(), "$\\mathbf{r}$, $\\mathbf{r}_x$, $\\theta$"),
    ("ShearFree()", bf.ShearRigid(), "$\\mathbf{r}$, $\\theta$, $|\\mathbf{r}_x|$"),
)


def bent(element):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 1, element, bf.Rectangle(0.05, 0.12), SOFT)
    turned = bf.Prescribed(beam.end, ux=-0.15, uy=0.3, rotation=1.0)
    return beam, bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start), turned]))


def main():
    figure, grid = plt.subplots(1, 3, figsize=(10.5, 3.4), layout="constrained")
    for axes, (name, element, unknown) in zip(grid, KINDS, strict=True):
        beam, solution = bent(element)
        at = [beam.at(float(fraction)) for fraction in np.linspace(0.0, 1.0, 41)]
        x, y = np.array([solution.position(point)[-1] for point in at]).T
        axes.plot(x, y, color=INK, linewidth=2.0)
        for point, place in ((beam.start, (0.0, 0.0)), (beam.end, (x[-1], y[-1]))):
            found = solution.fields(point)
            for vector, colour, label in ((found.r_x[-1], BLUE, "x"), (found.r_y[-1], RED, "y")):
                axes.quiver(*place, *vector, color=colour, angles="xy", scale_units="xy", scale=3.2, width=0.012)
                axes.text(*(np.array(place) + 0.38 * vector), rf"$\mathbf{{r}}_{label}$", color=colour, fontsize=11)
            axes.plot(*place, "o", color=INK, markersize=6)
        axes.set_title(f"{name}\n{unknown}", fontsize=11)
        axes.set_aspect("equal")
        axes.axis("off")
        axes.set(xlim=(-0.15, 1.15), ylim=(-0.2, 0.8))
    figure.savefig("coordinates.png", dpi=110)


if __name__ == "__main__":
    main()
