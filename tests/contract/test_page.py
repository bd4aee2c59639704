"""The page of a report in a browser: it answers to pointer, keys and address, reads anywhere, and is for everybody."""

import base64
import json
import math
from pathlib import Path
import re
import tempfile
import unittest

import numpy as np

from tests.browser import BrowserTest, axe, needs_browser
from tests.result_files import finding, series, write

import report


def results(folder):
    """A few results of every way in which the page shows some; one finding departs."""
    schemes = (dict(), dict(divergence="nonlocal", error_linf=0.9 * 2 * math.pi / np.array([160, 320, 640, 1280])))
    write(folder, "fig2", *(series(path=path, **scheme) for path in ("delta = 4h", "delta = h^2") for scheme in schemes),
          title="Asymptotic compatibility of Model I")
    write(folder, "theorem", *(series(path="delta = sqrt(h)", kernel="power", alpha=0.5, **scheme) for scheme in schemes))
    write(folder, "stiff", *(series(stepping=way, theory_statement="Stiff scenes") for way in ("explicit", "implicit")))
    statements = ("Lemma 2.3", "Lemma 2.5")
    some = [finding(check=f"uniform, delta = {i}h", statement=statements[i % 2], observed_order=0.9 + i / 100)
            for i in range(2, 12)]
    bad = finding(check="moved, delta = 4h", verdict="below", as_expected=0, alarm=1, observed_order=0.5,
                  reason="pairwise orders 0.5")
    write(folder, "consistency", kind="consistency", findings=[*some, bad])
    checks = ("step norm", "maximum principle", "alarms")
    wrong = [finding(subject=subject, check=check, test="bounds", upper=1.0, verdict="violated", promised="holds",
                     expected="violated", alarm=1, remark="nothing of it") for subject in ("no viscosity (Model II, local)",)
             for check in checks]
    true = [finding(subject="Model II", check=check, test="bounds", upper=1.0) for check in checks]
    write(folder, "controls", kind="controls", findings=[*true, *wrong])


@needs_browser
class Page(BrowserTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        results(folder.name)
        cls.page = report.report(Path(folder.name), sorted(Path(folder.name).glob("*.h5")))

    def rows(self, table, column):
        """Texts of a column of the table with this label, of the rows that are shown."""
        return self.run_script(
            "return [...document.querySelector(`table[aria-label='${arguments[0]}']`).tBodies[0].rows]"
            ".filter(row => row.offsetParent !== null).map(row => row.cells[arguments[1]].textContent)", table, column)

    def point_at(self, stem, curve, point):
        """Moves the pointer onto a point of a figure."""
        self.run_script("document.querySelector(`[data-figure='${arguments[0]}'] .card`).scrollIntoView()", stem)
        x, y = self.run_script("""
            const figure = document.querySelector(`figure[data-figure='${arguments[0]}']`), svg = figure.querySelector("svg");
            const [x, y] = JSON.parse(figure.querySelector("script").textContent)[arguments[1]][4][arguments[2]];
            const at = new DOMPoint(x, y).matrixTransform(svg.getScreenCTM());
            return [at.x, at.y];""", stem, curve, point)
        self.command("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)

    def test_it_opens_without_a_complaint_and_asks_for_nothing(self):
        self.open(self.page)
        self.assertEqual(self.errors(), [])
        self.assertEqual(self.run_script("return performance.getEntriesByType('resource').map(one => one.name)"), [])
        self.assertEqual(self.run_script("return [...document.images].filter(one => !one.naturalWidth).length"), 0)
        self.assertGreater(self.run_script("return document.querySelectorAll('svg.drawing path').length"), 20)

    def test_the_first_screen_says_what_holds_and_what_departs(self):
        self.open(self.page)
        below = self.run_script("return ['#q\\\\.departing tr.departs', '.verdicts'].map("
                                "one => document.querySelector(one).getBoundingClientRect().top)")
        self.assertLess(max(below), 900)
        self.assertIn("1 of 17 findings", self.find(".outcome").text)
        self.assertEqual(self.run_script("return document.querySelectorAll('.verdicts .mark.bad').length"), 1)

    def test_a_point_tells_what_it_is_and_its_series_stands_out_in_every_panel(self):
        self.open(self.page)
        self.point_at("fig2", 0, 1)
        tip = self.find(".tip").text
        for text in ("Model I, local divergence", "delta = 4h; order 0.97 [0.95, 1.01], theory 1: confirmed", "320",
                     "order to the coarser", "seconds"):
            self.assertIn(text, tip)
        lit = self.run_script("return [...document.querySelectorAll('.highlighted .lit')].map(one => one.dataset.series)")
        self.assertEqual((len(lit), set(lit)), (2, {"model-i-local-divergence"}))
        self.command("Input.dispatchMouseEvent", type="mouseMoved", x=5, y=5)
        self.assertEqual(self.run_script("return document.querySelectorAll('.tip').length"), 0)

    def test_keys_go_through_points_and_say_them(self):
        self.open(self.page)
        self.run_script("document.querySelector(\"[data-figure=fig2] .card\").focus()")
        for key, text in (("ArrowRight", "N 160"), ("ArrowRight", "N 320"), ("ArrowDown", "nonlocal divergence")):
            self.press(key)
            self.assertIn(text, self.find(".told").get_attribute("textContent"))
        self.press("Enter")
        self.assertIn("hide%20fig2=model-i-nonlocal-divergence", self.browser.current_url)

    def press(self, key):
        self.command("Input.dispatchKeyEvent", type="keyDown", key=key, code=key)
        self.command("Input.dispatchKeyEvent", type="keyUp", key=key, code=key)

    def test_a_click_on_a_legend_hides_its_series_and_the_address_keeps_it(self):
        self.open(self.page)
        hidden = ("return [...document.querySelectorAll('[data-figure=fig2] [data-series]')].filter(one => "
                  "getComputedStyle(one).display === 'none').length")
        self.assertEqual(self.run_script(hidden), 0)
        self.run_script("document.querySelector(\"[data-figure=fig2] [data-legend='model-i-local-divergence'] text\")"
                        ".dispatchEvent(new MouseEvent('click', {bubbles: true}))")
        self.assertEqual(self.run_script(hidden), 2)
        self.open(self.page, "#" + self.browser.current_url.partition("#")[2])
        self.assertEqual(self.run_script(hidden), 2)

    def test_tables_are_sorted_by_their_heads_and_the_address_keeps_it(self):
        self.open(self.page, "#consistency")
        label = "A study"
        self.unfold()
        head = f"document.querySelector(`table[aria-label='{label}'] thead th:nth-child(3) button`)"
        self.run_script(f"{head}.click()")
        orders = [float(re.search(r"[\d.]+", text)[0]) for text in self.rows(label, 2)]
        self.assertEqual(orders, sorted(orders))
        self.assertEqual(orders[0], 0.5)
        self.run_script(f"{head}.click()")
        self.open(self.page, "#" + self.browser.current_url.partition("#")[2])
        self.unfold()
        again = [float(re.search(r"[\d.]+", text)[0]) for text in self.rows(label, 2)]
        self.assertEqual(again, sorted(orders, reverse=True))
        self.assertEqual(self.run_script(f"return {head}.parentElement.ariaSort"), "descending")

    def unfold(self):
        self.run_script("for (const fold of document.querySelectorAll('details')) fold.open = true")
        self.settle()

    def test_rows_are_filtered_and_saved(self):
        self.open(self.page)
        self.unfold()
        field = self.find("input[aria-label='filter rows of A study']")
        field.send_keys("2.3 5h")
        self.assertEqual(self.rows("A study", 1), [])
        field.clear()
        field.send_keys("4h 2.3")
        self.assertEqual(self.rows("A study", 1), ["uniform, delta = 4h"])
        saved = self.browser.execute_async_script("""
            const done = arguments[0];
            URL.createObjectURL = (blob) => (blob.text().then(done), "");
            HTMLAnchorElement.prototype.click = () => {};
            document.querySelector("button[aria-label='CSV of A study']").click();""")
        lines = saved.strip().splitlines()
        self.assertEqual(len(lines), 2)
        self.assertIn('"uniform, delta = 4h"', lines[1])
        self.open(self.page, "#" + self.browser.current_url.partition("#")[2])
        self.unfold()
        self.assertEqual(self.rows("A study", 1), ["uniform, delta = 4h"])

    def test_a_statement_leads_to_its_findings_alone(self):
        self.open(self.page)
        self.run_script("document.querySelector(\"a[data-find='Lemma 2.3']\").click()")
        self.settle()
        self.assertEqual(len(self.rows("A study", 1)), 5)
        self.assertTrue(self.browser.current_url.partition("#")[2].startswith("consistency&"))

    def test_departing_only(self):
        self.open(self.page, "#&only=departing")
        shown = self.run_script("return [...document.querySelectorAll('.study')].filter(one => one.offsetParent).map(one => one.id)")
        self.assertEqual(shown, ["consistency"])
        self.assertEqual(self.rows("A study", 1), ["moved, delta = 4h"])
        self.run_script("document.querySelector('.tools input').click()")
        self.assertEqual(self.run_script("return [...document.querySelectorAll('.study')].every(one => one.offsetParent)"), True)

    def test_the_reader_goes_back(self):
        self.open(self.page)
        self.run_script("document.querySelector('nav a').click()")
        self.assertIn("#q.figures", self.browser.current_url)
        self.run_script("history.back()")
        self.settle()
        self.assertNotIn("#q.figures", self.browser.current_url)

    def test_dark_is_dark_in_figures_too_and_paper_is_white(self):
        colors = ("return [getComputedStyle(document.body).backgroundColor, "
                  "getComputedStyle(document.querySelector('.card')).backgroundColor, "
                  "getComputedStyle(document.querySelector('svg.drawing')).fill]")
        light, dark, white = "rgb(255, 255, 255)", "rgb(20, 24, 29)", "rgb(0, 0, 0)"
        self.open(self.page)
        self.assertEqual(self.run_script(colors), [light, light, white])
        self.open(self.page, prefers_color_scheme="dark")
        self.assertEqual(self.run_script(colors)[:2], [dark, dark])
        self.assertNotEqual(self.run_script(colors)[2], white)
        self.open(self.page, "#&theme=light", prefers_color_scheme="dark")
        self.assertEqual(self.run_script(colors), [light, light, white])
        self.open(self.page, "#&theme=dark")
        self.assertEqual(self.run_script(colors)[:2], [dark, dark])
        self.open(self.page, "#&theme=dark", medium="print")
        self.assertEqual(self.run_script(colors), [light, light, white])

    def test_it_prints_without_what_paper_cannot_do(self):
        self.open(self.page, medium="print")
        seen = self.run_script("return ['nav', '.tools', '.finder', '#q\\\\.explorer'].filter("
                               "one => document.querySelector(one)?.offsetParent)")
        self.assertEqual(seen, [])
        badge = self.run_script("const style = getComputedStyle(document.querySelector('.badge.good'));"
                                "return [style.borderTopStyle, style.color]")
        self.assertEqual(badge, ["solid", "rgb(27, 31, 36)"])
        heads = self.run_script("return [...document.querySelectorAll('thead th button')].map("
                                "one => getComputedStyle(one).display)")
        self.assertEqual(set(heads), {"contents"}, "heads of the next page would be empty")
        printed = base64.b64decode(self.command("Page.printToPDF", preferCSSPageSize=True)["data"])
        pages = len(re.findall(rb"/Type\s*/Page\b", printed))
        self.assertTrue(3 <= pages <= 25, pages)

    def test_no_width_makes_the_page_scroll_sideways(self):
        for width in (375, 768, 1300):
            self.open(self.page, width=width)
            self.unfold()
            self.assertLessEqual(self.run_script("return document.documentElement.scrollWidth"), width)
        wide = self.run_script("return [...document.querySelectorAll('.scroll')].filter(one => "
                               "one.scrollWidth > one.clientWidth + 1).map(one => one.firstElementChild.ariaLabel)")
        self.assertEqual(wide, [])

    def test_keys_reach_the_results_in_a_few_steps(self):
        self.open(self.page)
        self.press("Tab")
        self.assertEqual(self.run_script("return document.activeElement.className"), "skip")
        stops = self.run_script("return [...document.querySelectorAll('a[href], button, input, select, summary, "
                                "[tabindex=\"0\"]')].filter(one => one.offsetParent && one.tabIndex >= 0).length")
        self.assertLess(stops, 90)
        self.run_script("document.querySelector('#q\\\\.theorems tbody a').focus()")
        places = []
        for key in ("ArrowDown", "ArrowUp"):
            places.append(self.run_script("return document.activeElement.outerHTML"))
            self.press(key)
        places.append(self.run_script("return document.activeElement.outerHTML"))
        self.assertNotEqual(places[0].replace("-1", "0"), places[1])
        self.assertEqual(places[0], places[2])
        self.assertEqual(self.run_script("return document.querySelectorAll('.scroll[tabindex]').length"), 0)

    def test_headings_are_in_order(self):
        self.open(self.page)
        levels = self.run_script("return [...document.querySelectorAll('h1, h2, h3, h4')].map(one => Number(one.tagName[1]))")
        self.assertEqual(levels[0], 1)
        self.assertEqual(levels.count(1), 1)
        self.assertTrue(all(after <= before + 1 for before, after in zip(levels, levels[1:])), levels)
        said = self.run_script("return [...document.querySelectorAll('h3')].map(one => one.textContent)")
        self.assertEqual(len(said), len(set(said)))

    def test_any_quantity_is_explored_over_any_other(self):
        self.open(self.page, "#q.explorer")
        circles = "return document.querySelectorAll('.explorer circle').length"
        every = self.run_script(circles)
        self.assertEqual(every, 32)
        self.choose("path", "delta = h^2")
        self.choose("x", "N")
        self.assertEqual(self.run_script(circles), 8)
        self.assertIn("8 cases of 2 series", self.find(".explorer [role=status]").text)
        self.assertIn("explore%20path=delta", self.browser.current_url)
        self.open(self.page, "#" + self.browser.current_url.partition("#")[2])
        self.assertEqual(self.run_script(circles), 8)
        self.assertEqual(self.run_script("return document.querySelector('.explorer svg').lastChild.tagName"), "circle")
        best = self.run_script("return [...document.querySelectorAll('.explorer tbody tr')].map(one => one.textContent)")
        self.assertEqual(len(best), 4)
        self.assertTrue(all("nonlocal" in text for text in best), best)     # its errors are smaller at every N

    def choose(self, name, value):
        self.run_script("const input = document.querySelector(`.explorer select[name=${arguments[0]}]`);"
                        "input.value = arguments[1]; input.dispatchEvent(new Event('change'))", name, value)

    def test_without_a_script_all_of_it_can_be_read(self):
        self.command("Emulation.setScriptExecutionDisabled", value=True)
        self.addCleanup(self.command, "Emulation.setScriptExecutionDisabled", value=False)
        self.browser.get("about:blank")
        self.browser.get(self.page.as_uri())
        for text in ("1 of 17 findings not as expected", "Lemma by lemma", "no viscosity"):
            self.assertIn(text, self.find("body").text)
        self.assertIn("pairwise orders 0.5", self.find("body").get_attribute("textContent"))

    def test_axe_finds_nothing_serious(self):
        text = axe()
        for media in (dict(), dict(prefers_color_scheme="dark"), dict(width=375)):
            with self.subTest(media):
                self.open(self.page, **media)
                self.unfold()
                self.run_script(text)
                found = self.browser.execute_async_script(
                    "const done = arguments[0]; axe.run(document, {resultTypes: ['violations']}).then(one => done(JSON.stringify("
                    "one.violations.map(v => [v.impact, v.id, v.nodes.slice(0, 3).map(n => n.html.slice(0, 200) + n.failureSummary)]))))")
                serious = [one for one in json.loads(found) if one[0] in ("serious", "critical")]
                self.assertEqual(serious, [], json.dumps(serious, indent=1))


if __name__ == "__main__":
    unittest.main()
