"""Records of the event log."""
from __future__ import annotations

from typing import Any, NamedTuple, Optional, Sequence

from . import errors
from ._cm1e import lib


class Event(NamedTuple):
    """What happened to an axis or to the bus; `time` in s since the first cycle."""
    number: int
    time: float
    kind: str
    axis: Optional[str]
    code: int
    text: str


def event_of(data: Any, text: str, axes: Sequence[str]) -> Event:
    axis = axes[data.axis] if 0 <= data.axis < len(axes) else None
    return Event(data.number, data.run_ns * 1e-9, errors.text(lib.cm1e_log_kind_name(data.kind)), axis, data.code, text)
