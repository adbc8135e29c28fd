"""Shows a page in headless Chromium as a reader sees it, and checks what no parser can.

    python tests/readers/check_page.py report.html [--shots FOLDER] [--chromium PROGRAM]

Scripts are off. At each width, in light and dark, the page has to be shown whole (no picture broken, nothing wider than the
screen), and nothing may be fetched but the page itself. With --shots, a picture of each is written. Needs Python and a
Chromium (Debian: apt install chromium), with which it talks over two pipes; no package besides.
"""

import argparse
import base64
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

WIDTHS = [360, 768, 1280]
SCHEMES = ["light", "dark"]
NAMES = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"]
# For everything.
PATIENCE_S = 300
# The widths that matter, what sticks out, and what is broken; run by the debugger, as the page's own scripts are off.
MEASURE = """({
    width: document.documentElement.scrollWidth,
    height: document.documentElement.scrollHeight,
    broken: [...document.images].filter(image => !image.complete || !image.naturalWidth).length,
    images: document.images.length,
    text: document.body.innerText.length,
})"""


class Browser:
    """A Chromium that is driven over its pipes."""

    def __init__(self, program: str, profile: str) -> None:
        (commands, self._commands), (self._answers, answers) = os.pipe(), os.pipe()
        # It reads from descriptor 3 and writes to 4.
        shell = f'exec "$0" "$@" 3<&{commands} 4>&{answers}'
        flags = ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--remote-debugging-pipe"]
        flags += ["--no-first-run", f"--user-data-dir={profile}", "about:blank"]
        self._process = subprocess.Popen(
            ["bash", "-c", shell, program, *flags],
            pass_fds=[commands, answers],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(commands)
        os.close(answers)
        self._last, self._rest, self.events = 0, b"", []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def call(self, method: str, **params: object) -> dict:
        """The result of a command."""
        self._last += 1
        message = {"id": self._last, "method": method, "params": params}
        if hasattr(self, "_session"):
            message["sessionId"] = self._session
        os.write(self._commands, json.dumps(message).encode() + b"\0")
        while (answer := self._read()).get("id") != self._last:
            self.events.append(answer)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def wait_for(self, method: str) -> None:
        """Returns once the event has come."""
        while not any(event.get("method") == method for event in self.events):
            self.events.append(self._read())

    def _read(self) -> dict:
        while b"\0" not in self._rest:
            chunk = os.read(self._answers, 1 << 16)
            if not chunk:
                raise RuntimeError("Chromium ended")
            self._rest += chunk
        message, self._rest = self._rest.split(b"\0", 1)
        return json.loads(message)

    def close(self) -> None:
        self._process.terminate()
        self._process.wait()


def find_chromium() -> str:
    found = next(filter(None, map(shutil.which, NAMES)), None)
    if found is None:
        sys.exit(f"error: there is none of {', '.join(NAMES)} on PATH\n  hint: install one (Debian: apt install chromium)")
    return found


def check(browser: Browser, page: Path, width: int, scheme: str, shots: Path | None) -> list[str]:
    """What is wrong with the page at this width."""
    url = page.resolve().as_uri()
    browser.events.clear()
    browser.call("Emulation.setScriptExecutionDisabled", value=True)
    browser.call("Emulation.setDeviceMetricsOverride", width=width, height=800, deviceScaleFactor=1, mobile=width < 500)
    browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
    for domain in ["Page", "Network", "Log"]:
        browser.call(f"{domain}.enable")
    browser.call("Page.navigate", url=url)
    browser.wait_for("Page.loadEventFired")
    found = browser.call("Runtime.evaluate", expression=MEASURE, returnByValue=True)["result"]["value"]
    if shots:
        clip = {"x": 0, "y": 0, "width": width, "height": found["height"], "scale": 1}
        shot = browser.call("Page.captureScreenshot", clip=clip, captureBeyondViewport=True)
        (shots / f"{page.stem}-{width}-{scheme}.png").write_bytes(base64.b64decode(shot["data"]))
    requests = [e["params"]["request"]["url"] for e in browser.events if e.get("method") == "Network.requestWillBeSent"]
    fetched = [request for request in requests if request != url and not request.startswith("data:")]
    entries = [e["params"]["entry"]["text"] for e in browser.events if e.get("method") == "Log.entryAdded"]
    problems = [f"fetches {request}" for request in fetched] + [f"the browser says: {entry}" for entry in entries]
    if found["width"] > width:
        problems.append(f"is {found['width']} px wide")
    if found["broken"]:
        problems.append(f"{found['broken']} of {found['images']} pictures are not shown")
    if not found["text"] or not found["images"]:
        problems.append("shows nothing")
    return problems


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("page", type=Path)
    parser.add_argument("--shots", type=Path, help="a folder for pictures of the page")
    parser.add_argument("--chromium", help="the browser's program")
    args = parser.parse_args()
    if args.shots:
        args.shots.mkdir(parents=True, exist_ok=True)
    signal.alarm(PATIENCE_S)
    bad = 0
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(args.chromium or find_chromium(), profile)
        try:
            for width in WIDTHS:
                for scheme in SCHEMES:
                    problems = check(browser, args.page, width, scheme, args.shots)
                    bad += bool(problems)
                    print(f"{args.page} at {width} px, {scheme}: {'; '.join(problems) or 'ok'}")
        finally:
            browser.close()
    sys.exit(min(bad, 1))


if __name__ == "__main__":
    main()
