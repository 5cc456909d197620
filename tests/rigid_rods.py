"""Two uniform rigid rods of square section, one hinged to the ground and the other to its end, and their equations."""

import numpy as np

LENGTHS, DEPTH, AREA, DENSITY = (1.0, 0.7), 0.01, 1e-4, 7850.0


def double_pendulum(time, state, gravity=9.81, torque=0.0):
    """Rates of both angles from the x axis and of their velocities; torque: on the second rod, in the hinge between."""
    (first, second, w1, w2), (l1, l2) = state, LENGTHS
    m1, m2 = (DENSITY * AREA * length for length in LENGTHS)
    c, s = np.cos(first - second), np.sin(first - second)
    turning, height = m2 * l1 * l2 * c / 2, DEPTH**2 / 12
    matrix = [[m1 * (l1**2 / 3 + height) + m2 * l1**2, turning], [turning, m2 * (l2**2 / 3 + height)]]
    pull = gravity * np.array([(m1 / 2 + m2) * l1 * np.cos(first), m2 * l2 * np.cos(second) / 2])
    turned = m2 * l1 * l2 * s / 2 * np.array([w2**2, -(w1**2)])
    right = np.array([-torque, torque]) - turned - pull
    return np.array([w1, w2, *np.linalg.solve(matrix, right)])
