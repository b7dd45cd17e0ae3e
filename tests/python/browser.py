# SPDX-License-Identifier: GPL-3.0-or-later
"""Chromium without a window, with software rendering: Debian's chromium and chromium-driver, driven by selenium."""
import json
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

SWITCHES = (
    "--headless=new",
    "--no-sandbox",
    "--disable-dev-shm-usage",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--hide-scrollbars",
    "--window-size=1280,900",
)


class Browser:
    """One browser; every page must be drawn without a word on the console."""

    def __init__(self, downloads):
        options = Options()
        for switch in SWITCHES:
            options.add_argument(switch)
        options.binary_location = "/usr/bin/chromium"
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        options.add_experimental_option(
            "prefs",
            {
                "download.default_directory": str(downloads),
                "profile.default_content_setting_values.automatic_downloads": 1,
            },
        )
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.driver.set_script_timeout(60)
        self.downloads = downloads

    def open(self, address, width=1280, height=900, dark=False):
        """Opens a page at a width, in light or dark, and waits until it is drawn."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme]})
        self.driver.get(address if "://" in str(address) else f"file://{address}")
        self.wait("return document.body.dataset.drawn === 'yes'")
        self.wait("return !Report.data.packings.length || Report.viewer.triangles !== null")
        self.settle()
        return self

    def run(self, program, *arguments):
        return self.driver.execute_script(program, *arguments)

    def wait(self, condition, seconds=60):
        end = time.monotonic() + seconds
        while not self.run(condition):
            assert time.monotonic() < end, f"not within {seconds} s: {condition}; console: {self.console()}"
            time.sleep(0.05)

    def settle(self):
        """Waits until the browser has painted the page as it is now."""
        self.driver.execute_async_script(
            "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 30)))"
        )

    def element(self, selector):
        return self.driver.find_element("css selector", selector)

    def picture(self):
        """Pixels of the packing as it is drawn now, for comparing."""
        return self.run("Report.renderPacking(); return document.getElementById('packing-canvas').toDataURL()")

    def console(self):
        """What the console holds of warnings and errors; the driver's own remarks on graphics are no part of the page."""
        lines = [json.loads(json.dumps(line)) for line in self.driver.get_log("browser")]
        return [line["message"] for line in lines if "GPU stall" not in line["message"]]

    def quit(self):
        self.driver.quit()
