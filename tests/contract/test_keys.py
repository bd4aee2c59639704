"""The keys of a study file: those that `acstudy list keys` prints are those that the reader allows, and reads."""

import re
import unittest

from tests.program import ROOT, ProgramTest, edit

HEADING = re.compile(r"\[+([a-z-]+)\]+(?: or \[\[\1\]\])?(, optional)?  (.+)")
NO_VALUE = "1979-05-27"  # a date, which no key takes
SCENE = 'period = "2*pi"\nT = 1\nc = "1"\nb = "1/2"\nu = "sin(x - t)"\n'
TINY = f"""[study]
name = "tiny"

[scene]
{SCENE}
[[scheme]]
model = 2
divergence = "local"
kernel = "cubic-spline"

[time]
integrator = "ssprk2"
step = "h/2"

[[path]]
name = "delta = 3h"
delta = "3*h"
N = [40, 80, 160, 320]
source = "local"

[source]
rule = "gauss"
"""
SWEEP = '\n[sweep]\nN = [20, 40]\nratios = [1, 4]\n'
CONTROL = '\n[[control]]\nname = "no viscosity"\nscheme = { model = 2, divergence = "local", kernel = "cubic-spline" }\n'


def without(text, *tables):
    """A study without some of its tables."""
    for table in tables:
        text, count = re.subn(rf"^\[+{table}\]+\n(?:[^\[\n].*\n|\n)*", "", text, flags=re.MULTILINE)
        assert count == 1, table
    return text


def of_kind(kind, text):
    return edit(text, ('name = "tiny"', f'name = "tiny"\nkind = "{kind}"'))


# A small study of each kind, with every table that it may have.
STUDIES = {
    "convergence": TINY,
    "consistency": without(TINY, "time", "source") + SWEEP,
    "identities": without(TINY, "time", "source", "path") + SWEEP,
    "stability": without(TINY, "time", "source", "path") + SWEEP + '\n[printed]\nviolated = ["cubic-spline"]\n',
    "stability-map": without(TINY, "time", "source", "path") + CONTROL +
                     '\n[stability-map]\nN = 24\nratios = [1, 4]\ncfl = [0.5, 1]\nintegrators = ["forward-euler"]\n'
                     '\n[growth]\nratio = 2\ncfl = [0.9]\n',
    "controls": edit(TINY, ('"ssprk2"', '"forward-euler"')) + CONTROL +
                '\n[[consistency]]\nname = "delta = h"\ndelta = "h"\nN = [40, 80, 160, 320]\nsource = "local"\n',
    "map": without(TINY, "path") + '\n[map]\ndelta = [0.1, 0.2, 0.4, 0.8]\nN = [20, 40, 80, 160]\nsources = ["local"]\n',
    "extremes": without(TINY, "scene", "time", "source", "path") + "\n[extremes]\nN = 100\nsteps = 100\n",
    "pollution": '[study]\nname = "tiny"\n\n[pollution]\nstudies = ["other.toml"]\n',
    "digits": '[study]\nname = "tiny"\n\n[[weights]]\nmodel = 1\nkernel = "inverse"\n\n[digits]\nratios = [1]\n'
              '\n[scene]\nuse = "lee-du-2019"\n\n[gaps]\nN = 100\ntimes = [1]\n',
    "corpus": '[study]\nname = "tiny"\n',
    "coverage": '[study]\nname = "tiny"\n\n[coverage]\nseries = 100\nseed = 1\n',
    "scan": '[study]\nname = "tiny"\n\n[scan]\nevery = 100\nseed = 1\n',
}
INLINE = {"kernel": 'kernel = { name = "power", alpha = 0.5 }',
          "kernel.profile": 'kernel = { profile = "1-s" }',
          "kernel.eta": 'kernel = { eta = "1-s" }',
          "kernel.breaks": 'kernel = { eta = "1-s", breaks = "1/2" }',
          "kernel.exponent": 'kernel = { eta = "1-s", exponent = 0.5 }',
          "N": 'N = { from = 40, until = "decided", most = 320 }',
          "start": 'start = { name = "jittered", smallest_gap = 0.1, seed = 1 }'}


class Keys(ProgramTest):
    def tables(self, kind):
        """Keys by table, as `list keys KIND` prints them, with what it says of each; and the optional tables."""
        done = self.acstudy("list", "keys", kind)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        tables, optional = {}, set()
        for block in done.stdout.strip().split("\n\n"):
            lines = block.splitlines()
            keys = {line.split()[0]: line for line in lines if line.startswith("  ")}
            for heading in lines[:len(lines) - len(keys)]:
                name, may_lack, _ = HEADING.fullmatch(heading).groups()
                tables[name] = keys
                if may_lack:
                    optional.add(name)
        return tables, optional

    def explain(self, text):
        self.write("study.toml", text)
        self.write("other.toml", TINY)
        return self.acstudy("explain", "study.toml")

    def with_line(self, text, table, key, value):
        """A study with a line in its table in place of the one that has the key; and the number of this line."""
        lines = text.splitlines()
        top = next(i for i, line in enumerate(lines) if line.strip("[]") == table)
        outer, _, inner = key.partition(".")
        line = f"{outer} = {value}"
        if inner:
            line, count = re.subn(rf'\b{inner} = [^,}}]*\b"?', f"{inner} = {value}", INLINE.get(key, INLINE[outer]),
                                 count=1)
            self.assertEqual(count, 1)
        end = next((i for i in range(top + 1, len(lines)) if not lines[i]), len(lines))
        others = [] if key == "use" else [old for old in lines[top + 1:end] if not old.startswith(f"{outer} =")]
        lines[top + 1:end] = [line, *others]
        return "\n".join(lines) + "\n", top + 2

    def test_each_kind_is_listed_and_its_study_is_right(self):
        listed = self.acstudy("list", "kinds").stdout
        self.assertEqual(re.findall(r'^"([a-z-]+)" ', listed, re.MULTILINE), list(STUDIES))
        for kind, text in STUDIES.items():
            with self.subTest(kind):
                done = self.explain(of_kind(kind, text))
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                tables, _ = self.tables(kind)
                self.assertEqual(sorted(tables), sorted(set(re.findall(r"^\[+([a-z-]+)", text, re.MULTILINE))))

    def test_each_key_is_read(self):
        seen = set()  # tables that kinds share are read by one function
        for kind, text in STUDIES.items():
            tables, _ = self.tables(kind)
            for table, keys in tables.items():
                if kind == "digits" and table == "scene":
                    continue  # the exact gaps are those of one scene
                for key, line in keys.items():
                    if (table, line) in seen:
                        continue
                    seen.add((table, line))
                    with self.subTest(kind=kind, table=table, key=key):
                        broken, line = self.with_line(of_kind(kind, text), table, key, NO_VALUE)
                        done = self.explain(broken)
                        self.assertEqual(done.returncode, 2)
                        self.assertRegex(done.stderr, rf"\Aacstudy: study\.toml:{line}:\d+: ")
                        self.assertNotIn("unknown key", done.stderr)

    def test_no_other_key_is_allowed(self):
        for kind, text in STUDIES.items():
            tables, _ = self.tables(kind)
            for table, keys in tables.items():
                with self.subTest(kind=kind, table=table):
                    broken, line = self.with_line(of_kind(kind, text), table, "nonsense", 1)
                    done = self.explain(broken)
                    self.assertEqual(done.returncode, 2)
                    known = re.fullmatch(rf'acstudy: study\.toml:{line}:1: unknown key "nonsense" in \[+{table}\]+; '
                                         r"known keys: ([^;]*)(; did you mean .*)?\n", done.stderr)
                    self.assertIsNotNone(known, done.stderr)
                    if not (kind == "digits" and table == "scene"):
                        self.assertEqual(known[1].split(", "), [key for key in keys if "." not in key])

    def test_what_is_needed_is_missed_and_nothing_else(self):
        for kind, text in STUDIES.items():
            tables, optional = self.tables(kind)
            for table, keys in tables.items():
                if kind == "digits" and table in ("scene", "gaps"):
                    continue  # one needs the other
                for key, line in keys.items():
                    if "." in key or f"\n{key} = " not in text:
                        continue
                    always = line.endswith("; needed")
                    if not always and "; needed" in line:
                        continue  # needed where something else is so, or is not
                    with self.subTest(kind=kind, table=table, key=key):
                        lines = of_kind(kind, text).splitlines()
                        top = next(i for i, one in enumerate(lines) if one.strip("[]") == table)
                        here = next((i for i in range(top, len(lines)) if lines[i].startswith(f"{key} = ")), None)
                        if here is None:
                            continue
                        done = self.explain("\n".join(lines[:here] + lines[here + 1:]) + "\n")
                        self.assertEqual(done.returncode, 2 if always else 0, done.stderr)
                if table == "study":
                    continue
                with self.subTest(kind=kind, table=table):
                    done = self.explain(without(of_kind(kind, text), table))
                    self.assertEqual(done.returncode, 0 if table in optional else 2, done.stderr)

    def test_keys_of_no_kind_are_refused(self):
        done = self.acstudy("list", "keys", "nonsense")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertRegex(done.stderr, r'\Aacstudy: no kind of study is named "nonsense"; write one of convergence, ')
        self.assertEqual(self.acstudy("list", "kernels", "map").returncode, 2)


if __name__ == "__main__":
    unittest.main()
