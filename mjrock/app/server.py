"""The server of the form: it listens on 127.0.0.1 alone and answers only who knows the token in its address.

A request names the task and brings all that it needs, so that two windows share nothing. The answer is a line of JSON
for each part. Where the window closes, or stops a run, the connection ends, and with it the process that computes.
No path comes from a request: pages are files of a fixed list, and what a run keeps has a random name.
"""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import select
import socket
import threading
from collections import OrderedDict
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from typing import Any

from .worker import BusyError, EndedError, Item, Team

HERE = "127.0.0.1"
"""The one address that the server listens on."""
LARGEST = 32 * 2**20
"""Most bytes of a request, which brings the records of a run."""
KEPT, KEPT_BYTES = 12, 512 * 2**20
"""Most things that are kept of runs, and most bytes of all of them; the oldest are dropped."""
QUICK, FOR_A_RUN = 60.0, 24 * 3600.0
"""Limits on the time of a task, and of a run, which can be stopped [s]."""
LOCKED = "default-src 'none'; frame-ancestors 'self'; base-uri 'none'; form-action 'none'; "
RULES = LOCKED + "script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; frame-src 'self'"
"""What the page may load: its own files alone, and no script within the page."""
FILM_RULES = LOCKED + "sandbox allow-scripts; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"
"""What the film may load: nothing. Its scripts cannot reach the form."""
HEADS = {
    "Cache-Control": "no-store",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}
"""What every answer asks of the browser: keep nothing, and give nothing to other sites."""
PAGES = {
    "": ("form.html", "text/html"),
    "form.css": ("form.css", "text/css"),
    "form.js": ("form.js", "text/javascript"),
}
"""The files of the form by the end of their address, with their types."""


class Store:
    """What runs leave with the server, by random names: films, and responses for a report."""

    def __init__(self) -> None:
        self._lock, self._kept = threading.Lock(), OrderedDict[str, bytes]()

    def put(self, content: bytes) -> str:
        """Keep bytes; their name. The oldest go where there are too many."""
        with self._lock:
            name = secrets.token_urlsafe(12)
            self._kept[name] = content
            while len(self._kept) > KEPT or sum(map(len, self._kept.values())) > KEPT_BYTES:
                self._kept.popitem(last=False)
            return name

    def get(self, name: object) -> bytes | None:
        """The bytes of a name; None where there are none any more."""
        with self._lock:
            return self._kept.get(name) if isinstance(name, str) else None


class FormServer(ThreadingHTTPServer):
    """The server of the form.

    Args:
        team: what does the tasks.
        port: of the server; 0 takes a free one.
    """

    daemon_threads = True
    allow_reuse_address = os.name == "posix"  # elsewhere another program could then listen on the same port

    def __init__(self, team: Team, port: int = 0) -> None:
        self.team, self.store, self.token = team, Store(), secrets.token_urlsafe(24)
        super().__init__((HERE, port), Handler)
        self.hosts = {f"{name}:{self.server_port}" for name in (HERE, "localhost")}
        self._lock, self._tickets = threading.Lock(), set[str]()

    @property
    def address(self) -> str:
        """Where the form is, with its token."""
        return f"http://{HERE}:{self.server_port}/{self.token}/"

    def new_ticket(self) -> str:
        """An address that leads to the form once. Other users of the machine may read it as an argument of the browser,
        and have no use of it then."""
        ticket = secrets.token_urlsafe(24)
        with self._lock:
            self._tickets.add(ticket)
        return f"http://{HERE}:{self.server_port}/{ticket}"

    def take_ticket(self, ticket: str) -> bool:
        """Whether a ticket is good; it is so once."""
        with self._lock:
            good = ticket in self._tickets
            self._tickets.discard(ticket)
            return good

    def handle_error(self, request: object, client_address: object) -> None:
        """Leave out errors of connections that the other side has ended."""


class Handler(BaseHTTPRequestHandler):
    """One connection."""

    server: FormServer
    timeout = 30
    server_version, sys_version = "mjrock", ""

    def log_message(self, format: str, *given: object) -> None:
        """Write no line for each request."""

    def do_GET(self) -> None:
        """Send a file of the form, or a film."""
        if self.headers.get("Host") in self.server.hosts and self.server.take_ticket(self.path.removeprefix("/")):
            self._head("text/plain", RULES, HTTPStatus.SEE_OTHER, Location=self.server.address)
            return
        place = self._place()
        if place is None:
            return
        if place in PAGES:
            name, kind = PAGES[place]
            self._send((files(__package__) / "page" / name).read_bytes(), kind, RULES)
        elif place.startswith("film/") and (film := self.server.store.get(place.removeprefix("film/"))):
            self._send(film, "text/html", FILM_RULES)
        else:
            self._refuse(HTTPStatus.NOT_FOUND, "there is no such page")

    def do_POST(self) -> None:
        """Do a task and send its answer, a line for each part."""
        place = self._place()
        if place is None:
            return
        name = place.removeprefix("do/")
        if not place.startswith("do/"):
            self._refuse(HTTPStatus.NOT_FOUND, "there is no such task")
            return
        request = self._request()
        if request is None:
            return
        if (name_of_run := request.get("responses")) is not None:
            request["responses"] = self.server.store.get(name_of_run)
            if request["responses"] is None:
                self._refuse(HTTPStatus.GONE, "the run is no longer kept; make it again")
                return
        parts = self.server.team.parts(name, request, self._left, FOR_A_RUN if name == "run" else QUICK)
        self._head("application/x-ndjson", RULES)
        with contextlib.closing(parts), contextlib.suppress(ConnectionError):
            try:
                for part in parts:
                    self._line(part)
            except BusyError:
                self._line({"error": "too much is computed at once; stop a run, or wait until one has ended"})
            except (EndedError, TimeoutError) as error:
                self._line({"error": str(error)})
            self._line({"done": True})

    def _place(self) -> str | None:
        """The end of the address, after the token; None, and a refusal, for a stranger.

        A page of another site that a browser shows under a name of its own for 127.0.0.1 has that name as its host.
        """
        _, token, *rest = self.path.partition("?")[0].split("/", 2) if self.path.startswith("/") else ("", "")
        origin = self.headers.get("Origin")
        own = origin is None or origin.removeprefix("http://") in self.server.hosts
        knows = secrets.compare_digest(token.encode(), self.server.token.encode())
        if self.headers.get("Host") not in self.server.hosts or not own or not knows or not rest:
            self._refuse(HTTPStatus.FORBIDDEN, "open the address that the command has written, with its token")
            return None
        return rest[0]

    def _request(self) -> dict[str, Any] | None:
        """What the request brings; None, and a refusal, for what is too large or is not an object of JSON."""
        length, kind = self.headers.get("Content-Length", ""), self.headers.get("Content-Type", "")
        if not (length.isascii() and length.isdigit()) or not kind.startswith("application/json"):
            self._refuse(HTTPStatus.BAD_REQUEST, "the request is not JSON with a Content-Length")
        elif int(length) > LARGEST:
            message = f"the request has {int(length) / 2**20:.0f} MB; at most {LARGEST / 2**20:.0f} MB are read"
            self._refuse(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, message)
        else:
            with contextlib.suppress(ValueError, RecursionError):
                request = json.loads(self.rfile.read(int(length)))
                if isinstance(request, dict):
                    return request
            self._refuse(HTTPStatus.BAD_REQUEST, "the request is not an object of JSON")
        return None

    def _left(self) -> bool:
        """Whether the other side has ended the connection."""
        readable, _, _ = select.select([self.connection], [], [], 0)
        with contextlib.suppress(ConnectionError):
            return bool(readable) and not self.connection.recv(1, socket.MSG_PEEK)
        return True

    def _line(self, part: Item) -> None:
        """Send a part of an answer; what it keeps is named in place of its bytes."""
        kept = {name: self.server.store.put(content) for name, content in part.pop("keep", {}).items()}
        self.wfile.write(json.dumps(part | kept, allow_nan=False).encode() + b"\n")

    def _head(self, kind: str, rules: str, status: HTTPStatus = HTTPStatus.OK, **more: str) -> None:
        self.send_response(status)
        own = {"Content-Type": f"{kind}; charset=utf-8", "Content-Security-Policy": rules}
        for name, value in (own | HEADS | more).items():
            self.send_header(name, value)
        self.end_headers()

    def _send(self, content: bytes, kind: str, rules: str, status: HTTPStatus = HTTPStatus.OK) -> None:
        self._head(kind, rules, status)
        self.wfile.write(content)

    def _refuse(self, status: HTTPStatus, message: str) -> None:
        self.close_connection = True
        self._send(message.encode(), "text/plain", RULES, status)
