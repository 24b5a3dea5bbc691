"""Files for other masters and tools, written from the tables of the devices, and the checker for files of any source:
ESI, EC_EXTEND, SII, ENI."""
from __future__ import annotations

import os
from typing import Any, Mapping, NamedTuple, Sequence

from . import errors
from ._cm1e import ffi, lib
from .config import Config, PathLike, _assign

_FORMATS = {"esi": lib.CM1E_FILE_ESI, "ec-extend": lib.CM1E_FILE_EC_EXTEND, "sii": lib.CM1E_FILE_SII,
            "eni": lib.CM1E_FILE_ENI}
_LAYOUTS = {"flat": lib.CM1E_ESI_FLAT, "mdp": lib.CM1E_ESI_MDP}
_WORDS = {"model": {"cm1-e": lib.CM1E_DEVICE_CM1E, "eb01": lib.CM1E_DEVICE_EB01, "eb02": lib.CM1E_DEVICE_EB02,
                    "eb12": lib.CM1E_DEVICE_EB12},
          "mapping": {"dynamic": lib.CM1E_MAPPING_DYNAMIC, "csp": lib.CM1E_MAPPING_CSP, "csv": lib.CM1E_MAPPING_CSV,
                      "profile": lib.CM1E_MAPPING_PROFILE},
          "order": {"ug-4.4": lib.CM1E_PDO_ORDER_UG_4_4, "ug-7.2": lib.CM1E_PDO_ORDER_UG_7_2}}
Device = Mapping[str, object]


class GeneratedFile(NamedTuple):
    """A file in memory; `warning`: what the user has to know about it, or ""."""
    data: bytes
    warning: str


class Finding(NamedTuple):
    """What the checker says of a place of a file; `rule` as in docs/CHECK-RULES.md, `line` 0: no single place."""
    rule: str
    is_error: bool
    line: int
    text: str


def _word(what: str, word: object, words: Mapping[str, Any]) -> Any:
    if word not in words:
        raise errors.ConfigError(f"{what} is {word!r}; expected {', '.join(words)}.", lib.CM1E_ERROR_CONFIG)
    return words[str(word)]


def _devices(devices: Sequence[Device]) -> Any:
    result = ffi.new("cm1e_device_options_t[]", max(1, len(devices)))
    for index, device in enumerate(devices):
        _assign(result[index], f"devices[{index}]", {
            name: _word(name, value, _WORDS[name]) if name in _WORDS else value for name, value in device.items()})
    return result


def _take(function: Any, *arguments: Any) -> GeneratedFile:
    file, diag = ffi.new("cm1e_file_t *"), errors.diag()
    errors.check(function(file, *arguments, diag), diag)
    try:
        return GeneratedFile(bytes(ffi.buffer(file.bytes, file.size)), errors.text(file.warning))
    finally:
        lib.cm1e_file_free(file)


def _options(format: str, devices: Sequence[Device], layout: str) -> tuple[Any, Any]:
    listed = _devices(devices)
    return ffi.new("cm1e_generate_options_t *", {
        "format": _word("the format", format, _FORMATS), "layout": _word("the layout", layout, _LAYOUTS),
        "devices": listed if devices else ffi.NULL, "device_count": len(devices)}), listed


def generate(format: str, devices: Sequence[Device] = (), *, layout: str = "flat") -> GeneratedFile:
    """Writes "esi", "ec-extend" or "sii" for devices, each a mapping of members of cm1e_device_options_t ("model": "cm1-e",
    "firmware": "1.3.5", "mapping": "csp" ...); none: one CM1-E with defaults."""
    options, kept = _options(format, devices, layout)
    result = _take(lib.cm1e_generate, options)
    del kept
    return result


def generate_eni(bus_file: PathLike, devices: Sequence[Device] = ()) -> GeneratedFile:
    """Writes the ENI of the network of a bus file; `devices`: the identity of its bridges."""
    config = Config.of_file(bus_file)
    options, kept = _options("eni", devices, "flat")
    options.network = config.data
    result = _take(lib.cm1e_generate, options)
    del kept
    return result


def generate_trio_program(devices: Sequence[Device] = ()) -> GeneratedFile:
    """Writes the TrioBASIC start program beside the EC_EXTEND of these devices."""
    options, kept = _options("ec-extend", devices, "flat")
    result = _take(lib.cm1e_generate_trio_program, options)
    del kept
    return result


def convert(source: PathLike | bytes, format: str, device: int = 0) -> GeneratedFile:
    """Reads a file of any format and writes it again, or an SII as ESI and an ESI's device (0 = first) as SII."""
    data = _bytes(source)
    return _take(lib.cm1e_generate_from, data, len(data), _word("the format", format, _FORMATS), device)


def _bytes(source: PathLike | bytes) -> bytes:
    if isinstance(source, bytes):
        return source
    with open(os.fspath(source), "rb") as file:
        return file.read()


def format_of(source: PathLike | bytes) -> str:
    """"ESI", "EC_EXTEND", "SII", "ENI" or "unknown", by the content."""
    data = _bytes(source)
    return errors.text(lib.cm1e_file_format_name(lib.cm1e_file_recognise(data, len(data))))


def _findings(found: Any) -> list[Finding]:
    """Copies them, and frees what C has."""
    try:
        listed = (lib.cm1e_findings_at(found, n) for n in range(lib.cm1e_findings_count(found)))
        return [Finding(errors.text(one.rule), one.is_error, one.line, errors.text(one.text)) for one in listed]
    finally:
        lib.cm1e_findings_free(found)


def check_file(source: PathLike | bytes) -> list[Finding]:
    """Checks a file by every rule of docs/CHECK-RULES.md; an empty list: nothing is wrong. FileError: it cannot be read."""
    data, found, diag = _bytes(source), ffi.new("cm1e_findings_t **"), errors.diag()
    errors.check(lib.cm1e_check_file(found, data, len(data), diag), diag)
    return _findings(found[0])
