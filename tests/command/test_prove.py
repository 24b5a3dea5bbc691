#!/usr/bin/env python3
"""`cm1e prove` on the simulated segment. Against the simulator every point agrees, for every firmware, both orders of the
mappings, every bridge. Against a simulator that plays a profile with one planted difference exactly the points that it
concerns differ, and name it; the profile that is then written plays the same device again.

test_prove.py BIN-DIRECTORY
"""
import json
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import real_time  # noqa: E402

CM1E = os.path.join(sys.argv[1], "cm1e")
READ, WRITE = 0x0007, 0x0038
SINT, INT, DINT, USINT, UINT, UDINT = 2, 3, 4, 5, 6, 7

# Name, profile, the points that differ, a word of the differences.
PLANTED = [
    ("another firmware", {"entries": [{"entry": "0x100A", "text": "1.4.0"}]}, {"id.firmware"}, "1.4.0"),
    ("another hardware", {"entries": [{"entry": "0x1009", "text": "MYO28-03A"}]}, {"id.hardware"},
     "MYO28-03A"),
    ("another revision", {"entries": [{"entry": "0x1018:03", "value": 0x20020104}]}, {"id.revision", "sii.identity"},
     "0x20020104"),
    ("a missing object", {"missing": [f"0x2201:0{n}" for n in range(5)]}, {"dict.objects"}, "0x2201:01"),
    ("no H8, as UG 7.5 shows", {"missing": ["0x60FB:09"]}, {"dict.objects"}, "0x60FB:09"),
    ("an object more", {"entries": [{"entry": "0x605D", "type": INT, "bits": 16, "access": READ | WRITE, "default": 1,
                                     "name": "Halt option code"}]}, {"dict.objects"}, "Halt option code"),
    ("another default", {"entries": [{"entry": "0x6084", "default": 1000}]}, {"dict.defaults"}, "1000"),
    ("another constant", {"entries": [{"entry": "0x6502", "value": 0x1A4}]}, {"dict.values"}, "420"),
    ("another range", {"entries": [{"entry": "0x6098", "minimum": -4}]}, {"dict.ranges", "write.too-low"}, "-4"),
    ("another upper bound", {"entries": [{"entry": "0x609A", "maximum": 9000000}]}, {"dict.ranges", "write.too-high"},
     "9000000"),
    ("read-only", {"entries": [{"entry": "0x607C", "type": DINT, "bits": 32, "access": READ}]},
     {"dict.access", "write.same", "write.too-high", "write.too-low"}, "read "),
    ("another size", {"entries": [{"entry": "0x6079", "type": INT, "bits": 16, "access": READ | 0x80}]},
     {"dict.sizes", "dict.types"}, "0x6079:00"),
    ("another abort code", {"codes": {"aborts": {"0x06070012": "0x06070010"}}}, {"abort.too-long"}, "0x06070010"),
    ("another AL status code", {"codes": {"al_status": {"0x0011": "0x0001"}}},
     {"state.init-safeop", "state.init-op", "state.preop-op", "state.preop-boot", "boot.preop"},
     "0x0001"),
    ("another error code", {"codes": {"errors": {"0x4502": "0x0000"}}}, {"error.no-mode"}, "0x0000"),
    ("another mapping", {"entries": [{"entry": "0x1601:00", "value": 2},
                                     {"entry": "0x1601:02", "value": 0x607A0020}]}, {"map.1601"}, "6040/16 607A/32"),
    ("another mapping in use", {"entries": [{"entry": "0x1A00:00", "value": 8},
                                            {"entry": "0x1A00:08", "value": 0x60610008}]}, {"map.1A00"}, "6079/16"),
]


VIRTUAL = "bus: {virtual_time: true}\n"


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def prove(*words):
    return subprocess.run([CM1E, "prove", *words], capture_output=True, text=True, timeout=120, check=False)


def verdicts(report):
    return {point["id"]: point["verdict"] for point in report["points"]}


def report_of(*words):
    done = prove(*words, "--json")
    expect(done.stdout.startswith("{"), f"{words}: {done}")
    report = json.loads(done.stdout)
    differs = [point for point in report["points"] if point["verdict"] == "differs"]
    expect(done.returncode == (1 if differs else 0), f"{words}: exit status {done.returncode}")
    expect(report["counts"]["differs"] == len(differs), f"{words}: {report['counts']}")
    return report, {point["id"] for point in differs}


def write(path, value):
    with open(path, "w", encoding="utf-8") as file:
        file.write(value if isinstance(value, str) else json.dumps(value))
    return path


def unknown(report):
    return {point["id"] for point in report["points"] if point["verdict"] == "unknown"}


def other_cycles(firmware):
    """Cycle times that a firmware does not have."""
    return {"cycle.500", "cycle.250", "cycle.200"} if firmware < "1.3.2" else set()


def check_agreement(folder):
    report, differs = report_of("-i", "sim")
    expect(differs == unknown(report) == set(), f"in real time: {differs}, {unknown(report)}")
    network = os.path.join(folder, "network.yaml")
    for firmware in ("1.2.0", "1.3.0", "1.3.2", "1.3.3", "1.3.4", "1.3.5"):
        order = "ug_7_2" if firmware in ("1.2.0", "1.3.5") else "ug_4_4"
        write(network, f"bus: {{sim_pdo_order: {order}, virtual_time: true}}\n"
                       f"axes: [{{firmware: {firmware}, motor: CM1-E-23L20D}}]\n")
        report, differs = report_of("-b", network, "--allow-writes")
        expect(differs == set() and unknown(report) == {"esc.clock"} | other_cycles(firmware), f"{firmware}, {order}: {differs}")
    for motors in (("CM1", "CM1"), ("CM2", "CM2"), ("CM1", "CM2")):
        write(network, VIRTUAL + "axes:\n  - {position: 2, channel: 1, motor: %s, k37: 10}\n  - {position: 2, channel: 3, "
                       "motor: %s, k37: 10}\n" % motors)
        report, differs = report_of("-b", network, "2", "--allow-writes", "--allow-dead-ends")
        expect(differs == set() and unknown(report) == {"esc.clock"}, f"bridge {motors}: {report}")
        told = verdicts(report)
        expect({told[point] for point in ("cml.mode", "cml.status", "cml.parameter", "mode.dead-ends")} == {"agrees"},
               f"modes of a bridge {motors}: {told}")


def check_planted(folder):
    profile, again = os.path.join(folder, "planted.json"), os.path.join(folder, "again")
    for name, planted, points, word in PLANTED:
        write(profile, {"cm1e_profile": 1, **planted})
        report, differs = report_of("-b", SIM, "--profile", profile, "--allow-writes", "-o", again)
        expect(differs == points, f"{name}: {differs} differ; expected {points}")
        told = json.dumps([point["differences"] for point in report["points"] if point["id"] in points])
        expect(word in told, f"{name}: {word} is not in {told}")
        with open(again + ".md", encoding="utf-8") as file:
            page = file.read()
        expect(all(f"### {point}: " in page for point in points) and "simulated segment" in page, f"{name}: {page}")
        second, _ = report_of("-b", SIM, "--profile", again + ".profile.json", "--allow-writes")
        expect(verdicts(second) == verdicts(report), f"{name}: its profile plays another device: {verdicts(second)}")


def check_eeprom(folder):
    """Another serial number than in 0x1018, and 32 bits of torque in the TxPDOs, in the image of the EEPROM."""
    good, changed = os.path.join(folder, "good"), os.path.join(folder, "sii.json")
    prove("-b", SIM, "-o", good)
    with open(good + ".profile.json", encoding="utf-8") as file:
        profile = json.load(file)
    image, serial = profile["sii"], 2 * 0x1C
    for sii, points in ((image[:serial] + "07" + image[serial + 2:], {"sii.identity"}),
                        (re.sub("(776000....)10", r"\g<1>20", image), {"sii.contents"})):
        expect(sii != image, f"nothing is changed for {points}")
        write(changed, {**profile, "sii": sii})
        _, differs = report_of("-b", SIM, "--profile", changed)
        expect(differs == points, f"EEPROM: {differs}; expected {points}")


def check_damage(folder):
    """Profiles that make no sense: neither the simulator nor the comparison crashes or hangs."""
    seed = random.randrange(1 << 32)
    chance = random.Random(seed)
    with open(os.path.join(folder, "good.profile.json"), encoding="utf-8") as file:
        good = file.read()
    for _ in range(12):
        profile = json.loads(good)
        for entry in chance.sample(profile["entries"], 10):
            key = chance.choice(["type", "bits", "access", "value", "default", "minimum", "maximum"])
            entry[key] = chance.choice([0, 1, 9, 33, 64, 65, 255, 65535, -1, 2**63 - 1, -2**63])
        at = chance.randrange(len(profile["sii"]))
        profile["sii"] = profile["sii"][:at] + chance.choice("0123456789ABCDEF") + profile["sii"][at + 1:]
        done = prove("-b", SIM, "--allow-writes", "--profile", write(os.path.join(folder, "odd.json"), profile))
        expect(done.returncode in (0, 1), f"seed {seed}: {done.returncode}, {done.stderr}")


def check_bridge(folder):
    network = write(os.path.join(folder, "bridge.yaml"), VIRTUAL + "axes: [{position: 1, channel: 1, k37: 10}]\n")
    profile = write(os.path.join(folder, "bridge.json"), {"cm1e_profile": 1, "missing": ["0xF540:0C"], "entries": [
        {"entry": "0x6502", "default": 0x80}], "codes": {"aborts": {"0x06020000": "0x08000000"}}})
    _, differs = report_of("-b", network, "--profile", profile, "1")
    expect(differs == {"dict.objects", "dict.defaults", "abort.no-object"}, f"bridge: {differs}")


def check_cia402(folder):
    """A drive of another maker agrees; what it is not like is found; its own profile plays it again."""
    network = write(os.path.join(folder, "drive.yaml"), VIRTUAL + "axes: [{position: 1, device: cia402, unit: "
                    "{counts_per_unit: 10000}, drive: {counts_per_revolution: 131072, max_speed_rpm: 3000}}]\n")
    again = os.path.join(folder, "drive")
    report, differs = report_of("-b", network, "-o", again)
    expect(differs == set() and unknown(report) == {"esc.clock", "sii.contents"}, f"drive: {differs}, {unknown(report)}")
    second, differs = report_of("-b", network, "--profile", again + ".profile.json")
    expect(differs == set() and verdicts(second) == verdicts(report), f"its own profile: {differs}")
    profile = write(os.path.join(folder, "drive.json"), {"cm1e_profile": 1, "missing": ["0x60B8"], "entries": [
        {"entry": "0x6065", "default": 7}, {"entry": "0x6098", "type": 2, "bits": 8, "access": 7},
        {"entry": "0x1A01:00", "value": 2}]})
    report, differs = report_of("-b", network, "--profile", profile, "-o", again)
    expect(differs == {"dict.objects", "dict.defaults", "dict.access"}, f"another drive: {differs}")
    second, _ = report_of("-b", network, "--profile", again + ".profile.json")
    expect(verdicts(second) == verdicts(report), f"its profile plays another drive: {verdicts(second)}")


def check_motion(folder):
    """Every point with motion agrees, each homing method on a machine that has its switch in that direction."""
    home = {f"home.{method}" for method in range(-6, 0)}
    limits = ("--allow-motion", "--max-velocity", "2", "--max-travel", "6")
    for swap, nowhere in (("", {"home.-4", "home.-5"}),
                          (", sim: {sensor_input2_counts: -150000, sensor_input3_counts: 150000}",
                           {"home.-3", "home.-6"})):
        for firmware in ("1.2.0", "1.3.2", "1.3.5"):
            network = write(os.path.join(folder, "motion.yaml"),
                            VIRTUAL + f"axes: [{{position: 1, firmware: {firmware}{swap}}}]\n")
            report, differs = report_of("-b", network, *limits)
            expect(differs == set() and unknown(report) == {"esc.clock", "watchdog.motor"} | nowhere | other_cycles(firmware),
                   f"{firmware}{swap}: {differs}, {unknown(report)}")
    # Within a revolution there is neither stop nor switch; the motor is stopped there.
    report, differs = report_of("-b", SIM, "--allow-motion", "--max-velocity", "2", "--max-travel", "1")
    expect(differs == set() and unknown(report) == {"esc.clock", "watchdog.motor"} | home,
           f"within a revolution: {differs}, {unknown(report)}")
    network = write(os.path.join(folder, "bridge.yaml"), VIRTUAL + "axes: [{position: 1, channel: 1, k37: 10}]\n")
    report, differs = report_of("-b", network, *limits)
    expect(differs == set() and unknown(report) == {"esc.clock"} and {"move.csp", "home.1", "home.4"} <= set(
        verdicts(report)), f"a motor behind a bridge: {report['counts']}, {differs}, {unknown(report)}")


def check_interruption():
    """Ctrl-C in a slow move: the motor is disabled, nothing moves any more, and nothing counts as a difference."""
    program = subprocess.Popen([CM1E, "prove", "-i", "sim", "--json", "--point", "move.*", "--allow-motion",
                                "--max-velocity", "0.1", "--max-travel", "6"], stdout=subprocess.PIPE, text=True)
    time.sleep(4)
    program.send_signal(signal.SIGINT)
    report = json.loads(program.communicate(timeout=30)[0])
    told = verdicts(report)
    notes = {point["id"]: point["note"] for point in report["points"]}
    expect(program.returncode == 1 and told["move.enable"] == "agrees" and report["counts"]["differs"] == 0, f"{told}")
    expect(notes["move.csp"] == "the run was interrupted" and "told to end" in notes["move.pp"], f"{notes}")


def check_nohup():
    """A terminal that is closed ends nothing where its signal is ignored, as nohup does."""
    program = subprocess.Popen([CM1E, "prove", "-i", "sim", "--json", "--allow-writes"], stdout=subprocess.PIPE, text=True,
                               preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    while program.poll() is None:
        program.send_signal(signal.SIGHUP)
        time.sleep(0.05)
    out = program.communicate()[0]
    expect(program.returncode == 0 and "told to end" not in out, f"nohup: {program.returncode}")


def check_refusals(folder):
    for words, said in ((["-i", "sim", "--allow-motion"], "needs limits"),
                        (["-i", "sim", "--max-travel", "1"], "for --allow-motion"),
                        (["-i", "lo", "--profile", "x"], "for the simulated segment"),
                        (["-i", "sim", "9"], "no slave 9")):
        done = prove(*words)
        expect(done.returncode != 0 and said in done.stderr, f"{words}: {done}")
    for text, said in (("{", "file"), ('{"cm1e_profile": 2}', "device profile"),
                       ('{"cm1e_profile": 1, "entries": [{"entry": "6084"}]}', "0x6084:00"),
                       ('{"cm1e_profile": 1, "entries": [{"entry": "0x6084", "typ": 3}]}', "typ: expected"),
                       ('{"cm1e_profile": 1, "entries": [{"entry": "0x6084", "type": 3}]}', "together"),
                       ('{"cm1e_profile": 1, "entries": [{"entry": "0x-1"}]}', "0x6084:00"),
                       ('{"cm1e_profile": 1, "entries": [{"entry": "0x6084", "name": "%s"}]}' % (64 * "n"), "63 bytes"),
                       ('{"cm1e_profile": 1, "entries": [{"entry": "0x6098", "value": 300}]}', "-128 ... 127"),
                       ('{"cm1e_profile": 1, "entries": [{"entry": "0x6098", "type": 5, "bits": 8, "access": 63, "default": '
                        '-1}]}', "the default -1, which its type does not have: 0 ... 255"),
                       ('{"cm1e_profile": 1, "entries": [{"entry": "0x6084", "maximum": 4294967296}]}', "the maximum"),
                       ('{"cm1e_profile": 1, "codes": {"abort": {}}}', "aborts"),
                       ('{"cm1e_profile": 1, "codes": ["0x0011"]}', "aborts"),
                       ('{"cm1e_profile": 1, "codes": {"aborts": ["0x06070012"]}}', "pairs"),
                       ('{"cm1e_profile": 1, "codes": {"errors": {"0x4502": "0x70000"}}}', "0x0011"),
                       ('{"cm1e_profile": 1, "codes": {"al_status": {"0x0011": "-1"}}}', "0x0011"),
                       ('{"cm1e_profile": 1, "codes": {"aborts": {"0x106070012": "0x0"}}}', "0x06090031"),
                       ('{"cm1e_profile": 1, "sii": "4G"}', "hexadecimal"),
                       ('{"cm1e_profile": 1, "sii": "44"}', "bytes")):
        done = prove("-b", SIM, "--profile", write(os.path.join(folder, "bad.json"), text))
        expect(done.returncode == 1 and said in done.stderr, f"{text}: {done}")
    listed = prove("--list", "--json")
    expect(listed.returncode == 0 and len({point["id"] for point in json.loads(listed.stdout)}) > 60, f"{listed}")


def check_eeprom_and_damage(folder):
    """Both change the profile of a good device."""
    check_eeprom(folder)
    check_damage(folder)


def in_a_folder(check):
    with tempfile.TemporaryDirectory() as folder:
        check(folder)


with tempfile.TemporaryDirectory() as work:
    # No point but the clock of the controller needs real time.
    SIM = write(os.path.join(work, "virtual.yaml"), VIRTUAL + "axes: [{position: 1}]\n")
    real_time.together(check_interruption, check_nohup, *(lambda check=check: in_a_folder(check) for check in (
        check_motion, check_planted, check_agreement, check_eeprom_and_damage, check_bridge, check_cia402,
        check_refusals)))
