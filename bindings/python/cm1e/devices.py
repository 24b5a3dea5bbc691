"""The devices of a network: slaves, their signals, objects and files; what is simulated of them."""
from __future__ import annotations

import os
import time
from typing import TYPE_CHECKING, Any, Optional, Union

from . import errors
from ._cm1e import ffi, lib
from .config import Config, PathLike
from .files import Finding, _bytes, _findings
from .signals import Signals
from .slaves import SimulatedMotor, Slave, motor_of, slave_of

if TYPE_CHECKING:
    from .bus import Bus

_FIRMWARE_BYTES = 1024  # no firmware has less


class Devices:
    """What a bus and a network beside it have in common."""

    _started: bool

    def _live(self) -> Any:
        raise NotImplementedError

    def _code(self, function: Any, *arguments: Any) -> Any:
        """Calls a function of C for this network; returns what that returns."""
        return function(self._live(), *arguments)

    def _do(self, function: Any, *arguments: Any) -> None:
        errors.check(self._code(function, *arguments))

    def _ask(self, function: Any, *arguments: Any) -> None:
        diag = errors.diag()
        errors.check(self._code(function, *arguments, diag), diag)

    def scan(self) -> list[Slave]:
        """Finds the slaves, before the start; none of them is configured."""
        self._ask(lib.cm1e_py_scan)
        return self.slaves

    @property
    def io(self) -> Signals:
        """The process data of all slaves, by name."""
        self._live()
        return Signals(self)

    @property
    def slaves(self) -> list[Slave]:
        """What the scan found."""
        result: list[Slave] = []
        data = ffi.new("cm1e_slave_info_t *")
        while True:
            error = self._code(lib.cm1e_py_slave, len(result) + 1, data)
            if error == lib.CM1E_ERROR_NOT_FOUND:
                return result
            errors.check(error)
            result.append(slave_of(data))

    def sdo_read(self, slave: int, index: int, subindex: int = 0, size: int = 512) -> bytes:
        """The bytes of an object, as on the wire; `size` is the most that it can have."""
        data = ffi.new("uint8_t[]", size)
        sdo = ffi.new("cm1e_sdo_t *", {"position": slave, "index": index, "subindex": subindex, "data": data, "size": size})
        self._transfer(sdo)
        return bytes(ffi.buffer(data, sdo.size))

    def sdo_write(self, slave: int, index: int, subindex: int, value: bytes) -> None:
        """Writes an object; `value` is little endian, of the size of the object."""
        if not isinstance(value, (bytes, bytearray)):
            raise TypeError(f"the value is {value!r}; expected bytes, little endian, of the size of the object, as from "
                            "(5).to_bytes(4, 'little')")
        data = ffi.new("uint8_t[]", bytes(value))
        sdo = ffi.new("cm1e_sdo_t *", {"position": slave, "index": index, "subindex": subindex, "data": data,
                                       "size": len(value), "write": True})
        self._transfer(sdo)

    def _transfer(self, sdo: Any) -> None:
        try:
            self._ask(lib.cm1e_py_sdo, sdo)
        except errors.Error as error:
            if error.code == lib.CM1E_ERROR_INVALID_ARGUMENT:
                self._check_slave(sdo.position, self.slaves)
            raise

    @staticmethod
    def _check_slave(slave: int, slaves: list[Slave]) -> None:
        if not 1 <= slave <= len(slaves):
            raise errors.NotFoundError(f"There is no slave {slave}; the network has {len(slaves)}.",
                                       lib.CM1E_ERROR_NOT_FOUND) from None

    # ---- files -------------------------------------------------------------------------------------------------------

    def _file(self, slave: int, name: str, data: Any, size: int, password: int, timeout: float, **flags: bool) -> int:
        encoded = ffi.new("char[]", name.encode())
        file = ffi.new("cm1e_py_file_t *", {"position": slave, "name": encoded, "data": data, "size": size,
                                            "password": password, "answer_ns": round(timeout * 1e9), **flags})
        self._ask(lib.cm1e_py_file, file)
        return int(file.size)

    def read_file(self, slave: int, name: str, *, password: int = 0, maximum: int = 1 << 20, timeout: float = 5.0) -> bytes:
        """A file in a slave (FoE), after a scan or while the bus runs; `maximum`: bytes that it can have, `timeout`: for
        one answer, in s."""
        data = ffi.new("uint8_t[]", max(1, maximum))
        return bytes(ffi.buffer(data, self._file(slave, name, data, maximum, password, timeout)))

    def write_file(self, slave: int, name: str, data: bytes, *, password: int = 0, timeout: float = 5.0) -> None:
        """Writes a file into a slave (FoE). What the slave has of a file that breaks off is its own matter."""
        self._file(slave, name, ffi.from_buffer(data), len(data), password, timeout, write=True)

    def compare(self, source: Union[PathLike, bytes], slave: int) -> list[Finding]:
        """Compares a file (ESI, EC_EXTEND, SII, ENI) with a slave: dictionary, mapping and SII, as far as the file states
        them. After scan(), before start()."""
        data, found = _bytes(source), ffi.new("cm1e_findings_t **")
        self._ask(lib.cm1e_py_compare, found, data, len(data), slave)
        return _findings(found[0])

    def update_firmware(self, slave: int, source: Union[PathLike, bytes], *, name: Optional[str] = None, password: int = 0,
                        other_device: bool = False, timeout: float = 20.0) -> str:
        """Writes a firmware of the maker into a motor (FoE in Bootstrap), before start(), and returns the version that it
        has then. Refused for a slave that is no CM1-E, unless `other_device`, and while a motor has torque. `name`: by
        which the motor knows the file; that of `source`. Keep the power of the motor on until the end. After an exception
        the firmware may be incomplete: try again, or see docs/COMMAND.md (`cm1e firmware update`)."""
        data = _bytes(source)
        known = name or ("" if isinstance(source, bytes) else os.path.basename(os.fspath(source)))
        self._check_update(slave, data, known, other_device)
        self._file(slave, known, ffi.from_buffer(data), len(data), password, timeout, write=True, bootstrap=True)
        end = time.monotonic() + 30.0
        while True:
            try:
                found = self.scan()[slave - 1]
            except (errors.Error, IndexError):
                if time.monotonic() > end:
                    raise
            else:
                if found.software_version or time.monotonic() > end:
                    return found.software_version
            time.sleep(0.5)

    def _check_update(self, slave: int, data: bytes, name: str, other_device: bool) -> None:
        if self._started:
            raise errors.StateError("The firmware is written before the bus is started: the motor leaves the cycle.",
                                    lib.CM1E_ERROR_STATE)
        if len(data) < _FIRMWARE_BYTES or not name:
            raise errors.ConfigError(f"No firmware has {len(data)} bytes." if name else "The file needs a name.",
                                     lib.CM1E_ERROR_CONFIG)
        slaves = self.scan()
        self._check_slave(slave, slaves)
        if slaves[slave - 1].kind != "cm1-e" and not other_device:
            raise errors.ConfigError(f"Slave {slave} is no CM1-E. other_device=True allows it.", lib.CM1E_ERROR_CONFIG)
        for motor in slaves:
            if motor.kind == "cm1-e" and int.from_bytes(self.sdo_read(motor.position, 0x6041), "little") & 0x6F == 0x27:
                raise errors.StateError(f"The motor of slave {motor.position} is enabled: disable it first.",
                                        lib.CM1E_ERROR_STATE)

    # ---- the simulator -----------------------------------------------------------------------------------------------

    def simulate(self, line: str) -> str:
        """A command of the console of the simulated segment ("help" lists them), and its answer."""
        answer = ffi.new("char[16384]")
        error = self._code(lib.cm1e_py_simulate, line.encode(), answer, 16384)
        errors.check(error, None, errors.text(answer))
        return errors.text(answer)

    def simulated_motor(self, slave: int) -> SimulatedMotor:
        """The true values behind a simulated motor."""
        found = self.slaves
        if found:
            self._check_slave(slave, found)
        probe = ffi.new("cm1e_sim_probe_t *")
        self._do(lib.cm1e_py_probe, slave, probe)
        return motor_of(probe)


class Network(Devices):
    """One of several networks of a program: its devices. Its axes are among those of the bus."""

    def __init__(self, bus: Bus, number: int, config: Config) -> None:
        self._bus, self._number = bus, number
        self.axis_names = tuple(config.axis_names())

    @property
    def _started(self) -> bool:  # type: ignore[override]
        return self._bus._started

    def _live(self) -> Any:
        return self._bus._live()

    def _code(self, function: Any, *arguments: Any) -> Any:
        lib.cm1e_py_select(self._number)  # for calls of this thread
        try:
            return super()._code(function, *arguments)
        finally:
            lib.cm1e_py_select(0)

    def __repr__(self) -> str:
        return f"<Network {self._number + 1} of {', '.join(self.axis_names) or 'no axes'}>"
