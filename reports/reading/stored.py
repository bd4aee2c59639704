"""A group of a result file: its attributes and data sets by their stored names, and records made of them."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import MISSING, fields
from functools import cached_property, lru_cache

import h5py
from h5py import h5a, h5d, h5g, h5s, h5t
import numpy as np

Column = np.ndarray     # [n], an entry per case or point
Between = np.ndarray    # [n - 1], an entry per neighboring two


class Stored:
    """What a group holds. KeyError or ValueError, with the group's name, where something is missing or ill-formed."""

    def __init__(self, group):
        self.group = group

    @cached_property
    def attributes(self):
        """{name: value} of all that there are."""
        return self.attributes_named("")

    def attributes_named(self, start):
        """{name: value} of those whose names begin so."""
        found = []
        h5a.iterate(self.group.id, found.append)
        return {name.decode(): _attribute(self.group, name) for name in found if name.startswith(start.encode())}

    def record(self, kind, **given):
        """A `kind`: each field of this dataclass that is not given is what is stored under its name, where it is text, a
        number or an array.

        Fields typed `Column` and `Between` are data sets, all others attributes. A field with a default may be missing;
        a column whose default is None is then NaN, for files of older versions lack it.
        """
        values, columns = dict(given), {}
        data_sets, attributes = _stored(kind)
        for field in data_sets:
            if field.name not in given:
                columns[field.name] = self._column(field, next(iter(columns.values()), None))
        for name, convert, default, optional in attributes:
            if name not in given:
                values[name] = convert(self.attribute(name, default, optional, _NUMBERS.get(convert)))
        return kind(**values, **columns)

    def attribute(self, name, default=None, optional=False, number=None):
        """The value of an attribute. `number`: int or float, for one that is known to be one is read faster."""
        try:
            value = _attribute(self.group, name.encode(), number)
        except KeyError:
            value = default
        if value is None and not optional:
            raise KeyError(f"{self.group.name}: no attribute {name}")
        return value

    def group_of(self, name):
        try:    # by the lower interface, in a third of the time
            return Stored(h5py.Group(h5g.open(self.group.id, name.encode())))
        except KeyError:
            raise KeyError(f"{self.group.name}: no group {name}") from None

    def _column(self, field, first):
        """A data set, as long as the `first`."""
        try:
            data = h5d.open(self.group.id, field.name.encode())
        except KeyError:
            if field.default is MISSING:
                raise KeyError(f"{self.group.name}: no dataset {field.name}") from None
            return np.full(len(first), np.nan)
        dtype, kind = _in_memory(data.get_type())
        values = np.empty(data.shape, dtype or data.dtype)
        data.read(h5s.ALL, h5s.ALL, values, kind)
        values = np.atleast_1d(values)
        n = len(values if first is None else first)
        expected = max(n - 1, 0) if field.type == "Between" else n
        if values.shape != (expected,):
            raise ValueError(f"{self.group.name}/{field.name}: shape {values.shape}, but {expected} entries belong to "
                             f"N of {n}")
        return values


@lru_cache(maxsize=None)
def _stored(kind):
    """The fields of a dataclass that are data sets, and (name, conversion, default, may be none) of its attributes."""
    return ([field for field in fields(kind) if field.type in ("Column", "Between")],
            [(field.name, _AS[field.type], None if field.default is MISSING else field.default, field.type in _OPTIONAL)
             for field in fields(kind) if field.type in _AS])


def _attribute(group, name, number=None):
    """The value of an attribute, by the lower interface of h5py: in a quarter of the time. `number`: see attribute().

    Opened by name: HDF5 sorts all of them anew for each that is opened by its number. KeyError if there is none.
    """
    attribute = h5a.open(group.id, name)
    if number:
        # To ask for the type takes as long as to read.
        with suppress(OSError, RuntimeError, TypeError, ValueError):    # it is no number
            return _scalar(attribute, *_usual(number))
    stored = attribute.get_type()
    dtype, kind = _in_memory(stored)
    if dtype is None or attribute.get_storage_size() != stored.get_size():
        return _plain(group.attrs[name.decode()])
    return _scalar(attribute, dtype, kind)


def _scalar(attribute, dtype, kind):
    value = np.empty((), dtype)
    attribute.read(value, kind)
    return _plain(value)


@lru_cache(maxsize=None)
def _usual(number):
    """(dtype, HDF5's type) of int or float in memory."""
    dtype = np.dtype(number)
    return dtype, h5t.py_create(dtype)


def _in_memory(stored):
    """(dtype, HDF5's type) of numbers and of texts of fixed length once they are read; (None, None) for others."""
    kind = stored.get_class()
    if kind == h5t.STRING and not stored.is_variable_str():
        return _text(stored.get_size()), stored
    return _number(kind, stored.get_size()) if kind in (h5t.INTEGER, h5t.FLOAT) else (None, None)


@lru_cache(maxsize=None)
def _text(size):
    return np.dtype(f"S{size}")


@lru_cache(maxsize=None)
def _number(kind, size):
    dtype = np.dtype(f"{'i' if kind == h5t.INTEGER else 'f'}{size}")
    return dtype, h5t.py_create(dtype)


def _plain(value):
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.item()
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else value


def _number_or_none(value):
    return None if value is None or np.isnan(value) else float(value)


_AS = {"str": str, "int": int, "float": float, "bool": bool, "float | None": _number_or_none}
_NUMBERS = {int: int, bool: int, float: float, _number_or_none: float}
_OPTIONAL = ("float | None",)
