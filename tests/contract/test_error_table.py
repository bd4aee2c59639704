"""Tables of errors as programs and people write them, read by acstudy fit."""

import unittest

from tests.contract.test_fit import HALVED, power, table
from tests.program import ProgramTest

NOT_A_NUMBER = "not a number that a double can hold; write one such as 1.5e-3, nan or inf"
LEVELS = [(0.1, 0.01), (0.05, 0.0025), (0.025, 0.000625)]


class TableTest(ProgramTest):
    def test_separators_comments_order_and_line_ends_do_not_matter(self):
        expected = self.fitted(table(power(1)), "--order", "1", code=0)
        rows = table(power(1)).splitlines()
        for text in (table(power(1), ";"), table(power(1), "\t"), table(power(1), "  "), table(power(1), " , "),
                     "\n".join([rows[0]] + rows[:0:-1]), "\r\n".join(rows), "\ufeff" + "\n".join(rows),
                     "# made by hand\n\n" + "\n".join(f"{row}  # so it is" for row in rows) + "\n\n",
                     table(power(1), header=('"h"', '"error"'))):
            self.assertEqual(self.fitted(text, "--order", "1", code=0), expected, text)

    def test_columns_have_names(self):
        text = "N;L2;spacing;n\n" + "".join(f"{i};{e!r};{v!r};{1 + i}\n" for i, (v, e) in enumerate(zip(HALVED, power(2))))
        result = self.fitted(text, "--variable", "spacing", "--error", "L2", "--weight", "n", "--order", "2", code=0)
        self.assertEqual([level["weight"] for level in result["levels"]], [1, 2, 3, 4, 5])
        self.assert_bad_input(self.fit(text), 'table.csv:1:1: no column "h"; the columns are N, L2, spacing, n; '
                                              "name one with --variable")

    def test_what_cannot_be_read_is_named_by_line_and_column(self):
        positive = "it must be positive and finite; correct it or leave the row out"
        for text, message in (
                ("h,error\n0.1,abc\n", f'2:5: error = "abc"; {NOT_A_NUMBER}'),
                ("h,error\n0.1, 1e999\n", f'2:6: error = "1e999"; {NOT_A_NUMBER}'),
                ("h,error\n0.1,\n", '2:5: error = ""; the cell is empty; write a number there or leave the row out'),
                ("h,error\n0.1,0.2x\n", f'2:5: error = "0.2x"; {NOT_A_NUMBER}'),
                ("h;error\n0,1;0.2\n", '2:1: h = "0,1"; a decimal comma; write a point'),
                ("h,error\n-0.1,0.2\n", f"2:1: h = -0.1; {positive}"),
                ("h,error\nnan,0.2\n", f"2:1: h = nan; {positive}"),
                ("h,error\n# x\n0.1,0.2,3\n",
                 "3:1: 3 value(s), but the header names 2 column(s); write one value for each"),
                ("h,error,h\n1,2,3\n", '1:9: a second column "h"; name each once'),
                ("h,error\n", "1:1: the table has a header and no rows; write a row for each level"),
                ("# nothing\n", "1:1: the table has no header; write the names of the columns in its first line")):
            self.assert_bad_input(self.fit(text), f"table.csv:{message}")
        missing = "cannot read a table there; name a file whose first line names its columns"
        for file in ("none.csv", "."):
            self.assert_bad_input(self.acstudy("fit", file), f"{file}: {missing}")

    def test_tables_are_read_as_found(self):
        expected = [{"variable": h, "error": e, "weight": 1} for h, e in LEVELS]
        for name, text in {
                "Fortran": "h error\n 1.0D-01 1.00d-02\n 0.5-001 2.5E-3\n 0.25d-1 0.625-003\n",
                "quoted": '"h","error"\n"0.1","0.01"\n\'0.05\',"0.0025"\n "0.025" , "0.000625" \n',
                "numpy.savetxt": "# h error\n1.0e-01 1.0e-02\n5.0e-02 2.5e-03\n2.5e-02 6.25e-04\n",
                "numpy.savetxt with its usual delimiter": "# run 7\n# h,error\n0.1 0.01\n0.05 0.0025\n0.025 0.000625\n# end\n",
                "MATLAB": "% h error\n0.1 0.01\n0.05 0.0025\n0.025 0.000625\n",
                "tabs, one for several": "h\t\terror\n0.1\t0.01\n0.05\t\t0.0025\n0.025\t\t0.000625\n",
                "Markdown": "| h | error |\n|---|---:|\n| 0.1 | 0.01 |\n| 0.05 | 0.0025 |\n| 0.025 | 0.000625 |\n",
                "text with rules": "+---+---+\n| h | error |\n+===+===+\n| 0.1 | 0.01 |\n| 0.05 | 0.0025 |\n| 0.025 | 0.000625 |\n+---+---+",
                "TeX": "\\toprule\nh & error \\\\ \\hline\n1/10 & 0.01 \\\\\n1/20 & 0.0025 \\\\[2pt]\n1/40 & 0.000625 \\\\\n\\bottomrule\n",
                "rows of separators": "h,error\n0.1,0.01\n,\n0.05,0.0025\n0.025,0.000625\n,,,\n",
                "# in a name": "h,# cells,error\n0.1,1,0.01 # coarse\n0.05,2,0.0025\n0.025,3,0.000625\n"}.items():
            self.assertEqual(self.fitted(text, "--order", "2", code=0)["levels"], expected, name)

    def test_tabs_leave_blanks_in_names_and_cells_empty(self):
        text = "mesh size\tL2 error\tnote\tmax\n0.1\t0.01\t\t1\n0.05\t0.0025\ta b\t\n0.025\t0.000625\t\t2\n"
        names = ("--variable", "mesh size", "--error")
        self.assertEqual(len(self.fitted(text, *names, "L2 error", "--order", "2", code=0)["levels"]), 3)
        self.assert_bad_input(self.fit(text, *names, "max"), 'table.csv:3:17: max = ""; the cell is empty; '
                                                             "write a number there or leave the row out")

    def test_what_windows_prints_for_no_number_is_none(self):
        for text in ("1.#QNAN", "-1.#IND", "1.#INF", "-1.#INF00", "1.#J", "1.#QNAN0e+000", "-nan(ind)", "NaN", "Infinity",
                     "+Inf"):
            rows = f"h,error\n0.1,0.1\n0.05,{text}\n0.025,0.025 # last\n0.0125,0.0125\n"
            result = self.fitted(rows, "--order", "1", code=1)
            self.assertEqual((result["verdict"], result["levels"][1]["error"]), ("unstable", None), text)
            self.assertIn("inf" if "INF" in text.upper() or "J" in text else "nan", result["reason"], text)
        for text in ("1.#X", "1.#INFx", "1.0#", "+-1", "1.0-1", "1/2/3", "e5", "1e", "1.2.3", "0x10", ".", "1e999"):
            self.assert_bad_input(self.fit(f"h,error\n0.1,{text}\n"), f'table.csv:2:5: error = "{text}"; {NOT_A_NUMBER}')

    def test_encodings_and_line_ends_are_named(self):
        text = table(power(1))
        utf16 = "table.csv:1:1: the table is written in UTF-16, or it is no text; save it as UTF-8"
        for encoding in ("utf-16", "utf-16-le", "utf-16-be"):
            self.assert_bad_input(self.fit(text.encode(encoding)), utf16)
        self.assert_bad_input(self.fit(text.replace("\n", "\r")), "table.csv:1:8: a carriage return (CR) alone ends a "
                                                                  "line; save the table with line feeds (LF or CR LF)")

    def test_decimal_commas_are_named(self):
        comma = "a decimal comma; write a point"
        for text, message in (
                ("h error\n0,1 0,2\n", f'2:1: h = "0,1"; {comma}'),
                ("h\terror\n0.1\t0,2e-3\n", f'2:5: error = "0,2e-3"; {comma}'),
                ('h,error\n"0,1","0,2"\n', f'2:1: h = "0,1"; {comma}'),
                ("h,error\n0,1;0,2\n", '2:1: "0,1;0,2"; decimal commas, but the header is separated by commas; write points'),
                ("h,error\n0,1,0,2\n", "2:1: 4 value(s), but the header names 2 column(s); write one value for each, "
                                       "and points for decimal commas")):
            self.assert_bad_input(self.fit(text), f"table.csv:{message}")

    def test_a_missing_header_is_named(self):
        self.assert_bad_input(self.fit("# made by hand\n0.1,0.01\n0.05,0.0025\n"),
                              "table.csv:2:1: the first line holds numbers, 0.1, 0.01; "
                              "write the names of the columns in a line above")

    def test_standard_input(self):
        text = table(power(1))
        self.write("table.csv", text)
        self.assertEqual(self.acstudy("fit", "-", "--order", "1", input=text).stdout,
                         self.acstudy("fit", "table.csv", "--order", "1").stdout)
        self.assert_bad_input(self.acstudy("fit", "-", input="h,error\n-1,2\n"),
                              "<stdin>:2:1: h = -1; it must be positive and finite; correct it or leave the row out")
        self.assert_bad_input(self.acstudy("fit", "-", input=""), "<stdin>: cannot read a table there; "
                                                                  "name a file whose first line names its columns")


if __name__ == "__main__":
    unittest.main()
