"""Axes and groups: their values, and motions that wait, or can be awaited."""
from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Any, Generator, Iterator, NamedTuple, Optional

from . import blocks as fb
from . import errors
from ._block import AXES_GROUP_REF, AXIS_REF, Block
from ._cm1e import ffi, lib
from .codes import AxisState, ErrorCode, GroupState

if TYPE_CHECKING:
    from .bus import Bus


class AxisInfo(NamedTuple):
    """The values of an axis, all of the same cycle, in units of the axis. What the motor does not tell is None."""
    state: AxisState
    set_position: float
    set_velocity: float
    set_acceleration: float
    position: float
    velocity: float
    torque: Optional[float]
    lag: float
    powered: bool
    homed: bool
    online: bool
    in_position: bool
    error: ErrorCode
    device_error: int
    digital_inputs: Optional[int]
    statusword: int
    mode: int
    temperature: Optional[int]
    dc_link_voltage: Optional[float]


def info_of(data: Any) -> AxisInfo:
    return AxisInfo(AxisState(data.state), data.set_position, data.set_velocity, data.set_acceleration,
                    data.actual_position, data.actual_velocity, data.actual_torque if data.torque_known else None,
                    data.position_lag, data.powered, data.homed, data.online, data.in_position,
                    ErrorCode(data.error), data.device_error, data.digital_inputs if data.digital_known else None, data.statusword, data.mode,
                    data.temperature if data.temperature_known else None,
                    data.dc_link_voltage if data.dc_link_known else None)


class Command:
    """A command that a block executes. wait() blocks, `await` lets other tasks of asyncio go on. If waiting is broken
    off (Ctrl-C, a time limit, a cancelled task), the axis is stopped."""

    def __init__(self, bus: Bus, block: Block, reference: Optional[AXIS_REF | AXES_GROUP_REF]) -> None:
        self.block = block
        self._bus = bus
        self._reference = reference
        self._failed: Optional[BaseException] = None
        self._ended = False

    @property
    def done(self) -> bool:
        """Whether it has ended, well or not."""
        return self._ended or bool(lib.cm1e_py_block_ended(self.block._c))

    def wait(self, timeout: Optional[float] = None) -> Command:
        """Waits for its end; seconds of the bus. Raises what went wrong."""
        if not self._ended:
            try:
                self._bus._wait_for(self.block, timeout)
                self._finish()
            except BaseException as error:
                self._break_off(error)
                raise
        return self._result()

    def __await__(self) -> Generator[Any, None, Command]:
        if not self._ended:
            try:
                yield from self._bus._watch(self.block).__await__()
                self._finish()
            except BaseException as error:
                self._break_off(error)
                raise
        return self._result()

    def stop(self) -> None:
        """Stops the axis, and ends the command."""
        if not self._ended:
            self._break_off(errors.CommandAborted("The command was stopped.", lib.CM1E_ERROR_CANCELLED))

    def _finish(self) -> None:
        if self._ended:
            return
        self._ended = True
        self._failed = self.block._error()
        self._bus._release(self.block)

    def _break_off(self, error: BaseException) -> None:
        self._ended, self._failed = True, error
        try:
            if self._reference is not None:
                self._bus._stop_moving(self._reference)
        finally:
            self._bus._release(self.block)

    def _result(self) -> Command:
        if self._failed is not None:
            raise self._failed
        return self


class Axis(AXIS_REF):
    """An axis of a bus. Distances are in its units u, velocities in u/s, accelerations in u/s2, jerks in u/s3; an
    acceleration, deceleration or jerk of 0 selects the maximum of the axis. Every motion waits for its end, or with
    wait=False returns a Command that can be waited for or awaited."""

    def __init__(self, bus: Bus, name: str, handle: Any, index: int) -> None:
        super().__init__(bus, name, handle)
        self._index = index
        self._power: Optional[fb.MC_Power] = None

    # ---- values ------------------------------------------------------------------------------------------------

    @property
    def info(self) -> AxisInfo:
        """All values, of one cycle."""
        return self.bus._axis_info(self._index)

    @property
    def position(self) -> float:
        """u; measured."""
        return self.info.position

    @property
    def velocity(self) -> float:
        """u/s; measured."""
        return self.info.velocity

    @property
    def torque(self) -> Optional[float]:
        """% of rated torque; None: the motor does not tell."""
        return self.info.torque

    @property
    def state(self) -> AxisState:
        """AxisState of PLCopen."""
        return self.info.state

    @property
    def error_text(self) -> str:
        """The error of the axis, or why the last command was refused, in sentences."""
        return self.bus._error_text(self)

    # ---- commands ----------------------------------------------------------------------------------------------

    def execute(self, block: Block, *, wait: bool = True, timeout: Optional[float] = None) -> Command:
        """Executes any block of this axis that has an input Execute."""
        return self.bus.execute(block, self, wait=wait, timeout=timeout)

    def enable(self, timeout: Optional[float] = 10.0) -> None:
        """Switches the power stage on, and waits for it."""
        if self._power is None:
            self._power = fb.MC_Power(Axis=self, EnablePositive=True, EnableNegative=True)
            self.bus._attach(self._power)
        self._power.Enable = True
        try:
            self.bus._wait_for(self._power, timeout)
            failed = self._power._error()
            if failed is not None:
                raise failed
        except BaseException:
            if self.bus.running:
                self._power.Enable = False  # or the motor would have torque later, when nobody waits for it
            raise

    def disable(self, timeout: Optional[float] = 10.0) -> None:
        """Ramps the motor down, switches the power stage off, and waits for it."""
        if self._power is not None:
            self._power.Enable = False
        self.bus._wait_until(lambda: not self.info.powered, timeout, f"{self.name} is still enabled")

    def move_absolute(self, position: float, velocity: float, acceleration: float = 0, deceleration: float = 0,
                      jerk: float = 0, *, direction: fb.MC_DIRECTION = fb.MC_DIRECTION.mcShortestWay,
                      buffer_mode: fb.MC_BUFFER_MODE = fb.MC_BUFFER_MODE.mcAborting, wait: bool = True,
                      timeout: Optional[float] = None) -> Command:
        """MC_MoveAbsolute. `direction`: of modulo axes."""
        return self.execute(fb.MC_MoveAbsolute(
            Axis=self, Position=position, Velocity=velocity, Acceleration=acceleration,
            Deceleration=deceleration, Jerk=jerk, Direction=direction, BufferMode=buffer_mode), wait=wait, timeout=timeout)

    def move_relative(self, distance: float, velocity: float, acceleration: float = 0, deceleration: float = 0,
                      jerk: float = 0, *, buffer_mode: fb.MC_BUFFER_MODE = fb.MC_BUFFER_MODE.mcAborting,
                      wait: bool = True, timeout: Optional[float] = None) -> Command:
        """MC_MoveRelative."""
        return self.execute(fb.MC_MoveRelative(
            Axis=self, Distance=distance, Velocity=velocity, Acceleration=acceleration,
            Deceleration=deceleration, Jerk=jerk, BufferMode=buffer_mode), wait=wait, timeout=timeout)

    def move_velocity(self, velocity: float, acceleration: float = 0, deceleration: float = 0, jerk: float = 0, *,
                      wait: bool = True, timeout: Optional[float] = None) -> Command:
        """MC_MoveVelocity: ends when the velocity is reached; the axis goes on. Below 0: the negative direction."""
        direction = fb.MC_DIRECTION.mcNegativeDirection if velocity < 0 else fb.MC_DIRECTION.mcPositiveDirection
        return self.execute(fb.MC_MoveVelocity(
            Axis=self, Velocity=abs(velocity), Acceleration=acceleration, Deceleration=deceleration, Jerk=jerk,
            Direction=direction), wait=wait, timeout=timeout)

    def home(self, position: float = 0.0, *, wait: bool = True, timeout: Optional[float] = None) -> Command:
        """MC_Home, as the bus file configures it: afterwards the reference has this position."""
        return self.execute(fb.MC_Home(Axis=self, Position=position), wait=wait, timeout=timeout)

    def set_position(self, position: float, *, relative: bool = False) -> None:
        """MC_SetPosition: the axis is at this position from now on; nothing moves."""
        self.execute(fb.MC_SetPosition(Axis=self, Position=position, Relative=relative))

    def halt(self, deceleration: float = 0, jerk: float = 0, *, wait: bool = True,
             timeout: Optional[float] = None) -> Command:
        """MC_Halt: ramps down to standstill."""
        return self.execute(fb.MC_Halt(Axis=self, Deceleration=deceleration, Jerk=jerk), wait=wait, timeout=timeout)

    def stop(self, deceleration: float = 0, jerk: float = 0, *, timeout: Optional[float] = None) -> None:
        """MC_Stop: ramps down to standstill, whatever the axis does, and then allows commands again."""
        self.execute(fb.MC_Stop(Axis=self, Deceleration=deceleration, Jerk=jerk), timeout=timeout)

    def reset(self, timeout: Optional[float] = 10.0) -> None:
        """MC_Reset: leaves ErrorStop when the cause is gone."""
        self.execute(fb.MC_Reset(Axis=self), timeout=timeout)

    def read_parameter(self, number: int) -> float:
        """MC_ReadParameter, by its number in docs/FUNCTION-BLOCKS.md."""
        block = fb.MC_ReadParameter(Axis=self, Enable=True, ParameterNumber=number)
        with self._named_parameter(number):
            self.bus._once(block)
        return block.Value

    def write_parameter(self, number: int, value: float) -> None:
        """MC_WriteParameter."""
        with self._named_parameter(number):
            self.execute(fb.MC_WriteParameter(Axis=self, ParameterNumber=number, Value=value))

    @contextlib.contextmanager
    def _named_parameter(self, number: int) -> Iterator[None]:
        try:
            yield
        except errors.AxisError as error:
            if error.code != lib.CM1E_ERROR_AXIS_PARAMETER:
                raise
            raise errors.AxisError(f"{self.name} has no parameter {number}; docs/FUNCTION-BLOCKS.md lists those that can be "
                                   "read and written.", error.code) from None


class Group(AXES_GROUP_REF):
    """An axes group (PLCopen Part 4), made with Bus(groups=[...])."""

    @property
    def state(self) -> GroupState:
        """GroupState."""
        info = ffi.new("cm1e_group_info_t *")
        self.bus._do(lib.cm1e_py_group_read, self._handle[0], info)
        return GroupState(info.state)

    @property
    def error_text(self) -> str:
        """The error of the group, or why the last command was refused, in sentences."""
        return self.bus._error_text(self)

    def execute(self, block: Block, *, wait: bool = True, timeout: Optional[float] = None) -> Command:
        """Executes any block of this group that has an input Execute."""
        return self.bus.execute(block, self, wait=wait, timeout=timeout)

    def add(self, axis: Axis, ident: int) -> None:
        """MC_AddAxisToGroup: the axis gets this place, 1 ... 8."""
        self.execute(fb.MC_AddAxisToGroup(AxesGroup=self, Axis=axis, IdentInGroup=ident))

    def enable(self) -> None:
        """MC_GroupEnable."""
        self.execute(fb.MC_GroupEnable(AxesGroup=self))

    def disable(self) -> None:
        """MC_GroupDisable."""
        self.execute(fb.MC_GroupDisable(AxesGroup=self))

    def move_linear_absolute(self, position: list[float], velocity: float, acceleration: float = 0,
                             deceleration: float = 0, jerk: float = 0, *,
                             buffer_mode: fb.MC_BUFFER_MODE = fb.MC_BUFFER_MODE.mcAborting, wait: bool = True,
                             timeout: Optional[float] = None) -> Command:
        """MC_MoveLinearAbsolute: a straight line, in the order of the places of the axes."""
        return self.execute(fb.MC_MoveLinearAbsolute(
            AxesGroup=self, Position=position, Velocity=velocity, Acceleration=acceleration, Deceleration=deceleration,
            Jerk=jerk, BufferMode=buffer_mode), wait=wait, timeout=timeout)

    def move_direct_absolute(self, position: list[float], *,
                             buffer_mode: fb.MC_BUFFER_MODE = fb.MC_BUFFER_MODE.mcAborting, wait: bool = True,
                             timeout: Optional[float] = None) -> Command:
        """MC_MoveDirectAbsolute: as fast as the axes can, all of them get there together."""
        return self.execute(fb.MC_MoveDirectAbsolute(AxesGroup=self, Position=position, BufferMode=buffer_mode),
                            wait=wait, timeout=timeout)

    def interrupt(self, deceleration: float = 0, jerk: float = 0) -> None:
        """MC_GroupInterrupt: comes to rest along the path, and keeps the commands, which wait for resume()."""
        self.execute(fb.MC_GroupInterrupt(AxesGroup=self, Deceleration=deceleration, Jerk=jerk))

    def resume(self) -> None:
        """MC_GroupContinue: the commands that were interrupted go on."""
        self.execute(fb.MC_GroupContinue(AxesGroup=self))

    def stop(self) -> None:
        """MC_GroupStop: ramps down along the path."""
        self.execute(fb.MC_GroupStop(AxesGroup=self))
