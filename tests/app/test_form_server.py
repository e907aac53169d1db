"""The server of the form: who gets an answer, what it refuses, and that nothing goes on which nobody waits for."""

import http.client
import json
import os
import socket
import threading
import time

import pytest

from mjrock.app import server as module
from mjrock.app.server import FormServer, Store
from mjrock.app.worker import Team


@pytest.fixture(scope="module")
def server():
    team = Team("form_tasks")
    made = FormServer(team)
    thread = threading.Thread(target=made.serve_forever, daemon=True)
    thread.start()
    yield made
    made.shutdown()
    made.server_close()
    team.close()


def ask(server, method, place, body=None, **headers):
    """Status, headers and text of an answer, by the token of the server unless the place begins with a slash."""
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=30)
    path = place if place.startswith("/") else f"/{server.token}/{place}"
    content = None if body is None else json.dumps(body).encode()
    own = {} if body is None else {"Content-Type": "application/json"}
    connection.request(method, path, content, own | {name.replace("_", "-"): text for name, text in headers.items()})
    response = connection.getresponse()
    text = response.read().decode()
    connection.close()
    return response.status, response.headers, text


def parts(server, task, request):
    status, _, text = ask(server, "POST", f"do/{task}", request)
    assert status == 200
    return [json.loads(line) for line in text.splitlines()]


def gone(process, seconds=5.0):
    """Whether a process ends within some time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            os.kill(process, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.02)
    return False


def test_it_listens_on_the_loopback_alone(server):
    assert server.server_address == ("127.0.0.1", server.server_port)
    assert server.address == f"http://127.0.0.1:{server.server_port}/{server.token}/"
    assert len(server.token) >= 32


def test_an_answer_comes_in_lines_and_says_when_it_is_whole(server):
    assert parts(server, "echo", {"a": "é"}) == [{"request": {"a": "é"}}, {"done": True}]
    assert [one.get("number") for one in parts(server, "count", {"of": 3})] == [0, 1, 2, None]


def test_an_error_is_a_part_and_the_process_goes_on(server):
    found = parts(server, "fail", {})
    assert found == [{"begun": True}, {"error": "ValueError: thickness = -1 m"}, {"done": True}]
    assert parts(server, "echo", {})[0] == {"request": {}}


def test_a_process_that_dies_is_an_error_and_the_next_task_has_another(server):
    assert "process" in parts(server, "die", {})[0]["error"]
    assert parts(server, "echo", {})[0] == {"request": {}}


OTHER_HOSTS = "evil.example", "evil.example:PORT", "127.0.0.1", "127.0.0.1:1", "", "127.0.0.1.evil:PORT"
OTHER_PATHS = "/", "/form.js", "/wrong/", "/wrong/form.js", "/TOKEN", "/TOKENx/", "//", "/é/", "*"
FILES = "../server.py", "%2e%2e/server.py", "form.js/../../server.py", "/etc/passwd", "film/../form.js", "film/", "x"


@pytest.mark.parametrize("host", OTHER_HOSTS)
def test_another_host_is_refused(server, host):
    """A page of another site may have a name of its own that leads to 127.0.0.1."""
    status, _, text = ask(server, "GET", "", Host=host.replace("PORT", str(server.server_port)))
    assert (status, "token" in text) == (403, True)


def test_localhost_is_the_same_machine(server):
    assert ask(server, "GET", "", Host=f"localhost:{server.server_port}")[0] == 200


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1:1"])
def test_a_request_of_another_page_is_refused(server, origin):
    assert ask(server, "POST", "do/echo", {}, Origin=origin)[0] == 403
    assert ask(server, "POST", "do/echo", {}, Origin=f"http://127.0.0.1:{server.server_port}")[0] == 200


@pytest.mark.parametrize("path", OTHER_PATHS)
def test_without_the_token_there_is_nothing(server, path):
    path = path.replace("TOKEN", server.token)
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=10) as connection:
        connection.sendall(f"GET {path} HTTP/1.0\r\nHost: 127.0.0.1:{server.server_port}\r\n\r\n".encode("latin-1"))
        text = connection.makefile("rb").read().decode()
    assert " 403 " in text.splitlines()[0]
    assert server.token not in text


def test_a_ticket_leads_to_the_form_once(server):
    ticket = server.new_ticket().rpartition("/")[2]
    assert server.token not in ticket
    assert ask(server, "GET", f"/{ticket}", Host="evil.example")[0] == 403
    status, headers, _ = ask(server, "GET", f"/{ticket}")
    assert (status, headers["Location"]) == (303, server.address)
    assert ask(server, "GET", f"/{ticket}")[0] == 403


@pytest.mark.parametrize("place", FILES)
def test_no_path_leads_to_a_file(server, place):
    status, _, text = ask(server, "GET", f"/{server.token}/{place}")
    assert status == 404
    assert "import" not in text


@pytest.mark.parametrize("place", ["do/", "do/serve", "do/../do/echo", "do/__class__", "do/os.getpid"])
def test_only_tasks_are_done(server, place):
    found = parts(server, place.removeprefix("do/"), {})
    assert "is not one of echo, count" in found[0]["error"]


@pytest.mark.parametrize("place", ["echo", "", "form.js", "film/x"])
def test_nothing_else_takes_a_request(server, place):
    assert ask(server, "POST", place, {})[0] == 404


def test_a_page_loads_nothing_from_elsewhere(server):
    for place, kind in (("", "text/html"), ("form.js", "text/javascript"), ("form.css", "text/css")):
        status, headers, text = ask(server, "GET", place)
        assert status == 200
        assert headers["Content-Type"] == f"{kind}; charset=utf-8"
        rules = headers["Content-Security-Policy"]
        assert rules.startswith("default-src 'none'")
        assert "unsafe" not in rules
        assert headers["Referrer-Policy"] == "no-referrer"
        assert "//" not in text.replace("://www.w3.org", "").split("<body>")[0] or kind != "text/html"
        assert "http" not in text.replace("http-equiv", "")


@pytest.mark.parametrize("body", ["", "[]", "7", "{", '"x"', "[" * 100_000, "\ud800".encode("utf-8", "surrogatepass")])
def test_what_is_no_object_is_refused(server, body):
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=30)
    connection.request("POST", f"/{server.token}/do/echo", body, {"Content-Type": "application/json"})
    assert connection.getresponse().status == 400
    connection.close()


def test_another_type_of_content_is_refused(server):
    """A form of another site can send text, and no JSON."""
    assert ask(server, "POST", "do/echo", {}, Content_Type="text/plain")[0] == 400


def test_what_is_too_large_is_refused_before_it_is_read(server):
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=10) as connection:
        head = f"POST /{server.token}/do/echo HTTP/1.0\r\nHost: 127.0.0.1:{server.server_port}\r\n"
        connection.sendall(f"{head}Content-Type: application/json\r\nContent-Length: {2**40}\r\n\r\n".encode())
        text = connection.makefile("rb").read().decode()
    assert " 413 " in text.splitlines()[0]
    assert "at most 32 MB" in text


def test_a_task_that_is_left_ends_with_its_process(server):
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=30)
    body = json.dumps({}).encode()
    connection.request("POST", f"/{server.token}/do/wait", body, {"Content-Type": "application/json"})
    response = connection.getresponse()
    process = json.loads(response.readline())["process"]
    os.kill(process, 0)
    response.close()
    connection.close()
    assert gone(process)
    assert parts(server, "echo", {})[0] == {"request": {}}


def test_a_task_that_takes_too_long_ends(server, monkeypatch):
    monkeypatch.setattr(module, "TASK_LIMIT", 0.3)
    begun = parts(server, "wait", {})
    assert "took longer than 0.3 s" in begun[1]["error"]
    assert gone(begun[0]["process"])


def test_two_windows_are_served_side_by_side(server):
    found = {}

    def window(of):
        found[of] = parts(server, "count", {"of": of, "pause": 0.02})

    threads = [threading.Thread(target=window, args=(of,)) for of in (8, 9)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert {of: len(answer) - 1 for of, answer in found.items()} == {8: 8, 9: 9}
    processes = [{part["process"] for part in answer[:-1]} for answer in found.values()]
    assert processes[0].isdisjoint(processes[1])


def test_more_than_can_be_done_at_once_is_refused_in_words(server, monkeypatch):
    monkeypatch.setattr("mjrock.app.worker.MOST_BUSY", 0)
    assert "too much is computed" in parts(server, "echo", {})[0]["error"]


def test_what_a_run_keeps_has_a_name_of_its_own_and_comes_back_with_it(server):
    name = parts(server, "keep", {})[0]["film"]
    status, headers, text = ask(server, "GET", f"film/{name}")
    assert (status, text) == (200, "<p>film</p>")
    assert "sandbox allow-scripts" in headers["Content-Security-Policy"]
    assert parts(server, "received", {"responses": name})[0] == {"responses": "<p>film</p>"}
    assert parts(server, "received", {"responses": None})[0] == {"responses": None}
    for other in ("other", [1], {}, 7):
        status, _, text = ask(server, "POST", "do/received", {"responses": other})
        assert (status, text) == (410, "the run is no longer kept; make it again")


def test_the_oldest_of_what_is_kept_goes(monkeypatch):
    store = Store()
    names = [store.put(bytes(1)) for _ in range(module.MOST_KEPT + 1)]
    assert [store.get(name) is None for name in names[:2]] == [True, False]
    monkeypatch.setattr(module, "MOST_KEPT_BYTES", 10)
    last = store.put(bytes(8))
    assert (store.get(names[-1]), store.get(last)) == (bytes(1), bytes(8))
    assert store.get(names[-3]) is None


def test_all_processes_end_with_the_team():
    team = Team("form_tasks")
    parts_of_two = [team.parts("wait", {}, lambda: False, 60.0) for _ in range(2)]
    processes = [next(one)["process"] for one in parts_of_two]
    team.close()
    assert all(map(gone, processes))
