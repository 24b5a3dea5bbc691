"""A command in a terminal of its own (a pty), for tests that press its keys."""
import os
import pty
import re
import select
import subprocess
import termios
import time

RIGHT, LEFT = b"\x1b[C", b"\x1b[D"


class Terminal:
    """A command in a terminal, its standard output a pipe of its own, so that both can be looked at."""

    def __init__(self, command, screen=False):
        """screen: its standard output is the terminal too."""
        self.master, slave = pty.openpty()
        self.before = termios.tcgetattr(slave)
        self.slave = slave
        self.seen = ""
        self.process = subprocess.Popen(["setsid", "--ctty", *command], stdin=slave,
                                        stderr=slave, stdout=slave if screen else subprocess.PIPE, text=True)

    def look(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if select.select([self.master], [], [], 0.02)[0]:
                self.seen += os.read(self.master, 65536).decode(errors="replace")
        return self.seen

    def wait(self, text, seconds=20):
        end = time.monotonic() + seconds
        while text not in self.seen and time.monotonic() < end and self.process.poll() is None:
            self.look(0.05)
        return text in self.seen

    def hold(self, key, seconds):
        """As a keyboard: the key, and its repetitions."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            os.write(self.master, key)
            self.look(0.04)

    def position(self, axis):
        self.seen = ""
        self.look(0.3)
        shown = re.findall(rf"{axis}: +(-?[\d.e+-]+) ", self.seen)
        return float(shown[-1]) if shown else None

    def end(self, seconds=20):
        try:
            out = self.process.communicate(timeout=seconds)[0]
        except subprocess.TimeoutExpired:
            self.process.kill()
            return None, ""
        self.look(0.1)
        return self.process.returncode, out
