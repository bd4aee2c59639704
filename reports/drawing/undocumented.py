"""matplotlib's classes without the texts that list their properties: writing those takes a third of loading it."""

from matplotlib import artist

artist.kwdoc = lambda _: ""
