"""For tests of machine programs: the fixture cm1e_bus is a simulated bus on virtual time.

    @pytest.mark.cm1e_bus("machine.yaml")                    a bus file, beside the test or below the root of the tests
    @pytest.mark.cm1e_bus(axes=["X", "Y"])                   axes with defaults
    @pytest.mark.cm1e_bus(axes=[{"name": "X", "counts_per_unit": 5000}], groups=["G"])

What stands in a bus file about interface and time does not matter: a test never moves a motor. Without the mark, the
option cm1e_bus_file of pytest.ini is the bus file, or there is one axis X of one revolution per unit. A test that leaves an
axis in ErrorStop passes only if it says so: @pytest.mark.cm1e_bus(..., error_stop=True)."""
from __future__ import annotations

import os
from typing import Any, Iterator

import pytest

import cm1e

_OWN = ("axes", "groups", "cycle_time", "trace", "trace_every", "trace_objects", "text")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addini("cm1e_bus_file", "bus file of the fixture cm1e_bus", default="")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "cm1e_bus(bus_file, axes=..., groups=..., error_stop=False): the simulated bus of "
                                       "the fixture cm1e_bus")


def _options(request: pytest.FixtureRequest) -> tuple[dict[str, Any], bool]:
    """What Bus() is made with, and whether the test may end in ErrorStop."""
    mark = request.node.get_closest_marker("cm1e_bus")
    options = dict(mark.kwargs) if mark else {}
    error_stop = bool(options.pop("error_stop", False))
    unknown = set(options) - set(_OWN)
    if unknown or (mark and len(mark.args) > 1):
        raise pytest.UsageError(f"cm1e_bus: {', '.join(sorted(unknown)) or 'two files'}: expected a bus file, or some of "
                                f"{', '.join(_OWN)}, error_stop")
    configured = str(request.config.getini("cm1e_bus_file"))
    if mark and mark.args:
        options["source"] = _found(request, os.fspath(mark.args[0]))
    elif configured and not options:
        options["source"] = _found(request, configured)
    elif "text" not in options:
        axes = options.get("axes", ["X"])
        options["axes"] = axes if isinstance(axes, int) else [
            {"name": axis} if isinstance(axis, str) else axis for axis in axes]
    return options, error_stop


def _found(request: pytest.FixtureRequest, name: str) -> str:
    """A file beside the test, or below the root of the tests."""
    places = [os.path.join(folder, name) for folder in (request.path.parent, request.config.rootpath)]
    for path in places:
        if os.path.exists(path):
            return path
    raise pytest.UsageError(f"cm1e_bus: there is no bus file {' or '.join(places)}")


@pytest.fixture
def cm1e_bus(request: pytest.FixtureRequest) -> Iterator[cm1e.Bus]:
    """A simulated bus on virtual time, started: bus["X"].enable(), bus.advance(0.5), bus.simulate("power 1 off") ..."""
    options, error_stop = _options(request)
    bus = cm1e.Bus(options.pop("source", None), interface="sim", virtual_time=True, control="none", **options)
    with bus:
        yield bus
        ended = [axis for axis in bus.axes if axis.state == cm1e.AxisState.ERROR_STOP] if bus.running else []
        said = "\n".join(f"{axis.name}: {axis.error_text}" for axis in ended)
    if ended and not error_stop:
        pytest.fail(f"An axis is in ErrorStop at the end of the test.\n{said}", pytrace=False)
