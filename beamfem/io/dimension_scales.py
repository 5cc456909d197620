"""Arrays over dimension scales in HDF5 files, as netCDF has them.

They are made with the low-level functions of h5py, in half the time: a model has some of them for each beam.
"""

from functools import lru_cache
from typing import Any

import numpy as np


def array(group: Any, name: str, shape: tuple[int, ...], meaning: str, unit: str) -> Any:
    """Return a new array of floats with the attributes `long_name` and `units`."""
    from h5py import Dataset, h5d, h5s, h5t  # slow to import, and need not be installed

    made = h5d.create(group.id, name.encode(), h5t.NATIVE_DOUBLE, h5s.create_simple(shape), _plain())
    _describe(made, "long_name", meaning)
    _describe(made, "units", unit)
    return Dataset(made)


def scale(group: Any, name: str, values: np.ndarray, meaning: str, unit: str) -> Any:
    """Return a new dimension scale."""
    from h5py import h5ds

    result = array(group, name, values.shape, meaning, unit)
    write(result, values)
    h5ds.set_scale(result.id, name.encode())
    return result


def variable(group: Any, name: str, meaning: str, unit: str, scales: tuple[Any, ...]) -> Any:
    """Return a new array over dimension scales."""
    from h5py import h5ds

    result = array(group, name, tuple(len(over) for over in scales), meaning, unit)
    for dimension, over in enumerate(scales):
        h5ds.attach_scale(result.id, over.id, dimension)
    return result


def write(dataset: Any, values: np.ndarray, rows: slice = slice(None)) -> None:
    """Write values into some rows of an array, or all."""
    from h5py import h5s

    if dataset.shape == values.shape:
        dataset.id.write(h5s.ALL, h5s.ALL, np.ascontiguousarray(values, dtype=float))
    else:
        dataset[rows] = values


@lru_cache(maxsize=1)
def _plain() -> Any:
    """Return the properties of new arrays: files do not tell when they were made."""
    from h5py import h5p

    properties = h5p.create(h5p.DATASET_CREATE)
    properties.set_obj_track_times(False)
    return properties


@lru_cache(maxsize=1)
def _kind_of_text() -> Any:
    """Return the type and the shape of a text in a file."""
    from h5py import h5s, h5t, string_dtype

    return h5t.py_create(string_dtype(), logical=True), h5s.create(h5s.SCALAR)


def _describe(made: Any, name: str, text: str) -> None:
    from h5py import h5a, string_dtype

    h5a.create(made, name.encode(), *_kind_of_text()).write(np.array(text, dtype=string_dtype()))
