"""`mjrock app`: the form in the browser, on this machine alone."""

from __future__ import annotations

import contextlib
import webbrowser
from collections.abc import Sequence

from ..command_line import Answer, parser_of
from ..notice import notice
from ..quantities import require_within
from .server import FormServer
from .worker import Team


def answer(argv: Sequence[str]) -> Answer:
    """Serve the form until Ctrl-C.

    Raises:
        OSError: if the port is taken.
        ValueError: for a port out of its range.
    """
    parser = parser_of("app", "A form in the browser: checks, runs and reports, on this machine alone. Ctrl-C ends it.")
    parser.add_argument("--port", type=int, help="of the server, 1024 to 65535; a free one where it is left out")
    parser.add_argument("--no-browser", action="store_true", help="write the address, and open no browser")
    options = parser.parse_args(argv)
    port = 0 if options.port is None else int(require_within("--port", options.port, 1024, 65535))
    team = Team(f"{__package__}.tasks")
    try:
        with FormServer(team, port) as server:
            notice(f"the form is at {server.address}")
            notice("keep the address to yourself; Ctrl-C ends the form and all of its runs")
            if not options.no_browser and has_windows():
                webbrowser.open(server.new_ticket())
            with contextlib.suppress(KeyboardInterrupt):
                server.serve_forever()
    finally:
        team.close()
    return Answer("the form is closed")


def has_windows() -> bool:
    """Whether there is a browser with windows; one of text would take the terminal."""
    try:
        return type(webbrowser.get()) is not webbrowser.GenericBrowser
    except webbrowser.Error:
        return False
