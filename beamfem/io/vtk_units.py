"""Units of the fields of ParaView files, by their names in SI."""

UNITS = {
    "points": "m",
    "displacement": "m",
    "velocity": "m/s",
    "rotation": "rad",
    "stress_xx": "Pa",
    "stress_xy": "Pa",
    "von_mises_stress": "Pa",
    "cauchy_stress": "Pa",
    "second_piola_kirchhoff_stress": "Pa",
    "normal_force": "N",
    "shear_force": "N",
    "bending_moment": "N m",
    "force": "N",
    "moment": "N m",
    "line_force": "N/m",
    "acceleration": "m/s^2",
    "stiffness": "N/m, N/m, N m/rad",
}  # what is not here is a number without a unit
