"""A headless Chromium for tests of pages, over the pipe of its debugging protocol."""

import json
import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

CHROMIUM = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), None
)
KEYS = {"/": {"text": "/"}, "p": {"text": "p"}}


class Page:
    """An open page; ``errors`` are its exceptions and the errors of its console."""

    def __init__(self, to: Any, back: Any) -> None:
        self._to, self._back, self._number, self._rest = to, back, 0, b""
        self.errors: list[str] = []
        target = self._call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self._call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **given: Any) -> Any:
        """Result of a method of the protocol."""
        return self._call(method, self._session, **given)

    def open(self, path: Path) -> None:
        """Open a file and wait until it is loaded."""
        self.call("Page.navigate", url=path.resolve().as_uri())
        self.until("document.readyState === 'complete'")

    def value(self, expression: str) -> Any:
        """Value of an expression in the page."""
        found = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        return found["result"].get("value")

    def until(self, expression: str) -> None:
        """Wait until an expression is true, ten seconds at most."""
        poll = f"""new Promise((yes, no) => {{
            const began = Date.now();
            const look = () => ({expression}) ? yes(1) : Date.now() - began > 1e4 ? yes(0) : setTimeout(look, 20);
            look();
        }})"""
        assert self.value(poll) == 1, (expression, self.errors)

    def press(self, key: str) -> None:
        """Press a key and release it."""
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, **(KEYS.get(key, {}) if kind == "keyDown" else {}))

    def type(self, text: str) -> None:
        """Insert a text where the focus is."""
        self.call("Input.insertText", text=text)

    def look(self, width: int, *, dark: bool = False) -> None:
        """Set the width of the window, and a light or dark scheme."""
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)

    def _call(self, method: str, session: str | None = None, **given: Any) -> Any:
        self._number += 1
        message = {"id": self._number, "method": method, "params": given} | ({"sessionId": session} if session else {})
        self._to.write(json.dumps(message).encode() + b"\0")
        while (answer := self._next()).get("id") != self._number:
            self._note(answer)
        assert "error" not in answer, (method, answer["error"])
        return answer["result"]

    def _next(self) -> Any:
        while b"\0" not in self._rest:
            got = self._back.read(1 << 16)
            assert got, "the browser has ended"
            self._rest += got
        message, _, self._rest = self._rest.partition(b"\0")
        return json.loads(message)

    def _note(self, event: Any) -> None:
        given = event.get("params", {})
        if event.get("method") == "Runtime.exceptionThrown":
            details = given["exceptionDetails"]
            self.errors.append(details.get("exception", {}).get("description") or details["text"])
        elif event.get("method") == "Log.entryAdded" and given["entry"]["level"] == "error":
            self.errors.append(given["entry"]["text"])
        elif event.get("method") == "Runtime.consoleAPICalled" and given["type"] == "error":
            self.errors.append(str(given["args"]))


@contextmanager
def browser(profile: Path) -> Iterator[Page]:
    """Open a headless Chromium with an empty page; ``profile`` is a new folder."""
    assert CHROMIUM is not None
    (to_read, to_write), (back_read, back_write) = os.pipe(), os.pipe()
    command = f'exec "$0" "$@" 3<&{to_read} 4>&{back_write}'
    flags = ["--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", f"--user-data-dir={profile}"]
    with subprocess.Popen(
        ["bash", "-c", command, CHROMIUM, *flags, "--remote-debugging-pipe"],
        pass_fds=(to_read, back_write),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    ) as process:
        os.close(to_read)
        os.close(back_write)
        with os.fdopen(to_write, "wb", 0) as to, os.fdopen(back_read, "rb", 0) as back:
            page = Page(to, back)
            yield page
            page._call("Browser.close")
        process.wait(20)
