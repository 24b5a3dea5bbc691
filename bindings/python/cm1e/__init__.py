"""Myostat CM1-E servo motors over EtherCAT, with the function blocks of PLCopen. The cycle is the library's, in C;
Python supervises it: docs/PYTHON.md."""
from __future__ import annotations

from . import blocks
from .axis import Axis, AxisInfo, Command, Group
from .bus import Bus
from .codes import AxisState, ErrorCode, GroupState
from .attach import Attached, Program, Recording, attach, programs
from .config import check_bus_file
from .errors import (AxisError, BusError, CommandAborted, ConfigError, DriveError, Error, FileError,
                     NotFoundError, StateError, WaitTimeout)
from .events import Event
from .files import Finding, GeneratedFile, check_file
from .signals import Signal, SignalInfo, Signals
from .slaves import SimulatedMotor, Slave, Statistics
from .trace import Trace
from ._cm1e import lib as _lib
from .errors import text as _text

__version__ = _text(_lib.cm1e_version())

__all__ = ["Attached", "Axis", "AxisError", "AxisInfo", "AxisState", "Bus", "BusError", "Command", "CommandAborted", "ConfigError",
           "DriveError", "Error", "ErrorCode", "Event", "FileError", "Finding", "GeneratedFile", "Group", "GroupState", "NotFoundError", "Program",
           "Recording", "SimulatedMotor", "Signal", "SignalInfo", "Signals", "Slave", "StateError", "Statistics", "Trace",
           "WaitTimeout", "attach", "blocks", "check_bus_file", "check_file", "programs"]
