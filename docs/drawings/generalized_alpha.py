"""What a step of the generalized-alpha method does to a linear oscillator: what it damps, how it slows down."""

import matplotlib.pyplot as plt
import numpy as np

COLOURS = ("#222222", "#0077BB", "#228833", "#CC3311")
RADII = (1.0, 0.9, 0.5, 0.0)


def amplification(radius, turn):
    """Return the matrix of a step for (u, h u', h^2 a) of u'' = -w^2 u; turn: w h."""
    alpha_m, alpha_f = (2.0 * radius - 1.0) / (radius + 1.0), radius / (radius + 1.0)
    gamma = 0.5 + alpha_f - alpha_m
    beta = 0.25 * (gamma + 0.5) ** 2
    square = turn**2
    after = np.array([[1.0, 0.0, -beta], [0.0, 1.0, -gamma], [(1.0 - alpha_f) * square, 0.0, 1.0 - alpha_m]])
    before = np.array([[1.0, 1.0, 0.5 - beta], [0.0, 1.0, 1.0 - gamma], [-alpha_f * square, 0.0, -alpha_m]])
    return np.linalg.solve(after, before)


def angle(matrix):
    """Return by how much a step turns the oscillation: that of the complex pair, the third value damps itself."""
    values = np.linalg.eigvals(matrix)
    return float(np.angle(values[np.argmax(values.imag)]))


def main():
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 3.2), layout="constrained")
    steps = np.logspace(-2.0, 2.0, 300)  # of a period
    for radius, colour in zip(RADII, COLOURS, strict=True):
        values = [np.linalg.eigvals(amplification(radius, 2.0 * np.pi * step)) for step in steps]
        left.semilogx(
            steps, [np.abs(own).max() for own in values], color=colour, label=rf"$\varrho_\infty = {radius:g}$"
        )
        short = np.linspace(0.005, 0.15, 60)
        turned = [angle(amplification(radius, 2.0 * np.pi * step)) for step in short]
        right.plot(short, 100.0 * (2.0 * np.pi * short / turned - 1.0), color=colour)
    left.set(
        xlabel="step / period", title="spectral radius: what is left of an amplitude after a step", ylim=(-0.03, 1.06)
    )
    right.set(xlabel="step / period", ylabel="%", title="error of the period")
    left.legend(fontsize=9)
    for axes in (left, right):
        axes.title.set_fontsize(11)
        axes.grid(True, color="0.9", linewidth=0.6)
    figure.savefig("generalized_alpha.png", dpi=110)


if __name__ == "__main__":
    main()
