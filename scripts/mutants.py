#!/usr/bin/env python3
"""Tests the tests: each patch in tests/mutants plants one mistake in a copy of the sources.

A C++ test or a gate of the shorter studies has to see it; what takes longer is not asked. The first line of a patch
says what the mistake is. A patch named control-* changes nothing that counts, and has to survive. Only a mutant that
compiles can be caught.
Exit codes: 0 every mistake is caught and every control survives; 1 not so, or a patch does not apply or compile;
2 nothing was tested: bad usage, or the sources without any patch do not pass.
"""

import argparse
import json
import os
from pathlib import Path
import re
import shutil
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ET

ROOT = Path(__file__).resolve().parent.parent
TEST_SECONDS = 120
GATES_SECONDS = 600
# These look at command line, report and patches, not at numbers.
NOT_FOR_MUTANTS = "^python_"
# These repeat, at length, what the others ask.
LONG_STUDIES = ("fig*", "map", "controls", "pollution")


class Failure(Exception):
    """A step that has to succeed did not; the message is its output."""


class Copy:
    """A copy of the sources in a temporary folder, with a build folder that all mutants share."""

    def __init__(self, folder, jobs):
        self.root, self.build, self.jobs = folder / "acstudy", folder / "build", jobs
        # git apply takes no notice of a repository above the copy; ccache finds again what another copy has compiled
        self.environment = {**os.environ, "GIT_CEILING_DIRECTORIES": str(folder), "CCACHE_BASEDIR": str(folder),
                            "CCACHE_NOHASHDIR": "1"}
        listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT,
                                capture_output=True, check=False)
        if listed.returncode != 0:
            raise Failure("git ls-files: " + listed.stderr.decode(errors="replace"))
        for name in filter(None, listed.stdout.decode().split("\0")):
            if (ROOT / name).is_file():
                (self.root / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, self.root / name)

    def do(self, *command):
        done = subprocess.run([str(word) for word in command], cwd=self.root, env=self.environment, text=True,
                              errors="replace", stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if done.returncode != 0:
            raise Failure(done.stdout)

    def configure(self):
        launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        self.do("cmake", "-S", self.root, "-B", self.build, "-DCMAKE_BUILD_TYPE=Release", "-DACSTUDY_TESTS=ON",
                *launcher)

    def compile(self):
        self.do("cmake", "--build", self.build, "-j", self.jobs)

    def failing_tests(self):
        """Names of the tests that fail or take too long."""
        log = self.build / "Testing" / "Temporary" / "LastTestsFailed.log"
        log.unlink(missing_ok=True)
        done = subprocess.run(["ctest", "-j", str(self.jobs), "--timeout", str(TEST_SECONDS), "-E", NOT_FOR_MUTANTS],
                              cwd=self.build, env=self.environment, text=True, errors="replace", capture_output=True,
                              check=False)
        names = log.read_text(encoding="utf-8").splitlines() if log.exists() else []
        if (done.returncode != 0) != bool(names):
            raise Failure(done.stdout + done.stderr)
        return [name.partition(":")[2] for name in names]

    def departing_gates(self):
        """Gates that depart when the shorter studies are run anew; or the exit code that says why there are none."""
        out = self.build / "gates"
        shutil.rmtree(out, ignore_errors=True)
        acstudy, junit = str(self.build / "acstudy"), self.build / "gates.xml"
        junit.unlink(missing_ok=True)
        studies = sorted(str(path) for path in (self.root / "studies").glob("*.toml")
                         if not any(path.match(f"{name}.toml") for name in LONG_STUDIES))
        try:
            code = self.exit_code([acstudy, "run", *studies, "--out", str(out), "--jobs", str(self.jobs)])
            if code not in (0, 1, 3):
                return [f"acstudy run exits with {code}"]
            code = self.exit_code([acstudy, "check", *sorted(map(str, out.glob("*.json"))), "--junit", str(junit)])
            if code not in (0, 1):
                return [f"acstudy check exits with {code}"]
        except subprocess.TimeoutExpired:
            return [f"the studies take more than {GATES_SECONDS} s"]
        return [f"{case.get('classname')}: {case.get('name')}" for case in ET.parse(junit).getroot().iter("testcase")
                if case.find("failure") is not None]

    def exit_code(self, command):
        return subprocess.run(command, cwd=self.root, capture_output=True, check=False,
                              timeout=GATES_SECONDS).returncode

    def caught_by(self):
        return [{"kind": "test", "name": name} for name in self.failing_tests()] + [
            {"kind": "gate", "name": name} for name in self.departing_gates()]


def changed_file(patch):
    return re.search(r"^\+\+\+ b/(\S+)", patch, re.M)[1]


def test_mutant(copy, path):
    text = path.read_text(encoding="utf-8")
    mutant = {"name": path.stem, "file": changed_file(text), "what": text.partition("\n")[0],
              "expected": "survives" if path.stem.startswith("control-") else "caught", "caught_by": []}
    started = time.monotonic()
    try:
        copy.do("git", "apply", path)
        try:
            copy.compile()
            mutant["caught_by"] = copy.caught_by()
        finally:
            copy.do("git", "apply", "--reverse", path)
        mutant["outcome"] = "caught" if mutant["caught_by"] else "survives"
    except Failure as failure:
        mutant["outcome"], mutant["error"] = "error", str(failure)[-2000:]
    mutant["caught"] = mutant["outcome"] == "caught"
    mutant["as_expected"] = mutant["outcome"] == mutant["expected"]
    mutant["seconds"] = round(time.monotonic() - started, 1)
    return mutant


def row(mutant):
    kinds = [one["kind"] for one in mutant["caught_by"]]
    by = ", ".join(f"{kinds.count(kind)} {kind}s" for kind in ("test", "gate"))
    line = "{:<6}  {:<24}  {:<8}  {:<18}  {}".format("ok" if mutant["as_expected"] else "DEPART", mutant["name"],
                                                     mutant["outcome"], by, mutant["what"])
    if not mutant["as_expected"]:
        line += "".join(f"\n        {one['kind']}: {one['name']}" for one in mutant["caught_by"])
        line += "\n" + mutant.get("error", "") if "error" in mutant else ""
    return line


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", action="append", metavar="NAME", help="this mutant alone; may be given again")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="for compiler, tests and studies")
    parser.add_argument("--out", type=Path, default=Path("reports/out/mutants"), metavar="DIR",
                        help="folder for mutants.json; not that of the results, all *.json of which the gates read")
    options = parser.parse_args()
    patches = {path.stem: path for path in sorted((ROOT / "tests" / "mutants").glob("*.patch"))}
    for name in options.only or []:
        if name not in patches:
            parser.error(f'no mutant "{name}"; there are {", ".join(patches)}')
    chosen = [path for name, path in patches.items() if not options.only or name in options.only]

    with tempfile.TemporaryDirectory(prefix="acstudy-mutants-") as folder:
        try:
            options.out.mkdir(parents=True, exist_ok=True)
            copy = Copy(Path(folder).resolve(), options.jobs)
            copy.configure()
            copy.compile()
            caught_by = copy.caught_by()
            if caught_by:
                raise Failure("\n".join(f"{one['kind']}: {one['name']}" for one in caught_by))
        except (Failure, OSError) as failure:
            print(f"mutants.py: without any mistake the sources do not pass, so nothing was tested; see to that first:\n"
                  f"{failure}",
                  file=sys.stderr)
            return 2
        mutants = []
        for path in chosen:
            mutants.append(test_mutant(copy, path))
            print(row(mutants[-1]), flush=True)

    written = options.out / "mutants.json"
    partial = options.out / "mutants.json.partial"
    partial.write_text(json.dumps({"mutants": mutants}, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    partial.replace(written)
    departing = sum(not mutant["as_expected"] for mutant in mutants)
    caught = sum(mutant["caught"] for mutant in mutants)
    print(f"{len(mutants)} mutants, {caught} caught, {departing} depart; details in {written}")
    return 1 if departing else 0


if __name__ == "__main__":
    sys.exit(main())
