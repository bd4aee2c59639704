"""Texts measured and formulas parsed once for all figures of a process: matplotlib does so anew for each figure."""

from functools import lru_cache

from matplotlib import text, textpath
from matplotlib.mathtext import MathTextParser


class _Texts(textpath.TextToPath):
    """What every renderer asks for the size of a text."""

    def __init__(self):
        super().__init__()
        self.mathtext_parser = _Formulas()
        self._sizes = {}

    def get_text_width_height_descent(self, s, prop, ismath):
        key = s, hash(prop), ismath     # of its values: they can change
        if key not in self._sizes:
            self._sizes[key] = super().get_text_width_height_descent(s, prop, ismath)
        return self._sizes[key]


class _Formulas:
    """A MathTextParser that remembers more than 50 formulas."""

    def __init__(self):
        parser = MathTextParser("path")
        self._parsed = lru_cache(maxsize=1024)(parser.parse)

    def parse(self, s, dpi=72, prop=None, **more):
        return self._parsed(s, dpi, prop.copy() if prop is not None else None, **more)


def measure_once():
    """Makes renderers share what is known of texts; a matplotlib that asks otherwise is slower, no more."""
    shared = _Texts()
    for module in (textpath, text):     # of matplotlib 3.6 and of 3.10
        if hasattr(module, "TextToPath"):
            module.TextToPath = lambda: shared
