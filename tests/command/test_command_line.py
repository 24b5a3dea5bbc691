#!/usr/bin/env python3
"""The command `cm1e` and the examples as a user calls them, on the simulated segment: what is right works and can be
read by a program, what is wrong is refused with the exit status and the word that helps.

test_command_line.py BIN-DIRECTORY SOURCE-DIRECTORY
"""
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import real_time  # noqa: E402

BIN, SOURCE = sys.argv[1], sys.argv[2]
FAILED, WRONG_USE = 1, 2
BRIDGE = ["--device", "eb12", "--vendor", "0xAA77", "--product", "1", "--revision", "2"]
faults = []


def run(program, *words, stdin=""):
    return subprocess.run([os.path.join(BIN, program), *words], capture_output=True, text=True, timeout=60, input=stdin)


def expect(condition, what, result):
    if not condition:
        faults.append(f"{what}: exit status {result.returncode}\n{result.stdout}{result.stderr}")


def check_bridge_found(folder):
    """Two motors behind a bridge, a CM1-E before it; a bus file that expects another motor."""
    path = os.path.join(folder, "bridge.yaml")
    lines = ["axes:", "  - {position: 1}", "  - {position: 2, channel: 1, motor: CM1, k37: 10}",
             "  - {position: 2, channel: 4, motor: CM2, k37: 10}"]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    scan = run("cm1e", "scan", "-i", f"sim:{path}", "--json")
    bridge = {"model": "EB12", "motors": ["CM1", "CM1", "CM2", "CM2"]}
    expect([slave["bridge"] for slave in json.loads(scan.stdout)] == [None, bridge], "scan of a bridge", scan)
    table = run("cm1e", "scan", "-b", path, "-i", "sim")
    expect(table.returncode == 0 and "bridge EB12, motors CM1, CM1, CM2, CM2" in table.stdout, "scan of a bridge", table)
    other = os.path.join(folder, "other.yaml")
    with open(other, "w", encoding="utf-8") as file:
        file.write("\n".join(lines[:-1]).replace("CM1", "CM2") + "\n")
    wrong = run("cm1e", "scan", "-b", other, "-i", f"sim:{path}")
    expect(wrong.returncode == FAILED and "a CM1 there (object 0xF511:01)" in wrong.stderr, "another motor", wrong)


def check_good(folder):
    scan = run("cm1e", "scan", "-i", "sim", "--json")
    told = [(slave["vendor_id"], slave["software_version"]) for slave in json.loads(scan.stdout)]
    expect(told == [(0x4441, "1.3.5")], "scan", scan)
    bus = run("cm1e", "scan", "-i", "sim", "-b", f"{SOURCE}/examples/three_axes.yaml")
    expect(bus.returncode == 0 and bus.stdout.count("CM1-E") == 3, "scan of a bus file", bus)
    expect([line.split()[-1] for line in bus.stdout.splitlines()[:4]] == ["configured", "X", "Y", "Z"],
           "scan names the axes of the bus file", bus)
    machine = f"{SOURCE}/examples/machine.yaml"
    named = run("cm1e", "scan", "-i", "sim", "-b", machine, "--json")
    expect([slave["configured"] for slave in json.loads(named.stdout)] ==
           [[name] for name in ("coupler", "valves", "switches", "pressures", "set-points", "feed")], "scan names slaves",
           named)
    check_bridge_found(folder)
    status = run("cm1e", "status", "-i", "sim", "--json")
    expect(json.loads(status.stdout)[0]["dc_link_volt"] > 20, "status", status)
    for index, value in (("0x1018:1", 0x4441), ("0x6502", 0x1A5), ("0x607C", 0), ("0x60F6:1B", 30), ("60f6:1b", 30)):
        sdo = run("cm1e", "sdo", "-i", "sim", "--json", "read", "1", index)
        expect(json.loads(sdo.stdout)["value"] == value, f"sdo read {index}", sdo)
    text = run("cm1e", "sdo", "-i", "sim", "read", "1", "0x1008")
    expect(text.stdout == "CM1-E\n", "sdo read of a text", text)
    write = run("cm1e", "sdo", "-i", "sim", "write", "1", "0x607C", "-1200")
    expect(write.returncode == 0, "sdo write", write)
    for words in (["--", "1", "0x6098", "-1"], ["1", "--", "0x6098", "-1"], ["1", "0x6098", "--", "-1"]):
        write = run("cm1e", "sdo", "-i", "sim", "write", *words)
        expect(write.returncode == 0, f"sdo write {words}", write)
    svg, csv, pcap = (os.path.join(folder, name) for name in ("trace.svg", "trace.csv", "frames.pcap"))
    move = run("cm1e", "move", "-i", "sim", "--json", "--by", "-0.25", "--svg", svg, "--csv", csv, "--pcap", pcap)
    expect(move.returncode == 0 and json.loads(move.stdout)["done"], "move", move)
    xml.etree.ElementTree.parse(svg)
    with open(csv, encoding="utf-8") as file:
        expect(len(file.readlines()) > 100, "trace as CSV", move)
    expect(os.path.getsize(pcap) > 10000, "pcap", move)
    home = run("cm1e", "home", "-i", "sim", "--method", "-3", "--velocity", "5", "--acceleration", "90", "--position",
               "7.5", "--json")
    expect(home.returncode == 0 and abs(json.loads(home.stdout)["to"] - 7.5) < 0.01, "home", home)
    check_in_position(folder)
    sii = os.path.join(folder, "cm1e.sii")
    generate = run("cm1e", "generate", "sii", "-o", sii)
    expect(generate.returncode == 0 and os.path.getsize(sii) == 2048, "generate sii", generate)


def check_in_position(folder):
    """Done means that the motor is there; one that cannot get there is an error, in text, JSON and exit status."""
    bus = os.path.join(folder, "in_position.yaml")
    keys = {"host": "", "csv": "mapping: csv", "drive": "motion: drive", "turn": "unit: {modulo_range: 2}"}
    for name, key in keys.items():
        with open(bus, "w", encoding="utf-8") as file:
            file.write(f"bus: {{virtual_time: true}}\naxes: [{{name: a, {key}}}]\n")
        for words, target in ((["--by", "1"], 1), (["--by", "0.001"], 0.001), (["--to", "-1.5"], -1.5),
                              (["--speed", "2", "--for", "0.1"], None)):
            if (name, target) == ("turn", -1.5):
                words, target = ["--to", "1.9"], 1.9
            moved = run("cm1e", "move", "-i", "sim", "-b", bus, "--json", *words)
            shown = json.loads(moved.stdout)
            there = shown["done"] and abs(shown["deviation"]) <= 0.0002001
            expect(moved.returncode == 0 and there, "in position", moved)
            if target is not None:
                expect(abs(shown["to"] - target - shown["deviation"]) < 1e-9, "its target", moved)
        if name == "turn":
            continue
        stopped = run("cm1e", "move", "-i", "sim", "-b", bus, "--json", "--by", "5.4")
        shown = json.loads(stopped.stdout)
        expect(stopped.returncode == FAILED and not shown["done"] and shown["error"] and abs(shown["to"] - 5) < 0.01
               and abs(shown["deviation"] + 0.4) < 0.01, "against a stop", stopped)
    with open(bus, "w", encoding="utf-8") as file:
        file.write("bus: {virtual_time: true}\naxes: [{name: a, in_position: {timeout_s: 0.4}}]\n")
    stopped = run("cm1e", "move", "-i", "sim", "-b", bus, "--by", "5.4")
    for words in ("did not reach its set-point in time", "stood at 5.4 u", "at 5 u", "0.4 u below", "mechanical stop"):
        expect(stopped.returncode == FAILED and not stopped.stdout and words in stopped.stderr, words, stopped)
    text = run("cm1e", "move", "-b", bus, "--by", "0.5")
    expect("to 0.5, deviation 0 (simulated)\n" in text.stdout, "as text", text)
    turn = os.path.join(folder, "turn.yaml")
    with open(turn, "w", encoding="utf-8") as file:
        file.write("bus: {interface: sim, virtual_time: true}\naxes: [{name: T, unit: {modulo_range: 360, "
                   "units_per_revolution: 360}, sim: {no_stops: true}}]\n")
    text = run("cm1e", "move", "-b", turn, "--by", "360", "-v", "1000")
    expect("to 0, deviation 0 (simulated)\n" in text.stdout, "a whole turn", text)
    home = run("cm1e", "home", "-b", bus, "--method", "-3", "--position", "7.5", "--json")
    expect(home.returncode == 0 and abs(json.loads(home.stdout)["deviation"]) <= 0.0002001, "home", home)


def check_files(folder):
    """Each format is written, found without fault, and comes back from its reader as it was."""
    for name, words in (("flat", ["esi"]), ("mdp", ["esi", "--layout", "mdp", "--mapping", "csp", "--dc"]),
                        ("both", ["esi", "--firmware", "V1.2.0", "--device", "cm1-e"]),
                        ("trio", ["ec-extend", *BRIDGE, "--axes", "2", "--device", "cm1-e", "--mapping", "csp"]),
                        ("sii", ["sii", "--alias", "7", "--serial", "0x12"]),
                        ("eni", ["eni", "-b", f"{SOURCE}/examples/three_axes.yaml"])):
        path, again = os.path.join(folder, name), os.path.join(folder, f"{name}-again")
        written = run("cm1e", "generate", *words, "-o", path)
        expect(written.returncode == 0, f"generate {' '.join(words)}", written)
        checked = run("cm1e", "check", "--json", path)
        expect(checked.returncode == 0 and json.loads(checked.stdout)["findings"] == [], f"check of {name}", checked)
        anew = run("cm1e", "generate", words[0], "--from", path, "-o", again)
        expect(anew.returncode == 0, f"generate --from of {name}", anew)
        with open(path, "rb") as first, open(again, "rb") as second:
            expect(first.read() == second.read(), f"{name} comes back as it was", anew)
    check_networks(folder)
    image = run("cm1e", "generate", "sii", "--from", os.path.join(folder, "both"), "--number", "2", "-o",
                os.path.join(folder, "second.sii"))
    expect(image.returncode == 0, "SII of the second device of an ESI", image)
    shown = run("cm1e", "generate", "esi", "-o", "-")
    expect(shown.returncode == 0 and shown.stdout.startswith("<?xml"), "generate to standard output", shown)
    expect("EEPROM" in shown.stderr, "generate esi warns of the EEPROM", shown)

    check_configuration_words(folder)
    check_hostile_names(folder)
    check_lost_output(folder)
    check_kept_files(folder)
    check_dictionary()
    check_cml(folder)
    check_sii(folder)
    check_diff(folder)


def check_configuration_words(folder):
    """Words of another device, or damaged ones, can make a device unreachable."""
    image, other = os.path.join(folder, "words.sii"), os.path.join(folder, "other.sii")
    run("cm1e", "generate", "sii", "-o", image)
    with open(image, "rb") as file:
        good = bytearray(file.read())
    for at, word in ((0, "checksum"), (0x10, "vendor"), (0x14, "product")):
        wrong = bytearray(good)
        wrong[at] ^= 1
        with open(other, "wb") as file:
            file.write(wrong)
        refused = run("cm1e", "generate", "esi", "--config-data", other, "-o", "-")
        expect(refused.returncode == WRONG_USE and word in refused.stderr, f"words of an image with a wrong {word}",
               refused)
    taken = run("cm1e", "generate", "esi", "--config-data", image, "-o", "-")
    expect(taken.returncode == 0, "words of an image", taken)


def check_hostile_names(folder):
    """Names out of a file never act on a terminal, and JSON stays JSON; names of files that are no UTF-8, too."""
    good = run("cm1e", "generate", "esi", "-o", "-").stdout
    hostile = good.replace("<Type>UINT</Type>", "<Type>A\u009b31mB\nC\u202eD&#10;E</Type>")
    path = os.path.join(os.fsencode(folder), b"hostile-\xe9.xml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(hostile)
    plain, as_json = (subprocess.run([os.path.join(BIN, "cm1e"), "check", *words, path], capture_output=True,
                                     timeout=60) for words in ([], ["--json"]))
    expect(plain.returncode == FAILED and b"A?31mB?C?D?E" in plain.stdout
           and not any(mark.encode() in plain.stdout for mark in "\u009b\u202e\x1b"), "hostile names", plain)
    findings = json.loads(as_json.stdout or b"{}").get("findings", [])
    expect(len(findings) > 0 and len(findings) == plain.stdout.count(b" [type-unknown]\n")
           + plain.stdout.count(b" [pdo-"), "hostile names as JSON", as_json)


def check_diff_of_network(folder):
    """An ENI is of a whole network: slaves that are missing, or too many, are a difference."""
    three, one = (["-b", in_virtual_time(folder, "three_axes.yaml"), "-i", "sim"], ["-i", "sim"])
    for network, other, wanted, word in ((three, three, 0, ""), (one, one, 0, ""),
                                         (three, one, 2, "network ends with slave 1"),
                                         (one, three, 1, "ends with this slave, number 1")):
        path = os.path.join(folder, "network.eni")
        run("cm1e", "generate", "eni", *network, "-o", path)
        result = run("cm1e", "diff", path, *other, "--json")
        texts = [(finding["line"], finding["text"]) for slave in json.loads(result.stdout or "[]")
                 for finding in slave["findings"] if finding["rule"] == "differs"]
        expect(result.returncode == (FAILED if wanted else 0) and len(texts) == wanted
               and all(line > 0 and word in text for line, text in texts), f"diff of an ENI: {word}", result)


def check_kept_files(folder):
    """A file that is written again keeps its rights, a link stays a link, and no other file is touched."""
    path, link, beside = (os.path.join(folder, name) for name in ("kept.sii", "link.sii", "kept.sii.part"))
    with open(beside, "w", encoding="utf-8") as file:
        file.write("of somebody else")
    for name in (path, link):
        written = run("cm1e", "generate", "sii", "--serial", "5", "-o", name)
        expect(written.returncode == 0 and os.path.getsize(path) == 2048, f"writing {name}", written)
        if name == path:
            os.chmod(path, 0o640)
            os.truncate(path, 7)
            os.symlink(path, link)
    with open(beside, encoding="utf-8") as file:
        expect(file.read() == "of somebody else" and os.path.islink(link) and os.stat(path).st_mode & 0o777 == 0o640
               and sorted(name for name in os.listdir(folder) if name.startswith("kept")) ==
               ["kept.sii", "kept.sii.part"], "files beside, links and rights", written)


def check_lost_output(folder):
    """What does not arrive is no success."""
    path = os.path.join(folder, "lost.sii")
    run("cm1e", "generate", "sii", "-o", path)
    for words in (["check", path], ["check", "--json", path], ["sii", "decode", path], ["generate", "sii", "-o", "-"],
                  ["--version"], ["--help"], ["move", "--help"], ["sdo", "--usage"]):
        with open("/dev/full", "wb") as full:
            lost = subprocess.run([os.path.join(BIN, "cm1e"), *words], stdout=full, stderr=subprocess.PIPE, text=True,
                                  timeout=60)
        expect(lost.returncode == FAILED and "standard output" in lost.stderr, f"lost output of {words[0]}",
               subprocess.CompletedProcess(words, lost.returncode, "", lost.stderr))


def check_diff(folder):
    image = os.path.join(folder, "diff.sii")
    run("cm1e", "sii", "-i", "sim", "read", "1", image)
    same = run("cm1e", "diff", image, "-i", "sim")
    expect(same.returncode == 0 and "beside slave 1, 0 errors" in same.stdout, "diff of the same", same)
    network = in_virtual_time(folder, "three_axes.yaml")
    three = run("cm1e", "diff", image, "-b", network, "-i", "sim")
    expect(three.returncode == 0 and "beside slave 3" in three.stdout, "diff of three axes", three)
    told = run("cm1e", "diff", image, "-b", network, "-i", "sim", "--json")
    expect([slave["position"] for slave in json.loads(told.stdout)] == [1, 2, 3], "diff of three axes as JSON", told)
    check_diff_of_network(folder)
    with open(image, "r+b") as file:
        file.seek(2 * 0x0C)
        file.write(b"\x99")
    other = run("cm1e", "diff", image, "-i", "sim", "-p", "1", "--json")
    expect(other.returncode == FAILED and "differs-identity" in [finding["rule"] for finding in
                                                                  json.loads(other.stdout)[0]["findings"]],
           "diff of another revision", other)
    with open(image, "r+b") as file:
        file.seek(2 * 0x0A)
        file.write(b"\x99")
    none = run("cm1e", "diff", image, "-i", "sim")
    expect(none.returncode == WRONG_USE and "does not describe any slave" in none.stderr, "diff of another product", none)


def check_dictionary():
    told = run("cm1e", "sdo", "-i", "sim", "list", "1", "--values", "--json")
    objects = {entry["index"]: entry for entry in json.loads(told.stdout)}
    expect(len(objects) > 40 and objects[0x1018]["entries"][2]["value"] == 0x44412002, "sdo list --json", told)
    control = objects[0x6040]["entries"][0]
    expect(control["type"] == "UINT" and control["write"] and control["rxpdo"] and not control["txpdo"],
           "0x6040 in sdo list", told)
    text = run("cm1e", "sdo", "-i", "sim", "list", "1")
    expect(text.returncode == 0 and "0x6064  VAR" in text.stdout and " = " not in text.stdout, "sdo list", text)


NETWORK_WITH_BRIDGE = """bus: {interface: sim, virtual_time: true}
axes:
  - {name: solo, position: 1}
  - {name: left, position: 2, channel: 1, motor: CM1, k37: 10}
  - {name: up, position: 2, channel: 3, motor: CM2, k37: 10}
"""


def check_cml(folder):
    """Strings to motors behind a bridge, named by axis, by connector or in the string; what may move one is refused."""
    bus = os.path.join(folder, "bridge.yaml")
    with open(bus, "w", encoding="utf-8") as file:
        file.write(NETWORK_WITH_BRIDGE)
    cml = lambda *words, **more: run("cm1e", "cml", "-b", bus, *words, **more)
    state = cml("?99.3")
    expect(state.returncode == 0 and state.stdout == "Ux.3=16  motor free\n", "cml ?99.3", state)
    kept = cml("-a", "left", "K53", "K53=77", "K53,?96", "O2")
    expect(kept.returncode == 0 and kept.stdout == "K53.1=0\nsent\nK53.1=77\nPx.1=0\nsent\n", "cml of an axis", kept)
    listed = cml("--channel", "3", "--json", "?90")
    lines = json.loads(listed.stdout)[0]["lines"]
    expect(lines[0] == "K21.3=0" and lines[-1] == "K82.3=0" and "K37.3=10" in lines, "cml ?90", listed)
    moved = cml("--allow-motion", "(.1", "|.1", ").1", "?99.1", "--json")
    answers = json.loads(moved.stdout)
    expect(moved.returncode == 0 and answers[1]["lines"] == ["Origin.1=0"] and answers[3]["state"] == "motor free",
           "cml with motion", moved)
    several = cml("--slave", "2", stdin="?99.1\n\n^.1\nK37.3\n")
    expect(several.returncode == FAILED and several.stdout == "Ux.1=8  in position\nK37.3=10\n" and
           "--allow-motion" in several.stderr and "cml>" not in several.stdout, "cml line by line", several)
    told = cml("--json", stdin="?99.1\n*\n^.1\n?99.3")
    objects = [json.loads(part + "}") for part in told.stdout.split("}\n") if part]
    expect([entry["lines"] for entry in objects] == [["Ux.1=8"], [], ["Ux.3=16"]] and
           "may move" in objects[1]["error"] and "names no connector" in told.stderr, "cml line by line as JSON", told)
    cut = cml("-a", "left", stdin="(\0?99\n?99\n")
    expect(cut.returncode == WRONG_USE and cut.stdout == "Ux.1=8  in position\n" and "byte 0" in cut.stderr,
           "a line with a byte 0", cut)
    late = cml("--timeout", "0.05", "?1234.1")
    expect(late.returncode == FAILED and "within 50 ms" in late.stderr, "cml without an answer", late)
    for words, status, word in (
            (["?99"], WRONG_USE, "--channel"), (["?99.9"], WRONG_USE, "1 ... 4"), (["-a", "solo", "?99"], WRONG_USE, "CM1-E"),
            (["-a", "left", "?99.3"], WRONG_USE, "another motor"), (["--slave", "1", "?99.1"], WRONG_USE, "no EtherCAT Cool"),
            (["--slave", "9", "?99.1"], FAILED, "no slave 9"),
            (["-a", "left", "--slave", "2", "?99"], WRONG_USE, "--axis"),
            (["-a", "left", ""], WRONG_USE, "is empty"), (["-a", "left", "K53="], WRONG_USE, "cut off"),
            (["-a", "left", "K53\r\n"], WRONG_USE, "CR or LF"), (["-a", "left", "?" * 65], WRONG_USE, "64 bytes"),
            (["hello\x1b.1"], WRONG_USE, "hello?.1"), (["-a", "left", "\x1b[2J"], WRONG_USE, "printable"),
            (["(.1"], WRONG_USE, "--allow-motion"),
            (["K37.1=30"], WRONG_USE, "--allow-motion"), (["--channel", "5", "?99"], WRONG_USE, "1 ... 4"),
            (["--timeout", "0", "?99.1"], WRONG_USE, "above 0"), (["-a", "middle", "?99"], WRONG_USE, "no axis")):
        refused = cml(*words)
        expect(refused.returncode == status and word in refused.stderr and refused.stdout == "" and
               "\x1b" not in refused.stderr, f"cml {words}: \"{word}\"", refused)
    with open(bus, "w", encoding="utf-8") as file:
        file.write(NETWORK_WITH_BRIDGE.replace("virtual_time: true", "virtual_time: false"))
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT):
        check_cml_ended(bus, number)
    none = run("cm1e", "cml", "-i", "sim", "?99.1")
    expect(none.returncode == FAILED and "no EtherCAT Cool MUSCLE Bridge" in none.stderr, "cml without a bridge", none)


def check_cml_ended(bus, number):
    """A signal in the middle of a search, also that of a terminal that is gone: the motor is freed before the end."""
    command = [os.path.join(BIN, "cm1e"), "cml", "-b", bus, "--allow-motion"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True) as cml:
        cml.stdin.write("(.3\n|.3\n")
        cml.stdin.flush()
        cml.stdout.readline() # "sent": the motor is enabled, the search begins
        time.sleep(0.1)
        cml.send_signal(number)
        output, complaint = cml.communicate(timeout=30)
    ended = subprocess.CompletedProcess(command, cml.returncode, output, complaint)
    expect(cml.returncode == FAILED and '"|.3" was cancelled' in complaint, f"cml ended by {number.name}", ended)


def check_sii(folder):
    image, backup = os.path.join(folder, "slave.sii"), os.path.join(folder, "backup.sii")
    read = run("cm1e", "sii", "-i", "sim", "read", "1", image)
    expect(read.returncode == 0 and os.path.getsize(image) == 2048, "sii read", read)
    write = run("cm1e", "sii", "-i", "sim", "write", "1", image, "--backup", backup)
    expect(write.returncode == 0 and "off and on" in write.stdout, "sii write", write)
    with open(image, "rb") as old, open(backup, "rb") as new:
        expect(old.read() == new.read(), "the backup of sii write", write)
    again = run("cm1e", "sii", "-i", "sim", "write", "1", image, "--backup", backup)
    expect(again.returncode == FAILED and "exists" in again.stderr, "sii write over a backup", again)
    os.remove(backup)
    with open(image, "r+b") as file:
        file.seek(14)
        file.write(b"\x00")
    wrong = run("cm1e", "sii", "-i", "sim", "write", "1", image, "--backup", backup)
    expect(wrong.returncode == FAILED and "checksum" in wrong.stderr and not os.path.exists(backup),
           "sii write of a wrong checksum", wrong)
    forced = run("cm1e", "sii", "-i", "sim", "write", "1", image, "--backup", backup, "--force-checksum", "--json")
    expect(forced.returncode == 0 and json.loads(forced.stdout)["backup"] == backup, "sii write, forced", forced)


def check_networks(folder):
    """The ENI of a network that was scanned is that of its bus file, in both orders of the mappings; one with a device
    of another kind between the motors needs the scan."""
    with open(f"{SOURCE}/examples/three_axes.yaml", encoding="utf-8") as file:
        text = file.read()
    for order in ("ug_4_4", "ug_7_2"):
        bus = os.path.join(folder, f"{order}.yaml")
        with open(bus, "w", encoding="utf-8") as file:
            file.write(text.replace("bus:\n", f"bus:\n  virtual_time: true\n  sim_pdo_order: {order}\n", 1))
        configured = run("cm1e", "generate", "eni", "-b", bus, "-o", "-")
        scanned = run("cm1e", "generate", "eni", "-b", bus, "-i", "sim", "-o", "-")
        expect(configured.returncode == 0 and configured.stdout == scanned.stdout, f"ENI of a scan, {order}", scanned)
    gap = os.path.join(folder, "gap.yaml")
    with open(gap, "w", encoding="utf-8") as file:
        file.write(text.replace("bus:\n", "bus:\n  virtual_time: true\n", 1).replace("position: 3", "position: 5"))
    refused = run("cm1e", "generate", "eni", "-b", gap, "-o", "-")
    expect(refused.returncode == WRONG_USE and "scan" in refused.stderr, "ENI of a bus file with gaps", refused)
    path = os.path.join(folder, "gap.eni")
    mixed = run("cm1e", "generate", "eni", "-b", gap, "-i", "sim", "-o", path)
    expect(mixed.returncode == 0, "ENI of a network with other devices", mixed)
    checked = run("cm1e", "check", path)
    expect(checked.returncode == 0 and "0 errors, 0 warnings" in checked.stdout, "check of it", checked)
    beside = run("cm1e", "diff", path, "-b", gap, "-i", "sim")
    expect(beside.returncode == 0, "diff of it", beside)
    plain = run("cm1e", "generate", "eni", "-i", "sim", "--mapping", "csp", "-o", "-")
    expect(plain.returncode == 0 and "<Pdo>5633</Pdo>" in plain.stdout, "ENI of a scan with a mapping", plain)


def check_no_motor(folder):
    """A network of a coupler alone: it is scanned and shown, and what is no motor is called so."""
    bus = os.path.join(folder, "coupler.yaml")
    with open(bus, "w", encoding="utf-8") as file:
        file.write("bus: {sim_gaps: coupler, virtual_time: true}\naxes: [{type: virtual}]\n")
    status = run("cm1e", "status", "-b", bus)
    expect(status.returncode == 0 and status.stdout == "slave 1: Coupler, no motor, Pre-Operational\n"
           "simulated network: no real device\n", "no motor", status)
    status = run("cm1e", "status", "-b", bus, "--json")
    expect(json.loads(status.stdout) == [{"position": 1, "name": "Coupler", "firmware": "", "is_motor": False,
                                          "al_state": "Pre-Operational", "emergencies": []}], "no motor", status)
    with open(bus, "w", encoding="utf-8") as file:
        file.write("bus: {sim_gaps: terminal, virtual_time: true}\naxes: [{position: 2}]\n")
    status = run("cm1e", "status", "-b", bus)
    expect(status.stdout.startswith("slave 1: Digital terminal 4+4, no motor, Pre-Operational\nslave 2, axis "
                                    "axis1: CM1-E, firmware"),
           "a motor behind a terminal", status)
    move = run("cm1e", "move", "-b", bus, "--by", "1", "--json")
    expect(move.returncode == 0 and json.loads(move.stdout)["done"], "a motor behind device emulation", move)


BRIDGED = """\
bus:
  interface: sim
  virtual_time: true
axes:
  - {name: first, position: 1}
  - {name: left, position: 2, channel: 1, motor: CM1, k37: 10}
  - {name: lift, position: 2, channel: 3, motor: CM2, k37: 3}
"""


def check_bridge(folder):
    """A bridge behind a motor: its axes by name, its objects by the bridge's dictionary, one slave in the ENI."""
    bus = os.path.join(folder, "bridge.yaml")
    with open(bus, "w", encoding="utf-8") as file:
        file.write(BRIDGED)
    status = run("cm1e", "status", "-b", bus, "--json")
    drives = json.loads(status.stdout)
    expect(len(drives) == 2 and "dc_link_volt" in drives[0] and drives[1]["bridge"] == "EB12", "status", status)
    motors = drives[1]["motors"]
    expect([motor["axis"] for motor in motors] == ["left", None, "lift", None], "axes of a bridge", status)
    expect([motor["status_text"] for motor in motors] == ["in position"] * 2 + ["motor free"] * 2, "words", status)
    # They are asked some milliseconds after the power-on of the simulated bridge, while it initialises them.
    initialising = ("Not ready to switch on", "Switch on disabled")
    expect(all(motor["state"] in initialising and motor["mode_name"] == "csp" for motor in motors), "states", status)
    table = run("cm1e", "scan", "-b", bus).stdout.splitlines()
    starts = {line.find("0x") for line in table[1:] if line[:3].strip().isdigit()}
    expect(starts == {table[0].find("vendor")}, f"columns of a scan with a long name: {table}", status)
    text = run("cm1e", "status", "-b", bus)
    expect("motor 3: CM2, axis \"lift\"" in text.stdout and "176800 bit/s, every 1 ms" in text.stdout, "status", text)
    k24 = run("cm1e", "sdo", "-b", bus, "read", "2", "0x70F6:4", "--json")
    expect(json.loads(k24.stdout)["name"] == "K24" and json.loads(k24.stdout)["type"] == "DINT", "sdo read", k24)
    for index, mark in (("0x603F", '"N/A"'), ("0x60F6:42", '"-"')):
        refused = run("cm1e", "sdo", "-b", bus, "read", "2", index)
        expect(refused.returncode == FAILED and f"marked {mark} in the guide" in refused.stderr, index, refused)
    objects = json.loads(run("cm1e", "sdo", "-b", bus, "list", "2", "--json").stdout)
    marks = {(row["index"], entry["subindex"]): entry.get("availability") for row in objects for entry in row["entries"]}
    expect((marks[0x603F, 0], marks[0x60F6, 42], marks[0x6041, 0]) == ("N/A", "-", None), "sdo list", text)
    move = run("cm1e", "move", "-b", bus, "left", "--by", "0.5", "--json")
    expect(move.returncode == 0 and json.loads(move.stdout)["axis"] == "left", "move behind a bridge", move)
    check_unknown_bridge(folder, bus)
    check_unknown_servo_drive(folder)
    refused = run("cm1e", "generate", "eni", "-b", bus, "-o", "-")
    expect(refused.returncode == WRONG_USE and "left, lift: it is behind a bridge" in refused.stderr, "ENI", refused)
    configured = run("cm1e", "generate", "eni", "-b", bus, "-o", "-", "--device", "eb12", "--vendor", "0xAA77",
                     "--product", "0xEB12", "--revision", "0x10000")
    path = os.path.join(folder, "bridge.eni")
    scanned = run("cm1e", "generate", "eni", "-b", bus, "-i", "sim", "-o", path)
    with open(path, encoding="utf-8") as file:
        expect(configured.returncode == scanned.returncode == 0 and configured.stdout == file.read(), "ENI of a scan",
               configured)
    expect(run("cm1e", "check", path).returncode == 0, "check of it", scanned)
    beside = run("cm1e", "diff", path, "-b", bus)
    expect(beside.returncode == 0 and "slave 2, 0 errors, 0 warnings" in beside.stdout, "diff of it", beside)


def check_unknown_bridge(folder, bus):
    """Without a bus file nothing is guessed; the one that is printed holds when K37 is filled in."""
    refused = run("cm1e", "move", "-i", f"sim:{bus}", "--by", "1")
    expect(refused.returncode == FAILED and f"cm1e cml -i sim:{bus} --slave 2 \"K37.3\"" in refused.stderr,
           "move without a bus file", refused)
    printed = refused.stderr[refused.stderr.index("bus:\n"):]
    path = os.path.join(folder, "printed.yaml")
    for text, status in ((printed, WRONG_USE), (re.sub(r"ANSWER-TO-K37\.\d", "10", printed), 0)):
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        scan = run("cm1e", "scan", "-b", path)
        expect(scan.returncode == status and (status == 0 or "k37" in scan.stderr), "the printed bus file", scan)


def check_unknown_servo_drive(folder):
    """A drive of another maker is not skipped in silence, and the printed bus file holds when it is filled in."""
    refused = run("cm1e", "move", "-i", f"sim:{SOURCE}/examples/cia402.yaml", "--by", "1")
    expect(refused.returncode == FAILED and "slave 1 is a CiA 402 servo drive" in refused.stderr,
           "move of a servo drive without a bus file", refused)
    printed = refused.stderr[refused.stderr.index("bus:\n"):]
    expect(printed.count("device: cia402") == 3, "the printed bus file", refused)
    path = os.path.join(folder, "printed.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(printed.replace("COUNTS", "131072").replace("SPEED", "3000"))
    moved = run("cm1e", "move", "-b", path, "axis2", "--by", "1")
    expect(moved.returncode == 0 and "done" in moved.stdout, "move with the printed bus file", moved)


def in_virtual_time(folder, name):
    """A bus file of examples/ that does not wait."""
    path = os.path.join(folder, f"virtual_{name}")
    with open(f"{SOURCE}/examples/{name}", encoding="utf-8") as real, open(path, "w", encoding="utf-8") as file:
        file.write(real.read().replace("bus:\n", "bus:\n  virtual_time: true\n", 1))
    return path


def check_examples(folder):
    plc = ["03_plc_program", "--seconds", "6", "-b"]
    for words in (["01_scan"], ["02_move_one_axis"],
                  [*plc, in_virtual_time(folder, "three_axes.yaml"), "--svg", os.path.join(folder, "example.svg")],
                  [*plc, in_virtual_time(folder, "cia402.yaml")]):
        example = run(*words)
        expect(example.returncode == 0, " ".join(words), example)
    xml.etree.ElementTree.parse(os.path.join(folder, "example.svg"))


# Wrong use: words, exit status, and what the complaint must contain.
WRONG = [
    ([], WRONG_USE, "Usage"),
    (["fly"], WRONG_USE, "fly"),
    (["scan"], WRONG_USE, "-i"),
    (["scan", "-i", "no-such-interface"], FAILED, "no-such-interface"),
    (["scan", "-b", "no-such-file.yaml"], WRONG_USE, "no-such-file.yaml"),
    (["scan", "-i", "x" * 100], WRONG_USE, "too long"),
    (["scan", "-i", "sim:no-such-file.yaml"], WRONG_USE, "no-such-file.yaml"),
    (["sdo", "-i", "sim", "read"], WRONG_USE, "read POSITION"),
    (["sdo", "-i", "sim", "list"], WRONG_USE, "read POSITION"),
    (["sdo", "-i", "sim", "list", "2"], FAILED, "no slave 2"),
    (["sdo", "-i", "sim", "read", "1", "0x99999"], WRONG_USE, "index"),
    (["sdo", "-i", "sim", "read", "2", "0x1008"], FAILED, "no slave 2"),
    (["sdo", "-i", "sim", "read", "1", "0x5555"], FAILED, "does not exist"),
    (["sdo", "-i", "sim", "write", "1", "0x6041", "0"], FAILED, "0x6041"),
    (["sdo", "-i", "sim", "write", "1", "0x607C", "99999999999"], WRONG_USE, "expected"),
    (["sdo", "-i", "sim", "write", "1", "0x6099:1", "999999"], FAILED, "0x6099"),
    (["sdo", "-i", "sim", "write", "1", "0x5555", "1"], WRONG_USE, "--type"),
    (["move", "-i", "sim"], WRONG_USE, "--to"),
    (["move", "-i", "sim", "--to", "nan"], WRONG_USE, "number"),
    (["move", "-i", "sim", "--to", "1", "--by", "1"], WRONG_USE, "exclude"),
    (["move", "-i", "sim", "--speed", "1"], WRONG_USE, "--for"),
    (["move", "-i", "sim", "2", "--by", "1"], WRONG_USE, "no axis"),
    (["move", "-i", "sim", "--by", "1", "--velocity", "1000"], FAILED, "up to 50 u/s"),
    (["move", "-i", "sim", "--by", "1", "--acceleration", "-1"], WRONG_USE, "above 0"),
    (["move", "-i", "sim", "-b", f"{SOURCE}/examples/three_axes.yaml", "Y", "--to", "1000"], FAILED,
     "limits -20 ... 70"),
    (["home", "-i", "sim", "--method", "-7"], WRONG_USE, "method"),
    (["home", "-i", "sim", "--method", "0"], WRONG_USE, "method"),
    (["home", "-i", "sim", "--method", "-2", "--velocity", "100"], FAILED, "homing parameter"),
    # What is given beside the bus file's method counts: it was ignored once, torque and all.
    (["home", "-i", "sim", "-b", f"{SOURCE}/examples/three_axes.yaml", "X", "--torque", "5"], WRONG_USE, "10 ... 100"),
    (["home", "-i", "sim", "-b", f"{SOURCE}/examples/three_axes.yaml", "X", "--for", "0.5"], FAILED, "in time"),
    (["home", "-i", "sim", "-b", f"{SOURCE}/examples/three_axes.yaml", "X", "--offset", "1e9"], FAILED,
     "homing.offset"),
    (["home", "-i", "sim", "-b", f"{SOURCE}/examples/bridge.yaml", "lift", "--acceleration", "1e9"], FAILED,
     "homing.acceleration"),
    (["sim"], WRONG_USE, "-i"),
    (["sim", "-i", "no-such-interface"], FAILED, "no-such-interface"),
    (["sim", "-i", "lo", "--pdo-order", "up"], WRONG_USE, "ug-4.4"),
    (["cml", "?99.1"], WRONG_USE, "-i"),
    (["sii", "-i", "sim"], WRONG_USE, "read POSITION|AXIS FILE"),
    (["sii", "-i", "sim", "read", "0", "x"], WRONG_USE, "position"),
    (["sii", "-i", "sim", "read", "2", "x"], FAILED, "no slave 2"),
    (["sii", "-i", "sim", "read", "1", "/no/such/folder/x"], FAILED, "/no/such/folder"),
    (["sii", "-i", "sim", "write", "1", "x"], WRONG_USE, "--backup"),
    (["sii", "-i", "sim", "write", "1", f"{SOURCE}/README.md", "--backup", "/no/such/folder/x"], FAILED, "backup"),
    (["sii", "read", "1", "x"], WRONG_USE, "-i"),
    (["sii", "decode", "no-such-file"], WRONG_USE, "no-such-file"),
    (["sim", "-i", "lo", "--sii", "no-such-file"], WRONG_USE, "no-such-file"),
    (["sim", "-i", "lo", "--sii", f"{SOURCE}/README.md"], FAILED, "is damaged at byte 0x000E"),
    (["sii", "decode", f"{SOURCE}/README.md"], FAILED, ""),
    (["diff", "-i", "sim"], WRONG_USE, "which file"),
    (["diff", f"{SOURCE}/README.md"], WRONG_USE, "-i"),
    (["diff", f"{SOURCE}/README.md", "-i", "sim"], WRONG_USE, "known format"),
    (["diff", f"{SOURCE}/README.md", "-i", "sim", "-p", "2"], WRONG_USE, "no slave 2"),
    (["diff", "no-such-file", "-i", "sim"], WRONG_USE, "no-such-file"),
    (["generate", "-o", "x"], WRONG_USE, "eni"),
    (["generate", "edf", "-o", "x"], WRONG_USE, "ec-extend"),
    (["generate", "esi", "sii", "-o", "x"], WRONG_USE, "sii"),
    (["generate", "sii"], WRONG_USE, "-o"),
    (["generate", "esi", "-o", "x", "--layout", "round"], WRONG_USE, "mdp"),
    (["generate", "esi", "-o", "x", "--device", "cm2"], WRONG_USE, "eb12"),
    (["generate", "esi", "-o", "x", "--device", "eb12"], WRONG_USE, "vendor"),
    (["generate", "esi", "-o", "x", "--firmware", "1.3.5", *BRIDGE], WRONG_USE, "vendor"),
    (["generate", "esi", "-o", "x", "--mapping", "fast"], WRONG_USE, "profile"),
    (["generate", "esi", "-o", "x", "--config-data", SOURCE], WRONG_USE, "folder"),
    (["generate", "esi", "-o", "x", "--config-data", f"{SOURCE}/README.md"], WRONG_USE, "not an SII image"),
    (["generate", "esi", "-o", ""], WRONG_USE, "the output is missing"),
    (["generate", "esi", "-o", "x", *BRIDGE[:2], "--vendor", "-1"], WRONG_USE, "the vendor ID"),
    (["generate", "sii", "-o", "x", "--layout", "mdp"], WRONG_USE, "--layout is only for esi"),
    (["generate", "esi", "-o", "x", "--alias", "7"], WRONG_USE, "--alias is only for sii"),
    (["generate", "esi", "-o", "x", "--dc-mode", "7"], WRONG_USE, "--dc-mode is only for ec-extend"),
    (["generate", "esi", "-o", "x", "--from", "y", "--layout", "mdp"], WRONG_USE, "--layout"),
    (["generate", "sii", "-o", "x", "--number", "2"], WRONG_USE, "--number is only for --from"),
    (["generate", "esi", "-o", "x", "-i", "sim"], WRONG_USE, "ENI"),
    (["generate", "esi", "-o", "x", "--program", "y"], WRONG_USE, "ec-extend"),
    (["generate", "sii", "-o", "x", "--device", "cm1-e", "--device", "cm1-e"], WRONG_USE, "one device"),
    (["generate", "esi", "-o", "x", "--device", "cm1-e", "--device", "cm1-e", "--mapping", "csp"], WRONG_USE,
     "the same product"),
    (["generate", "ec-extend", "-o", "x", "--program", "x"], WRONG_USE, "same file"),
    (["generate", "ec-extend", "-o", "never", "--mapping", "csv", "--program", "y"], WRONG_USE, "dynamic or csp"),
    (["generate", "sii", "-o", "x", "--number", "2", "--from", f"{SOURCE}/tests/golden/esi-cm1e-1.3.5-flat.xml"],
     WRONG_USE, "no device 2"),
    (["generate", "eni", "-o", "x"], WRONG_USE, "network"),
    (["generate", "eni", "-o", "x", "-b", f"{SOURCE}/examples/three_axes.yaml", "--mapping", "csp"], WRONG_USE,
     "bus file"),
    (["generate", "eni", "-o", "x", "-b", "/no/such/file"], WRONG_USE, "/no/such/file"),
    (["generate", "eni", "-o", "x", "-i", "sim", "--device", "eb01"], WRONG_USE, "network"),
    (["generate", "eni", "-o", "x", "-b", f"{SOURCE}/examples/three_axes.yaml", "--vendor", "1"], WRONG_USE,
     "identity of its bridges"),
    (["generate", "esi", "-o", "x", "--from", "/no/such/file"], WRONG_USE, "/no/such/file"),
    (["generate", "esi", "-o", "x", "--from", f"{SOURCE}/README.md"], FAILED, "no file of a known format"),
    (["check"], WRONG_USE, "which file"),
    (["check", "a", "b"], WRONG_USE, "one file"),
    (["check", "/no/such/file"], WRONG_USE, "/no/such/file"),
    (["check", SOURCE], WRONG_USE, "folder"),
    (["check", f"{SOURCE}/README.md"], FAILED, "EtherCATInfo"),
    (["generate", "sii", "-o", "/no/such/folder/x"], FAILED, "/no/such/folder"),
    (["generate", "sii", "-o", "x", "--firmware", "9.9"], WRONG_USE, "1.3.5"),
]


def check_wrong():
    """Nor is anything written then."""
    for words, status, word in WRONG:
        result = run("cm1e", *words)
        expect(result.returncode == status and word in result.stderr,
               f"cm1e {' '.join(words)[:80]}: expected exit status {status} and \"{word}\"", result)
    if os.path.exists("never"):
        faults.append("a file was written although its program was refused")


MIXED = """\
bus:
  interface: sim
  virtual_time: true
axes:
  - {name: line, type: virtual}
  - {name: X}
  - {name: wheel, type: encoder}
  - {name: Y}
"""


def check_axes_without_a_motor(folder):
    """Axes without a motor have no place on the bus: what goes to slaves leaves them out, or says so."""
    bus, motors, empty = (os.path.join(folder, f"{name}.yaml") for name in ("mixed", "motors", "empty"))
    for path, text in ((bus, MIXED), (motors, "".join(line for line in MIXED.splitlines(True) if "type" not in line)),
                       (empty, MIXED.split("  - {name: X}")[0])):
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    for words in (["scan"], ["status"]):
        mixed = run("cm1e", *words, "-b", bus, "-i", "sim")
        plain = run("cm1e", *words, "-b", motors, "-i", "sim")
        expect(mixed.returncode == 0 and mixed.stdout == plain.stdout, f"{words[0]} beside virtual axes", mixed)
    for words in (["generate", "eni", "-o", "-"], ["generate", "eni", "-o", "-", "-i", "sim"]):
        mixed = run("cm1e", *words, "-b", bus)
        expect(mixed.returncode == 0 and mixed.stdout == run("cm1e", *words, "-b", motors).stdout,
               "ENI beside virtual axes", mixed)
    moved = run("cm1e", "move", "-b", bus, "-i", "sim", "Y", "--by", "1")
    expect(moved.returncode == 0 and "Y: move done" in moved.stdout, "move beside virtual axes", moved)
    for words in (["move", "line", "--by", "1"], ["home", "line"], ["move", "1", "--by", "1"], ["move", "--by", "1"],
                  ["cml", "--axis", "line", "?99.1"], ["move", "wheel", "--by", "1"]):
        refused = run("cm1e", *words, "-b", bus, "-i", "sim")
        expect(refused.returncode != 0 and "no motor" in refused.stderr, f"{words} without a motor", refused)
    scan = run("cm1e", "scan", "-b", empty, "-i", "sim")
    expect(scan.returncode == 0, "scan with virtual axes only", scan)
    eni = run("cm1e", "generate", "eni", "-b", empty, "-o", "-")
    expect(eni.returncode == WRONG_USE and "no axis with a motor" in eni.stderr, "ENI of virtual axes only", eni)


def in_a_folder(*checks):
    with tempfile.TemporaryDirectory() as folder:
        for check in checks:
            check(folder)


def main():
    real_time.run_above_others()
    in_folder = lambda *checks: lambda: in_a_folder(*checks)  # noqa: E731
    real_time.together(in_folder(check_good), in_folder(check_files), check_wrong,
                       in_folder(check_bridge, check_no_motor, check_axes_without_a_motor, check_examples))
    real_time.end(faults, f"the command line: good use and {len(WRONG)} kinds of wrong use")


if __name__ == "__main__":
    main()
