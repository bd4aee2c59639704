"""What a report keeps of the last one: never what is out of date, damaged or made by somebody else."""

import multiprocessing
import os
import pickle
import shutil
import unittest
from unittest import mock

from tests.result_files import ReportTest, finding, series, write

from drawing import look
from reading import made
from reading import kept, results


class Kept(ReportTest):
    def setUp(self):
        super().setUp()
        write(self.folder, "fig1", series())
        write(self.folder, "ledger", kind="consistency", findings=[finding()])
        self.drawn, self.read = [], []

    def page(self, *arguments):
        """The page of a run in one process; what it drew and read is in `drawn` and `read`."""
        self.drawn.clear(), self.read.clear()
        render, read_study = look.render, results.read_study
        with mock.patch("os.sched_getaffinity", lambda _: {0}), \
                mock.patch("drawing.look.render", lambda one, *more: self.drawn.append(one.stem) or render(one, *more)), \
                mock.patch("reading.results.read_study", lambda path: self.read.append(path.stem) or read_study(path)):
            code, _, err = self.run_report(self.folder, *arguments)
        self.assertEqual((code, err), (0, ""))
        return (self.folder / "index.html").read_text(encoding="utf-8")

    def entries(self):
        return sorted((self.folder / kept.FOLDER).iterdir())

    def test_nothing_is_made_twice_and_the_page_is_the_same(self):
        first = self.page()
        self.assertEqual(sorted(self.drawn), ["cost.lee-du-2019", "fig1", "ledger.lemma-2-5"])
        self.assertEqual(self.read, ["fig1", "ledger"])
        self.assertEqual(self.page(), first)
        self.assertEqual((self.drawn, self.read), ([], []))
        shutil.rmtree(self.folder / kept.FOLDER)
        self.assertEqual(self.page(), first)

    def test_what_changes_is_made_anew_and_nothing_else(self):
        self.page()
        time = os.stat(self.folder / "ledger.h5").st_mtime
        write(self.folder, "ledger", kind="consistency", findings=[finding(subject="another scheme")])
        os.utime(self.folder / "ledger.h5", (time, time))      # a clock is not believed
        html = self.page()
        self.assertEqual((self.drawn, self.read), (["ledger.lemma-2-5"], ["ledger"]))
        self.assertIn("another scheme", html)

    def test_a_figure_whose_looks_depend_on_another_study_changes_with_it(self):
        write(self.folder, "fig2", series(divergence="nonlocal"))
        self.page()
        # Before the others in the order of names, it takes the first looks.
        write(self.folder, "fig0", series(kernel="power", alpha=0.5))
        whole = self.page()
        self.assertIn("fig1", self.drawn)
        shutil.rmtree(self.folder / kept.FOLDER)
        self.assertEqual(self.page(), whole)

    @unittest.skipUnless(multiprocessing.get_start_method() == "fork" and hasattr(os, "sched_getaffinity"),
                         "the processes have to inherit what is patched here")
    def test_two_processes_share_what_one_study_takes(self):
        write(self.folder, "ledger", kind="consistency",
              findings=[finding(statement=statement) for statement in ("Lemma 2.5", "Lemma 3.4, A", "Lemma 3.4, B")])
        alone = self.page()
        shutil.rmtree(self.folder / kept.FOLDER)
        (self.folder / "fig1.h5").rename(self.folder / "fig1.away")
        with mock.patch("os.sched_getaffinity", lambda _: {0, 1}), mock.patch("reading.made.LARGE", 0):
            self.assertEqual(self.run_report(self.folder)[0], 0)
        (self.folder / "fig1.away").rename(self.folder / "fig1.h5")
        self.assertEqual(self.page(), alone)
        self.assertEqual((self.drawn, self.read), (["fig1", "cost.lee-du-2019"], ["fig1"]))

    def test_files_are_drawn_though_the_figure_is_kept(self):
        self.page()
        self.page("--figures", self.folder / "figures", "--format", "svg")
        self.assertTrue((self.folder / "figures" / "fig1.svg").stat().st_size > 1000)

    def test_what_is_damaged_is_made_anew(self):
        first = self.page()
        for damage in (lambda content: content[: len(content) // 2], lambda content: b"", lambda content: content[:-1] + b"x"):
            for file in self.entries():
                file.write_bytes(damage(file.read_bytes()))
            self.assertEqual(self.page(), first)
            self.assertEqual(len(self.drawn), 3)

    def test_a_foreign_entry_calls_nothing(self):
        first = self.page()
        evil = pickle.dumps(Evil(self.folder / "called"))
        for file in self.entries():
            file.write_bytes(kept.hashlib.blake2b(evil, digest_size=16).digest() + evil)
        self.assertEqual(self.page(), first)
        self.assertFalse((self.folder / "called").exists())

    def test_other_sources_keep_nothing_of_these(self):
        self.page()
        before = self.entries()
        with mock.patch("reading.kept.digest", lambda *parts, made=kept.digest: made(*parts, "other sources")):
            self.page()
        self.assertEqual(len(self.drawn), 3)
        self.assertFalse(set(before) & set(self.entries()))

    def test_a_folder_that_cannot_be_written_to_keeps_nothing(self):
        def refused(path, content):
            raise PermissionError(path)

        one = kept.Kept(self.folder, refused)
        study, = made.studies([self.folder / "fig1.h5"], one)
        self.assertEqual(study.name, "fig1")


class Evil:
    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return os.mkdir, (str(self.path),)


if __name__ == "__main__":
    unittest.main()
