"""Looks at a program that runs, from outside, through its control socket (docs/CONTROL.md). The program may be of any
language, and in real time."""
from __future__ import annotations

import contextlib
import glob
import json
import os
import re
import socket
import stat
import struct
import threading
import time
from types import TracebackType
from typing import Any, Iterator, NamedTuple, Optional, Sequence, Union

import numpy as np

from . import errors
from ._cm1e import lib
from .trace import Trace

Target = Union[int, str, "os.PathLike[str]", None]


def _folders() -> dict[str, int]:
    """Where programs put their sockets, and who has to own these folders; root looks into those of users too."""
    if "CM1E_RUNTIME_DIR" in os.environ:
        return {os.environ["CM1E_RUNTIME_DIR"]: os.geteuid()}
    folders = {"/run/cm1e": 0, f"/tmp/cm1e-{os.getuid()}": os.getuid()}
    if "XDG_RUNTIME_DIR" in os.environ:
        folders[os.path.join(os.environ["XDG_RUNTIME_DIR"], "cm1e")] = os.getuid()
    if os.getuid() == 0:
        for folder in glob.glob("/tmp/cm1e-*") + glob.glob("/run/user/*/cm1e"):
            user = re.fullmatch(r"/tmp/cm1e-(\d+)|/run/user/(\d+)/cm1e", folder)
            if user:
                folders[folder] = int(user.group(1) or user.group(2))
    return folders


def _stranger(folder: str, owner: int) -> Optional[str]:
    """What is wrong with a folder: whoever can write there could act for a program. None: nothing, or it is absent."""
    try:
        found = os.lstat(folder)
    except OSError:
        return None
    if not stat.S_ISDIR(found.st_mode):
        return f"{folder} is not a directory."
    if found.st_uid != owner or found.st_mode & 0o022:
        return (f"The directory {folder} belongs to user {found.st_uid} with rights {found.st_mode & 0o777:03o}; expected "
                f"user {owner}, and that no other one may write it, because whoever writes there could act for a program.")
    return None


class Program(NamedTuple):
    """A running program with a control socket."""
    pid: int
    path: str


def _sockets(folder: str) -> Iterator[Program]:
    for path in sorted(glob.glob(os.path.join(glob.escape(folder), "cm1e-*-*.sock"))):
        match = re.search(r"cm1e-(\d+)-\d+\.sock$", path)
        if match and os.path.exists(f"/proc/{match.group(1)}"):
            yield Program(int(match.group(1)), path)


def programs() -> list[Program]:
    """The running programs that can be attached to. Sockets in a folder that others can write are left out."""
    return [program for folder, owner in _folders().items() if _stranger(folder, owner) is None
            for program in _sockets(folder)]


def _refused(target: Optional[int]) -> Optional[str]:
    """Why a socket that has the name of such a program is none."""
    for folder, owner in _folders().items():
        why = _stranger(folder, owner)
        if why and any(target in (None, program.pid) for program in _sockets(folder)):
            return why
    return None


def _path_of(target: Target) -> tuple[str, Optional[int]]:
    """The path of the socket, and the process that has to serve it; None: the caller has named the socket."""
    if target is not None and not isinstance(target, int):
        return os.fspath(target), None
    listed = [program for program in programs() if target in (None, program.pid)]
    why = _refused(target) if not listed else None
    if why:
        raise errors.Error(why, lib.CM1E_ERROR_PERMISSION)
    if not listed:
        which = f"Process {target}" if target is not None else "No program"
        raise errors.NotFoundError(f"{which} has {'no' if target is not None else 'a'} control socket.",
                                   lib.CM1E_ERROR_NOT_FOUND)
    if len(listed) > 1:
        raise errors.StateError("Several programs run: " + ", ".join(program.path for program in listed) +
                                ". Name one of these paths.", lib.CM1E_ERROR_STATE)
    return listed[0].path, listed[0].pid


class Attached:
    """A connection to a running program: the path of its socket, the number of its process, or None: the only one that
    there is. What it may do, `control` in the bus file of the program says. What it moves ends with the connection. Threads
    may share one; their requests are asked in turn. A request that is broken off (Ctrl-C, no answer in time) closes it."""

    def __init__(self, target: Target = None, timeout: float = 5.0) -> None:
        self._path, pid = _path_of(target)
        self._asking, self._under_way = threading.RLock(), False
        self._socket: Optional[socket.socket] = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._socket.settimeout(timeout)
        try:
            self._socket.connect(self._path)
        except OSError as error:
            self.close()
            raise errors.NotFoundError(f"{self._path}: {error.strerror or error}.", lib.CM1E_ERROR_NOT_FOUND) from None
        self._check_server(pid)
        self.hello: dict[str, Any] = self.ask("hello", protocol=1)

    def _check_server(self, expected: Optional[int]) -> None:
        """That a socket which was found by the number of a process is that of this process."""
        assert self._socket is not None
        size = struct.calcsize("iII")
        pid, user, _ = struct.unpack("iII", self._socket.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, size))
        if expected in (None, pid):
            return
        self.close()
        raise errors.Error(f"{self._path} has the name of process {expected}, and process {pid} of user {user} serves "
                                  "it: name the path if that is meant.", lib.CM1E_ERROR_PERMISSION)

    def close(self) -> None:
        """Ends the connection, and what it moves."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def __enter__(self) -> Attached:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        self.close()

    # ---- the protocol ------------------------------------------------------------------------------------------------

    def _read(self, connection: socket.socket, size: int) -> bytes:
        data = b""
        while len(data) < size:
            part = connection.recv(min(size - len(data), 1 << 20))
            if not part:
                raise errors.StateError("The program has ended.", lib.CM1E_ERROR_STATE)
            data += part
        return data

    def ask(self, request: str, **arguments: object) -> Any:
        """Any request of docs/CONTROL.md; returns the member of the reply that has its name. Arguments that are None are
        not sent."""
        message = {"request": request, **{name: value for name, value in arguments.items() if value is not None}}
        return self._exchange(message).get(_MEMBER.get(request, request))

    def _exchange(self, message: dict[str, object]) -> Any:
        data = json.dumps(message).encode()
        with self._asking:
            connection = self._socket
            if connection is None:
                errors.closed("The connection")
            if self._under_way:  # waiting for it would never end
                raise errors.StateError("This thread waits for another request: what a signal calls cannot ask on the same "
                                        "connection.", lib.CM1E_ERROR_STATE)
            try:
                self._under_way = True
                connection.sendall(struct.pack(">I", len(data)) + data)
                reply = json.loads(self._read(connection, struct.unpack(">I", self._read(connection, 4))[0]))
                self._under_way = False
            except TimeoutError:
                self.close()  # its reply, if it comes, would be taken for that of the next request
                raise errors.WaitTimeout("The program does not answer.", lib.CM1E_ERROR_TIMEOUT) from None
            except OSError:
                self.close()
                raise errors.StateError("The program has ended.", lib.CM1E_ERROR_STATE) from None
            except BaseException:
                self.close()
                raise
        if not reply["ok"]:
            diag = reply["error"]
            raise errors._class_of(diag["code"])(diag["text"], diag["code"], diag["foreign_code"])
        return reply

    # ---- looking -----------------------------------------------------------------------------------------------------

    @property
    def axes(self) -> list[dict[str, Any]]:
        """The axes with the members of docs/CONTROL.md: name, state, position ..."""
        return list(self.ask("axes"))

    def axis(self, name: str) -> dict[str, Any]:
        """One of them."""
        axes = self.axes
        for axis in axes:
            if axis["name"] == name:
                return axis
        raise errors.NotFoundError(f"The program has no axis {name!r}; it has "
                                   f"{', '.join(axis['name'] for axis in axes)}.", lib.CM1E_ERROR_NOT_FOUND)

    @property
    def slaves(self) -> list[dict[str, Any]]:
        return list(self.ask("slaves"))

    @property
    def statistics(self) -> dict[str, Any]:
        return dict(self.ask("statistics"))

    @property
    def io(self) -> list[dict[str, Any]]:
        """The signals of all slaves with their values."""
        return list(self.ask("io"))

    def log(self, after: int = 0) -> list[dict[str, Any]]:
        """The records of the event log behind number `after`."""
        events: list[dict[str, Any]] = []
        while True:
            part = self.ask("log", after=after)
            events += part["events"]
            if not part["events"]:
                return events
            after = part["last"]

    def sdo_read(self, slave: int, index: int, subindex: int = 0, size: int = 512) -> bytes:
        """The bytes of an object, as on the wire."""
        return bytes.fromhex(self.ask("sdo_read", slave=slave, index=index, subindex=subindex, size=size))

    def sdo_write(self, slave: int, index: int, subindex: int, value: bytes) -> None:
        """Writes an object; needs control: maintain."""
        self.ask("sdo_write", slave=slave, index=index, subindex=subindex, data=value.hex())

    def record(self, seconds: float, every: int = 1, objects: Sequence[tuple[str, int, int]] = ()) -> Trace:
        """Records all signals for so long, every `every`-th cycle, with objects in the process data: (axis, index,
        subindex). It uses a connection of its own, because a recording ends with its connection."""
        with self.recording(every, objects) as recording:
            end, parts = time.monotonic() + seconds, [recording.take()]
            while time.monotonic() < end:
                time.sleep(min(0.1, max(0.0, end - time.monotonic())))
                parts.append(recording.take())
        return Trace(np.concatenate([part.array for part in parts]))

    def recording(self, every: int = 1, objects: Sequence[tuple[str, int, int]] = (),
                  variables: Optional[Sequence[str]] = None) -> Recording:
        """The same, while it goes on: a context manager whose take() returns the samples since the last call."""
        return Recording(self._path, every, objects, variables)

    def variables(self, part: str = "") -> dict[str, Any]:
        """The variables of a program in Structured Text with `part` in their names, and their values."""
        found: dict[str, Any] = {}
        types = {"BOOL": bool, "ULINT": int}  # a ULINT above 2^63 - 1 comes as a text
        after: Optional[int] = 0
        while after is not None:
            reply = self._exchange({"request": "variables", "from": after})
            found.update((row["name"], types.get(row["type"], lambda value: value)(row["value"]))
                         for row in reply["variables"] if part.lower() in row["name"].lower())
            after = reply.get("next")
        return found

    # ---- moving, with control: maintain ------------------------------------------------------------------------------

    @contextlib.contextmanager
    def enabled(self, axis: str, timeout: float = 5.0) -> Iterator[None]:
        """Power for an axis that the program does not command, for as long as the block lasts; it has to be
        renewed at least every 2 s, by jog() or keep()."""
        number = self.axis(axis)["number"]
        self.ask("enable", axis=number)
        try:
            end = time.monotonic() + timeout
            while not self.axis(axis)["powered"]:
                if time.monotonic() > end:
                    raise errors.WaitTimeout(f"{axis} is not enabled after {timeout} s.", lib.CM1E_ERROR_TIMEOUT)
                time.sleep(0.01)
            yield
        finally:
            if self._socket is not None:
                with contextlib.suppress(errors.Error):
                    self.ask("disable", axis=number)

    def keep(self) -> None:
        """Renews what this connection holds."""
        self.ask("keep")

    def jog(self, axis: str, velocity: float, seconds: float, acceleration: float = 0) -> None:
        """Moves an axis at a velocity for so long, then ramps it down. If this process stands still meanwhile, the axis
        is halted after a quarter of a second."""
        number, end = self.axis(axis)["number"], time.monotonic() + seconds
        try:
            while time.monotonic() < end:
                self.ask("jog", axis=number, velocity=velocity, acceleration=acceleration)
                self.keep()
                time.sleep(min(0.05, max(0.0, end - time.monotonic())))
        finally:
            if self._socket is not None:
                self.ask("stop", axis=number)

    def reset(self, axis: str) -> None:
        """As MC_Reset."""
        self.ask("reset", axis=self.axis(axis)["number"])

    def output(self, name: str, value: Optional[float], keep: float = 1.0) -> None:
        """Sets an output of a slave without a motor for so many seconds; None lets go of it."""
        self._exchange({"request": "output", "name": name, "value": value, "keep_ms": round(keep * 1000)})


class Recording:
    """Samples of a program while it runs in real time, through a connection of their own. They wait up to 4 s to be taken;
    `lost` counts those that waited longer."""

    def __init__(self, path: str, every: int = 1, objects: Sequence[tuple[str, int, int]] = (),
                 variables: Optional[Sequence[str]] = None) -> None:
        self.lost = 0
        self._connection = Attached(path)
        try:
            named = [{"axis": self._connection.axis(axis)["number"], "index": index, "subindex": subindex}
                     for axis, index, subindex in objects]
            begun = self._connection.ask("record", every=every, objects=named, variables=variables)
        except BaseException:
            self._connection.close()
            raise
        self._names = [column["name"] for column in begun["columns"]]

    def take(self) -> Trace:
        """The samples since the last call."""
        came = self._connection.ask("samples")
        self.lost = int(came["lost"])
        table = np.frombuffer(bytes.fromhex(came["data"]), dtype=np.dtype([("t", "<i8"), ("v", "<f8", (len(self._names),))]))
        array = np.zeros(len(table), dtype=[(name, "<f8") for name in ("time", *self._names)])
        array["time"] = table["t"] * 1e-9
        for number, name in enumerate(self._names):
            array[name] = table["v"][:, number]
        return Trace(array)

    def close(self) -> None:
        """Ends the recording."""
        self._connection.close()

    def __enter__(self) -> Recording:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        self.close()


_MEMBER = {"sdo_read": "data", "sdo_info": "data", "sii_read": "data", "registers": "data", "sdo_write": "data",
           "file_data": "data"}


def attach(target: Target = None) -> Attached:
    """Attached(target)."""
    return Attached(target)
