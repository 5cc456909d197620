"""Frequency responses against closed forms: an oscillator, and a beam of Timoshenko."""

import warnings

import numpy as np
import pytest

import beamfem as bf
from beamfem.errors import UnstableWarning
from tests.equations.test_damped_modes import STEEL, oscillator

THICK = bf.Rectangle(0.1, 0.1)


def test_a_mass_with_spring_and_damper_responds_as_the_closed_form():
    model, frequencies = oscillator(50.0, 3.0, 1.0), np.linspace(0.0, 5.0, 41)
    push = bf.PointForce(model.beams[0].start, (1.0, 0.0))
    response = bf.frequency_response(model, push, ("ux", model.beams[0].start), frequencies)
    rate = 2.0 * np.pi * frequencies
    exact = 1.0 / (50.0 + 3.0j * rate - rate**2)
    assert np.abs(response.values / exact - 1.0).max() < 1e-6
    assert response.amplitude == pytest.approx(np.abs(exact), rel=1e-6)
    assert response.phase == pytest.approx(np.angle(exact), abs=1e-6)
    assert len(response) == 41


def timoshenko(frequency, x, force, moment):
    """Return deflection and rotation at x of a cantilever of length 1 under a harmonic force and moment at its end.

    (k G A (w' - t))' + w^2 rho A w = 0, (E I t')' + k G A (w' - t) + w^2 rho I t = 0, by their matrix exponential.
    """
    from scipy.linalg import expm

    rigidity, inertia = THICK.rigidity(STEEL), THICK.inertia(STEEL)
    square = (2.0 * np.pi * frequency) ** 2
    # y = (w, t, shear force, moment)
    matrix = np.zeros((4, 4))
    matrix[0, 1], matrix[0, 2] = 1.0, 1.0 / rigidity.shear
    matrix[1, 3] = 1.0 / rigidity.bending
    matrix[2, 0] = -square * inertia.mass
    matrix[3, 1], matrix[3, 2] = -square * inertia.rotary, -1.0
    start = np.linalg.solve(expm(matrix)[2:, 2:], [force, moment])
    return (expm(x * matrix)[:, 2:] @ start)[:2]


@pytest.mark.parametrize(("force", "moment"), [(1.0, 0.0), (0.0, 1.0)], ids=["force", "moment"])
def test_a_cantilever_responds_as_timoshenkos_beam(force, moment):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 12, bf.CRBF(4), THICK, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)])
    load = bf.PointForce(beam.end, (0.0, 1.0)) if force else bf.PointMoment(beam.end, 1.0)
    frequencies = np.array([0.0, 10.0, 50.0, 200.0, 700.0, 2000.0, 3000.0])
    for place in (1.0, 0.4):
        exact = np.array([timoshenko(f, place, force, moment) for f in frequencies])
        for quantity, expected in zip(("uy", "rotation"), exact.T, strict=True):
            response = bf.frequency_response(model, load, (quantity, beam.at(place)), frequencies)
            assert response.values == pytest.approx(expected, rel=1e-6)


def test_a_turned_and_bent_beam_responds_reciprocally():
    """Displacement at a by a force at b is that at b by a force at a, about any conservative state."""
    beam = bf.Beam(bf.Line((0, 0), (0.6, 0.8)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), STEEL)
    a, b = bf.PointForce(beam.at(0.5), (1.0, 0.0)), bf.PointForce(beam.end, (0.0, 1.0))
    loads = [bf.PointForce(beam.end, (20.0, -30.0)), bf.PointForce(beam.at(0.5), (0.0, 0.0))]
    stay = bf.SpringDamper(beam.end, (1.0, 0.0), 10.0, 4.0)
    model = bf.Model([beam], [bf.Clamp(beam.start)], loads, connectors=[stay])
    bent, frequencies = bf.solve_static(model), [0.0, 3.0, 20.0]
    one = bf.frequency_response(model, a, ("uy", beam.end), frequencies, about=bent)
    other = bf.frequency_response(model, b, ("ux", beam.at(0.5)), frequencies, about=bent)
    assert one.values == pytest.approx(other.values, rel=1e-8)
    straight = bf.frequency_response(model, a, ("uy", beam.end), frequencies)
    assert np.abs(straight.values / one.values - 1.0).max() > 1e-2


def test_an_actuator_drives_a_beam_at_resonance():
    """About a resonance, the response is that of one mode: force times shape over twice its damping."""
    viscous = bf.Material(2.1e11, 0.3, 7850.0, retardation_time=1e-5)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), viscous)
    model = bf.Model([beam], [bf.Clamp(beam.start)])
    modes = bf.solve_modes(model, 1)
    rate, bending = 2.0 * np.pi * modes.frequencies[0], bf.Rectangle(0.01, 0.01).rigidity(viscous).bending
    shape = modes.solution(0, amplitude=1e-4, frames=3)
    tip, turn = shape.displacement(beam.end)[0, 1], shape.rotation(beam.end)[0]
    size = (modes.modes[0] @ (shape.p[0] - modes.state.p)) / (modes.modes[0] @ modes.modes[0])
    response = bf.frequency_response(model, bf.Actuation(beam, curvature=1.0), ("uy", beam.end), modes.frequencies)
    expected = bending * turn * tip / size**2 / (1j * rate * 1e-5 * rate**2)
    assert response.values[0] == pytest.approx(expected, rel=1e-3)


def test_a_response_is_drawn(tmp_path):
    model = oscillator(50.0, 3.0)
    push = bf.PointForce(model.beams[0].start, (1.0, 0.0))
    response = bf.frequency_response(model, push, ("ux", model.beams[0].start), [3.0, 1.0, 2.0])
    figure = response.plot(tmp_path / "response.png")
    upper, lower = figure.axes
    assert upper.get_ylabel() == "displacement ux at (0, 0) [m]"
    assert lower.get_xlabel() == "frequency [Hz]"
    assert upper.lines[0].get_xdata().tolist() == [1.0, 2.0, 3.0]
    assert (tmp_path / "response.png").stat().st_size > 5000


def test_bad_input_is_named():
    model = oscillator(50.0, 3.0)
    start = model.beams[0].start
    push = bf.PointForce(start, (1.0, 0.0))
    for frequency in (-1.0, 1e200):
        with pytest.raises(bf.InputError, match="frequencies"):
            bf.frequency_response(model, push, ("ux", start), [frequency])
    with pytest.raises(bf.InputError, match="is infinite"):
        bf.frequency_response(bf.Model([model.beams[0]]), push, ("ux", start), [0.0])
    with pytest.raises(bf.InputError, match="loads of a Model cannot hold"):
        bf.frequency_response(model, start, ("ux", start), [0.0])


def test_default_elements_resolve_the_frequencies_that_are_asked_for():
    """They were refined for ten modes, and responses above these were off by up to the fourfold in silence."""
    steel, section = bf.Material(2.1e11, 0.3, 7850.0), bf.Rectangle(0.01, 0.01)

    def response(**mesh):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=section, material=steel, **mesh)
        push = bf.PointForce(beam.end, (0.0, 1.0))
        clamped = bf.Model([beam], [bf.Clamp(beam.start)])
        return bf.frequency_response(clamped, push, ("uy", beam.end), [6e3, 9e3, 15e3]).values

    assert response() == pytest.approx(response(elements=40, element=bf.CRBF(6)), rel=2e-3)


def test_frequencies_that_default_elements_cannot_resolve_are_refused():
    rubber = bf.Material(1e5, 0.3, 1000.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=bf.Rectangle(0.1, 0.1), material=rubber)
    clamped = bf.Model([beam], [bf.Clamp(beam.start)])
    with pytest.raises(bf.InputError, match=r"resolve 160 modes at most, here up to .* give the beams elements"):
        bf.frequency_response(clamped, bf.PointForce(beam.end, (0.0, 1.0)), ("uy", beam.end), [1e6])


def test_an_unstable_state_has_no_steady_response():
    column = bf.Beam(bf.Line((0, 0), (0, 1)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), bf.Material(2.1e11, 0.3, 7850.0))
    euler = np.pi**2 / 4.0 * column.section_at(0.0).rigidity(column.material).bending
    push = bf.PointForce(column.end, (1.0, 0.0))
    for factor, unstable in ((0.5, False), (2.0, True)):
        model = bf.Model([column], [bf.Clamp(column.start)], [bf.PointForce(column.end, (0.0, -factor * euler))])
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            state = bf.solve_static(model)[-1]
            found.clear()
            bf.frequency_response(model, push, ("ux", column.end), [1.0], about=state)
        assert [each.category for each in found] == [UnstableWarning] * unstable
