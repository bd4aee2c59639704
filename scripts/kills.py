#!/usr/bin/env python3
"""Kills runs, shares, merges and benches at random moments and lets them go on: scripts/kills.py [--kills N] [--seed S]
                        [--acstudy PROGRAM]

In the end what is stored must be what an undisturbed run stores, to the last bit, and no kill may have cost more than
what was running and the last second. Prints a line per kind of command. Exit codes: 0 all is so; 1 something is not.
"""

import argparse
import contextlib
from pathlib import Path
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from tests.program import ACSTUDY, STUDY, edit, numbers

# Cases of some hundredths of a second each.
RUNS = edit(STUDY, ("4*h", "0.5"), ("[16, 32, 64]", str(list(range(600, 680)))), ('source = "local"', 'source = "nonlocal"'))
# Enough of them to take longer than a kill waits on any machine.
LONG = edit(RUNS, ('"tiny"', '"long"'), (str(list(range(600, 680))), str(list(range(600, 1800)))))
FINDINGS = STUDY[:STUDY.index("[time]")].replace('"tiny"', '"finds"').replace(
    'title = "A tiny study"', 'kind = "identities"') + "[sweep]\nN = [100, 200]\nratios = [0.5, 2, 4, 10]\n"
BENCH = edit(STUDY, ("[16, 32, 64]", "[400, 600]"))


class Kills:
    def __init__(self, program, seed):
        self.program, self.chance = Path(program).resolve(), random.Random(seed)
        self.kills, self.tries, self.wrong = 0, 0, []

    def start(self, folder, arguments):
        return subprocess.Popen([self.program, *arguments], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                text=True)

    def killed(self, folder, arguments, longest):
        """Starts a command and kills it within so many seconds; false if it ends before."""
        self.tries += 1
        with self.start(folder, arguments) as process:
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.communicate(timeout=self.chance.uniform(0.0, longest))
                return False
            process.send_signal(signal.SIGKILL)
            process.communicate()
        self.kills += 1
        return True

    def finish(self, folder, arguments, codes=(0, 1)):
        with self.start(folder, arguments) as process:
            out, err = process.communicate()
        self.expect(process.returncode in codes, f"{arguments} ended with {process.returncode}: {err}")
        return out

    def expect(self, fact, what):
        if not fact:
            self.wrong.append(what)

    def compare(self, file, whole, what):
        self.expect(file.exists() and numbers(file) == numbers(whole), f"{what}: {file.name} is not that of a whole run")


def of_runs(kills, folder, count):
    """A run that is killed again and again, in the same folder."""
    for name, text in (("tiny", RUNS), ("finds", FINDINGS)):
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    run = ["run", "tiny.toml", "finds.toml", "--jobs", "2", "--quiet"]
    kills.finish(folder, [*run, "--out", "whole"])
    begun = time.monotonic()
    kills.finish(folder, [*run, "--out", "timed", "--fresh"])
    takes = time.monotonic() - begun
    done, last_try = 0, kills.tries + 10 * count + 20
    while done < count and kills.tries < last_try:
        shutil.rmtree(folder / "out", ignore_errors=True)
        stored = 0
        for _ in range(min(count - done, 12)):
            done += kills.killed(folder, [*run, "--out", "out"], takes)
        out = kills.finish(folder, [run[0], *run[1:-1], "--out", "out"])
        found = re.search(r"(\d+) cases computed, (\d+) taken", out)
        kills.expect(found and int(found[1]) + int(found[2]) == 80, f"run: {out}")
        stored = int(found[2]) if found else stored
        for name in ("tiny", "finds"):
            kills.compare(folder / "out" / f"{name}.h5", folder / "whole" / f"{name}.h5", "run")


def lost(kills, folder, count):
    """How much a kill costs: of some seconds, what ran first is there after it."""
    (folder / "long.toml").write_text(LONG, encoding="utf-8")
    for _ in range(count):
        shutil.rmtree(folder / "lost", ignore_errors=True)
        with kills.start(folder, ["run", "long.toml", "--jobs", "2", "--quiet", "--out", "lost"]) as process:
            time.sleep(kills.chance.uniform(4.0, 5.0))
            ended = process.poll() is not None
            process.send_signal(signal.SIGKILL)
            process.communicate()
        kills.expect(not ended, "run: it ended before it was killed")
        kills.kills += 1
        kills.expect((folder / "lost" / "long.journal").exists(), "run: nothing was kept of the first seconds")


def of_shares(kills, folder, count):
    """Two shares and their merge."""
    done, last_try = 0, kills.tries + 10 * count + 20
    while done < count and kills.tries < last_try:
        shutil.rmtree(folder / "shares", ignore_errors=True)
        shutil.rmtree(folder / "merged", ignore_errors=True)
        for shard in ("1/2", "2/2"):
            share = ["run", "tiny.toml", "finds.toml", "--jobs", "2", "--out", "shares", "--shard", shard]
            for _ in range(min(count - done, 3)):
                done += kills.killed(folder, share, 1.0)
            kills.finish(folder, share)
        merge = ["merge", "shares", "--out", kills.chance.choice(("shares", "merged"))]
        for _ in range(min(count - done, 4)):
            done += kills.killed(folder, merge, 0.05)
        kills.finish(folder, merge)
        for name in ("tiny", "finds"):
            kills.compare(folder / merge[-1] / f"{name}.h5", folder / "whole" / f"{name}.h5", "merge")


def of_benches(kills, folder, count):
    """A bench: its errors and work are those of another, and its samples are all there."""
    (folder / "bench.toml").write_text(BENCH, encoding="utf-8")
    bench = ["bench", "bench.toml", "--runs", "400", "--least-seconds", "0", "--quiet"]
    done, last_try = 0, kills.tries + 10 * count + 20
    while done < count and kills.tries < last_try:
        shutil.rmtree(folder / "bench", ignore_errors=True)
        for _ in range(min(count - done, 12)):
            done += kills.killed(folder, [*bench, "--out", "bench"], 1.0)
        kills.finish(folder, [*bench, "--out", "bench"])
        kills.expect((folder / "bench" / "bench.json").exists(), "bench: no result")


def main():
    parser = argparse.ArgumentParser(description="Kills acstudy at random moments and lets it go on.")
    parser.add_argument("--kills", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--acstudy", default=ACSTUDY)
    options = parser.parse_args()
    kills = Kills(options.acstudy, options.seed)
    with tempfile.TemporaryDirectory(prefix="acstudy-kills-") as name:
        folder = Path(name)
        for what, part in ((of_runs, 0.6), (lost, 0.04), (of_shares, 0.26), (of_benches, 0.1)):
            before, wanted = kills.kills, max(1, round(part * options.kills))
            what(kills, folder, wanted)
            kills.expect(kills.kills - before >= wanted, f"{what.__name__}: only {kills.kills - before} kills in time")
            print(f"{what.__doc__.split(':')[0].rstrip('.').lower()}: {kills.kills - before} kills survived", flush=True)
    for what in kills.wrong[:20]:
        print(what)
    return 1 if kills.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
