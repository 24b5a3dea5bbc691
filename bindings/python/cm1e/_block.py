"""What the classes of blocks.py have in common: members with the types of IEC 61131-3 in memory of C."""
from __future__ import annotations

import difflib
import math
from collections import deque
from datetime import timedelta
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Iterator, Mapping, NamedTuple, Optional

from . import errors
from ._cm1e import ffi, lib

if TYPE_CHECKING:
    from .bus import Bus

_RANGES = {"SINT": (-2**7, 2**7 - 1), "INT": (-2**15, 2**15 - 1), "UINT": (0, 2**16 - 1), "DINT": (-2**31, 2**31 - 1),
           "UDINT": (0, 2**32 - 1), "WORD": (0, 2**16 - 1), "DWORD": (0, 2**32 - 1)}
_MOMENT = timedelta(microseconds=1)

#: Of an argument that keeps its value. None is no value of any member: as a position it would be 0.
NOT_GIVEN: Any = type("NotGiven", (), {"__repr__": lambda self: "NOT_GIVEN"})()


class Member(NamedTuple):
    """A variable of a block or structure."""
    name: str
    section: str
    kind: str
    type: str
    of: Any


class Reference:
    """Something that blocks name by a handle."""

    def __init__(self, bus: Bus, name: str, handle: Any) -> None:
        self.bus = bus
        self.name = name
        self._handle = handle

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name}>"


class AXIS_REF(Reference):
    """An axis, as blocks take it."""


class AXES_GROUP_REF(Reference):
    """An axes group, as blocks take it."""


def _wrong(member: Member, expected: str, value: object) -> TypeError:
    return TypeError(f"{member.name}: expected {expected}, not {value!r}")


def _number(member: Member, value: object) -> float:
    kind = getattr(getattr(value, "dtype", None), "kind", "f")  # of NumPy: its bool and its complex numbers have a float too
    if isinstance(value, bool) or kind not in "fiu" or not hasattr(value, "__float__"):
        raise _wrong(member, "a number", value)
    result = float(value)
    if math.isnan(result):
        raise ValueError(f"{member.name}: expected a number, not {value!r}")
    return result


def _integer(member: Member, value: object) -> int:
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        raise _wrong(member, "an integer", value)
    number = int(value)
    low, high = _RANGES[member.type]
    if not low <= number <= high:
        raise ValueError(f"{member.name}: {number} is outside {low} ... {high} of {member.type}")
    return number


def _enumerator(member: Member, value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise _wrong(member, member.of.__name__, value)
    if isinstance(value, IntEnum) and not isinstance(value, member.of):
        raise _wrong(member, member.of.__name__, value)
    if value != 0 and value not in list(member.of):
        raise ValueError(f"{member.name}: {value} is no {member.of.__name__}")
    return int(value)


def _time(member: Member, value: object) -> int:
    if not isinstance(value, timedelta):
        raise _wrong(member, "a datetime.timedelta", value)
    return value // _MOMENT * 1000


def _string(member: Member, value: object) -> bytes:
    if not isinstance(value, str):
        raise _wrong(member, "a str", value)
    raw = value.encode()
    if len(raw) > 80 or b"\0" in raw:
        raise ValueError(f"{member.name}: a string has at most 80 bytes, and none of them is 0")
    return raw


def _bool(member: Member, value: object) -> int:
    if not isinstance(value, bool) and type(value).__name__ not in ("bool_", "bool"):
        raise _wrong(member, "a bool", value)
    return int(bool(value))


_SCALARS = {"float": _number, "int": _integer, "enum": _enumerator, "timedelta": _time, "str": _string, "bool": _bool}


def _sequence(member: Member, value: Any) -> list[Any]:
    if isinstance(value, (str, bytes)):
        raise _wrong(member, "a sequence", value)
    items = [value] if isinstance(value, Struct) else list(value)
    if member.of is None:
        return [_number(member, item) for item in items]
    for item in items:
        if not isinstance(item, member.of):
            raise _wrong(member, member.of.__name__, item)
    return items


class Struct:
    """A structure in memory of C."""
    _c_type: str
    _members: Mapping[str, Member]
    _data: Any
    _kept: dict[str, Any]
    _memory: dict[str, Any]
    _before: deque[Any]

    @staticmethod
    def _table(*members: Member) -> dict[str, Member]:
        return {member.name: member for member in members}

    def __init__(self, values: Mapping[str, Any]) -> None:
        object.__setattr__(self, "_data", ffi.new(self._c_type + " *"))
        object.__setattr__(self, "_kept", {})    # the objects that members name
        object.__setattr__(self, "_memory", {})  # and what C needs of them
        object.__setattr__(self, "_before", deque(maxlen=8))  # which the cycle may just be reading
        for name, value in values.items():
            if value is not NOT_GIVEN:
                setattr(self, name, value)

    # Where the memory is used by the cycle, Block overrides these two.
    def _read(self, name: str) -> Any:
        return self._data

    def _write(self, member: Member, data: Any) -> None:
        ffi.memmove(ffi.addressof(self._data, member.name), ffi.addressof(data, member.name),
                    ffi.sizeof(ffi.typeof(ffi.addressof(data, member.name)).item))

    def _member(self, name: str) -> Member:
        member = self._members.get(name)
        if member is None:
            near = difflib.get_close_matches(name, self._members, 1, 0.6)
            hint = f"; did you mean {near[0]}?" if near else ""
            raise AttributeError(f"{type(self).__name__} has no {name}{hint}", name=name, obj=self)
        return member

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        member = self._member(name)
        if member.kind in ("axis", "group", "struct", "reference") and name in self._kept:
            return self._kept[name]
        return _value(member, getattr(self._read(name), name))

    def __setattr__(self, name: str, value: Any) -> None:
        if name.startswith("_"):
            object.__setattr__(self, name, value)
            return
        member = self._member(name)
        if member.section == "output":
            raise AttributeError(f"{name} is an output of {type(self).__name__}", name=name, obj=self)
        data = ffi.new(self._c_type + " *")
        kept = self._put(member, data, value)
        self._check_count(name, value)
        if kept is None:
            self._write(member, data)
            return
        self._before.append(self._memory.get(name))
        self._kept[name], self._memory[name] = kept, _memory_of(kept)
        self._write(member, data)
        if f"NumberOf{name}" in self._members:
            setattr(self, f"NumberOf{name}", len(kept))

    def _check_count(self, name: str, value: Any) -> None:
        """C does not know how many elements are behind a pointer."""
        counted = self._members.get(name.removeprefix("NumberOf")) if name.startswith("NumberOf") else None
        if counted is not None and counted.kind == "reference" and value > len(self._kept.get(counted.name, ())):
            raise ValueError(f"{name} is {value}; {counted.name} has {len(self._kept.get(counted.name, ()))}")

    def _put(self, member: Member, data: Any, value: Any) -> Any:
        """Writes a value into `data`; returns what must live as long as it is there."""
        if member.kind in _SCALARS:
            setattr(data, member.name, _SCALARS[member.kind](member, value))
        elif member.kind in ("axis", "group"):
            expected = AXIS_REF if member.kind == "axis" else AXES_GROUP_REF
            if not isinstance(value, expected):
                raise _wrong(member, "an axis" if member.kind == "axis" else "an axes group", value)
            setattr(data, member.name, value._handle if member.section == "in_out" else value._handle[0])
            return value
        elif member.kind == "struct":
            if not isinstance(value, member.of):
                raise _wrong(member, member.of.__name__, value)
            setattr(data, member.name, value._data if member.section == "in_out" else value._data[0])
            return value
        elif member.kind == "reference":
            return self._point(member, data, value)
        else:
            self._fill(member, data, value)
        return None

    def _point(self, member: Member, data: Any, value: Any) -> Any:
        items = _sequence(member, value)
        memory = ffi.new(f"{member.type}[]", len(items))
        for index, item in enumerate(items):
            memory[index] = item._data[0]
        setattr(data, member.name, memory)
        return _Pointed(items, memory)

    def _fill(self, member: Member, data: Any, value: Any) -> None:
        array = getattr(data, member.name)
        items = _sequence(member, value)
        if len(items) > len(array):
            raise ValueError(f"{member.name}: {len(items)} values; at most {len(array)} have room")
        for index, item in enumerate(items):
            array[index] = item._data[0] if isinstance(item, Struct) else item

    def __repr__(self) -> str:
        return f"<{type(self).__name__}>"


class _Pointed(list):  # type: ignore[type-arg]
    """A sequence to which C points, with its memory."""

    def __init__(self, items: Any, memory: Any) -> None:
        super().__init__(items)
        self.memory = memory


def _memory_of(kept: Any) -> Any:
    """What C needs of an object, without the object: a bus must not be kept by what it keeps."""
    if isinstance(kept, Reference):
        return kept._handle
    return kept.memory if isinstance(kept, _Pointed) else (kept._data, kept._memory)


def references(struct: Struct) -> Iterator[Reference]:
    """The axes and groups that a block names, also in its structures."""
    for kept in struct._kept.values():
        if isinstance(kept, Reference):
            yield kept
        elif isinstance(kept, Struct):
            yield from references(kept)


def _value(member: Member, data: Any) -> Any:
    """What C has, for Python."""
    if member.kind == "bool":
        return bool(data)
    if member.kind == "timedelta":
        return timedelta(microseconds=data / 1000)
    if member.kind == "enum":
        return member.of(data) if data in list(member.of) else data
    if member.kind == "str":
        return errors.text(data)
    if member.kind == "array":
        return [_copied(member.of, item) for item in data]
    if member.kind == "struct" and data:
        return _copied(member.of, data)
    if member.kind in ("struct", "reference", "axis", "group"):
        return None
    return data


def _copied(of: Any, data: Any) -> Any:
    if of is None:
        return data
    result = of()
    ffi.memmove(result._data, ffi.addressof(data) if ffi.typeof(data).kind == "struct" else data,
                ffi.sizeof(of._c_type))
    return result


class Block(Struct):
    """A function block. Before it is attached to a bus, and in a callback of the cycle, its members are plain memory;
    afterwards the cycle reads and writes them on request."""
    _type: str
    _bus: Optional[Bus]
    _ends: list[str]

    def __init__(self, values: Mapping[str, Any]) -> None:
        self._bus = None
        super().__init__(values)
        for member in self._members.values():
            if member.section == "in_out" and member.kind == "struct" and member.name not in self._kept:
                setattr(self, member.name, member.of())
        outputs = [member.name for member in self._members.values()
                   if member.section == "output" and member.kind == "bool"]
        done = [name for name in ("Done", "InSync") if name in outputs] or outputs
        self._ends = done[:1] + [name for name in ("CommandAborted", "Error") if name in outputs and name != done[0]]
        offsets = [ffi.offsetof(self._c_type, name) for name in self._ends]
        self._offsets = ffi.new("uint32_t[]", offsets)
        self._c = ffi.new("cm1e_py_block_t *", {
            "call": lib.cm1e_py_call_of(self._type.encode()), "fb": self._data, "ends": self._offsets,
            "end_count": len(offsets)})

    def _read(self, name: str) -> Any:
        if self._bus is None:
            return self._data
        data = ffi.new(self._c_type + " *")
        self._transfer(ffi.addressof(data, name), ffi.addressof(self._data, name), None)
        return data

    def _write(self, member: Member, data: Any) -> None:
        to, source = ffi.addressof(self._data, member.name), ffi.addressof(data, member.name)
        if self._bus is None:
            ffi.memmove(to, source, ffi.sizeof(ffi.typeof(to).item))
        else:
            self._transfer(to, source, self._c)

    def _transfer(self, to: Any, source: Any, block: Any) -> None:
        assert self._bus is not None
        copies = ffi.new("cm1e_py_copy_t[1]", [{"to": to, "from": source, "size": ffi.sizeof(ffi.typeof(to).item)}])
        self._bus._do(lib.cm1e_py_transfer, copies, 1, block if block is not None else ffi.NULL)

    def _act(self, values: Mapping[str, Any]) -> None:
        from .bus import bus_of_callback
        for name, value in values.items():
            if value is not NOT_GIVEN:
                setattr(self, name, value)
        reference = next(references(self), None)
        bus = bus_of_callback() or (reference.bus if reference else None)
        if self._bus is not None:
            raise errors.StateError(f"{self._type} is attached: the cycle calls it already.", lib.CM1E_ERROR_STATE)
        if bus is None:
            raise errors.StateError(f"{self._type} is called in a callback of the cycle (Bus.on_cycle), or attached to a "
                                    "bus.", lib.CM1E_ERROR_STATE)
        bus._call(self)

    def _error(self) -> Optional[errors.Error]:
        """What its outputs Error and CommandAborted say."""
        where = f"{self._type}"
        reference = next(references(self), None)
        if reference is not None:
            where += f" of {reference.name}"
        if "Error" in self._members and self.Error:
            said = reference.bus._error_text(reference) if reference is not None else ""
            return errors.of_error_id(self.ErrorID, said, where)
        if "CommandAborted" in self._members and self.CommandAborted:
            return errors.CommandAborted(f"{where} was aborted by another command.", lib.CM1E_ERROR_CANCELLED)
        return None
