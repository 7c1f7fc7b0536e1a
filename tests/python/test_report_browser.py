"""The report's page in a real browser, opened from the disk and without network."""

from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page
from rps3_study import demo
from rps3_study.couple import run_crossing
from rps3_study.fmu import Fmu
from rps3_study.geometry import Geometry, degenerate_twists

VIEWS = "#animation .view:not([hidden])"
CURSOR = "document.getElementById('plot').layout.shapes[0].x0"


@pytest.fixture(scope="session")
def report(dist: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a demo with one task and two modes, one of which leaves the path at the singularity."""
    directory = tmp_path_factory.mktemp("report")
    demo.main(["--dist", str(dist), "--out", str(directory), "--tasks", "smooth", "--modes", "1", "2"])
    return directory / "index.html"


def opened(page: Page, report: Path) -> Page:
    page.goto(report.as_uri())
    page.wait_for_selector("#plot .cartesianlayer .trace")
    return page


def canvas(page: Page) -> bytes:
    """What the animation shows, as an image."""
    return page.locator(VIEWS).first.screenshot()


def test_page_shows_every_mode_of_the_case_beside_its_plots(page: Page, report: Path) -> None:
    opened(page, report)
    assert [text.split("\n")[0] for text in page.locator(VIEWS).all_inner_texts()] == ["RAC", "DRAC"]
    legend = set(page.locator("#plot .legendtext").all_text_contents())
    assert {"RAC", "DRAC", "reference"} == legend
    page.locator("#modes input").first.uncheck()
    assert page.locator(VIEWS).count() == 1


def test_slider_moves_animation_and_cursor_of_the_plots(page: Page, report: Path) -> None:
    opened(page, report)
    before = canvas(page)
    page.locator("#time").fill("0.5")
    page.wait_for_function(f"{CURSOR} === 0.5")
    assert page.locator("#clock").inner_text() == "0.500 s"
    assert canvas(page) != before


def test_play_moves_the_time_until_pause(page: Page, report: Path) -> None:
    opened(page, report)
    before = canvas(page)
    page.locator("#play").click()
    page.wait_for_function("Number(document.getElementById('time').value) > 0.05")
    page.locator("#play").click()
    assert page.locator("#play").get_attribute("aria-label") == "Play"
    stopped = page.locator("#clock").inner_text()
    assert canvas(page) != before
    page.wait_for_timeout(200)
    assert page.locator("#clock").inner_text() == stopped
    # the slider shows the nearest drawn sample, of which there is one every 2 ms
    page.wait_for_function(f"Math.abs({CURSOR} - Number(document.getElementById('time').value)) < 2e-3")


def test_task_motors_and_group_of_plots_can_be_chosen(page: Page, report: Path) -> None:
    opened(page, report)
    first = page.locator("#tension").inner_text()
    page.locator("#variant").select_option("three motors")
    assert page.locator("#tension").inner_text() != first
    assert "three motors" in page.locator(".case.chosen h3").inner_text()
    for tab in page.locator("#groups button").all():
        tab.click()
        page.wait_for_selector("#plot .cartesianlayer .trace")
        assert tab.get_attribute("aria-selected") == "true"


def test_degenerate_direction_belongs_to_the_smallest_singular_value_of_the_plant(plant: Fmu, controller: Fmu) -> None:
    run = run_crossing(plant, controller, controller_parameters={"control_mode": 2}, stop_time=0.6, step=5e-3)
    twists, values = degenerate_twists(run, Geometry.of(plant))
    np.testing.assert_allclose(values, run["plant.sigma_min"], atol=1e-12)
    assert values.min() < 1e-2
    np.testing.assert_allclose(np.linalg.norm(twists, axis=1), 1.0)
    assert (np.einsum("ti,ti->t", twists[1:], twists[:-1]) > 0.9).all()
