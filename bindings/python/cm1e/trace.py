"""Recorded signals as NumPy arrays."""
from __future__ import annotations

import os
import tempfile
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._cm1e import lib

if TYPE_CHECKING:
    from .bus import Bus


class Trace:
    """Samples: trace["X actual position"] and trace.time are arrays of float64; the names of cm1e/trace.h."""

    def __init__(self, array: npt.NDArray[Any]) -> None:
        self.array = array

    @classmethod
    def _of_bus(cls, bus: Bus) -> Trace:
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "trace.npy")
            bus._ask(lib.cm1e_py_write_trace, b"npy", os.fsencode(path))
            return cls(np.load(path))

    @property
    def names(self) -> tuple[str, ...]:
        """The signals, without the time."""
        return tuple(self.array.dtype.names or ())[1:]

    @property
    def time(self) -> npt.NDArray[np.float64]:
        """s since the first cycle."""
        return np.ascontiguousarray(self.array["time"])

    def __getitem__(self, name: str) -> npt.NDArray[np.float64]:
        names = self.array.dtype.names or ()
        if name not in names:
            raise KeyError(f"the trace has no {name!r}; it has {', '.join(names)}")
        return np.ascontiguousarray(self.array[name])

    def __len__(self) -> int:
        return len(self.array)

    def __repr__(self) -> str:
        return f"<Trace of {len(self)} samples: {', '.join(self.names)}>"
