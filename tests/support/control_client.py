"""The control socket of a running program (docs/CONTROL.md): a client, and a program to be looked at."""
import json
import os
import socket
import struct
import subprocess
import time


class Client:
    def __init__(self, program):
        path = getattr(program, "path", program)
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.socket.settimeout(20)
        while True:
            try:
                self.socket.connect(path)
                return
            except BlockingIOError:  # more connect at a time than wait in the queue
                time.sleep(0.01)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def send(self, text):
        data = text if isinstance(text, bytes) else text.encode()
        self.socket.sendall(struct.pack(">I", len(data)) + data)

    def receive(self):
        """The next reply; None: the program has closed the connection."""
        header = self.read(4)
        data = self.read(struct.unpack(">I", header)[0]) if header else None
        return json.loads(data) if data else None

    def read(self, length):
        data = b""
        while len(data) < length:
            try:
                part = self.socket.recv(length - len(data))
            except ConnectionError:
                return None
            if not part:
                return None
            data += part
        return data

    def ask(self, request, **arguments):
        self.send(json.dumps({"request": request, **arguments}))
        return self.receive()


class Program:
    """`cm1e move`, or another command, of axis X on a simulated segment, and where its socket is. It has no block for
    other axes."""

    SPEED = 0.5

    def __init__(self, cm1e, bus_file, environment, *options, seconds=120, command=None):
        self.cm1e, self.environment = cm1e, environment
        command = command or ("move", "--speed", str(self.SPEED))
        self.process = subprocess.Popen([cm1e, *command, "-b", bus_file, "X", "--for", str(seconds), *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        text=True, env=environment)
        self.pid = self.process.pid
        self.path = os.path.join(environment["CM1E_RUNTIME_DIR"], f"cm1e-{self.pid}-0.sock")

    def listens(self):
        """False: the socket is not there yet, or has its name and is not served yet."""
        try:
            Client(self).socket.close()
        except (FileNotFoundError, ConnectionRefusedError):
            return False
        return True

    def axis(self):
        """Axis X as the program tells of it; empty: all places of clients are taken, those of clients that have just
        vanished too."""
        try:
            with Client(self) as client:
                reply = client.ask("axes")
        except ConnectionError:
            return {}
        return reply["axes"][0] if reply and reply["ok"] else {}

    def moves(self):
        """It moves as it was told to. On a machine that pauses it goes on slower for a while (docs/SAFETY.md)."""
        axis = self.axis()
        return bool(axis) and axis["state"] == "ContinuousMotion" and axis["error"] is None and \
            abs(axis["velocity"] - self.SPEED) < 0.1

    def attached(self, *words):
        return subprocess.run([self.cm1e, *words, "--attach", str(self.pid)], capture_output=True, text=True,
                              timeout=60, env=self.environment)

    def end(self):
        """What it printed."""
        if self.process.poll() is None:
            self.process.terminate()
        out, err = self.process.communicate(timeout=30)
        return out + err
