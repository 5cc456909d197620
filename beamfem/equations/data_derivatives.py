"""Derivatives of the residual by the data of any part of a model: sections, materials, curves, loads and supports."""

from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass, replace
from typing import Any, NamedTuple
from warnings import catch_warnings, simplefilter

import numpy as np

from beamfem.equations.bound_connector import COMPLEX_STEP, Connector, Motion
from beamfem.equations.connectors import connectors_of
from beamfem.equations.equations import residual
from beamfem.equations.system import System, system_of
from beamfem.errors import InputError
from beamfem.model.model import Model
from beamfem.physics.compiled_connections import in_python
from beamfem.validation import shown

Place = tuple[object, str]  # a part of a model, such as a section, and the name of one of its fields
_STEP = 1e-3
_SHARED = {"supports", "loads", "connectors", "masses"}  # the lists of a model without which its mesh is the same
_DIFFERENCES = (  # offset and weight, of fourth order: central, and to one side where the other has no valid data
    ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12)),
    ((0, -25 / 12), (1, 4.0), (2, -3.0), (3, 4 / 3), (4, -1 / 4)),
    ((0, 25 / 12), (-1, -4.0), (-2, 3.0), (-3, -4 / 3), (-4, 1 / 4)),
)


class DataDerivative(NamedTuple):
    """Derivatives by the k numbers of a field, at fixed free coordinates.

    residual (n, k): of the residual, whose prescribed coordinates move along; state (n, k): of the coordinates, which
    change where supports prescribe them.
    """

    residual: np.ndarray
    state: np.ndarray


def varied(model: Model, change: np.ndarray, *places: Place) -> Model:
    """Return the model with `change` (k,) added to the k numbers of fields, wherever the parts stand in it.

    The model is otherwise the same. Raises InputError for data that is invalid, or that the model does not have.
    """
    new: dict[int, Any] = {id(part): _Fields() for part, _ in places}
    for part, name in places:
        values = _numbers(part, name)
        new[id(part)][name] = _tuples((values + change.reshape(values.shape)).tolist())
    found = {each.name: _rebuilt(getattr(model, each.name), new) for each in fields(model)}
    changes = {name: value for name, value in found.items() if value is not getattr(model, name)}
    for part, _ in places:
        if isinstance(new[id(part)], _Fields):
            raise InputError(f"{shown(part)} is no part of the model, or only a function refers to it")
    return model.with_(**changes) if changes.keys() <= _SHARED else replace(model, **changes)


def _numbers(part: object, name: str) -> np.ndarray:
    """Return the numbers of a field. Raises InputError for other fields."""
    if is_dataclass(part) and name in {each.name for each in fields(part)}:
        values = np.array(getattr(part, name), dtype=object)
        if values.size and all(type(value) in (int, float) for value in values.ravel()):
            return values.astype(float)
    raise InputError(f"{name} of {type(part).__name__} is no field of numbers, so that there is no derivative by it")


def _tuples(values: Any) -> Any:
    return tuple(map(_tuples, values)) if isinstance(values, list) else values


class _Fields(dict[str, Any]):
    """New values of fields of a part, by name."""


def _rebuilt(item: Any, new: dict[int, Any]) -> Any:
    """Return a part with all that it consists of; `new` has `_Fields` by the id of a part, and takes up what is done.

    Parts that were one object stay one.
    """
    known = new.get(id(item))
    if known is not None and not isinstance(known, _Fields):
        return known
    if isinstance(item, tuple | list):
        parts = [_rebuilt(part, new) for part in item]
        if all(one is other for one, other in zip(parts, item, strict=True)):
            return item
        return type(item)(*parts) if hasattr(item, "_fields") else type(item)(parts)
    if not is_dataclass(item) or isinstance(item, type):
        return item
    before = {each.name: getattr(item, each.name) for each in fields(item) if each.init}
    after = {name: _rebuilt(value, new) for name, value in before.items()} | (known or {})
    changes = {name: value for name, value in after.items() if value is not before[name]}
    new[id(item)] = item if known is None and not changes else replace(item, **changes)
    return new[id(item)]


def residual_derivative(system: System, state: Motion, time: float, *places: Place) -> DataDerivative:
    """Return the derivatives of `residual` in a state p, p', p'' (n,) by a field, such as (section, "area").

    Several places are changed by the same numbers, as the ends of curves that meet in a node. It is exact for parts at
    points with forces that are analytic (complex steps), and for data that enters as a polynomial up to degree 4, as
    stiffness and loads do; otherwise of fourth order in a relative 1e-3, of an element's length for curves. Tables are
    made anew where the data is theirs: with other loads, none is. p' and p'' are fixed, also where they are prescribed.
    Raises InputError for data that is no number, for parts that the model does not have, and if the coordinates of the
    model depend on the data.
    """
    inside = _by_complex_steps(system, state, time, places)
    if inside is not None:
        return DataDerivative(inside, np.zeros_like(inside))

    def sample(model: Model) -> np.ndarray:
        other = system_of(model, system.static)
        if other.model.size != system.model.size:
            raise InputError(f"the model has other coordinates with another {places[0][1]}")
        moved, turns = _moved(system, other, state, time)
        result = residual(other, *moved, time)
        for dofs, turn in turns:
            result[dofs] = turn.T @ result[dofs]
        return np.array([result, moved[0]])

    columns = np.stack(list(_differences(system, sample, places)), axis=-1)
    return DataDerivative(columns[0], columns[1])


def _differences(system: System, sample: Callable[[Model], np.ndarray], places: tuple[Place, ...]) -> Iterator[Any]:
    """Yield the derivatives of what `sample` returns for a varied model, by each number."""
    values = _numbers(*places[0]).ravel()
    size = float(np.abs(values).max()) or 1.0
    if any(_rebuilt(beam.curve, {id(places[0][0]): _Fields()}) is not beam.curve for beam in system.model.beams):
        size = float(system.strain_scale.min())
    for number in range(len(values)):
        step = np.zeros(len(values))
        step[number] = _STEP * size
        yield _difference(system.model, sample, step, places) / step[number]


def _difference(
    model: Model, sample: Callable[[Model], np.ndarray], step: np.ndarray, places: tuple[Place, ...]
) -> np.ndarray:
    refused = None
    for rule in _DIFFERENCES:
        try:
            models = [(varied(model, offset * step, *places), weight) for offset, weight in rule]
        except InputError as error:
            refused = refused or error
        else:
            first = sample(models[0][0])  # which takes all that is constant out of the sum, to the last digit
            return np.asarray(sum(weight * (sample(each) - first) for each, weight in models[1:]))
    assert refused is not None
    raise refused


def _moved(system: System, other: System, state: Motion, time: float) -> tuple[Motion, list[tuple[list[int], Any]]]:
    """Return the state of a varied system with the same free coordinates, and by how much its rollers turn (2, 2).

    What a roller lets move and what it holds turn with its normal.
    """
    p, v, a = (values.copy() for values in state)
    held = dict(zip(system.prescribed_dofs.tolist(), system.prescribed_values(time).tolist(), strict=True))
    turns = []
    for dof, value in zip(other.prescribed_dofs.tolist(), other.prescribed_values(time).tolist(), strict=True):
        p[dof] += value - held.get(dof, value)
    supports = zip(system.model.point_supports, other.model.point_supports, strict=True)
    for one, changed in supports:
        if one.direction is None or changed.direction is None:
            continue
        mesh = system.model.mesh_of(one.point)
        named = mesh.coordinates_of(mesh.node_at(one.point.fraction))
        dofs, (c, s), (nx, ny) = [named["r^x"], named["r^y"]], changed.direction, one.direction
        turn = np.array([[c * nx + s * ny, c * ny - s * nx], [s * nx - c * ny, c * nx + s * ny]])
        p[dofs] = other.reference[dofs] + turn @ (state[0][dofs] - system.reference[dofs])
        v[dofs], a[dofs] = turn @ v[dofs], turn @ a[dofs]
        turns.append((dofs, turn))
    return (p, v, a), turns


def _by_complex_steps(system: System, state: Motion, time: float, places: tuple[Place, ...]) -> np.ndarray | None:
    """Return the derivatives (n, k) of the residual by data of parts at points, None for other data.

    Complex steps do not go past the place where a stop or a cable begins to act.
    """
    parts, gravity = {id(part) for part, _ in places}, system.connectors.gravity(time)
    items = [item for item in system.connectors.items if id(item.given) in parts]
    if system.model.frame is not None or parts != {id(item.given) for item in items}:
        return None
    if all(item.compiled is not None and item.compiled.compiled is None for item in items):

        def forces_for(number: int) -> Iterator[np.ndarray]:
            first = 0
            for item in items:
                yield _force_by_data(item, state, gravity, changes[number][first : first + len(item.data)])
                first += len(item.data)

        changes = list(_differences(system, lambda model: _data(system, model, parts), places))
    elif all(item.compiled is None and not hasattr(item.item, "__post_init__") for item in items):

        def forces_for(number: int) -> Iterator[np.ndarray]:
            return (_force_by_field(item, state, time, gravity, number, places) for item in items)
    else:
        return None
    result = np.zeros((_numbers(*places[0]).size, len(state[0])))
    try:
        for number, column in enumerate(result):
            for item, force in zip(items, forces_for(number), strict=True):
                np.add.at(column, item.all, force)
    except InputError:  # a force that takes no complex data
        return None
    return result.T


def _data(system: System, model: Model, parts: set[int]) -> np.ndarray:
    """Return the data of parts in a varied model. Raises InputError if their definition is another one."""
    pairs = zip(system.connectors.items, connectors_of(model, system.static).items, strict=True)
    chosen = [(item, other) for item, other in pairs if id(item.given) in parts]
    if any(item.compiled is not other.compiled for item, other in chosen):
        raise InputError(f"{chosen[0][0].name} has another definition with other data")
    return np.concatenate([other.data for _, other in chosen])


def _force_by_data(item: Connector, state: Motion, gravity: np.ndarray, change: np.ndarray) -> np.ndarray:
    """Return the change (d + k,) of the force of a part of the package for a change of its data."""
    assert item.compiled is not None
    q, v, a, own, turned, data, _ = item.numbers(state, gravity)
    stepped, result = data.astype(complex), np.zeros(len(item.all), dtype=complex)
    stepped[: len(change)] += 1j * COMPLEX_STEP * change
    in_python(item.compiled)(q, v, a, own, turned.ravel(), stepped, gravity, result)
    return result.imag / COMPLEX_STEP


def _force_by_field(
    item: Connector, state: Motion, time: float, gravity: np.ndarray, number: int, places: tuple[Place, ...]
) -> np.ndarray:
    """Return the derivative (d + k,) of the force of a part in Python by one number of its fields."""
    changes = {}
    for part, name in places:
        if part is item.given:
            values = _numbers(part, name).astype(complex)
            values.flat[number] += 1j * COMPLEX_STEP
            changes[name] = _tuples(values.tolist())
    kind: Any = item.item
    stepped = replace(item, item=replace(kind, **changes))
    with catch_warnings():
        simplefilter("error", np.exceptions.ComplexWarning)
        return stepped.force(item.at(state, time, gravity)).imag / COMPLEX_STEP
