"""A bus: the network, the cycle that C runs, and what a Python program does with them."""
from __future__ import annotations

import asyncio
import os
import signal
import threading
import time
import weakref
from contextvars import ContextVar
from types import TracebackType
from typing import Any, Callable, Iterable, Literal, Optional, Sequence, Union

from . import blocks as fb
from . import errors
from ._block import AXES_GROUP_REF, AXIS_REF, Block, Reference, references
from ._cm1e import ffi, lib
from .attach import Recording
from .axis import Axis, AxisInfo, Command, Group, info_of
from .codes import AxisState
from .config import Axes, Config, PathLike
from .devices import Devices, Network
from .events import Event, event_of
from .slaves import Statistics, statistics_of
from .trace import Trace

Callback = Callable[["Bus"], object]
_callback_bus: ContextVar[Optional["Bus"]] = ContextVar("cm1e_callback_bus", default=None)
_CHUNK = 1000       # cycles on virtual time between two looks at Ctrl-C
_SLICE_NS = 20_000_000


def bus_of_callback() -> Optional[Bus]:
    return _callback_bus.get()


def _end(session: Any, process: int, kept: dict[int, Any]) -> None:
    """Ends a bus whose object is gone, and at the end of the interpreter: axes ramp down and are disabled. A forked
    child has the memory of the bus, and not its thread."""
    if os.getpid() == process:
        lib.cm1e_py_close(session, ffi.NULL)
    kept.clear()


def _end_by_signal(number: int, _frame: object) -> None:
    raise SystemExit(128 + number)


def _catch_signals() -> None:
    """A program that is told to end ends like Python does, so that motors stop: only where it has no handler."""
    if threading.current_thread() is threading.main_thread():
        for number in (signal.SIGTERM, signal.SIGHUP):
            if signal.getsignal(number) is signal.SIG_DFL:
                signal.signal(number, _end_by_signal)


def _listed(what: str, given: Any, kind: Any, right: str) -> list[Any]:
    """A list of this kind. A single text is none: its letters would be taken."""
    listed = list(given) if isinstance(given, Iterable) and not isinstance(given, (str, bytes)) else [None]
    if all(isinstance(one, kind) for one in listed):
        return listed
    raise TypeError(f"{what} is {given!r}; expected a list, as {right}")


class Bus(Devices):
    """A network of motors. As a context manager it starts, and at the end of the block, whatever ends it, stops the axes
    in order and disables them. So does the end of the interpreter, and the garbage collector when the last reference is lost.

    `source` is a bus file. Without it, `axes` is a number of simulated axes, or a list of their settings by the names of
    cm1e_axis_config_t. `interface`, `virtual_time`, `cycle_time` (s), `control` and `pcap` are used instead of what the
    file says. `groups`: names of axes groups. `trace`: s that are recorded, every `trace_every`-th cycle, with the
    objects `trace_objects` of the process data: (axis, index, subindex). `networks`: bus files of further networks, which
    the same cycle exchanges; their axes are behind those of the first one, and `networks` of the bus has their devices. `realtime`: "try" runs the cycle with real-time
    priority where that is permitted, "require" fails where it is not, "off" does not try."""

    def __init__(self, source: Optional[PathLike] = None, *, axes: Optional[Axes] = None,
                 interface: Optional[str] = None, virtual_time: Optional[bool] = None,
                 cycle_time: Optional[float] = None, control: Optional[str] = None, pcap: Optional[PathLike] = None,
                 groups: Sequence[str] = (), trace: float = 10.0, trace_every: int = 1,
                 trace_objects: Sequence[tuple[str, int, int]] = (),
                 realtime: Literal["try", "require", "off"] = "try", text: Optional[str] = None,
                 networks: Sequence[PathLike] = ()) -> None:
        if sum(given is not None for given in (source, axes, text)) > 1:
            raise TypeError("a bus is described by a file, a text or a list of axes: give one of them")
        config = Config.of_file(source) if source is not None else Config.of_text(text) if text is not None else \
            Config.of_axes(axes if axes is not None else 1)
        config.set(interface=interface, virtual_time=virtual_time, cycle_time=cycle_time, control=control, pcap=pcap)
        self.virtual_time: bool = bool(config.data.virtual_time)
        self.cycle_time: float = (config.data.cycle_time_ns or 1_000_000) * 1e-9
        self._settings = self._scheduler_settings(trace, trace_every, realtime)
        others = [Config.of_file(file) for file in _listed("networks", networks, (str, os.PathLike), "['second.yaml']")]
        self._others = tuple(Network(self, n + 1, one) for n, one in enumerate(others))
        self._axis_names = [name for one in (config, *others) for name in one.axis_names()]
        self._process = os.getpid()
        self._kept: dict[int, Any] = {}
        self._attached: set[int] = set()  # of those: what attach() has brought, no command
        self._callbacks: list[Callback] = []
        self._stops: list[Block] = []
        self._unwaited: list[Command] = []
        self._started = self._closed = False
        self._session = self._open(config)
        self._finalizer = weakref.finalize(self, _end, self._session, self._process, self._kept)
        self._axes: list[Axis] = []
        try:
            for other in others:
                other.set(virtual_time=self.virtual_time, cycle_time=cycle_time)
                self._ask(lib.cm1e_py_add, other.data)
            self._groups = {name: self._make_group(name) for name in _listed("groups", groups, str, "['table']")}
            for axis, index, subindex in _listed("trace_objects", trace_objects, (tuple, list), "[('X', 0x6077, 0)]"):
                self._ask(lib.cm1e_py_trace_object, axis.encode(), index, subindex)
        except BaseException:
            self.close()
            raise

    def _scheduler_settings(self, trace: float, every: int, realtime: str) -> Any:
        if realtime not in ("try", "require", "off"):
            raise errors.ConfigError(f"realtime is {realtime!r}; expected try, require or off.", lib.CM1E_ERROR_CONFIG)
        if every < 1 or trace < 0:
            raise errors.ConfigError("trace is below 0, or trace_every below 1.", lib.CM1E_ERROR_CONFIG)
        return ffi.new("cm1e_scheduler_config_t *", {
            "realtime_priority": -1 if realtime == "off" else 0, "realtime_required": realtime == "require",
            "trace_capacity": round(trace / self.cycle_time / every), "trace_every": every})

    def _open(self, config: Config) -> Any:
        session, diag = ffi.new("cm1e_py_session_t **"), errors.diag()
        errors.check(lib.cm1e_py_open(session, config.data, diag), diag)
        return ffi.gc(session[0], lib.cm1e_py_free) if os.getpid() == self._process else session[0]

    def _make_group(self, name: str) -> Group:
        handle = ffi.new("AXES_GROUP_REF_t *")
        self._ask(lib.cm1e_py_group, handle, name.encode())
        return Group(self, name, handle)

    # ---- how C is called ---------------------------------------------------------------------------------------------

    def _live(self) -> Any:
        if self._closed:
            errors.closed()
        if os.getpid() != self._process:
            raise errors.StateError("The bus belongs to the process that opened it, not to its child.",
                                    lib.CM1E_ERROR_STATE)
        return self._session

    # ---- start and end -----------------------------------------------------------------------------------------------

    def start(self) -> Bus:
        """Brings the slaves to Operational and starts the cycle. On virtual time it stands until time is let pass."""
        self._ask(lib.cm1e_py_begin, self._settings)
        self._started = True
        _catch_signals()
        handles, infos, count = self._read_axes()
        for index in range(count):
            handle = ffi.new("AXIS_REF_t *", handles[index])
            self._axes.append(Axis(self, self._axis_names[index], handle, index))
        return self

    def stop(self) -> None:
        """Ends the cycle in order: axes ramp down and are disabled. Traces and log can still be read."""
        self._ask(lib.cm1e_py_end)

    def close(self) -> None:
        """Stops, and closes the network. Everything that belongs to the bus raises StateError from then on."""
        if self._closed or os.getpid() != self._process:
            return
        self._closed = True
        diag = errors.diag()
        try:
            errors.check(lib.cm1e_py_close(self._session, diag), diag)
        finally:
            self._finalizer.detach()
            self._kept.clear()
            self._callbacks.clear()

    def __enter__(self) -> Bus:
        try:
            return self if self._started else self.start()
        except BaseException:
            self.close()
            raise

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        try:
            self.close()
        except errors.Error as at_close:
            if error is None:
                raise
            error.add_note(f"The bus was closed with an error: {at_close}")

    def __repr__(self) -> str:
        state = "closed" if self._closed else "running" if self.running else "stopped" if self._started else "open"
        return f"<Bus of {', '.join(self._axis_names) or 'no axes'}, {state}>"

    @property
    def running(self) -> bool:
        """Whether the cycle runs."""
        return not self._closed and bool(lib.cm1e_py_runs(self._live()))

    @property
    def networks(self) -> tuple[Devices, ...]:
        """The devices of each network: this bus itself, then those of Bus(networks=[...])."""
        return (self, *self._others)

    # ---- axes and groups ---------------------------------------------------------------------------------------------

    @property
    def axes(self) -> tuple[Axis, ...]:
        """The axes in the order of the configuration; from the start on."""
        self._live()
        return tuple(self._axes)

    def axis(self, name: str) -> Axis:
        """The axis with this name."""
        for axis in self.axes:
            if axis.name == name:
                return axis
        has = ", ".join(self._axis_names) if self._started else "none before its start"
        raise errors.NotFoundError(f"The bus has no axis {name!r}; it has {has}.", lib.CM1E_ERROR_NOT_FOUND)

    __getitem__ = axis

    def group(self, name: str) -> Group:
        """The axes group with this name, of Bus(groups=[...])."""
        self._live()
        if name not in self._groups:
            raise errors.NotFoundError(f"There is no axes group {name!r}: name it in Bus(groups=[...]).",
                                       lib.CM1E_ERROR_NOT_FOUND)
        return self._groups[name]

    def _read_axes(self) -> tuple[Any, Any, int]:
        room = len(self._axis_names)
        handles, infos = ffi.new("AXIS_REF_t[]", room), ffi.new("cm1e_axis_info_t[]", room)
        count = ffi.new("uint32_t *", room)
        self._do(lib.cm1e_py_axes, handles, infos, count)
        return handles, infos, count[0]

    def _axis_info(self, index: int) -> AxisInfo:
        return info_of(self._read_axes()[1][index])

    def _error_text(self, reference: Reference) -> str:
        axis, group = ffi.new("AXIS_REF_t *"), ffi.new("AXES_GROUP_REF_t *")
        if isinstance(reference, AXIS_REF):
            axis = reference._handle
        else:
            group = reference._handle
        buffer = ffi.new("char[2048]")
        lib.cm1e_py_error_text(self._live(), axis[0], group[0], buffer, 2048)
        return errors.text(buffer)

    # ---- blocks ------------------------------------------------------------------------------------------------------

    def attach(self, *blocks: Block) -> None:
        """Lets the cycle call these blocks in every cycle from now on, behind those before."""
        for block in blocks:
            if not isinstance(block, Block):
                raise TypeError(f"expected a function block, not {block!r}")
            if len(self._attached) >= lib.CM1E_PY_BLOCKS:  # the other places are for commands: an axis can always be stopped
                raise errors.StateError(f"{block._type} is not attached: {lib.CM1E_PY_BLOCKS} blocks are. Detach those that "
                                        "are not needed.", lib.CM1E_ERROR_FULL)
            self._attach(block)
            self._attached.add(id(block._c))

    def _attach(self, block: Block) -> None:
        if block._bus is not None:
            raise errors.StateError(f"{block._type} is attached already.", lib.CM1E_ERROR_STATE)
        self._check_started()
        self._check_own(block)
        self._kept[id(block._c)] = (block._c, block._data, block._offsets, block._memory)
        block._bus = self
        try:
            self._do(lib.cm1e_py_block_add, block._c)
        except errors.Error:
            block._bus = None
            self._forget(block)
            raise
        except BaseException:  # Ctrl-C, before or behind that: now it is added in either case
            lib.cm1e_py_block_add(self._session, block._c)
            raise

    def detach(self, *blocks: Block) -> None:
        """Ends that. A motion that such a block began goes on."""
        for block in blocks:
            if block._bus is self:
                self._do(lib.cm1e_py_block_remove, block._c)
                block._bus = None
                self._forget(block)

    def _forget(self, block: Block) -> None:
        """C does not use the memory of this block any more."""
        self._kept.pop(id(block._c), None)
        self._attached.discard(id(block._c))

    def execute(self, block: Block, reference: Optional[AXIS_REF | AXES_GROUP_REF] = None, *, wait: bool = True,
                timeout: Optional[float] = None) -> Command:
        """Executes a block that has an input Execute: a rising edge, until it is done, is aborted or fails. `reference`
        is the axis or group that is stopped if waiting is broken off."""
        if "Execute" not in block._members:
            raise TypeError(f"{block._type} has no input Execute")
        if wait:
            self._check_may_wait()
        for earlier in [command for command in self._unwaited if command.done]:
            self._unwaited.remove(earlier)
            earlier._finish()
        if block._bus is not None:
            raise errors.StateError(f"{block._type} is attached already.", lib.CM1E_ERROR_STATE)
        command = Command(self, block, reference)
        block.Execute = True
        try:
            self._attach(block)
            if wait:
                return command.wait(timeout)
            self._unwaited.append(command)
        except BaseException as error:
            if block._bus is self:  # it was broken off before somebody waited for it
                command._break_off(error)
            raise
        return command

    def _check_started(self) -> None:
        self._live()
        if not self.running:
            raise errors.StateError("The bus does not run: start it first, or it has ended.", lib.CM1E_ERROR_STATE)

    def _check_own(self, block: Block) -> None:
        for reference in references(block):
            if reference.bus is not self:
                raise errors.AxisError(f"{reference.name} is on another bus.", lib.CM1E_ERROR_FB_AXIS_REF)

    def _call(self, block: Block) -> None:
        """One call in the present cycle."""
        self._check_own(block)
        if not self.virtual_time:
            raise errors.StateError("In real time the cycle calls the blocks that are attached to the bus.",
                                    lib.CM1E_ERROR_STATE)
        self._do(lib.cm1e_py_block_call, block._c)

    def _once(self, block: Block) -> None:
        """Lets a block with Enable act once."""
        self.attach(block)
        try:
            self._wait_for(block, 1.0)
            failed = block._error()
        finally:
            self._release(block)
        if failed is not None:
            raise failed

    def _release(self, block: Block) -> None:
        """The last call of a block, with its input off. What it showed at its end stays readable."""
        if self._closed or block._bus is not self:
            return
        try:
            self._end_calls(block)
        except BaseException:  # Ctrl-C within it, perhaps before C was called
            self._end_calls(block)
            raise
        if isinstance(block, (fb.MC_Stop, fb.MC_GroupStop)) and self.virtual_time and self.running:
            self._advance(1, None)  # the axis leaves Stopping in this cycle

    def _end_calls(self, block: Block) -> None:
        size, name = ffi.sizeof(block._c_type), "Execute" if "Execute" in block._members else "Enable"
        lib.cm1e_py_block_release(self._session, block._c, ffi.new("char[]", size), size,
                                  ffi.offsetof(block._c_type, name))
        block._bus = None
        self._forget(block)

    def _stop_moving(self, reference: AXIS_REF | AXES_GROUP_REF) -> None:
        """Ramps down whatever moves, and waits for it, at most 10 s; also within a callback or an exception."""
        if self._closed or not self.running:
            return
        stop: Block = fb.MC_Stop(Axis=reference, Execute=True) if isinstance(reference, AXIS_REF) else \
            fb.MC_GroupStop(AxesGroup=reference, Execute=True)
        if isinstance(reference, Axis) and reference.state in (AxisState.DISABLED, AxisState.ERROR_STOP):
            return
        if _callback_bus.get() is not None:
            self._attach(stop)
            self._stops.append(stop)
            return
        callbacks, self._callbacks = self._callbacks, []
        try:
            self._attach(stop)
            self._wait_for(stop, 10.0)
        finally:
            self._callbacks = callbacks
            self._release(stop)

    # ---- time --------------------------------------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """s since the first cycle."""
        time_ns = ffi.new("int64_t *")
        self._do(lib.cm1e_py_time, time_ns)
        return float(time_ns[0]) * 1e-9

    def on_cycle(self, callback: Callback) -> Callback:
        """Calls a function in every cycle, where programs are called: only on virtual time, because Python does not keep
        the time of a cycle. Blocks that it calls (block(Execute=True)) act in that cycle. An exception ends the waiting
        of whoever lets time pass. Can be used as a decorator."""
        if not self.virtual_time:
            raise errors.StateError("A callback of the cycle needs virtual_time=True: in real time the cycle is C's alone.",
                                    lib.CM1E_ERROR_STATE)
        self._live()
        self._callbacks.append(callback)
        return callback

    def advance(self, seconds: float) -> None:
        """Virtual time: lets so much time pass."""
        if not 0 <= seconds < float("inf"):
            raise ValueError(f"{seconds} s cannot pass; expected a time from 0 on")
        self.cycles(round(seconds / self.cycle_time))

    def cycles(self, count: int) -> None:
        """Virtual time: lets so many cycles pass."""
        self._check_started()
        if count < 0:
            raise ValueError(f"{count} cycles cannot pass; expected a number from 0 on")
        if not self.virtual_time:
            raise errors.StateError("Only virtual time can be advanced; in real time use sleep().", lib.CM1E_ERROR_STATE)
        self._check_may_wait()
        while count > 0:
            count -= self._advance(min(count, _CHUNK), None)

    def sleep(self, seconds: float) -> None:
        """Lets so much time of the bus pass, virtual or real."""
        if self.virtual_time:
            self.advance(seconds)
        else:
            self._live()
            time.sleep(seconds)

    def _check_may_wait(self) -> None:
        if _callback_bus.get() is not None:
            raise errors.StateError("A callback of the cycle cannot wait: start the command with wait=False, and look at "
                                    "its done in later cycles.", lib.CM1E_ERROR_STATE)

    def _advance(self, cycles: int, block: Optional[Block]) -> int:
        """Returns how many cycles passed: at least one, one where there are callbacks."""
        for stop in [stop for stop in self._stops if lib.cm1e_py_block_ended(stop._c)]:
            self._stops.remove(stop)
            self._release(stop)
        if self._callbacks:
            token = _callback_bus.set(self)
            try:
                for callback in list(self._callbacks):
                    callback(self)
            finally:
                _callback_bus.reset(token)
            cycles = 1
        advanced = ffi.new("uint64_t *")
        self._do(lib.cm1e_py_advance, cycles, block._c if block is not None else ffi.NULL, advanced)
        if advanced[0] == 0:
            self._tell_end()
        return int(advanced[0])

    def _tell_end(self) -> None:
        self._ask(lib.cm1e_py_end)
        raise errors.StateError("The run has ended.", lib.CM1E_ERROR_STATE)

    def _pass_slice(self, block: Block, limit: float) -> None:
        """Lets some time pass, until `limit` on the clock of the bus, or until the block ends."""
        if self.virtual_time:
            left = round((limit - self.time) / self.cycle_time) if limit != float("inf") else _CHUNK
            self._advance(max(1, min(_CHUNK, left)), block)
        elif not lib.cm1e_py_wait(self._live(), block._c, _SLICE_NS) and not self.running:
            self._tell_end()

    def _limit(self, timeout: Optional[float]) -> float:
        return float("inf") if timeout is None else self._now() + timeout

    def _now(self) -> float:
        return self.time if self.virtual_time else time.monotonic()

    def _wait_for(self, block: Block, timeout: Optional[float]) -> None:
        self._check_may_wait()
        limit = self._limit(timeout)
        while not lib.cm1e_py_block_ended(block._c):
            if self._now() >= limit:
                raise errors.WaitTimeout(f"{block._type} has not ended after {timeout} s.", lib.CM1E_ERROR_TIMEOUT)
            self._check_started()
            self._pass_slice(block, limit)

    async def _watch(self, block: Block) -> None:
        """For `await`: on virtual time everybody who waits lets one cycle pass in turn."""
        while not lib.cm1e_py_block_ended(block._c):
            self._check_started()
            if self.virtual_time:
                self._check_may_wait()
                self._advance(1, None)
                await asyncio.sleep(0)
            else:
                await asyncio.sleep(0.002)

    def _wait_until(self, condition: Callable[[], bool], timeout: Optional[float], said: str) -> None:
        self._check_may_wait()
        limit = self._limit(timeout)
        while not condition():
            if self._now() >= limit:
                raise errors.WaitTimeout(f"{said} after {timeout} s.", lib.CM1E_ERROR_TIMEOUT)
            self.sleep(self.cycle_time)

    def wait_until(self, condition: Callable[[], bool], timeout: Optional[float] = None) -> None:
        """Lets time pass until a condition holds, which is looked at in every cycle, about, in real time."""
        self._check_started()
        self._wait_until(condition, timeout, "The condition does not hold")

    # ---- what is recorded --------------------------------------------------------------------------------------------

    @property
    def statistics(self) -> Statistics:
        """Of the cycle."""
        data = ffi.new("cm1e_scheduler_statistics_t *")
        self._do(lib.cm1e_py_statistics, data)
        return statistics_of(data)

    def log(self, after: int = 0) -> list[Event]:
        """The event log behind record number `after`: at most the last 1024 records."""
        result: list[Event] = []
        data, buffer = ffi.new("cm1e_log_event_t *"), ffi.new("char[512]")
        while True:
            error = lib.cm1e_py_log(self._live(), after, data, buffer, 512)
            if error == lib.CM1E_ERROR_NOT_FOUND:
                return result
            errors.check(error)
            result.append(event_of(data, errors.text(buffer), self._axis_names))
            after = data.number

    def recording(self, every: int = 1, objects: Sequence[tuple[str, int, int]] = ()) -> Recording:
        """Records while the bus runs in real time: a context manager whose take() returns the samples since the last
        call. On virtual time `trace` is there at any moment."""
        self._check_started()
        if self.virtual_time:
            raise errors.StateError("On virtual time the trace can be had at any moment.", lib.CM1E_ERROR_STATE)
        path = self.statistics.control_socket
        if not path:
            raise errors.StateError("This run has no control socket (control: none), through which it could be recorded.",
                                    lib.CM1E_ERROR_STATE)
        return Recording(path, every, objects)

    @property
    def trace(self) -> Trace:
        """What was recorded: on virtual time at any moment, in real time after stop()."""
        return Trace._of_bus(self)

    def write_trace(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the trace as .npy, .csv, .svg or .html."""
        name = os.fspath(path)
        self._ask(lib.cm1e_py_write_trace, os.path.splitext(name)[1].removeprefix(".").encode(), os.fsencode(name))
