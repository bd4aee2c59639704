"""The commands as data: help texts with examples, nearest words, completion of shells, the man page."""

import os
import re
import shutil
import subprocess
import unittest

from tests.program import ACSTUDY, ProgramTest

COMMANDS = re.findall(r"^  ([a-z]+)  ", subprocess.run([ACSTUDY, "--help"], text=True, capture_output=True, check=True)
                      .stdout.partition("Commands:")[2].partition("Options:")[0], re.MULTILINE)


class Help(ProgramTest):
    def test_every_command_has_two_examples_that_name_what_it_has(self):
        self.assertLessEqual({"run", "check", "compare", "fit", "bench", "explain", "list", "completion", "man"}, set(COMMANDS))
        for command in ("", *COMMANDS):
            with self.subTest(command):
                done = self.acstudy(*command.split(), "--help")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                usage, _, examples = done.stdout.partition("\nExamples:\n")
                self.assertIn(f"Usage: acstudy {command or 'COMMAND'} [OPTIONS]", usage)
                lines = re.findall(r"^  (acstudy .*)$", examples, re.MULTILINE)
                self.assertGreaterEqual(len(lines), 2)
                for line in lines:
                    for option in re.findall(r" (--?[a-z]+)", line.partition("|")[0]):
                        self.assertIn(option, usage)
                self.assertTrue(all(len(line) <= 80 for line in done.stdout.splitlines()))

    def test_defaults_and_choices_are_named(self):
        said = re.sub(r"\s+", " ", self.acstudy("run", "--help").stdout)
        for words in ("--out DIR", "(reports/out)", "vector: ", "readable: ", "(vector)", "from 1 to 1024", "-v, --verbose",
                      "-q, --quiet", "not with --quiet"):
            self.assertIn(words, said)
        said = re.sub(r"\s+", " ", self.acstudy("fit", "--help").stdout)
        for words in ("--dimension D", "goes with --count", "not with --error, --weight", "(h)"):
            self.assertIn(words, said)


class Nearest(ProgramTest):
    def test_a_wrong_word_is_answered_with_the_nearest(self):
        self.write("good.toml", "")
        for arguments, said in ((("rn",), 'unknown command "rn"; did you mean "run"? see acstudy --help'),
                                (("chekc", "x"), 'unknown command "chekc"; did you mean "check"? see '),
                                (("frobnicate",), 'unknown command "frobnicate"; write one of run, check, '),
                                (("run", "good.toml", "--jbos", "3"),
                                 'unknown option "--jbos" of run; did you mean "--jobs"? see acstudy run --help'),
                                (("run", "good.toml", "--verbos"),
                                 'unknown option "--verbos" of run; did you mean "--verbose"? see acstudy run --help'),
                                (("run", "good.toml", "--repaets=3"),
                                 'unknown option "--repaets" of run; did you mean "--repeats"? see acstudy run --help'),
                                (("run", "good.toml", "--form", "vectr"),
                                 '--form: "vectr" is none of vector, readable; did you mean "vector"? see acstudy run --help'),
                                (("list", "kernel"), '"kernel" is none of schemes, kernels, integrators, scenes, kinds, '
                                                     'keys; did you mean "kernels"? see acstudy list --help'),
                                (("--verison",), 'unknown option "--verison"; did you mean "--version"? ')):
            with self.subTest(arguments):
                done = self.acstudy(*arguments)
                self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1), done.stderr)
                self.assertIn(said, done.stderr)


class Completion(ProgramTest):
    def setUp(self):
        super().setUp()
        for name in ("fig1.toml", "fig2.toml", "notes.txt", "out.json"):
            self.write(name, "")
        (self.folder / "folder").mkdir()

    def completed(self, *words):
        """What bash offers for the last of the words."""
        script = self.acstudy("completion", "bash").stdout
        quoted = " ".join(f"'{word}'" for word in ("acstudy", *words))
        done = subprocess.run(["bash", "--norc", "-c", f"{script}\nCOMP_WORDS=({quoted}); COMP_CWORD={len(words)}\n_acstudy\n"
                               "printf '%s\\n' \"${COMPREPLY[@]}\""],
                              cwd=self.folder, text=True, capture_output=True, check=False, timeout=20)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return sorted(done.stdout.split())

    @unittest.skipUnless(shutil.which("bash"), "needs bash")
    def test_bash_completes_commands_options_values_and_files(self):
        for words, offered in ((("",), sorted((*COMMANDS, "--help", "--version"))), (("r",), ["run"]),
                               (("run", "--jo"), ["--jobs"]), (("run", "--form", ""), ["readable", "vector"]),
                               (("run", "-v", ""), ["fig1.toml", "fig2.toml", "folder"]),
                               (("run", "fig1.toml", "fig"), ["fig1.toml", "fig2.toml"]),
                               (("run", "--out", ""), ["folder"]), (("run", "--jobs", ""), []),
                               (("check", ""), ["folder", "out.json"]), (("list", "ke"), ["kernels", "keys"]),
                               (("completion", ""), ["bash", "zsh"]), (("nonsense", ""), [])):
            with self.subTest(words):
                self.assertEqual(self.completed(*words), offered)

    @unittest.skipUnless(shutil.which("bash"), "needs bash")
    def test_bash_registers_it(self):
        script = self.acstudy("completion", "bash").stdout
        done = subprocess.run(["bash", "--norc", "-c", f"{script}\ncomplete -p acstudy"], text=True, capture_output=True,
                              check=False, timeout=20)
        self.assertEqual((done.returncode, done.stdout), (0, "complete -o filenames -F _acstudy acstudy\n"))

    def test_every_option_is_in_both(self):
        for shell in ("bash", "zsh"):
            script = self.acstudy("completion", shell).stdout
            for command in COMMANDS:
                self.assertRegex(script, rf"\n    {command}\)\n")
                for option in re.findall(r"^  (?:-\w, )?(--[a-z-]+)", self.acstudy(command, "--help").stdout, re.MULTILINE):
                    self.assertIn(option, script)

    @unittest.skipUnless(shutil.which("zsh"), "needs zsh")
    def test_zsh_reads_it(self):
        self.write("_acstudy", self.acstudy("completion", "zsh").stdout)
        done = subprocess.run(["zsh", "-f", "-c", "autoload -Uz compinit && compinit -u -D && source ./_acstudy && "
                               "print $_comps[acstudy]"], cwd=self.folder, text=True, capture_output=True, check=False,
                              timeout=20)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "_acstudy\n", ""))

    def test_another_shell_is_refused(self):
        done = self.acstudy("completion", "fish")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn('"fish" is none of bash, zsh', done.stderr)


class Manual(ProgramTest):
    def test_it_has_every_command_option_and_exit_code(self):
        page = self.acstudy("man").stdout
        plain = page.replace("\\-", "-")
        for command in COMMANDS:
            self.assertIn(f"\n.SS {command}\n", plain)
            for option in re.findall(r"^  (?:-\w, )?(--[a-z-]+)", self.acstudy(command, "--help").stdout, re.MULTILINE):
                self.assertIn(option, plain)
        for code in (0, 1, 2, 3, 4, 130):
            self.assertRegex(plain, rf"\n\.TP\n\.B {code}\n")

    @unittest.skipUnless(shutil.which("man"), "needs man")
    def test_man_formats_it_without_a_warning(self):
        page = self.write("acstudy.1", self.acstudy("man").stdout)
        done = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", page], text=True, capture_output=True, check=False,
                              timeout=60, env={**os.environ, "MANWIDTH": "80", "LC_ALL": "C.UTF-8"})
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("EXIT STATUS", done.stdout)
        self.assertTrue(ACSTUDY.name in done.stdout)


if __name__ == "__main__":
    unittest.main()
