"""A client of the control socket of a running program (docs/CONTROL.md)."""
import json
import socket
import struct
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
