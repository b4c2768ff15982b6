"""A page in a browser without a window: what it shows, and what a user can do to it."""
import base64
import json
import shutil
import tempfile
import time

import pytest

webdriver = pytest.importorskip("selenium.webdriver")

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
DRIVER = shutil.which("chromedriver")
needs_chromium = pytest.mark.skipif(not (CHROMIUM and DRIVER), reason="no Chromium: apt-get install chromium chromium-driver")

# Software rendering where there is no graphics card, and no background network traffic of the browser.
FLAGS = """--headless=new --no-sandbox --disable-gpu-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader
--ignore-gpu-blocklist --disable-background-networking --disable-component-update --disable-sync --no-first-run
--window-size=1400,900""".split()


class Page:
    """A page in a separate browser, with a log of its requests and errors."""

    def __init__(self, *flags):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        options = webdriver.ChromeOptions()
        options.binary_location = CHROMIUM
        for flag in [*FLAGS, *flags, f"--user-data-dir={self.folder.name}"]:
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(DRIVER))

    def open(self, page):
        """Open a page, given by its path or address; return the seconds until the first picture."""
        start = time.monotonic()
        self.driver.get(page if isinstance(page, str) else page.as_uri())
        self.settle()
        return time.monotonic() - start

    def settle(self, seconds=60):
        """Wait until the data are unpacked and the picture is drawn."""
        end = time.monotonic() + seconds
        while self.js("return document.documentElement.dataset.busy") != "0":
            assert time.monotonic() < end, "the page is not ready"
            time.sleep(0.02)
        self.driver.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")

    def js(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def element(self, name):
        return self.driver.find_element("id", name)

    def put(self, name, value, event="change"):
        """Set the value of an input element, with the event that a user would cause."""
        self.js("const e = document.getElementById(arguments[0]); e.value = arguments[1];"
                "e.dispatchEvent(new Event(arguments[2], { bubbles: true }))", name, str(value), event)
        self.settle()

    def part(self, name, visible=None, opacity=None):
        """Show or hide a patch or region, or set its opacity, by the controls of its row."""
        self.js("""
            const [name, visible, opacity] = arguments;
            const row = [...document.querySelectorAll("#part-lists li")].find((li) => li.textContent === name);
            const [box, knob] = row.querySelectorAll("input");
            if (visible !== null && box.checked !== visible) box.click();
            if (opacity !== null) {
              knob.value = opacity;
              knob.dispatchEvent(new Event("input", { bubbles: true }));
            }""", name, visible, opacity)
        self.settle()

    def opacities(self):
        """Return the opacity of each part in percent, as the panel shows it."""
        return self.js("""return Object.fromEntries([...document.querySelectorAll("#part-lists li")]
            .map((li) => [li.textContent, Number(li.querySelector("[type=range]").value)]))""")

    def downloads(self, folder):
        """Have the browser put downloads into `folder`."""
        self.driver.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(folder)})

    def click(self, name):
        self.js("document.getElementById(arguments[0]).click()", name)
        self.settle()

    def picture(self):
        """Return the picture as the bytes of a PNG file."""
        return base64.b64decode(self.js("return document.getElementById('view').toDataURL().split(',')[1]"))

    def thumbnail(self):
        """Return the colours of a small copy of the picture, for comparison but for the last digits."""
        return self.js("""
            const view = document.getElementById("view"), copy = document.createElement("canvas");
            [copy.width, copy.height] = [100, 60];
            const pen = copy.getContext("2d");
            pen.drawImage(view, 0, 0, 100, 60);
            return [...pen.getImageData(0, 0, 100, 60).data];""")

    def colours(self):
        """Return the approximate number of colours of the picture, and the fraction that is not
        background."""
        return self.js("""
            const view = document.getElementById("view"), copy = document.createElement("canvas");
            [copy.width, copy.height] = [200, 120];
            const pen = copy.getContext("2d");
            pen.drawImage(view, 0, 0, 200, 120);
            const data = pen.getImageData(0, 0, 200, 120).data, seen = new Map();
            for (let i = 0; i < data.length; i += 4) {
              const key = (data[i] >> 4) + "," + (data[i + 1] >> 4) + "," + (data[i + 2] >> 4);
              seen.set(key, (seen.get(key) ?? 0) + 1);
            }
            return [seen.size, 1 - Math.max(...seen.values()) / (200 * 120)];""")

    def red(self):
        """Count the pixels of a smaller copy that have the red of bad tets."""
        return self.js("""
            const view = document.getElementById("view"), copy = document.createElement("canvas");
            [copy.width, copy.height] = [400, 240];
            const pen = copy.getContext("2d");
            pen.drawImage(view, 0, 0, 400, 240);
            const data = pen.getImageData(0, 0, 400, 240).data;
            let n = 0;
            for (let i = 0; i < data.length; i += 4) n += data[i] > 150 && data[i + 1] < 70 && data[i + 2] < 80;
            return n;""")

    def requests(self):
        """Return the URLs that were requested, except the page itself."""
        urls = []
        for entry in self.driver.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            # The first tab of the browser makes requests as well.
            if message["method"] == "Network.requestWillBeSent" and message["params"]["documentURL"].startswith("file:"):
                urls.append(message["params"]["request"]["url"])
        assert urls, "not even the page was requested"
        return [url for url in urls if not url.startswith(("file:", "data:"))]

    def violations(self):
        """Return the rules of accessibility that the page violates, as axe finds them."""
        axe = pytest.importorskip("axe_core_python.selenium")
        self.driver.set_script_timeout(100)  # a busy machine with software rendering takes longer than the usual 30 s
        return [violation["help"] for violation in axe.Axe().run(self.driver)["violations"]]

    def errors(self):
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] != "INFO"]

    def close(self):
        self.driver.quit()
        self.folder.cleanup()
