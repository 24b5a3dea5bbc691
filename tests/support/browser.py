"""A headless Chromium that a test uses as a person would: DevTools commands over a pipe, so it needs no port."""
import itertools
import json
import os
import select
import shutil
import subprocess
import tempfile
import time


def path():
    names = ("chromium", "chromium-browser", "google-chrome")
    return next((found for name in names if (found := shutil.which(name))), None)


class Browser:
    """`with Browser() as browser: page = browser.open(url)`"""

    def __init__(self):
        self.profile = tempfile.mkdtemp()
        theirs_in, self.to = os.pipe()
        self.back, theirs_out = os.pipe()
        self.process = subprocess.Popen(
            ["bash", "-c", 'exec "$@" 3<&"$READ" 4>&"$WRITE"', "-", path(), "--headless", "--no-sandbox",
             "--disable-gpu", "--window-size=1500,1200", "--remote-debugging-pipe", "--no-first-run", f"--user-data-dir={self.profile}",
             "about:blank"], pass_fds=(theirs_in, theirs_out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env={**os.environ, "READ": str(theirs_in), "WRITE": str(theirs_out)})
        os.close(theirs_in)
        os.close(theirs_out)
        self.numbers, self.rest, self.errors = itertools.count(1), b"", []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(timeout=30)
        os.close(self.to)
        os.close(self.back)
        shutil.rmtree(self.profile, ignore_errors=True)

    def message(self, end):
        while b"\0" not in self.rest:
            ready, _, _ = select.select([self.back], [], [], max(0, end - time.monotonic()))
            part = os.read(self.back, 1 << 16) if ready else b""
            if not part:
                raise OSError("the browser does not answer")
            self.rest += part
        text, self.rest = self.rest.split(b"\0", 1)
        return json.loads(text)

    def ask(self, method, session=None, **parameters):
        number, end = next(self.numbers), time.monotonic() + 60
        command = {"id": number, "method": method, "params": parameters, **({"sessionId": session} if session else {})}
        os.write(self.to, json.dumps(command).encode() + b"\0")
        while True:
            message = self.message(end)
            if message.get("method") == "Runtime.exceptionThrown":
                self.errors.append(message["params"]["exceptionDetails"])
            if message.get("id") == number:
                if "error" in message:
                    raise OSError(f"{method}: {message['error']}")
                return message["result"]

    def open(self, url):
        """A page in a window of its own, as the session to ask."""
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.ask("Runtime.enable", session)
        self.ask("Page.enable", session)
        self.ask("Page.navigate", session, url=url)
        self.wait(session, f"location.href === {json.dumps(url)} && document.readyState === 'complete'")
        return session

    def run(self, page, script):
        """The value of an expression in the page."""
        result = self.ask("Runtime.evaluate", page, expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise OSError(f"{script}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait(self, page, script, seconds=20):
        """Until the expression is true. Whether it was."""
        end = time.monotonic() + seconds
        while not (found := self.run(page, script)) and time.monotonic() < end:
            time.sleep(0.05)
        return found
