"""JSON that every parser reads, which knows no NaN and no infinity."""

import json
import math


def dumps(value, **options):
    """The text, with null for every number that is not finite."""
    return json.dumps(_finite(value), allow_nan=False, **options)


def number(value):
    """A number that was read: NaN for null."""
    return math.nan if value is None else value


def _finite(value):
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
