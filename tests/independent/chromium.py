"""Chromium without a window, driven over the DevTools protocol through a pipe: nothing but Python is needed.

https://chromedevtools.github.io/devtools-protocol/
"""

import base64
import json
import os
import select
import subprocess
import tempfile
import time


class Failure(Exception):
    """The browser did not do what was asked."""


class Browser:
    """A browser with a profile of its own."""

    def __init__(self, program, *options):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        their_in, our_out = os.pipe()
        our_in, their_out = os.pipe()

        def ends():
            # the browser reads from descriptor 3 and writes to 4; first away from both, so that neither is closed by the other
            source, sink = os.dup(their_in), os.dup(their_out)
            high = [os.dup2(source, 100), os.dup2(sink, 101)]
            os.dup2(high[0], 3)
            os.dup2(high[1], 4)

        words = [program, "--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--remote-debugging-pipe", "--no-first-run",
                 "--hide-scrollbars", f"--user-data-dir={self.profile.name}", *options, "about:blank"]
        self.process = subprocess.Popen(words, preexec_fn=ends, close_fds=False, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        os.close(their_in)
        os.close(their_out)
        self.reads, self.writes = our_in, our_out
        self.received, self.last, self.events = b"", 0, []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        os.close(self.reads)
        os.close(self.writes)
        self.profile.cleanup()

    def message(self, until):
        """The next message, or none at this time."""
        while b"\0" not in self.received:
            ready, _, _ = select.select([self.reads], [], [], max(0, until - time.monotonic()))
            if not ready:
                return None
            more = os.read(self.reads, 1 << 20)
            if not more:
                raise Failure("the browser ended")
            self.received += more
        message, self.received = self.received.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, session=None, /, **parameters):
        """The answer to a command."""
        self.last += 1
        command = {"id": self.last, "method": method, "params": parameters}
        if session:
            command["sessionId"] = session
        rest = json.dumps(command).encode() + b"\0"
        while rest:
            rest = rest[os.write(self.writes, rest):]
        until = time.monotonic() + 60
        while message := self.message(until):
            if message.get("id") == self.last:
                if "error" in message:
                    raise Failure(f"{method}: {message['error']['message']}")
                return message["result"]
            if "method" in message:
                self.events.append(message)
        raise Failure(f"{method}: no answer")


class Page:
    """A page in a window of this size. With `touch` it is a phone: the pointer is a finger. With `still` its reader wants no motion."""

    def __init__(self, browser, url, size=(1280, 900), touch=False, dark=False, still=False):
        self.browser = browser
        self.target = browser.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = browser.call("Target.attachToTarget", targetId=self.target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Log", "Network"]:
            self(f"{domain}.enable")
        width, height = size
        self("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2 if touch else 1, mobile=touch)
        self("Emulation.setTouchEmulationEnabled", enabled=touch, maxTouchPoints=5)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        motion = {"name": "prefers-reduced-motion", "value": "reduce" if still else "no-preference"}
        self("Emulation.setEmulatedMedia", features=[scheme, motion])
        began = time.monotonic()
        self("Page.navigate", url=url)
        self.wait("document.documentElement?.dataset.made === 'yes'")
        self.took = time.monotonic() - began

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.browser.call("Target.closeTarget", targetId=self.target)

    def __call__(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def js(self, expression):
        """The value of an expression in the page."""
        answer = self("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise Failure(f"{expression}: {answer['exceptionDetails']['exception'].get('description')}")
        return answer["result"].get("value")

    def settle(self):
        """Waits until what was asked for is drawn."""
        self.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))")

    def wait(self, condition):
        """Waits until a condition is true."""
        until = time.monotonic() + 30
        while not self.js(condition):
            if time.monotonic() > until:
                raise Failure(f"never true: {condition}; {self.faults()}")
            time.sleep(0.02)

    def faults(self):
        """What the page complained of, and what it asked for beside itself."""
        found = []
        for event in self.browser.events:
            if event.get("sessionId") != self.session:
                continue
            method, about = event["method"], event["params"]
            if method == "Runtime.exceptionThrown":
                found.append(about["exceptionDetails"]["exception"].get("description", "an exception"))
            elif method == "Log.entryAdded" and about["entry"]["level"] in ["error", "warning"]:
                # the browser tells of a graphics driver in software, and of canvases that are looked at from here
                if not any(word in about["entry"]["text"] for word in ["GPU stall", "GL Driver Message", "willReadFrequently"]):
                    found.append(about["entry"]["text"])
            elif method == "Runtime.consoleAPICalled" and about["type"] in ["error", "warning"]:
                found.append(str([one.get("value", one.get("description")) for one in about["args"]]))
            elif method == "Network.requestWillBeSent" and not about["request"]["url"].startswith(("file:", "data:", "blob:", "about:")):
                found.append(f"a request to {about['request']['url']}")
        return found

    def box(self, element):
        """Left, top, width and height of an element, which is scrolled into the window."""
        self.js(f"{element}.scrollIntoView({{ block: 'center' }})")
        self.settle()
        script = f"(() => {{ const e = {element}; const r = e.getBoundingClientRect(); return [r.left, r.top, r.width, r.height]; }})()"
        return self.js(script)

    def mouse(self, kind, x, y, **more):
        self("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def hover(self, x, y):
        self.mouse("mouseMoved", x, y)
        self.settle()

    def click(self, x, y):
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        self.mouse("mouseReleased", x, y, button="left", clickCount=1)
        self.settle()

    def press(self, element):
        """Clicks into the middle of an element, as a hand does."""
        left, top, width, height = self.box(element)
        self.click(left + width / 2, top + height / 2)

    def key(self, key, shift=False):
        codes = {"Tab": 9, "Enter": 13, "Escape": 27, " ": 32, "End": 35, "Home": 36, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}
        about = {"key": key, "code": "Space" if key == " " else key, "windowsVirtualKeyCode": codes[key], "modifiers": 8 if shift else 0}
        text = {" ": " ", "Enter": "\r"}.get(key)
        self("Input.dispatchKeyEvent", type="keyDown", **about, **({"text": text} if text else {}))
        self("Input.dispatchKeyEvent", type="keyUp", **about)
        self.settle()

    def swipe(self, x, y, dx, dy):
        """A finger is put down, moved and lifted."""
        self("Input.dispatchTouchEvent", type="touchStart", touchPoints=[{"x": x, "y": y}])
        for k in range(1, 11):
            self("Input.dispatchTouchEvent", type="touchMove", touchPoints=[{"x": x + dx * k / 10, "y": y + dy * k / 10}])
        self("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
        self.settle()

    def pdf(self, paper=(8.27, 11.69)):
        """The page printed on paper of this size [inch]; margins are those of the page."""
        width, height = paper
        answer = self("Page.printToPDF", printBackground=True, preferCSSPageSize=False, paperWidth=width, paperHeight=height)
        return base64.b64decode(answer["data"])

    def picture(self, path):
        """Saves what is in the window."""
        with open(path, "wb") as out:
            out.write(base64.b64decode(self("Page.captureScreenshot", format="png")["data"]))
