"""A changed bit of what is stored is found, or changes nothing that is read; what is whole is kept."""

import json
import random
import unittest

import h5py
import numpy as np

from tests.program import GOOD, STUDY, ProgramTest, edit, numbers, reseal, strict_json

TWO = edit(STUDY, ('kernel = "inverse"\n', 'kernel = "inverse"\n\n[[scheme]]\nmodel = 2\ndivergence = "local"\n'
                   'kernel = "cubic-spline"\n'))
IDENTITIES = STUDY[:STUDY.index("[time]")].replace('title = "A tiny study"', 'kind = "identities"') + (
    "[sweep]\nN = [16]\nratios = [2]\n")
FLIPS = 25


def flipped(content, place, bit):
    changed = bytearray(content)
    changed[place] ^= 1 << bit
    return bytes(changed)


class Damage(ProgramTest):
    def flips(self, content, count=FLIPS):
        """Bits of the content, the same in every run of the test."""
        chance = random.Random(17)
        return [(chance.randrange(len(content)), chance.randrange(8)) for _ in range(count)]

    def test_of_result_files(self):
        for text in (TWO, IDENTITIES):
            self.run_study(text, "--jobs", "1")
            file = self.folder / "out" / "tiny.h5"
            whole, result = file.read_bytes(), numbers(file)
            for place, bit in self.flips(whole):
                with self.subTest(place=place, bit=bit):
                    file.write_bytes(flipped(whole, place, bit))
                    done = self.run_study(text, "--jobs", "1")
                    if done.returncode == 4:  # nothing of it can be read
                        self.assertIn("tiny.h5: not a readable result file", done.stderr)
                        continue
                    # Behind its words the first block is empty, and nobody reads it.
                    self.assertIn(done.returncode, (0, 1))
                    self.assertEqual("not as it was written" in done.stderr, place < 50 or place >= 512, done.stderr)
                    self.assertEqual(numbers(file), result)

    def test_a_bad_case_is_named_and_the_others_stand(self):
        self.run_study(TWO)
        file = self.folder / "out" / "tiny.h5"
        result = numbers(file)
        with h5py.File(file, "r+") as opened:
            opened["series/001/cases/32/u"][3] *= 1.0000000000001
        done = self.run_study(TWO)
        self.assert_counts(done, 1, 5)
        self.assertIn("out/tiny.h5: series 001, N = 32: not as it was written", done.stderr)
        self.assertEqual(numbers(file), result)
        self.assertNotIn("written", self.run_study(TWO).stderr)

    def test_of_json(self):
        self.run_study(GOOD, expect=0)
        file = self.folder / "out" / "tiny.json"
        whole = file.read_bytes()
        values = strict_json(whole)
        values.pop("checksum")
        for place, bit in self.flips(whole):
            with self.subTest(place=place, bit=bit):
                file.write_bytes(flipped(whole, place, bit))
                done = self.acstudy("check", "out/tiny.json")
                if done.returncode == 0:
                    found = strict_json(file.read_bytes())
                    found.pop("checksum", None)
                    found = {key: value for key, value in found.items() if key in values}
                    self.assertEqual(found, values)
        # Whoever sets the same values in another way does no harm.
        file.write_text(json.dumps(strict_json(whole)), encoding="utf-8")
        self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 0)
        result = strict_json(whole)
        result["series"][0]["cases"][1]["seconds"] += 1
        file.write_text(json.dumps(result), encoding="utf-8")
        done = self.acstudy("check", "out/tiny.json")
        self.assertEqual(done.returncode, 1)
        self.assertIn("damaged, expected a file as it was written", done.stdout)
        for command in (("table", "out/tiny.json"), ("compare", "out/tiny.json", "out/tiny.h5")):
            self.assertIn("out/tiny.json: its checksum is not that of its values", self.acstudy(*command).stderr)
        self.run_study(GOOD, expect=0)
        self.assertEqual(self.acstudy("check", "out/tiny.json").returncode, 0)

    def test_of_a_bench(self):
        self.write("tiny.toml", TWO)
        bench = ("bench", "tiny.toml", "--out", "out", "--runs", "2", "--least-seconds", "0")
        self.assertEqual(self.acstudy(*bench).returncode, 0)
        file = self.folder / "out" / "bench.h5"
        whole = file.read_bytes()
        for place, bit in self.flips(whole, 15):
            with self.subTest(place=place, bit=bit):
                file.write_bytes(flipped(whole, place, bit))
                done = self.acstudy(*bench)
                self.assertEqual(done.returncode, 4 if place < 50 or place >= 512 else 0)
                self.assertEqual("bench.h5: not a readable bench (it is not as it was written)" in done.stderr,
                                 done.returncode == 4)

    def test_formats_of_other_versions(self):
        self.run_study(STUDY)
        file = self.folder / "out" / "tiny.h5"
        for found, said in (("acstudy-2", "its format acstudy-2 is that of a newer version"), ("x", "its format is not")):
            with self.subTest(found):
                with h5py.File(file, "r+") as opened:
                    opened.attrs["format"] = np.bytes_(found)
                reseal(file)
                done = self.run_study(STUDY, expect=4)
                self.assertIn(said, done.stderr)


if __name__ == "__main__":
    unittest.main()
