"""A headless Chromium, controlled through chromedriver's protocol, JSON over HTTP."""

import contextlib
import json
import re
import shutil
import subprocess
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any

FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
)


def missing() -> str:
    """Return the reason why there is no browser; empty if there is one."""
    not_found = [name for name in ("chromium", "chromedriver") if shutil.which(name) is None]
    return f"needs {' and '.join(not_found)}" if not_found else ""


class Browser:
    """A session of chromedriver."""

    def __init__(self, address: str, profile: Path) -> None:
        self.address = address
        options = {
            "binary": shutil.which("chromium"),
            "args": [*FLAGS, f"--user-data-dir={profile}"],
        }
        capabilities = {"goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}
        opened = self.call("session", {"capabilities": {"alwaysMatch": capabilities}})
        self.session = f"session/{opened['sessionId']}"

    def call(self, path: str, body: dict[str, Any] | None = None, method: str = "POST") -> Any:
        """Send a command of chromedriver; return the value of the response."""
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(f"{self.address}/{path}", data, method=method)
        with urllib.request.urlopen(request, timeout=120) as response:
            return json.loads(response.read())["value"]

    def tool(self, command: str, **arguments: Any) -> Any:
        """Send a command of Chromium's DevTools protocol; return its result."""
        body = {"cmd": command, "params": arguments}
        return self.call(f"{self.session}/goog/cdp/execute", body)

    def open(self, path: Path, width: int, dark: bool = False) -> None:
        """Open a file in a window of the given width [pixels], with light or dark colours."""
        self.tool(
            "Emulation.setDeviceMetricsOverride",
            width=width, height=900, deviceScaleFactor=1, mobile=False,
        )  # fmt: skip
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.tool("Emulation.setEmulatedMedia", features=[scheme])
        self.call(f"{self.session}/url", {"url": path.resolve().as_uri()})

    def run(self, script: str) -> Any:
        """Run a script in the page; return its result."""
        return self.call(f"{self.session}/execute/sync", {"script": script, "args": []})

    def console_messages(self) -> list[str]:
        """Return the messages of the console since the last call."""
        log = self.call(f"{self.session}/se/log", {"type": "browser"})
        return [entry["message"] for entry in log]


@contextlib.contextmanager
def browser(folder: Path) -> Iterator[Browser]:
    """Yield a browser with a separate profile; it is closed at the end of the block."""
    command = [str(shutil.which("chromedriver")), "--port=0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as driver:
        try:
            assert driver.stdout is not None
            line = next(line for line in driver.stdout if "started successfully" in line)
            port = re.search(r"port (\d+)", line)
            assert port is not None
            session = Browser(f"http://127.0.0.1:{port[1]}", folder / "profile")
            try:
                yield session
            finally:
                session.call(session.session, method="DELETE")
        finally:
            driver.terminate()
