"""The scripts of docs/gallery run, are short, and write their pictures."""
import ast
import shutil
import sys
from pathlib import Path

import pytest

pytest.importorskip("motet", reason="the package is not installed: ./test does it")
pytest.importorskip("pyvista")
Image = pytest.importorskip("PIL.Image")

SITE = Path(__file__).resolve().parent.parent / "docs" / "site"
sys.path.insert(0, str(SITE))
from draw import SCRIPTS, draw  # noqa: E402

BROWSERS = ("chromium", "chromium-browser", "google-chrome")


def names():
    return [pytest.param(script, id=script.stem) for script in SCRIPTS]


@pytest.mark.parametrize("script", names())
def test_script_draws_its_picture(script, tmp_path):
    if script.stem == "report" and not any(map(shutil.which, BROWSERS)):
        pytest.skip("no Chromium: apt-get install chromium")
    width, height = Image.open(draw(script, tmp_path, size=(300, 200))).size
    assert width > 100 and height > 50


@pytest.mark.parametrize("script", names())
def test_script_has_10_to_30_lines_and_says_what_it_shows(script):
    text = script.read_text()
    docstring = ast.parse(text).body[0]
    title, empty, *sentences = docstring.value.value.splitlines()
    assert title and not empty and sentences
    code = [line for line in text.splitlines()[docstring.end_lineno:] if line.strip() and not line.strip().startswith("#")]
    assert 10 <= len(code) <= 30, len(code)


def test_there_are_at_least_20():
    assert len(SCRIPTS) >= 20
