"""The colours of the form, and the words of its page."""

import re
from pathlib import Path

import pytest

from mjrock.app import form, server
from mjrock.app.form import TEXTS
from mjrock.reporting.texts import Words

PAGE = Path(form.__file__).parent / "page"
CSS = (PAGE / "form.css").read_text("utf-8")
SCHEMES = [
    dict(re.findall(r"--([\w-]+): (#[0-9a-f]+)", block)) for block in re.findall(r":root \{(.*?)\}", CSS, re.DOTALL)
]
PAIRS = [(name, ground) for name in ("ink", "quiet", "mark") for ground in ("paper", "panel")]
PAIRS += [("on-mark", "mark"), ("good", "on-good"), ("bad", "on-bad"), ("part", "on-part")]


def luminance(colour):
    """Relative luminance after WCAG 2.2."""
    digits = colour[1:] if len(colour) == 7 else "".join(2 * one for one in colour[1:])
    parts = [int(digits[i : i + 2], 16) / 255 for i in (0, 2, 4)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("scheme", SCHEMES, ids=["light", "dark"])
def test_texts_have_a_contrast_of_4_5_and_borders_of_3(scheme):
    """WCAG 2.2, 1.4.3 and 1.4.11."""
    assert len(SCHEMES) == 2
    assert {pair: found for pair in PAIRS if (found := contrast(scheme[pair[0]], scheme[pair[1]])) < 4.5} == {}
    assert contrast(scheme["line"], scheme["panel"]) >= 3


def test_the_page_asks_for_no_text_that_is_not_there():
    used = set(re.findall(r"texts\.(\w+)", (PAGE / "form.js").read_text("utf-8")))
    used |= set(re.findall(r'data-text="(\w+)"', (PAGE / "form.html").read_text("utf-8")))
    used |= set(re.findall(r'words\("form_(\w+)"', Path(form.__file__).with_name("tasks.py").read_text("utf-8")))
    texts = form.texts_of(Words("en", TEXTS))
    assert used - texts.keys() == set()
    assert len(used) > 15


def test_every_file_of_the_page_is_served():
    assert {name for name, _ in server.PAGES.values()} == {path.name for path in PAGE.iterdir()}
