"""Headless Chromium on a report: the page is opened, pointed at, typed into, printed."""

import os
from pathlib import Path
import shutil
import subprocess
import tarfile
import tempfile
import unittest

from tests.result_files import ReportTest

# Where tests have to run, as in CI, nothing that is missing is passed over.
REQUIRED = os.environ.get("ACSTUDY_BROWSER") == "required"
AXE = "axe-core@4.10.3"
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


def why_not():
    """What is missing; "" if nothing is."""
    if CHROMIUM is None or shutil.which("chromedriver") is None:
        return "needs Chromium and its driver: scripts/setup.sh browser"
    try:
        import selenium     # noqa: F401
    except ImportError:
        return "needs selenium for Python: scripts/setup.sh browser"
    return ""


def needs_browser(tests):
    """Skips a class of tests with a word where Chromium is missing; where it is required, they fail."""
    return tests if REQUIRED else unittest.skipIf(why_not(), why_not())(tests)


def axe():
    """The text of axe-core, which npm fetches once into the build folder."""
    program = os.environ.get("ACSTUDY")
    folder = (Path(program).parent if program else Path(tempfile.gettempdir())) / "axe-core"
    folder.mkdir(parents=True, exist_ok=True)
    archive = folder / f"{AXE.replace('@', '-')}.tgz"
    if not archive.exists():
        if shutil.which("npm") is None:
            raise _missing("needs npm for axe-core: scripts/setup.sh browser")
        done = subprocess.run(["npm", "pack", "--silent", AXE], cwd=folder, text=True, capture_output=True, check=False)
        if done.returncode:
            raise _missing(f"npm pack {AXE}: {done.stderr.strip()[-200:]}")
    with tarfile.open(archive) as file:
        return file.extractfile("package/axe.min.js").read().decode()


def _missing(what):
    return AssertionError(what) if REQUIRED else unittest.SkipTest(what)


class BrowserTest(ReportTest):
    """Has one browser for all tests of a class; each opens the page anew."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        from selenium import webdriver
        options = webdriver.ChromeOptions()
        options.binary_location = CHROMIUM
        for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                         "--hide-scrollbars", "--force-prefers-reduced-motion"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        service = webdriver.chrome.service.Service(shutil.which("chromedriver"))
        cls.browser = webdriver.Chrome(service=service, options=options)
        cls.addClassCleanup(cls.browser.quit)

    def open(self, path, place="", width=1300, height=900, **media):
        """Opens a file. `media`: features such as prefers_color_scheme="dark", and medium="print"."""
        medium = media.pop("medium", "")
        features = [{"name": name.replace("_", "-"), "value": value} for name, value in media.items()]
        self.command("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.command("Emulation.setEmulatedMedia", media=medium, features=features)
        self.browser.get("about:blank")     # else another place of the same file is no new page
        self.browser.get(f"{Path(path).as_uri()}{place}")
        self.settle()

    def command(self, name, **arguments):
        return self.browser.execute_cdp_cmd(name, arguments)

    def run_script(self, text, *arguments):
        return self.browser.execute_script(text, *arguments)

    def settle(self):
        """Waits until the page has done what it does after a frame."""
        self.browser.execute_async_script(
            "const done = arguments[0]; requestAnimationFrame(() => setTimeout(() => setTimeout(done, 0), 0));")

    def find(self, selector):
        return self.browser.find_element("css selector", selector)

    def errors(self):
        """What the console has complained of since the last time."""
        return [entry["message"] for entry in self.browser.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]
