"""What was read and drawn for the last report, kept beside it, so that only what changed is read and drawn again.

An entry is found by a digest of all that it is made of: contents of files, sources of the report, versions of libraries,
arguments. So none is ever out of date; one that is damaged, or made of anything but plain records, is made anew.
"""

import hashlib
import io
from importlib import metadata
from pathlib import Path
import pickle
import sys

FOLDER = ".report"      # in the folder of the results
_ROOT = Path(__file__).resolve().parent.parent
_LIBRARIES = ("h5py", "matplotlib", "numpy", "fonttools")
# A pickle can call whatever it names. Here it may name these.
_RECORDS = {"reading.records", "drawing.look", "drawing.hover"}
_PLAIN = {("pathlib", "PosixPath"), ("pathlib", "WindowsPath"), ("pathlib._local", "PosixPath"),
          *((module, name) for core in ("core", "_core") for module, name in (
              (f"numpy.{core}.multiarray", "_reconstruct"), (f"numpy.{core}.multiarray", "scalar"),
              (f"numpy.{core}.numeric", "_frombuffer"), ("numpy", "ndarray"), ("numpy", "dtype")))}
_SIZE = hashlib.sha256().digest_size        # which processors compute several times faster than other digests


class Kept:
    """The entries of a folder of results. `write`: (path, content), which writes a file whole or not at all."""

    def __init__(self, folder, write):
        self.folder, self.write, self.files = Path(folder) / FOLDER, write, {}
        self.sources = digest(*(file.read_bytes() for file in sorted(_ROOT.rglob("*.py"))), sys.version,
                              *map(_version, _LIBRARIES))

    def has(self, *made_of):
        """Whether there is an entry of this, whole or damaged."""
        return self._path(made_of).is_file()

    def get(self, *made_of):
        """What is kept of this; None for nothing."""
        path = self._path(made_of)
        try:
            content = path.read_bytes()
            path.touch()
            rest = memoryview(content)[_SIZE:]
            if content[:_SIZE] == hashlib.sha256(rest).digest():
                return _Reader(io.BytesIO(rest)).load()
        except (OSError, EOFError, pickle.UnpicklingError, AttributeError, ImportError, IndexError, TypeError, ValueError):
            pass
        return None

    def keep(self, value, *made_of):
        """Keeps a value; a folder that cannot be written to keeps nothing."""
        content = pickle.dumps(value, protocol=5)
        try:
            self.folder.mkdir(exist_ok=True)
            self.write(self._path(made_of), hashlib.sha256(content).digest() + content)
        except OSError:
            pass

    def of_file(self, path):
        """The digest of a file's content."""
        if path not in self.files:
            self.files[path] = digest(Path(path).read_bytes())
        return self.files[path]

    def clear(self):
        """Removes what other sources made."""
        for file in self.folder.glob("*.kept"):
            if not file.name.startswith(f"{self.sources}."):
                file.unlink(missing_ok=True)

    def _path(self, made_of):
        return self.folder / f"{self.sources}.{digest(*made_of)}.kept"


def digest(*parts):
    """Of bytes and of what has a text that says all of it."""
    found = hashlib.sha256()
    for part in parts:
        part = part if isinstance(part, bytes) else repr(part).encode()
        found.update(b"%d:" % len(part) + part)
    return found.hexdigest()


class _Reader(pickle.Unpickler):
    def find_class(self, module, name):
        if module in _RECORDS and "." not in name and isinstance(found := super().find_class(module, name), type):
            return found
        if (module, name) in _PLAIN:
            return super().find_class(module, name)
        raise pickle.UnpicklingError(f"{module}.{name} is no plain record")


def _version(library):
    try:
        return metadata.version(library)
    except metadata.PackageNotFoundError:
        return "unknown"
