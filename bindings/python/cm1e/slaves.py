"""What is known of slaves, of simulated motors and of the cycle."""
from __future__ import annotations

from typing import Any, NamedTuple, Optional

from . import errors
from ._cm1e import ffi


class Slave(NamedTuple):
    """A slave as the scan found it; `position` 1 is the first, `kind` None: none of the library's devices."""
    position: int
    name: str
    kind: Optional[str]
    vendor_id: int
    product_code: int
    revision: int
    serial_number: int
    alias: int
    explicit_id: int
    software_version: str
    al_state: int
    al_status_code: int


def slave_of(data: Any) -> Slave:
    return Slave(data.position, errors.text(data.name), errors.text(data.kind) if data.kind != ffi.NULL else None,
                 data.vendor_id, data.product_code, data.revision, data.serial_number, data.alias, data.explicit_id,
                 errors.text(data.software_version), data.al_state, data.al_status_code)


class SimulatedMotor(NamedTuple):
    """The truth behind a simulated drive; counts of its shaft since the start."""
    position_counts: float
    velocity_counts_per_s: float
    torque_nm: float
    torque_on: bool


def motor_of(data: Any) -> SimulatedMotor:
    return SimulatedMotor(data.position_counts, data.velocity_counts_per_s, data.torque_nm, data.torque_on)


class Statistics(NamedTuple):
    """Of the cycle; `realtime`: it has real-time priority, `advice`: what to do where it lacks that."""
    cycles: int
    overruns: int
    lost_frames: int
    working_counter_errors: int
    realtime: bool
    advice: str
    wake_up_latency_max_us: float
    execution_time_max_us: float
    control_socket: str


def statistics_of(data: Any) -> Statistics:
    return Statistics(data.cycles, data.overruns, data.bus.lost_frames, data.bus.working_counter_errors, data.realtime,
                      errors.text(data.advice), data.wake_up_latency.maximum_ns * 1e-3,
                      data.execution_time.maximum_ns * 1e-3, errors.text(data.control_socket))
