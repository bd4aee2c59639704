"""matplotlib's classes without the texts and signatures of their set(): making those takes a third of loading it."""

from matplotlib import artist

artist.kwdoc = lambda _: ""
artist.Artist._update_set_signature_and_docstring = classmethod(lambda _: None)
