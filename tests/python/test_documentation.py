"""The documentation inside the FMUs, out of the archives."""

import re
from pathlib import Path

import pytest
from fmpy.model_description import ScalarVariable
from lxml import html
from PIL import Image
from playwright.sync_api import Page
from rps3_study.fmu import Fmu
from rps3_study.fmu_documentation.equations import rendered
from rps3_study.fmu_documentation.variables import grouped


def index(fmu: Fmu) -> Path:
    return fmu.directory / "documentation" / "index.html"


def test_every_variable_stands_in_exactly_one_group(fmu: Fmu) -> None:
    listed = html.parse(index(fmu)).xpath("//h2[@id='capabilities']/preceding-sibling::table//tr/td[1]/code/text()")
    assert sorted(listed) == sorted(fmu.variables)


def test_a_variable_without_a_group_is_an_error() -> None:
    with pytest.raises(LookupError, match="unheard_of"):
        grouped("Rps3Plant", [ScalarVariable("unheard_of", 1, causality="output")])


def test_capabilities_are_those_of_the_model_description(fmu: Fmu) -> None:
    rows = html.parse(index(fmu)).xpath("//h2[@id='capabilities']/following-sibling::table[1]/tbody/tr")
    shown = {row[0].text_content(): (row[1].text_content(), row[2].text_content()) for row in rows}
    assert shown["canGetAndSetFMUstate"] == ("true", "true")
    assert shown["maxOutputDerivativeOrder"] == (str(fmu.description.coSimulation.maxOutputDerivativeOrder), "")


def test_links_lead_to_files_in_the_archive_and_nowhere_else(fmu: Fmu) -> None:
    page = html.parse(index(fmu))
    targets = page.xpath("//@href | //@src")
    files = [target for target in targets if not target.startswith(("#", "data:"))]
    assert any("third-party/nalgebra" in target for target in files)
    assert [target for target in files if not (index(fmu).parent / target).is_file()] == []


def test_every_license_text_is_linked(fmu: Fmu) -> None:
    texts = {
        path.relative_to(index(fmu).parent).as_posix()
        for path in (index(fmu).parent / "licenses" / "third-party").rglob("*")
        if path.is_file()
    }
    assert texts and texts <= set(html.parse(index(fmu)).xpath("//@href"))


def test_icon_is_a_small_picture(fmu: Fmu) -> None:
    with Image.open(fmu.directory / "model.png") as icon:
        assert (icon.format, icon.size) == ("PNG", (256, 256))
        assert len(icon.convert("RGB").getcolors(1 << 16) or []) > 10


def test_equations_leave_no_latex_behind(fmu: Fmu) -> None:
    text = re.sub(r"data:[^\"]*", "", index(fmu).read_text(encoding="utf-8"))
    assert "\\" not in text
    assert text.count("<math") > 10
    assert rendered(r"\(\dot q\)").startswith("<math")


def test_browser_draws_equations_and_pictures_from_the_unzipped_folder(fmu: Fmu, page: Page) -> None:
    page.goto(index(fmu).as_uri())
    sizes = page.evaluate("[...document.images].map((image) => image.complete ? image.naturalWidth : 0)")
    assert len(sizes) >= 4 and min(sizes) >= 100
    heights = page.evaluate("[...document.querySelectorAll('math')].map((one) => one.getBoundingClientRect().height)")
    assert min(heights) > 5
    fraction = page.locator("math[display=block] mfrac").first
    over, under = (fraction.locator(":scope > *").nth(k).bounding_box() for k in (0, 1))
    assert over["y"] + over["height"] <= under["y"] + 1
