"""A group of a result file: its attributes and data sets by their stored names, and records made of them."""

from __future__ import annotations

from dataclasses import MISSING, fields

import h5py
import numpy as np

Column = np.ndarray     # [n], an entry per case or point
Between = np.ndarray    # [n - 1], an entry per neighboring two


class Stored:
    """What a group holds. KeyError or ValueError, with the group's name, where something is missing or ill-formed."""

    def __init__(self, group):
        self.group = group

    @property
    def attributes(self):
        """All of them. To read one takes some 50 us, most of what a result takes: `attribute` reads no other."""
        return {name: _plain(value) for name, value in self.group.attrs.items()}

    def record(self, kind, **given):
        """A `kind`: each field of this dataclass that is not given is what is stored under its name, where it is text, a
        number or an array.

        Fields typed `Column` and `Between` are data sets, all others attributes. A field with a default may be missing;
        a column whose default is None is then NaN, for files of older versions lack it.
        """
        values, columns = dict(given), {}
        for field in fields(kind):
            if field.name in given:
                continue
            if field.type in ("Column", "Between"):
                columns[field.name] = self._column(field, next(iter(columns.values()), None))
            elif field.type in _AS:
                default = field.default if field.default is not MISSING else None
                values[field.name] = _AS[field.type](self.attribute(field.name, default, field.type in _OPTIONAL))
        return kind(**values, **columns)

    def attribute(self, name, default=None, optional=False):
        try:
            value = _plain(self.group.attrs[name])
        except KeyError:
            value = default
        if value is None and not optional:
            raise KeyError(f"{self.group.name}: no attribute {name}")
        return value

    def group_of(self, name):
        if name not in self.group:
            raise KeyError(f"{self.group.name}: no group {name}")
        return Stored(self.group[name])

    def _column(self, field, first):
        """A data set by the lower interface of h5py, in a third of the time; as long as the `first`."""
        try:
            data = h5py.h5d.open(self.group.id, field.name.encode())
        except KeyError:
            if field.default is MISSING:
                raise KeyError(f"{self.group.name}: no dataset {field.name}") from None
            return np.full(len(first), np.nan)
        values = np.empty(data.shape, data.dtype)
        data.read(h5py.h5s.ALL, h5py.h5s.ALL, values)
        values = np.atleast_1d(values)
        n = len(values if first is None else first)
        expected = max(n - 1, 0) if field.type == "Between" else n
        if values.shape != (expected,):
            raise ValueError(f"{self.group.name}/{field.name}: shape {values.shape}, but {expected} entries belong to "
                             f"N of {n}")
        return values


def _plain(value):
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.item()
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else value


def _number_or_none(value):
    return None if value is None or np.isnan(value) else float(value)


_AS = {"str": str, "int": int, "float": float, "bool": bool, "float | None": _number_or_none}
_OPTIONAL = ("float | None",)
