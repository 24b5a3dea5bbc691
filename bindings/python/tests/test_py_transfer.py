"""Files in slaves, firmware, and files of other masters beside the devices that they describe."""
import pytest

import cm1e
from cm1e import files

DRIVE = {"name": "X", "device": "cia402", "counts_per_revolution": 10000, "max_speed_rpm": 3000}
FILE = bytes((n * 7 + n // 251) % 256 for n in range(3000))


@pytest.fixture
def bus():
    with cm1e.Bus(axes=[DRIVE, {"name": "Y"}], virtual_time=True) as bus:
        yield bus


def image(version, size=30000):
    text = f"CM1-E simulated firmware {version}, {size} bytes\n".encode()
    return text + bytes(n % 251 for n in range(size - len(text)))


def test_file_comes_back_while_the_axis_moves(bus):
    x = bus["X"]
    x.enable()
    command = x.move_absolute(3, 5, wait=False)
    bus.write_file(1, "drive.par", FILE)
    assert bus.read_file(1, "drive.par") == FILE
    with pytest.raises(cm1e.BusError, match="file not found"):
        bus.read_file(1, "other")
    with pytest.raises(cm1e.Error):
        bus.read_file(1, "drive.par", maximum=100)
    with pytest.raises(cm1e.Error):
        bus.read_file(7, "drive.par")
    command.wait()
    bus.stop()
    bus.close()
    with pytest.raises(cm1e.StateError, match="closed"):
        bus.read_file(1, "drive.par")


def test_file_before_the_start():
    with pytest.raises(cm1e.Error):
        cm1e.Bus(axes=1, virtual_time=True).read_file(1, "drive.par")  # no scan yet
    bus = cm1e.Bus(axes=[DRIVE], virtual_time=True)
    bus.scan()
    bus.write_file(1, "drive.par", FILE)
    assert bus.read_file(1, "drive.par") == FILE
    bus.close()


def test_file_beside_a_device():
    bus = cm1e.Bus(axes=[{"name": "X"}], virtual_time=True)
    bus.scan()
    assert bus.compare(files.generate("esi", [{"model": "cm1-e"}]).data, 1) == []
    found = bus.compare(files.generate("esi", [{"model": "cm1-e", "firmware": "1.2.0"}]).data, 1)
    assert found and all(isinstance(one, cm1e.Finding) for one in found)
    with pytest.raises(cm1e.NotFoundError):
        bus.compare(files.generate("esi", [{"model": "eb01", "revision": 1, "vendor_id": 0xAA77, "product_code": 5}]).data, 1)
    with pytest.raises(cm1e.FileError):
        bus.compare(b"none", 1)
    with bus.start():
        with pytest.raises(cm1e.StateError, match="before the bus is started"):
            bus.compare(b"none", 1)


def test_firmware_is_written_and_read_back(tmp_path):
    bus = cm1e.Bus(axes=[{"name": "X"}, {"name": "Y"}], virtual_time=True)
    (tmp_path / "new.bin").write_bytes(image("1.2.0"))
    assert bus.update_firmware(1, tmp_path / "new.bin") == "1.2.0"
    assert [slave.software_version for slave in bus.slaves] == ["1.2.0", "1.3.5"]
    assert bus.update_firmware(1, image("1.3.5"), name="old.bin") == "1.3.5"
    for wrong, words in ((lambda: bus.update_firmware(1, b"short", name="x"), "5 bytes"),
                         (lambda: bus.update_firmware(1, image("1.2.0")), "a name"),
                         (lambda: bus.update_firmware(3, image("1.2.0"), name="x"), "no slave 3")):
        with pytest.raises(cm1e.Error, match=words):
            wrong()
    with bus.start():
        with pytest.raises(cm1e.StateError, match="before the bus is started"):
            bus.update_firmware(1, image("1.2.0"), name="x")


def test_firmware_of_another_device_is_refused():
    text = "bus: {interface: sim}\naxes: [{name: X, position: 2}]\nslaves: [{name: c, position: 1, sim: {device: coupler}}]\n"
    bus = cm1e.Bus(text=text, virtual_time=True)
    with pytest.raises(cm1e.ConfigError, match="no CM1-E"):
        bus.update_firmware(1, image("1.2.0"), name="x")
    bus.close()
