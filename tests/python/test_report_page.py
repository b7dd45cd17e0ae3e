# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of `boba report` in a browser: it is drawn, it answers to mouse and keyboard, and it shows the run's numbers."""
import csv
import io
import time

import boba
import made_run
import numpy as np
import pytest
from boba.report import page_of, report_data
from scipy.spatial import ConvexHull
from selenium.webdriver.common.keys import Keys

from browser import Browser


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    one = Browser(tmp_path_factory.mktemp("downloads"))
    yield one
    one.quit()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return made_run.make_run(tmp_path_factory.mktemp("page") / "run")


@pytest.fixture(scope="module")
def page(folder):
    path = folder.parent / "report.html"
    path.write_text(page_of(report_data([folder])))
    return path


def test_it_opens_and_draws_without_a_word_on_the_console(browser, page):
    for width, dark in ((1280, False), (1280, True), (390, False), (390, True)):
        browser.open(page, width=width, dark=dark)
        assert browser.console() == []
        assert browser.run("return document.documentElement.scrollWidth") <= width
        assert browser.element("h1").text == "made by a test"
        back = browser.run("return getComputedStyle(document.body).backgroundColor")
        lightness = sum(int(part) for part in back[back.index("(") + 1 : -1].split(",")[:3])
        assert (lightness < 200) == dark
        ink = browser.run(
            "const canvas = document.querySelector('#panel-mu canvas');"
            "const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);"
            "return data.filter((v, k) => k % 4 === 3 && v > 0).length"
        )
        assert ink > 500


def test_nothing_is_fetched(browser, page):
    browser.open(page)
    assert browser.run("return performance.getEntriesByType('resource').map((entry) => entry.name)") == []
    # The page's own policy: no program but its own, even where one found its way in.
    added = "const s = document.createElement('script'); s.textContent = 'window.hacked = 1'; document.body.append(s);"
    assert browser.run(added + "return window.hacked ?? 'blocked'") == "blocked"
    assert "Content Security Policy" in "".join(browser.console())


def shown_rows(browser, panel):
    text = browser.run("const own = Report.data.panels.find((each) => each.id === arguments[0]);"
                       "return Report.csv(Report.rowsOf(own))", panel)  # fmt: skip
    return list(csv.reader(io.StringIO(text)))


def test_values_are_those_of_the_table(browser, folder, page):
    browser.open(page)
    browser.run("const clock = document.getElementById('clock'); clock.value = 'time';"
                "clock.dispatchEvent(new Event('change'))")  # fmt: skip
    table = boba.open(folder).table
    head, *rows = shown_rows(browser, "mu")
    assert head[:4] == ["series", "step", "time (tau)", "mu"]
    numbers = np.array([[float(field) for field in row[1:4]] for row in rows])
    np.testing.assert_array_equal(numbers, np.stack([table["step"], table["time_tau"], table["mu"]], axis=1))
    coordination = boba.open(folder).measure("coordination")
    numbers = np.array([[float(field) for field in row[2:4]] for row in shown_rows(browser, "coordination")[1:]])
    wanted = np.stack([coordination["time_tau"], coordination["contacts_per_grain"]], axis=1)
    np.testing.assert_array_equal(numbers, wanted)


def test_the_value_under_the_pointer(browser, page):
    browser.open(page)
    box = browser.element("#panel-mu .plot")
    browser.run("document.getElementById('clock').value = 'time';"
                "document.getElementById('clock').dispatchEvent(new Event('change'))")  # fmt: skip
    seen = set()
    for _ in range(40):
        box.send_keys(Keys.ARROW_RIGHT)
        seen.add(browser.element("#panel-mu .u-legend tr:nth-child(2) td").text)
    assert seen & {"0.2", "-0.3"} and seen <= {"0.2", "-0.3", "0.05", "-"}


def test_zoom_by_keyboard_and_back(browser, page):
    browser.open(page)
    scale = "const { min, max } = Report.panelsDrawn.get('mu').plot.scales.x; return [min, max]"
    whole = browser.run(scale)
    box = browser.element("#panel-mu .plot")
    box.send_keys("+")
    browser.settle()
    near = browser.run(scale)
    assert near[1] - near[0] == pytest.approx((whole[1] - whole[0]) / 2, rel=1e-6)
    box.send_keys("0")
    browser.settle()
    assert browser.run(scale) == whole


def test_export(browser, folder, page):
    browser.open(page)
    browser.run("document.querySelectorAll('#panel-mu button')[4].click()")
    browser.run("document.querySelectorAll('#panel-mu button')[3].click()")
    names = [browser.downloads / "Stress_ratio.csv", browser.downloads / "Stress_ratio.png"]
    end = time.monotonic() + 30
    while not all(name.exists() and name.stat().st_size for name in names) and time.monotonic() < end:
        time.sleep(0.1)
    rows = list(csv.reader(names[0].open()))
    assert len(rows) == 1 + boba.open(folder).table.n_rows
    assert names[1].read_bytes().startswith(b"\x89PNG")


def test_the_time_slider_moves_the_packing(browser, page):
    browser.open(page)
    slider = browser.element("#packing-time")
    assert "step 9," in browser.element(".timeline output").text
    last = browser.picture()
    slider.send_keys(Keys.ARROW_LEFT)
    browser.wait("return document.querySelector('.timeline output').textContent.startsWith('step 7,')")
    browser.settle()
    assert browser.picture() != last
    slider.send_keys(Keys.ARROW_RIGHT)
    browser.settle()
    assert browser.picture() == last


def test_the_cross_section_changes_pixels(browser, page):
    browser.open(page)
    whole = browser.picture()
    axis = browser.element("#packing-axis")
    for name in "xyz":
        axis.send_keys(f"across {name}")
        browser.settle()
        half = browser.picture()
        assert half != whole, name
        browser.element("#packing-cut").send_keys(Keys.PAGE_DOWN)
        browser.settle()
        assert browser.picture() != half, name
        browser.element("#packing-cut").send_keys(Keys.PAGE_UP)
    # Beyond the packing nothing is cut, before it nothing is left but the cell.
    drawn = (
        "document.getElementById('packing-cut').value = arguments[0];"
        "document.getElementById('packing-cut').dispatchEvent(new Event('input')); return 0"
    )
    browser.run(drawn, 1000)
    browser.settle()
    all_of_it = browser.picture()
    browser.run(drawn, 0)
    browser.settle()
    assert len(browser.picture()) < len(all_of_it)


def test_a_grain_is_followed(browser, folder, page):
    browser.open(page)
    assert browser.run("return document.querySelector('.follow').hidden")
    number = browser.element("#packing-grain")
    number.send_keys("4", Keys.ENTER)
    browser.settle()
    shown = dict(
        zip(
            [e.text for e in browser.driver.find_elements("css selector", ".follow dt")],
            [e.text for e in browser.driver.find_elements("css selector", ".follow dd")],
        )
    )
    frame = boba.open(folder).frames[-1]
    hull = ConvexHull(frame.grains[1])  # molecule 4 is the second grain
    assert float(shown["volume (d^3)"]) == pytest.approx(hull.volume, rel=1e-4)
    sphericity = hull.area**1.5 / (6 * np.pi**0.5 * hull.volume)
    assert float(shown["asphericity"]) == pytest.approx(sphericity, rel=1e-4)
    pressure = -frame.grain_stress[1, :3].sum() / 3 / hull.volume
    assert float(shown["pressure (k/d)"]) == pytest.approx(pressure, rel=1e-4)
    assert shown["species"] == "species 1"


def test_the_packing_by_keyboard_and_colour(browser, page):
    browser.open(page)
    canvas = browser.element("#packing-canvas")
    first = browser.picture()
    canvas.send_keys(Keys.ARROW_RIGHT)
    browser.settle()
    assert browser.picture() != first
    canvas.send_keys("0")
    browser.settle()
    assert browser.picture() == first
    browser.element("#packing-colour").send_keys("volume")
    browser.settle()
    assert browser.picture() != first
    assert "volume" in browser.element(".scale").text


def test_several_runs_lie_over_each_other_and_make_a_sweep(browser, tmp_path):
    runs = [made_run.make_run(tmp_path / "sweep" / name) for name in ("slow", "fast")]
    for run, rate in zip(runs, ("1e-4", "2e-3")):
        (run / "scene.toml").write_text(made_run.SCENE + f"# --set stage.forth.rate={rate}\n")
    table = (runs[1] / "table.csv").read_text().replace(",0.2,", ",0.25,")
    (runs[1] / "table.csv").write_text(table)
    (tmp_path / "sweep.html").write_text(page_of(report_data([tmp_path / "sweep"])))
    browser.open(tmp_path / "sweep.html")
    assert browser.console() == []
    rows = shown_rows(browser, "mu")[1:]
    assert {row[0] for row in rows} == {"fast", "slow"}
    head = [e.text for e in browser.driver.find_elements("css selector", "#sweep-table thead th")]
    assert head[:2] == ["run", "stage.forth.rate"]
    cells = [e.text for e in browser.driver.find_elements("css selector", "#sweep-table tbody tr:nth-child(1) > *")]
    assert cells[:2] == ["fast", "0.002"]
    assert browser.run("return Report.data.packings.length") == 2


HOSTILE = """</script><script>window.hacked = 1</script><img src=x onerror="window.hacked = 2"> "'&amp;<!--"""


def test_nothing_of_a_scene_is_executed(browser, tmp_path):
    folder = made_run.make_run(tmp_path / """a'b"c<i>&d""")
    scene = made_run.SCENE.replace('"made by a test"', "'''" + HOSTILE.replace("'", "") + "\nsecond line'''")
    scene = scene.replace("count = 2", """name = '<b>"bold"'\ncount = 2""")
    (folder / "scene.toml").write_text(scene + f"# --set title={HOSTILE}\n")
    (folder / "run.log").write_text(f"2026-12-01 04:30:49 info {HOSTILE}\n2026-12-01 04:30:50 error {HOSTILE}\n")
    path = tmp_path / "hostile.html"
    path.write_text(page_of(report_data([folder])))
    browser.open(path)
    assert browser.console() == []
    assert browser.run("return window.hacked") is None
    assert (
        browser.run("return document.querySelectorAll('main img, main i, main b:not(.checks b), main script').length")
        == 0
    )
    assert browser.run("return document.getElementById('title').textContent") == HOSTILE
    assert browser.element(".run .chip.failed").text == "failed"


def test_it_prints(browser, page):
    browser.open(page, dark=True)
    printed = browser.driver.execute_cdp_cmd("Page.printToPDF", {"printBackground": True})
    assert len(printed["data"]) > 50_000


def test_a_run_without_frames(browser, tmp_path):
    folder = made_run.make_run(tmp_path / "still")
    (folder / "trajectory.h5").unlink()
    path = tmp_path / "still.html"
    path.write_text(page_of(report_data([folder])))
    browser.open(path)
    assert browser.console() == []
    assert not browser.element("#packing").is_displayed()
    assert "output.trajectory" in browser.element("#runs").text
