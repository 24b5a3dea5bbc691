"""The exceptions: every error of the library is one, with the text of the library."""
from __future__ import annotations

from typing import Any, NoReturn, Optional

from ._cm1e import ffi, lib
from .codes import ErrorCode


class Error(Exception):
    """An error of the library. `code` is its ErrorCode, `foreign_code` an SDO abort code, AL status code or error code of
    the drive (0: none)."""

    def __init__(self, text: str, code: int = -1, foreign_code: int = 0) -> None:
        super().__init__(text)
        self.code = ErrorCode(code)
        self.foreign_code = foreign_code


class ConfigError(Error):
    """A bus file or an option is wrong."""


class StateError(Error):
    """Not allowed at this moment: the bus is closed, not started, or has ended its run."""


class BusError(Error):
    """The network: slaves, frames, EtherCAT states, SDO transfers."""


class DriveError(Error):
    """The drive reports a fault, or does not do what it is told to."""


class AxisError(Error):
    """A command was refused, or failed."""


class NotFoundError(Error, LookupError):
    """There is nothing with this name."""


class FileError(Error):
    """A file is damaged, or cannot be read or written."""


class WaitTimeout(Error, TimeoutError):
    """Something did not happen in time."""


class CommandAborted(AxisError):
    """Another command has taken the axis."""


_CLASSES = {lib.CM1E_ERROR_CONFIG: ConfigError, lib.CM1E_ERROR_STATE: StateError, lib.CM1E_ERROR_TIMEOUT: WaitTimeout,
            lib.CM1E_ERROR_NOT_FOUND: NotFoundError, lib.CM1E_ERROR_FILE: FileError, lib.CM1E_ERROR_IO: FileError}


def _class_of(code: int) -> type[Error]:
    if code in _CLASSES:
        return _CLASSES[code]
    return BusError if -39 <= code <= -20 else DriveError if -47 <= code <= -40 else \
        AxisError if code <= -50 else Error


def text(cdata: Any) -> str:
    """A C string that may end within a character."""
    raw: bytes = ffi.string(cdata)
    return raw.decode(errors="replace")


def strerror(code: int) -> str:
    """Text of an ErrorCode in one line."""
    return text(lib.cm1e_strerror(code))


def fail(code: int, diag: Any = None, said: str = "") -> NoReturn:
    """Raises the exception of an error."""
    told = said or (text(diag.text) if diag is not None else "") or strerror(code)
    raise _class_of(code)(told, code, diag.foreign_code if diag is not None else 0)


def check(code: int, diag: Any = None, said: str = "") -> None:
    """Raises the exception of an error; CM1E_OK is none."""
    if code != lib.CM1E_OK:
        fail(code, diag, said)


def of_error_id(error_id: int, said: str, where: str) -> Error:
    """The exception of the ErrorID of a block."""
    code: int = lib.cm1e_error_from_id(error_id)
    return _class_of(code)(f"{where}: {said or strerror(code)}", code)


def diag() -> Any:
    return ffi.new("cm1e_diag_t *")


def closed(what: Optional[str] = None) -> NoReturn:
    raise StateError(f"{what or 'The bus'} is closed.", lib.CM1E_ERROR_STATE)
