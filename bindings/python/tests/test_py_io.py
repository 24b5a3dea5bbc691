"""Signals of slaves without a motor, by name."""
import numpy
import pytest

import cm1e

BUS = """bus: {interface: sim, cycle_time_us: 1000}
axes:
  - {name: X, position: 1, motor: CM1-E-17S30D, unit: {counts_per_unit: 5000}}
slaves:
  - {name: box, position: 2, sim: {device: digital, inputs: 4, outputs: 4}}
  - {name: levels, position: 3, sim: {device: analog, inputs: 2, outputs: 2}}
"""


@pytest.fixture
def bus():
    with cm1e.Bus(text=BUS, virtual_time=True) as bus:
        yield bus


def test_output_is_seen_at_the_input_wired_to_it(bus):
    lamp, button = bus.io["box.output 2"], bus.io["box.input 2"]
    assert button.value is False and lamp.output and not button.output
    for lit in (True, numpy.bool_(False), numpy.bool_(True)):
        lamp.value = lit
        bus.cycles(3)
        assert button.value is bool(lit) and lamp.value is bool(lit)
    assert button.quality == "good" and bus.io["box.input 1"].value is False


def test_analog_values(bus):
    output = bus.io["levels.AO Output Channel 1 Value"]
    output.value = -1234
    bus.cycles(5)
    assert bus.io["levels.AI Standard Channel 1 Value"].value == -1234
    with pytest.raises(cm1e.Error, match="cannot be 99999"):
        output.value = 99999
    for wrong in ("1", None, 1.5):
        with pytest.raises(TypeError):
            output.value = wrong
    with pytest.raises(OverflowError):
        output.value = 2**70


def test_what_cannot_be_written(bus):
    with pytest.raises(cm1e.Error, match="an input of type BOOL"):
        bus.io["box.input 1"].value = True
    with pytest.raises(cm1e.Error):
        bus.io["1.Controlword"].value = 15


def test_names(bus):
    listed = bus.io.list()
    assert len(bus.io) == len(listed) > 12
    assert {info.slave for info in listed} == {1, 2, 3}
    assert sum(info.output and not info.of_axis for info in listed) == 6
    assert all(isinstance(bus.io[name], cm1e.Signal) for name in list(bus.io)[:5])
    with pytest.raises(LookupError, match="box|levels|input"):
        bus.io["box.lamp"]
    with pytest.raises(TypeError):
        bus.io[1]


def test_signal_of_a_slave_that_is_away(bus):
    button = bus.io["box.input 1"]
    bus.simulate("unplug 2")
    bus.advance(0.1)
    assert button.quality in ("stale", "offline")
