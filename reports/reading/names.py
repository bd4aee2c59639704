"""How schemes, paths, variables and orders are written in figures and on the page."""

import math
import re

_MATH = {"delta": r"\delta", "h": "h", "N": "N", "max": r"\max", "min": r"\min", "pi": r"\pi"}


def scheme_names(schemes):
    """{scheme: name}, each as short as tells the schemes apart: a kernel is named only where kernels differ."""
    schemes = list(dict.fromkeys(schemes))
    kernels, alphas, mus = {}, {}, {}
    for scheme in schemes:
        kernels.setdefault(scheme.model, set()).add(scheme.kernel)
        alphas.setdefault((scheme.model, scheme.kernel), set()).add(scheme.alpha)
        mus.setdefault((scheme.model, scheme.kernel), set()).add(scheme.mu)
    written = {}
    for scheme in schemes:
        parts = [model(scheme)]
        several_alphas = len(alphas[scheme.model, scheme.kernel]) > 1
        if len(kernels[scheme.model]) > 1 or several_alphas:
            alpha = f" (α = {scheme.alpha:.4g})" if scheme.alpha is not None else ""
            parts.append(f"{scheme.kernel} kernel{alpha}")
        if scheme.divergence:
            parts.append(f"{scheme.divergence} divergence")
        if len(mus[scheme.model, scheme.kernel]) > 1:
            parts.append(f"μ = {scheme.mu:.4g}" if scheme.mu is not None else "no μ")
        written[scheme] = ", ".join(parts)
    return written


def full_name(scheme):
    """All of a scheme but its viscosity, as findings name their subject."""
    kernel = scheme.kernel + (f"({scheme.alpha:g})" if scheme.alpha is not None else "")
    divergence = f"{scheme.divergence} divergence" if scheme.divergence else ""
    return ", ".join(filter(None, (model(scheme), divergence, kernel)))


def model(scheme):
    return scheme.label or "Model " + {1: "I", 2: "II"}.get(scheme.model, str(scheme.model))


def order(value, form="{:.2f}"):
    """An order as text; a dash where there is none."""
    if not math.isfinite(value):
        return "–"
    return form.format(value).replace("-", "−")


def variable_math(variable):
    """The theory's variable as matplotlib sets it."""
    return {"h": "$h$", "max(h,delta)": r"$\max(h,\,\delta)$"}.get(variable) or literal(variable)


def literal(text):
    """Text that matplotlib sets as it stands: a dollar begins no formula."""
    return text.replace("$", r"\$")


def path_text(path):
    """A path's name with its signs: "δ = h²"."""
    return path.replace("delta", "δ").replace("^2", "²").replace("^3", "³").replace("sqrt(h)", "√h")


def path_math(path):
    """A path's name as matplotlib sets it: as a formula if it is one in delta, h and N, else as it stands."""
    text = re.sub(r"(\d)\s*\*\s*(?=[a-zA-Z(])", r"\1", path)
    tokens = re.findall(r"sqrt\([^()]*\)|\^-?[\d.]+|\d+(?:\.\d+)?|[A-Za-z]+|[-+*/=(),]|\s+|.", text)
    written = [_math_token(token) for token in tokens]
    return literal(path) if None in written or not path.strip() else "$" + "".join(written) + "$"


def _math_token(token):
    if token.isspace():
        return ""
    if token.startswith("sqrt("):
        inner = [_math_token(part) for part in re.findall(r"\d+(?:\.\d+)?|[A-Za-z]+|.", token[5:-1])]
        return None if None in inner or not inner else r"\sqrt{" + "".join(inner) + "}"
    if token.startswith("^"):
        return "^{" + token[1:] + "}" if len(token) > 1 else None
    if token == "*":
        return r"\,"
    if token[0].isdigit() or token in "-+/=(),":
        return token
    return _MATH.get(token)
