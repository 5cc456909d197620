"""A beam of fibres programmed independently: two-node elements after Reissner, one point each, dense Newton."""

import numpy as np

MODULUS, HARDENING, LIMIT, SIDE, POISSON = 2.1e11, 2.1e9, 2.5e8, 0.01, 0.3
FIBRES = 5
PLACES = SIDE * ((np.arange(FIBRES) + 0.5) / FIBRES - 0.5)
SHEAR = 5 / 6 * MODULUS / 2 / (1 + POISSON) * SIDE**2


def strains(q, length):
    """Return axial strain, shear and curvature (elements,) for coordinates (elements, 6): ux, uy, rotation."""
    along, across = 1.0 + (q[:, 3] - q[:, 0]) / length, (q[:, 4] - q[:, 1]) / length
    turn = 0.5 * (q[:, 2] + q[:, 5])
    axial = along * np.cos(turn) + across * np.sin(turn) - 1.0
    return axial, across * np.cos(turn) - along * np.sin(turn), (q[:, 5] - q[:, 2]) / length, turn


def fibres(axial, curvature, past):
    """Return stresses (elements, fibres) and the flow of the plastic strains."""
    strain = axial[:, None] - PLACES * curvature[:, None]
    trial = MODULUS * (strain - past) - HARDENING * past
    flow = (trial - np.sign(trial.real) * LIMIT) / (MODULUS + HARDENING)
    flow = np.where(np.abs(trial.real) > LIMIT, flow, 0.0)
    return MODULUS * (strain - past - flow), flow


def forces(q, past, length):
    """Return the nodal forces (elements, 6) and the axial forces (elements,)."""
    axial, shear, curvature, turn = strains(q, length)
    stress, _ = fibres(axial, curvature, past)
    normal, moment = stress.sum(axis=1) * SIDE**2 / FIBRES, -(stress @ PLACES) * SIDE**2 / FIBRES
    cut = SHEAR * shear
    x, y = normal * np.cos(turn) - cut * np.sin(turn), normal * np.sin(turn) + cut * np.cos(turn)
    half = 0.5 * length * (normal * shear - cut * (1.0 + axial))
    return np.stack([-x, -y, half - moment, x, y, half + moment], axis=1), normal


def axial_force(lift, steps, elements):
    """Return the mean axial force [N] of a bar of 1 m between clamps, one of which is moved across by `lift` [m]."""
    length, size = 1.0 / elements, 3 * elements + 3
    dof, free = 3 * np.arange(elements)[:, None] + np.arange(6), np.arange(3, size - 3)
    x = np.linspace(0.0, 1.0, elements + 1)
    q, past, change = np.zeros(size), np.zeros((elements, FIBRES)), np.zeros(size)
    change[1::3], change[2::3] = lift / steps * (3 * x**2 - 2 * x**3), lift / steps * 6 * (x - x**2)
    for step in range(1, steps + 1):
        before = q.copy()
        q += change
        q[-2] = lift * step / steps
        for _ in range(60):
            residual = np.bincount(dof.ravel(), forces(q[dof], past, length)[0].ravel(), size)
            tangent = np.zeros((size, size))
            for column in range(6):
                moved = q[dof].astype(complex)
                moved[:, column] += 1e-30j
                np.add.at(tangent, (dof, dof[:, [column]]), forces(moved, past, length)[0].imag / 1e-30)
            correction = np.linalg.solve(tangent[np.ix_(free, free)], -residual[free])
            q[free] += correction
            if np.abs(correction).max() < 1e-10:
                break
        else:
            raise ArithmeticError(f"step {step} does not converge")
        change = q - before
        axial, _, curvature, _ = strains(q[dof], length)
        normal = forces(q[dof], past, length)[1]
        past = past + fibres(axial, curvature, past)[1]
    return normal.mean()
