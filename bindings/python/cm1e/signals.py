"""Signals of the process data: digital and analog terminals, encoders, whatever a slave maps."""
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Iterator, List, Mapping, Union

from . import errors
from ._cm1e import ffi, lib

if TYPE_CHECKING:
    from .devices import Devices

Value = Union[bool, int, float]
_REAL = (lib.CM1E_IO_REAL, lib.CM1E_IO_LREAL)


@dataclass(frozen=True)
class SignalInfo:
    """A signal, as it is listed."""
    name: str       # as Signals takes it: "2.Channel 1 Input"
    slave: int
    output: bool
    of_axis: bool   # it belongs to an axis, and can be read only
    type: str
    bits: int
    index: int
    subindex: int


class Signal:
    """A signal of a slave. An output that was looked up belongs to this program."""

    def __init__(self, bus: Devices, name: str, data: Any) -> None:
        self._bus = bus
        self._data = data
        self.name = name
        self.output: bool = data.output
        self.type: str = errors.text(lib.cm1e_io_type_name(data.type))

    def _read(self) -> Any:
        value = ffi.new("cm1e_py_io_value_t *")
        self._bus._do(lib.cm1e_py_io_read, self._data, value)
        return value

    @property
    def value(self) -> Value:
        """Its value in the present cycle; of an output the one that is sent."""
        value = self._read()
        if self._data.type == lib.CM1E_IO_BOOL:
            return bool(value.integer)
        return float(value.real) if self._data.type in _REAL else int(value.integer)

    @value.setter
    def value(self, value: Value) -> None:
        if self._data.type in _REAL:
            error = self._bus._code(lib.cm1e_py_io_write_real, self._data, self._number(value, "__float__"))
        else:
            error = self._bus._code(lib.cm1e_py_io_write_integer, self._data, self._number(value, "__index__"))
        if error == lib.CM1E_ERROR_INVALID_ARGUMENT:
            errors.fail(error, None, f"{self.name} cannot be {value!r}: it is "
                        f"{'an output' if self.output else 'an input'} of type {self.type}.")
        errors.check(error)

    def _number(self, value: object, kind: str) -> Any:
        if self._data.type == lib.CM1E_IO_BOOL and type(value).__name__ in ("bool_", "bool"):  # also NumPy's
            return bool(value)
        if not hasattr(value, kind):
            raise TypeError(f"{self.name} is of type {self.type}; {value!r} is not")
        return value

    @property
    def quality(self) -> str:
        """How far the value can be trusted: "good", "stale", "offline" or "invalid"."""
        return errors.text(lib.cm1e_io_quality_name(self._read().quality))

    def __repr__(self) -> str:
        return f"<Signal {self.name}>"


class Signals(Mapping[str, Signal]):
    """The signals of a bus by name: "SLAVE.SIGNAL", as docs/BUS-FILE.md describes it; also "2.input 1"."""

    def __init__(self, bus: Devices) -> None:
        self._bus = bus

    def __getitem__(self, name: str) -> Signal:
        if not isinstance(name, str):
            raise TypeError(f"a signal is named by a str, such as \"2.input 1\", not {name!r}")
        data, diag = ffi.new("cm1e_io_t *"), errors.diag()
        errors.check(self._bus._code(lib.cm1e_py_io_find, name.encode(), data, diag), diag)
        return Signal(self._bus, name, data)

    def list(self) -> List[SignalInfo]:
        """All signals of all slaves."""
        result: List[SignalInfo] = []
        data = ffi.new("cm1e_io_info_t *")
        while True:
            error = self._bus._code(lib.cm1e_py_io_at, len(result), data)
            if error == lib.CM1E_ERROR_NOT_FOUND:
                return result
            errors.check(error)
            result.append(SignalInfo(f"{data.position}.{errors.text(data.name)}", data.position, data.output,
                                     data.of_axis, errors.text(lib.cm1e_io_type_name(data.type)), data.bits, data.index,
                                     data.subindex))

    def __iter__(self) -> Iterator[str]:
        return (info.name for info in self.list())

    def __len__(self) -> int:
        return len(self.list())
