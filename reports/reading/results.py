"""Result files of acstudy, read into plain records.

Reading only: nothing here computes, draws or writes. The layout is the format "acstudy-1" that `acstudy run` writes.
"""

from dataclasses import replace
from itertools import islice, zip_longest
import math
from pathlib import Path
import re
import zlib

import h5py
import numpy as np

from reading import names
from reading.records import Cases, Finding, Points, Scene, Scheme, Series, Study
from reading.stored import Stored

FORMAT = "acstudy-1"
# The kind whose findings are the verdicts on its series.
OF_SERIES = "convergence"
# Kinds whose series a report shows; the others have theirs as evidence of findings, and reading takes a while.
_WITH_SERIES = (OF_SERIES, "map")


class ResultError(Exception):
    """A file that cannot be read as a result of acstudy; the text is one line: file, what is wrong, remedy."""


def read_study(path, share=(0, 1)):
    """The study in the result file `path`; ResultError if the file is missing, damaged or of another format.

    share: (k, n) for the findings and series k, k + n, k + 2n, ... alone, see joined().
    """
    path = Path(path)
    if path.is_file() and not _is_whole(path):
        raise ResultError(f"{path}: not as it was written: damaged, or changed by another program; run the study again")
    try:
        # Read at once: a file has thousands of small groups.
        with h5py.File(path, "r", driver="core", backing_store=False) as file:
            return _study(path, file, share)
    except OSError as error:
        if not path.is_file():
            raise ResultError(f"{path}: no such file; run the study first") from error
        reason = " ".join(str(error).split()) or type(error).__name__
        raise ResultError(f"{path}: not a readable HDF5 file ({reason}); "
                          "run the study again or move the file away") from error
    except (KeyError, RuntimeError, TypeError, ValueError) as error:
        reason = " ".join(str(error).strip("'\"").split())
        raise ResultError(f"{path}: {reason}; run the study again") from error


def _is_whole(path):
    """Whether the words in front of an HDF5 file are those of what follows them; true without any."""
    with open(path, "rb") as file:
        words = file.read(512)
        if not words.startswith(b"acstudy: crc32 "):
            return True
        content = file.read()
    said = f"acstudy: crc32 {zlib.crc32(content):08x} of the {len(content)} bytes after these 512\n"
    return words.startswith(said.encode())


def _study(path, file, share):
    root = Stored(file["/"])
    found = root.attribute("format", "")
    if found != FORMAT:
        raise ResultError(f'{path}: format = "{found}"; not a result file of acstudy; '
                          f'write one of format "{FORMAT}" with "acstudy run"')
    name = root.attribute("study")
    # The name becomes file names beside the report: it must not lead out of the folder.
    if not re.fullmatch(r"[a-z0-9-]+", name):
        raise ResultError(f'{path}: study = "{name}"; a study is named by [a-z0-9-]+; rename it and run it again')
    kind = root.attribute("kind", OF_SERIES)
    scene = Stored(file["scene"]).record(Scene) if "scene" in file or kind == OF_SERIES else None
    where = f"scene of {name}" if scene is None else scene.name or f"scene of {name}"
    series = tuple(_of_series(group, where) for group in _groups(file, "series", share)) if kind in _WITH_SERIES else ()
    findings = tuple(map(_finding, _groups(file, "findings", share)))
    return Study(file=path, name=name, title=root.attribute("title"), kind=kind, text=root.attribute("study_text", ""),
                 provenance={key: str(value) for key, value in sorted(Stored(file["provenance"]).attributes.items())},
                 scene=scene, findings=series if kind == OF_SERIES else findings,
                 evidence=() if kind == OF_SERIES else series)


def joined(shares):
    """The study of which read_study() read all shares (0, n), (1, n), ..."""
    return replace(shares[0], findings=dealt([one.findings for one in shares]),
                   evidence=dealt([one.evidence for one in shares]))


def dealt(shares):
    """The sequence of which each share has every n-th element."""
    nothing = object()
    return tuple(one for turn in zip_longest(*shares, fillvalue=nothing) for one in turn if one is not nothing)


def _groups(file, name, share):
    """One after another: to close a file takes long while many of its groups are at hand."""
    within = file[name] if name in file else {}
    first, step = share
    return (Stored(within).group_of(key) for key in islice(sorted(within), first, None, step))


def _finding(group):
    """A finding as it is stored."""
    labels = tuple(group.attribute("labels", "").splitlines())
    points = group.record(Points, label=labels)
    if labels and len(labels) != len(points):
        raise ValueError(f"{group.group.name}: {len(labels)} labels, but {len(points)} points")
    return group.record(Finding, points=points, coordinates=group.group_of("coordinates").attributes,
                        also_expected=tuple(group.attribute("also_expected", "").split()), series=None,
                        fit={name.removeprefix("surface_"): float(value) for name, value in
                             sorted(group.attributes_named("surface_").items())})


def _of_series(group, scene):
    """The verdict on a series as a finding, with the series attached."""
    standing = group.attribute("motion") == "standing"  # b = 0, so both divergence forms are one
    scheme = group.record(Scheme, **({"divergence": ""} if standing else {}))
    series = group.record(Series, scheme=scheme, cases=group.record(Cases))
    cases = series.cases
    unbounded = np.full(len(cases), math.inf)
    return group.record(
        Finding, subject=names.full_name(scheme),
        check=", ".join(filter(None, (series.path, series.stepping, f"{series.source} source, {scene}"))),
        points=Points(cases.N, cases.h, cases.delta, cases.variable, cases.error_linf, -unbounded, unbounded),
        coordinates=group.group_of("coordinates").attributes, series=series)
