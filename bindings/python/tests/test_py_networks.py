"""Several networks in one program: one cycle, axes of all, devices of each."""
import pytest

import cm1e
from cm1e.blocks import MC_GearIn

FILE = "bus: {{interface: sim}}\naxes: [{{name: {0}1, sim: {{no_stops: true}}}}, {{name: {0}2}}]\n" \
       "slaves: [{{name: {0}in, position: 3, sim: {{device: digital, outputs: 4}}}}]\n"


@pytest.fixture
def files(tmp_path):
    for name in "ab":
        (tmp_path / f"{name}.yaml").write_text(FILE.format(name))
    return tmp_path / "a.yaml", tmp_path / "b.yaml"


def test_axes_of_two_networks_move_together(files):
    with cm1e.Bus(files[0], networks=[files[1]], virtual_time=True) as bus:
        assert [axis.name for axis in bus.axes] == ["a1", "a2", "b1", "b2"]
        master, slave = bus["a1"], bus["b1"]
        master.enable()
        slave.enable()
        gear = MC_GearIn(Master=master, Slave=slave, RatioNumerator=1, RatioDenominator=2, Execute=True)
        bus.attach(gear)
        bus.wait_until(lambda: gear.InGear, timeout=1)
        master.move_absolute(1, 5)
        assert slave.info.set_position == pytest.approx(0.5, abs=0.001)
        assert {"a1 set position", "b2 error"} <= set(bus.trace.names)
        first, second = bus.networks
        assert first is bus and len(second.slaves) == 3 and second.axis_names == ("b1", "b2")
        second.io["bin.output 1"].value = True
        bus.advance(0.01)
        assert second.io["bin.output 1"].value is True and bus.io["ain.output 1"].value is False
        bus.simulate("power 1 off")  # concerns the first network alone
        bus.advance(0.3)
        assert bus["a1"].state == cm1e.AxisState.ERROR_STOP and bus["b2"].state == cm1e.AxisState.DISABLED
        second.sdo_write(1, 0x6081, 0, (4711).to_bytes(4, "little"))
        assert [int.from_bytes(one.sdo_read(1, 0x6081), "little") == 4711 for one in bus.networks] == [False, True]


def test_network_that_does_not_fit_is_refused(files, tmp_path):
    with pytest.raises(cm1e.Error, match="a1"):
        cm1e.Bus(files[0], networks=[files[0]], virtual_time=True).start()
    with pytest.raises(cm1e.Error):
        cm1e.Bus(files[0], networks=[tmp_path / "none.yaml"])


def test_end_of_two_networks(files):
    bus = cm1e.Bus(files[0], networks=[files[1]], virtual_time=True)
    assert [len(network.scan()) for network in bus.networks] == [3, 3]
    second = bus.networks[1]
    with bus:
        bus["b1"].enable()
    for use in (lambda: second.slaves, lambda: second.sdo_read(1, 0x6041), lambda: second.read_file(1, "x")):
        with pytest.raises(cm1e.StateError, match="closed"):
            use()
