"""The polynomials of the fields, taken from the elements themselves."""

import matplotlib.pyplot as plt
import numpy as np

import beamfem as bf

XI = np.linspace(0.0, 1.0, 201)


def curves(axes, table, nodes, labels, title):
    for values, label in zip(table.T, labels, strict=True):
        axes.plot(XI, values, linewidth=1.6, label=label)
    axes.plot(nodes, np.zeros(len(nodes)), "o", color="#222222", markersize=5, clip_on=False, zorder=5)
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    axes.set(xlabel=r"$\xi$", title=title, xlim=(0, 1))
    axes.legend(fontsize=9)


def main():
    cubic, third = bf.Cubic(), bf.Lagrange(order=3)
    figure, grid = plt.subplots(1, 3, figsize=(10.5, 3.2), layout="constrained")
    names = [
        r"$N_1$ of $\mathbf{r}$",
        r"$N_2/l$ of $\mathbf{r}_x$",
        r"$N_3$ of $\mathbf{r}$",
        r"$N_4/l$ of $\mathbf{r}_x$",
    ]
    curves(grid[0], cubic.centreline(XI), cubic.nodes, names, r"Cubic(): $\mathbf{r}_0$")
    curves(grid[1], cubic.director(XI), cubic.nodes, ["$D_1$", "$D_2$"], r"Cubic(): $\mathbf{d}$")
    names = [rf"$N_{{{number}}}$" for number in range(1, 5)]
    curves(grid[2], third.centreline(XI), third.nodes, names, r"Lagrange(3): $\mathbf{r}_0$ and $\mathbf{d}$")
    figure.savefig("fields.png", dpi=110)


if __name__ == "__main__":
    main()
