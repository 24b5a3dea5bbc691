"""The configuration of a network: from a bus file, or made of numbers."""
from __future__ import annotations

import os
import tempfile
from typing import Any, Iterable, Mapping, Optional, Sequence, Union

from . import errors
from ._cm1e import ffi, lib

PathLike = Union[str, "os.PathLike[str]"]
Axes = Union[int, Sequence[Mapping[str, object]]]
_CONTROL = {"observe": lib.CM1E_CONTROL_OBSERVE, "none": lib.CM1E_CONTROL_NONE, "maintain": lib.CM1E_CONTROL_MAINTAIN}


def _assign(data: Any, where: str, values: Mapping[str, object]) -> None:
    """Members of a struct of cm1e/config.h by their names; a mapping for a struct in it."""
    fields = dict(ffi.typeof(data).item.fields if ffi.typeof(data).kind == "pointer" else ffi.typeof(data).fields)
    for name, value in values.items():
        if name not in fields:
            raise errors.ConfigError(f"{where}: there is no {name}; there are {', '.join(fields)}.", lib.CM1E_ERROR_CONFIG)
        if isinstance(value, Mapping):
            _assign(getattr(data, name), f"{where}.{name}", value)
        elif isinstance(value, str):
            raw = value.encode()
            if b"\0" in raw:
                raise errors.ConfigError(f"{where}.{name}: {value!r} has a character 0 in it.", lib.CM1E_ERROR_CONFIG)
            if fields[name].type.kind != "array":
                raise errors.ConfigError(f"{where}.{name}: {value!r} is a text; a number belongs there.",
                                         lib.CM1E_ERROR_CONFIG)
            if len(raw) >= fields[name].type.length:
                raise errors.ConfigError(f"{where}.{name}: {value!r} is too long: at most {fields[name].type.length - 1} bytes.",
                                         lib.CM1E_ERROR_CONFIG)
            setattr(data, name, raw)
        else:
            try:
                setattr(data, name, value)
            except (TypeError, OverflowError) as error:
                raise errors.ConfigError(f"{where}.{name}: {value!r} does not belong there: {error}.",
                                         lib.CM1E_ERROR_CONFIG) from None


class Config:
    """A cm1e_bus_config_t that lives as long as this object."""

    def __init__(self, data: Any) -> None:
        self.data = ffi.gc(data, lib.cm1e_bus_config_free)

    @classmethod
    def of_axes(cls, axes: Axes) -> Config:
        """So many axes with defaults, or axes with these members of cm1e_axis_config_t."""
        if isinstance(axes, int) and axes < 0:
            raise errors.ConfigError(f"{axes} axes: a bus has 0 or more.", lib.CM1E_ERROR_CONFIG)
        listed: list[Mapping[str, object]] = list(axes) if isinstance(axes, Iterable) else []
        if not isinstance(axes, (int, Iterable)) or not all(isinstance(one, Mapping) for one in listed):
            raise TypeError(f"axes is {axes!r}; expected a number of axes, or a list of their settings, as "
                            "[{'name': 'X', 'counts_per_unit': 1000}]")
        count = axes if isinstance(axes, int) else len(listed)
        data = ffi.new("cm1e_bus_config_t *")
        code = lib.cm1e_bus_config_init(data, ffi.NULL, min(count, 0xFFFFFFFF))
        errors.check(code, None, f"{count} axes are more than a bus has." if code == lib.CM1E_ERROR_CONFIG else "")
        result = cls(data)
        for index, values in enumerate(listed):
            _assign(data.axes[index], f"axes[{index}]", values)
        return result

    @classmethod
    def of_file(cls, path: PathLike) -> Config:
        """From a bus file; every mistake is told with its line and column."""
        data, diag = ffi.new("cm1e_bus_config_t *"), errors.diag()
        errors.check(lib.cm1e_bus_config_load(data, os.fsencode(path), diag), diag)
        return cls(data)

    @classmethod
    def of_text(cls, text: str) -> Config:
        """From the text of a bus file."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bus.yaml")
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            return cls.of_file(path)

    def set(self, *, interface: Optional[str] = None, virtual_time: Optional[bool] = None,
            cycle_time: Optional[float] = None, control: Optional[str] = None, pcap: Optional[PathLike] = None) -> None:
        """What a program decides beside the file."""
        if interface is not None:
            _assign(self.data, "bus", {"interface_name": interface})
        if virtual_time is not None:
            self.data.virtual_time = virtual_time
        if cycle_time is not None:
            self.data.cycle_time_ns = round(cycle_time * 1e9)
        if control is not None:
            if control not in _CONTROL:
                raise errors.ConfigError(f"control is {control!r}; expected observe, none or maintain.",
                                         lib.CM1E_ERROR_CONFIG)
            self.data.control = _CONTROL[control]
        if pcap is not None:
            _assign(self.data, "bus", {"pcap_file": os.fspath(pcap)})

    def axis_names(self) -> list[str]:
        return [errors.text(self.data.axes[i].name) or f"axis{i + 1}" for i in range(self.data.axis_count)]


def check_bus_file(path: PathLike) -> None:
    """Raises ConfigError, or another Error, with the line and column of what is wrong in a bus file."""
    Config.of_file(path)
