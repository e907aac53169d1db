"""Tasks for tests of the server and its processes."""

import os
import time


def echo(request, send):
    send({"request": request})


def count(request, send):
    for i in range(request["of"]):
        time.sleep(request.get("pause", 0.0))
        send({"number": i, "process": os.getpid()})


def wait(request, send):
    send({"process": os.getpid()})
    time.sleep(60)


def fail(request, send):
    send({"begun": True})
    raise ValueError("thickness = -1 m")


def die(request, send):
    os._exit(3)


def keep(request, send):
    send({"keep": {"film": b"<p>film</p>"}})


def received(request, send):
    send({"responses": None if request["responses"] is None else request["responses"].decode()})


TASKS = {one.__name__: one for one in (echo, count, wait, fail, die, keep, received)}
