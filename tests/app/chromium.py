"""Chromium for tests, which reads commands of its DevTools protocol from a pipe."""

import base64
import contextlib
import json
import os
import shutil
import signal
import subprocess
import tempfile
import threading
import time

BROWSER = shutil.which("chromium") or shutil.which("google-chrome")
SWITCHES = (
    "--headless=new",
    "--no-sandbox",
    "--enable-unsafe-swiftshader",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--remote-debugging-pipe",
    "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1",
)
"""It finds no machine but this one."""


class Browser:
    """A browser with one page. Use it in a `with` statement."""

    def __init__(self, size=(1280, 900), *, dark=False, language="en"):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.downloads = os.path.join(self.folder.name, "downloads")
        to_browser, commands = os.pipe()
        answers, from_browser = os.pipe()
        shell = f'exec "$@" 3<&{to_browser} 4>&{from_browser}'
        own = [f"--user-data-dir={self.folder.name}/profile", f"--lang={language}", f"--accept-lang={language}"]
        self.process = subprocess.Popen(
            ["bash", "-c", shell, "-", BROWSER, *SWITCHES, *own],
            pass_fds=(to_browser, from_browser),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        os.close(to_browser)
        os.close(from_browser)
        self.commands, self.answers = os.fdopen(commands, "wb", 0), os.fdopen(answers, "rb", 0)
        self.count, self.replies, self.events, self.session = 0, {}, [], None
        self.news = threading.Condition()
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Network", "DOM"):
            self.call(f"{domain}.enable")
        self.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=self.downloads)
        self.resize(*size)
        scheme = "dark" if dark else "light"
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])

    def __enter__(self):
        return self

    def __exit__(self, *error):
        with contextlib.suppress(AssertionError, OSError):
            self.call("Browser.close")
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(10)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.reader.join(10)
        self.commands.close()
        self.answers.close()
        self.folder.cleanup()

    def _read(self):
        text = b""
        while piece := self.answers.read(1 << 16):
            text += piece
            *messages, text = text.split(b"\0")
            with self.news:
                for message in map(json.loads, messages):
                    if "id" in message:
                        self.replies[message["id"]] = message
                    else:
                        self.events.append(message)
                self.news.notify_all()

    def call(self, method, **given):
        """The result of a command."""
        self.count += 1
        number = self.count
        of_page = self.session is not None and not method.startswith(("Browser.", "Target."))
        session = {"sessionId": self.session} if of_page else {}
        self.commands.write(json.dumps({"id": number, "method": method, "params": given} | session).encode() + b"\0")
        with self.news:
            assert self.news.wait_for(lambda: number in self.replies, 60), f"no answer to {method}"
            reply = self.replies.pop(number)
        assert "error" not in reply, (method, reply["error"])
        return reply["result"]

    def resize(self, width, height):
        mobile = width < 600
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=mobile)

    def open(self, address):
        self.call("Page.navigate", url=address)

    def run(self, script):
        """The value of a script in the page."""
        how = {"awaitPromise": True, "returnByValue": True, "userGesture": True}
        found = self.call("Runtime.evaluate", expression=script, **how)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def wait(self, script, seconds=60):
        """The value of a script in the page as soon as it is true."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                if value := self.run(f"(v => v instanceof Node ? true : v)({script})"):
                    return value
            except AssertionError:  # between two pages
                pass
            time.sleep(0.05)
        raise AssertionError(f"not within {seconds} s: {script}; {self.run('document.body.innerText')[:3000]}")

    def fill(self, place, text):
        """Type a text into a field, in place of what is there."""
        unfold = "for (let f = e.closest('details'); f; f = f.parentElement.closest('details')) f.open = true"
        focus = f"e => {{ if (!e) return false; {unfold}; e.focus(); e.select?.(); return true; }}"
        assert self.run(f"({focus})(document.getElementById({json.dumps(place)}))"), f"no field {place}"
        self.call("Input.insertText", text=text)

    def press(self, key, times=1):
        """Press a key, as Tab or Enter."""
        code = {"Tab": 9, "Enter": 13, "ArrowDown": 40}[key]
        text = {"text": "\r"} if key == "Enter" else {}
        for _ in range(times):
            for kind in ("keyDown", "keyUp"):
                event = {"type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code}
                self.call("Input.dispatchKeyEvent", **event, **(text if kind == "keyDown" else {}))

    def tab_to(self, place, most=60):
        """Press Tab until a field has the focus."""
        for _ in range(most):
            self.press("Tab")
            if self.run("document.activeElement.id") == place:
                return
        raise AssertionError(f"Tab does not reach {place} in {most} steps")

    def choose(self, place, value):
        """Choose a value of a list."""
        self.run(
            f"(e => {{ e.value = {json.dumps(value)}; e.dispatchEvent(new Event('change', {{bubbles: true}})); }})"
            f"(document.getElementById({json.dumps(place)}))"
        )

    def click(self, script):
        """Click what a script finds."""
        self.run(f"({script}).click()")

    def upload(self, selector, *paths):
        """Give files to a field."""
        root = self.call("DOM.getDocument")["root"]["nodeId"]
        node = self.call("DOM.querySelector", nodeId=root, selector=selector)["nodeId"]
        self.call("DOM.setFileInputFiles", files=[str(path) for path in paths], nodeId=node)

    def downloaded(self, seconds=60):
        """The one file that has been downloaded, and its bytes; it is taken away."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            names = os.listdir(self.downloads) if os.path.isdir(self.downloads) else []
            if names and not any(name.endswith(".crdownload") for name in names):
                path = os.path.join(self.downloads, names[0])
                with open(path, "rb") as file:
                    content = file.read()
                os.remove(path)
                return names[0], content
            time.sleep(0.05)
        raise AssertionError(f"no download within {seconds} s: {self.run('document.body.innerText')[:3000]}")

    def screenshot(self, path, *, whole=False):
        """Write a picture of the page, or of all that can be scrolled to."""
        data = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(data))

    @property
    def requested(self):
        """Addresses that the page has asked for."""
        return [one["params"]["request"]["url"] for one in self.events if one["method"] == "Network.requestWillBeSent"]

    @property
    def errors(self):
        """What went wrong in the page."""
        kinds = "Runtime.exceptionThrown", "Log.entryAdded"
        return [one["params"] for one in self.events if one["method"] in kinds]
