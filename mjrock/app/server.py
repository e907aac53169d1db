"""The server of the form: it listens on 127.0.0.1 alone and answers only requests with the token of its address.

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
from collections.abc import Iterator
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from typing import Any

from .worker import BusyError, EndedError, Item, Team

LOCAL_ADDRESS = "127.0.0.1"
"""The one address that the server listens on."""
LARGEST_REQUEST = 32 * 2**20
"""Most bytes of a request, which brings the records of a run."""
MOST_KEPT, MOST_KEPT_BYTES = 12, 512 * 2**20
"""Most things that are kept of runs, and most bytes of all of them; the oldest are dropped."""
TASK_LIMIT, RUN_LIMIT = 60.0, 24 * 3600.0
"""Limits on the time of a task, and of a run, which can be stopped [s]."""
POLICY = "default-src 'none'; frame-ancestors 'self'; base-uri 'none'; form-action 'none'; "
PAGE_POLICY = POLICY + "script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; frame-src 'self'"
"""What the page may load: its own files alone, and no script within the page."""
FILM_POLICY = POLICY + "sandbox allow-scripts; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"
"""What the film may load: nothing. Its scripts cannot reach the form."""
SECURITY_HEADERS = {
    "Cache-Control": "no-store",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}
"""What every answer requires of the browser: to keep nothing, and to give nothing to other sites."""
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
            while len(self._kept) > MOST_KEPT or sum(map(len, self._kept.values())) > MOST_KEPT_BYTES:
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
        super().__init__((LOCAL_ADDRESS, port), Handler)
        self.hosts = {f"{name}:{self.server_port}" for name in (LOCAL_ADDRESS, "localhost")}
        self._lock, self._tickets = threading.Lock(), set[str]()

    @property
    def address(self) -> str:
        """Where the form is, with its token."""
        return f"http://{LOCAL_ADDRESS}:{self.server_port}/{self.token}/"

    def new_ticket(self) -> str:
        """An address that leads to the form once. Other users of the machine may read it as an argument of the browser,
        and have no use of it then."""
        ticket = secrets.token_urlsafe(24)
        with self._lock:
            self._tickets.add(ticket)
        return f"http://{LOCAL_ADDRESS}:{self.server_port}/{ticket}"

    def take_ticket(self, ticket: str) -> bool:
        """Whether a ticket is good; it is so once."""
        with self._lock:
            is_valid = ticket in self._tickets
            self._tickets.discard(ticket)
            return is_valid

    def handle_error(self, request: object, client_address: object) -> None:
        """Leave out errors of connections that the other side has ended."""


class RefusedError(Exception):
    """A request is refused, with the status and the message that are its arguments."""


class Handler(BaseHTTPRequestHandler):
    """One connection."""

    server: FormServer
    timeout = 30
    server_version, sys_version = "mjrock", ""

    def log_message(self, format: str, *arguments: object) -> None:
        """Write no line for each request."""

    def do_GET(self) -> None:
        """Send a file of the form, or a film."""
        if self.headers.get("Host") in self.server.hosts and self.server.take_ticket(self.path.removeprefix("/")):
            self._send_headers("text/plain", PAGE_POLICY, HTTPStatus.SEE_OTHER, Location=self.server.address)
            return
        with self._refusals_sent():
            place = self._place()
            if place in PAGES:
                name, media_type = PAGES[place]
                self._send((files(__package__) / "page" / name).read_bytes(), media_type, PAGE_POLICY)
            elif place.startswith("film/") and (film := self.server.store.get(place.removeprefix("film/"))):
                self._send(film, "text/html", FILM_POLICY)
            else:
                raise RefusedError(HTTPStatus.NOT_FOUND, "there is no such page")

    def do_POST(self) -> None:
        """Do a task and send its answer, a line for each part."""
        with self._refusals_sent():
            place = self._place()
            name = place.removeprefix("do/")
            if not place.startswith("do/"):
                raise RefusedError(HTTPStatus.NOT_FOUND, "there is no such task")
            request = self._request()
            if (name_of_run := request.get("responses")) is not None:
                request["responses"] = self.server.store.get(name_of_run)
                if request["responses"] is None:
                    raise RefusedError(HTTPStatus.GONE, "the run is no longer kept; make it again")
            self._answer(name, request)

    def _answer(self, name: str, request: dict[str, Any]) -> None:
        """Do a task and send its answer, until the other side ends the connection."""
        limit = RUN_LIMIT if name == "run" else TASK_LIMIT
        parts = self.server.team.parts(name, request, self._is_disconnected, limit)
        self._send_headers("application/x-ndjson", PAGE_POLICY)
        with contextlib.closing(parts), contextlib.suppress(ConnectionError):
            try:
                for part in parts:
                    self._send_part(part)
            except BusyError:
                self._send_part({"error": "too much is computed at once; stop a run, or wait until one has ended"})
            except (EndedError, TimeoutError) as error:
                self._send_part({"error": str(error)})
            self._send_part({"done": True})

    def _place(self) -> str:
        """The end of the address, after the token.

        A page of another site that a browser shows under a name of its own for 127.0.0.1 has that name as its host.

        Raises:
            RefusedError: for another host, origin or token.
        """
        _, token, *rest = self.path.partition("?")[0].split("/", 2) if self.path.startswith("/") else ("", "")
        origin = self.headers.get("Origin")
        from_form = origin is None or origin.removeprefix("http://") in self.server.hosts
        has_token = secrets.compare_digest(token.encode(), self.server.token.encode())
        if self.headers.get("Host") not in self.server.hosts or not from_form or not has_token or not rest:
            raise RefusedError(HTTPStatus.FORBIDDEN, "open the address that the command has written, with its token")
        return rest[0]

    def _request(self) -> dict[str, Any]:
        """The object of JSON that the request brings.

        Raises:
            RefusedError: for a request that is too large, or is no object of JSON.
        """
        length, media_type = self.headers.get("Content-Length", ""), self.headers.get("Content-Type", "")
        if not (length.isascii() and length.isdigit()) or not media_type.startswith("application/json"):
            raise RefusedError(HTTPStatus.BAD_REQUEST, "the request is not JSON with a Content-Length")
        if int(length) > LARGEST_REQUEST:
            message = f"the request has {int(length) / 2**20:.0f} MB; at most {LARGEST_REQUEST / 2**20:.0f} MB are read"
            raise RefusedError(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, message)
        request: object = None
        with contextlib.suppress(ValueError, RecursionError):
            request = json.loads(self.rfile.read(int(length)))
        if not isinstance(request, dict):
            raise RefusedError(HTTPStatus.BAD_REQUEST, "the request is not an object of JSON")
        return request

    def _is_disconnected(self) -> bool:
        """Whether the other side has ended the connection."""
        readable, _, _ = select.select([self.connection], [], [], 0)
        with contextlib.suppress(ConnectionError):
            return bool(readable) and not self.connection.recv(1, socket.MSG_PEEK)
        return True

    def _send_part(self, part: Item) -> None:
        """Send a part of an answer; what it keeps is named in place of its bytes."""
        names = {key: self.server.store.put(content) for key, content in part.pop("keep", {}).items()}
        self.wfile.write(json.dumps(part | names, allow_nan=False).encode() + b"\n")

    def _send_headers(self, media_type: str, policy: str, status: HTTPStatus = HTTPStatus.OK, **more: str) -> None:
        self.send_response(status)
        headers = {"Content-Type": f"{media_type}; charset=utf-8", "Content-Security-Policy": policy}
        for name, value in (headers | SECURITY_HEADERS | more).items():
            self.send_header(name, value)
        self.end_headers()

    def _send(self, content: bytes, media_type: str, policy: str, status: HTTPStatus = HTTPStatus.OK) -> None:
        self._send_headers(media_type, policy, status)
        self.wfile.write(content)

    @contextlib.contextmanager
    def _refusals_sent(self) -> Iterator[None]:
        """Send a refusal that is raised in a `with` statement, and close the connection."""
        try:
            yield
        except RefusedError as error:
            status, message = error.args
            self.close_connection = True
            self._send(message.encode(), "text/plain", PAGE_POLICY, status)
