"""A page that shows a moving picture without loading anything from elsewhere."""

from __future__ import annotations

import html
import re

ICONS = {
    "fa-minus": "&#8722;",
    "fa-fast-backward": "|&#9664;&#9664;",
    "fa-step-backward": "|&#9664;",
    "fa-play fa-flip-horizontal": "&#9664;",
    "fa-pause": "&#10074;&#10074;",
    "fa-play": "&#9654;",
    "fa-step-forward": "&#9654;|",
    "fa-fast-forward": "&#9654;&#9654;|",
    "fa-plus": "&#43;",
}
"""What stands on the buttons of matplotlib's player in place of an icon font from the web."""


def standalone(text: str, title: str) -> str:
    """The page of matplotlib's player with characters for its icons, which it would load from the web."""
    text = re.sub(r"<link\b[^>]*>", "", text)
    text = re.sub(r'<i class="fa ([^"]*)"></i>', lambda icon: ICONS.get(icon[1], "&#8226;"), text)
    return f'<!DOCTYPE html>\n<meta charset="utf-8">\n<title>{html.escape(title)}</title>\n{text}'
