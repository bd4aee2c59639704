#!/bin/sh
# Prints the path of a Python that draws the report, that is, can import matplotlib, numpy, h5py and jinja2.
# $PYTHON comes first. Exit 4 when there is none, with what each candidate lacks.
set -u

lacks() {
    "$1" - 2>&1 <<'END'
import importlib, sys

lacking = [] if sys.version_info >= (3, 9) else ["version 3.9"]
for module in ("matplotlib", "numpy", "h5py", "jinja2"):
    try:
        importlib.import_module(module)
    except Exception:
        lacking.append(module)
print(", ".join(lacking) or "nothing")
END
}

tried=
seen=:
for candidate in ${PYTHON:+"$PYTHON"} python3 /usr/bin/python3 /usr/local/bin/python3 /opt/homebrew/bin/python3 \
    python3.14 python3.13 python3.12 python3.11 python3.10 python3.9; do
    python=$(command -v "$candidate") || continue
    case $seen in *":$python:"*) continue ;; esac
    seen=$seen$python:
    lacking=$(lacks "$python" | tail -n 1)
    if [ "$lacking" = nothing ]; then
        [ -z "${PYTHON:-}" ] || [ "$candidate" = "$PYTHON" ] || printf 'acstudy: PYTHON = %s will not do, taking %s\n' "$PYTHON" "$python" >&2
        echo "$python"
        exit 0
    fi
    tried="$tried
    $python lacks $lacking"
done
printf 'acstudy: no Python can draw the report: it has to import matplotlib, numpy, h5py and jinja2; name one with PYTHON%s\n' "${tried:-
    there is no python3 on the PATH}" >&2
exit 4
