"""Bus files, files for other masters, and the checker."""
import pytest

import cm1e
from cm1e import files

BUS = """bus: {interface: sim, cycle_time_us: 1000}
axes:
  - {name: X, position: 1, motor: CM1-E-17S30D, unit: {counts_per_unit: 5000}}
"""


def test_bus_file_is_checked(tmp_path):
    good, bad = tmp_path / "good.yaml", tmp_path / "bad.yaml"
    good.write_text(BUS)
    bad.write_text(BUS.replace("17S30D", "17S31D"))
    cm1e.check_bus_file(good)
    with pytest.raises(cm1e.ConfigError, match=r"bad.yaml:3:\d+.*17S31D"):
        cm1e.check_bus_file(bad)
    with pytest.raises(cm1e.Error, match="none.yaml"):
        cm1e.check_bus_file(tmp_path / "none.yaml")


def test_bus_of_a_text():
    with cm1e.Bus(text=BUS, virtual_time=True) as bus:
        bus["X"].enable()


@pytest.mark.parametrize("options, said", [
    ({"axes": 600}, "600 axes are more"), ({"axes": 10**12}, "1000000000000 axes are more"),
    ({"axes": -3}, "-3 axes: a bus has 0 or more"),
    ({"axes": [{"name": "X" * 40}]}, "too long: at most 31 bytes"),
    ({"axes": [{"counts_per_unit": "a"}]}, "counts_per_unit: 'a' is a text; a number belongs there"),
    ({"axes": [{"address": 70000}]}, "address: 70000 does not belong there"),
    ({"axes": [{"address": None}]}, "address: None does not belong there"),
    ({"axes": [{"homing": {"methd": 1}}]}, "there is no methd"), ({"control": "all"}, "observe"),
    ({"realtime": "no"}, "try"), ({"cycle_time": 0.003}, "cycle"), ({"axes": 1, "trace": -1}, "trace"),
    ({"interface": "x" * 80}, "too long"), ({"interface": "none0"}, "none0")])
def test_mistakes_in_options(options, said):
    with pytest.raises(cm1e.Error, match=said):
        cm1e.Bus(**options).start()


@pytest.mark.parametrize("options, said", [
    ({"axes": "X"}, "axes is 'X'; expected a number of axes, or a list"), ({"axes": [1]}, r"axes is \[1\]; expected a number"),
    ({"axes": 2.5}, "axes is 2.5"), ({"source": 1.5}, "float"), ({"source": "a", "axes": 1}, "give one of them"),
    ({"axes": [{"gear_numerator": "1"}]}, "a number belongs there"), ({"cycle_time": "1"}, ""),
    ({"axes": [{"max_velocity": "fast"}]}, "a number belongs there"), ({"groups": "table"}, r"as \['table'\]"),
    ({"groups": [1]}, "groups is"), ({"networks": "b.yaml"}, r"as \['second.yaml'\]"),
    ({"trace_objects": ("X", 1, 2)}, "trace_objects is"), ({"trace_objects": [(1, 2, 3)]}, "")])
def test_wrong_types_of_options(options, said):
    with pytest.raises((TypeError, cm1e.Error, AttributeError), match=said):
        cm1e.Bus(**options)


@pytest.mark.parametrize("kind, devices", [("esi", []), ("esi", [{"model": "cm1-e", "mapping": "csp"}]), ("ec-extend", []),
                                           ("sii", [{"alias": 7, "serial_number": 5}])])
def test_generated_files_have_no_errors(kind, devices):
    file = files.generate(kind, devices)
    assert files.format_of(file.data).lower().replace("_", "-") == kind
    assert not [finding for finding in files.check_file(file.data) if finding.is_error]
    assert files.convert(file.data, kind).data == file.data


def test_eni_of_a_bus_file(tmp_path):
    path = tmp_path / "machine.yaml"
    path.write_text(BUS)
    file = files.generate_eni(path)
    assert b"EtherCATConfig" in file.data and files.format_of(file.data) == "ENI"


def test_esi_and_sii_become_each_other():
    sii = files.generate("sii")
    assert files.format_of(files.convert(sii.data, "esi").data) == "ESI"
    assert files.format_of(files.convert(files.generate("esi").data, "sii").data) == "SII"
    with pytest.raises(cm1e.Error):
        files.convert(files.generate("esi").data, "sii", device=99)


def test_checker_finds_what_is_wrong(tmp_path):
    good = files.generate("esi").data
    path = tmp_path / "wrong.xml"
    path.write_bytes(good.replace(b"<Index>#x6040</Index>", b"<Index>#x6f40</Index>", 1))
    findings = cm1e.check_file(path)
    assert any(finding.is_error and finding.line > 1 and finding.rule for finding in findings)
    with pytest.raises(cm1e.FileError):
        cm1e.check_file(b"nothing that is known")
    with pytest.raises(cm1e.FileError, match="line|end|read"):
        cm1e.check_file(good[:len(good) // 2])


def test_options_of_files():
    assert b"AXIS" in files.generate_trio_program().data.upper()
    with pytest.raises(cm1e.ConfigError, match="esi, ec-extend"):
        files.generate("edi")
    with pytest.raises(cm1e.ConfigError, match="eb01"):
        files.generate("esi", [{"model": "eb03"}])
    with pytest.raises(cm1e.ConfigError, match="vendor"):
        files.generate("esi", [{"model": "eb01"}])
