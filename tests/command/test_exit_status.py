#!/usr/bin/env python3
"""Every command against the table of exit statuses in docs/COMMAND.md: what is wrong as a word, or cannot be read, is
refused with 2; what is right and is not there, cannot be written, or is wrong within is 1. Each says why in words.

test_exit_status.py BIN-DIRECTORY
"""
import os
import subprocess
import sys
import tempfile

CM1E = os.path.join(os.path.abspath(sys.argv[1]), "cm1e")
FAILED, WRONG_USE = 1, 2
BRIDGE = "bus: {interface: sim}\naxes:\n  - {name: X, position: 1, channel: 1, motor: CM1, k37: 10}\n"
ASTRAY = BRIDGE.replace("sim", "'sim:absent.yaml'")
BENT = BRIDGE.replace("sim", "'sim:good.st'")
SWAPPED = "bus: {interface: 'sim:bridge.yaml'}\naxes: [{name: X, position: 1}]\n"
OTHER_MAKER = "bus: {interface: 'sim:bridge.yaml'}\nslaves: [{name: valves, position: 1, vendor: 0x999}]\n"
DIGITS = "bus: {interface: sim}\naxes: [{name: '2', position: 1}]\n"
OTHER = BRIDGE.replace("sim", "'sim:bridge.yaml'") + "  - {name: Y, position: 8}\nslaves:\n  - {name: valves, position: 9}\n"
TUNE = ["tune", "step", "1", "--max-travel", "1", "--max-velocity", "1", "-i", "sim"]
SII = ["sii", "write", "1"]

# A file that a command reads: FILE is replaced by each of these.
UNREADABLE = {"absent": "absent", "a folder": "folder", "too large": "/dev/zero", "without a name": ""}
READS = [
    ["check", "FILE"], ["diff", "FILE", "-i", "sim"], ["run", "FILE", "-i", "sim"], ["st", "check", "FILE"],
    ["st", "build", "FILE"], ["firmware", "update", "FILE", "-i", "sim", "-p", "1", "--yes"],
    ["foe", "write", "1", "FILE", "-i", "sim", "--allow-write"], ["params", "restore", "1", "FILE", "-i", "sim"],
    ["params", "diff", "1", "FILE", "-i", "sim"], ["sii", "decode", "FILE"],
    [*SII, "FILE", "--backup", "old.sii", "-i", "sim"], ["generate", "esi", "--from", "FILE", "-o", "new.xml"],
    *([*words, "-b", "FILE"] for words in (
        ["scan"], ["status"], ["monitor", "--json"], ["trace", "--csv", "new.csv", "--for", "1"], ["sdo", "read", "1", "0x1018:1"],
        ["params", "list", "1"], ["log"], ["cml", "?99.1"], ["sii", "read", "1", "new.sii"], ["home"], ["move", "--by", "1"],
        ["enable", "--for", "1"], TUNE[:-2], ["reset"], ["recover"], ["io"], ["led", "1"], ["foe", "read", "1", "new.bin"],
        ["alias", "1"], ["states"], ["reg", "read", "1", "0x130", "2"], ["graph"], ["generate", "eni", "-o", "new.xml"],
        ["var", "list"], ["prove"], ["doctor"])),
    ["sim", "-i", "absent0", "FILE"],
]
# A file that a command writes.
UNWRITABLE = {"in no folder": "absent/new", "a full disk": "/dev/full", "in /proc": "/proc/new"}
WRITES = [
    ["graph", "-i", "sim", "--svg", "FILE"], ["sii", "read", "1", "FILE", "-i", "sim"],
    ["params", "backup", "1", "FILE", "-i", "sim", "--force"], ["init", "-i", "sim", "-o", "FILE", "--force"],
    *(["generate", *words, "-o", "FILE"] for words in (["esi"], ["sii"], ["ec-extend"], ["eni", "-i", "sim"])),
    ["trace", "-i", "sim", "--for", "0.1", "--csv", "FILE"], ["move", "-i", "sim", "--by", "0.1", "--html", "FILE"],
    [*TUNE, "--html", "FILE"], ["scan", "-i", "sim", "--pcap", "FILE"],
]
# Words, status, and what is said.
CASES = [
    (["scan", "eth0"], WRONG_USE, '"eth0" is too many: a network is named as in -i eth1'),
    (["init", "eth0"], WRONG_USE, '"eth0" is too many: a network is named as in -i eth1'),
    (["run", "machine.st"], WRONG_USE, "cm1e st build machine.st"),
    (["scan", "-i", "absent0"], FAILED, "absent0"), (["status", "--attach", "1"], FAILED, "Process 1 has no control socket"),
    (["sdo", "read", "99", "0x1018:1", "-i", "sim"], FAILED, "there is no slave 99"),
    (["sdo", "read", "0", "0x1018:1", "-i", "sim"], WRONG_USE, "1 ... 512"),
    (["states", "valves", "-b", "other.yaml"], FAILED, 'slave "valves" is not on the network'),
    (["states", "Y", "-b", "other.yaml"], FAILED, 'slave of axis "Y" is not on the network'),
    (["states", "valve", "-b", "other.yaml"], WRONG_USE, 'did you mean "valves"'),
    (["sdo", "write", "X", "0x6083", "1", "-b", "swapped.yaml"], FAILED, 'expected a CM1-E as axis "X", and found "EB'),
    (["foe", "write", "X", "bridge.yaml", "--allow-write", "-b", "swapped.yaml"], FAILED, "slave 1. Nothing was done"),
    (["sii", "write", "X", "bridge.yaml", "--backup", "new.sii", "-b", "swapped.yaml"], FAILED, "expected a CM1-E"),
    (["firmware", "update", "long", "-a", "X", "--yes", "-b", "swapped.yaml"], FAILED, "expected a CM1-E as axis"),
    (["alias", "X", "7", "--backup", "new.sii", "-b", "swapped.yaml"], FAILED, "The position 1 instead of the name"),
    (["states", "X", "init", "-b", "swapped.yaml"], FAILED, "expected a CM1-E"),
    (["prove", "X", "-b", "swapped.yaml"], FAILED, "expected a CM1-E"),
    (["params", "list", "X", "-b", "swapped.yaml"], FAILED, "expected a CM1-E"),
    (["sdo", "write", "valves", "0x6083", "1", "-b", "other_maker.yaml"], FAILED, "expected vendor 0x00000999"),
    (["sdo", "read", "X", "0x1018:1", "-b", "bridge.yaml"], WRONG_USE, "give the position, 1"),
    (["sdo", "read", "1"], WRONG_USE, "read POSITION|AXIS INDEX"), (["sii", "decode", "X", "-b", "bridge.yaml"], WRONG_USE, "connector 1"),
    (["sdo", "write", "2", "0x6083", "1", "-b", "digits.yaml"], FAILED, "there is no slave 2"),
    (["firmware", "update", "long", "-p", "2", "--yes", "-b", "digits.yaml"], FAILED, "there is no slave 2"),
    (["recover", "-i", "absent0"], FAILED, "no program runs this network"),
    (["explain", "nothingofthekind"], FAILED, "no text has"),
    (["var", "lsit"], WRONG_USE, 'there is no action "lsit"'), (["st", "biuld"], WRONG_USE, 'did you mean "build"'),
    (["firmware", "upgrade", "x"], WRONG_USE, "there is only update"),
    (["prove", "-i", "sim", "--point", "nothing"], WRONG_USE, 'there is no point "nothing"'),
    (["prove", "-i", "sim", "--point", "id.vendor", "--point", "state.preopp"], WRONG_USE, 'did you mean "state.preop"'),
    (["prove", "-i", "sim", "--point", "map.bridge"], WRONG_USE, "no point of a cm1-e"),
    (["prove", "-i", "sim", "--point", "cml.mode", "--allow-motion", "--max-velocity", "1", "--max-travel", "1"], WRONG_USE,
     "no point of a cm1-e"),
    (["prove", "-i", "sim", "-o", "absent/report"], FAILED, "absent/report.md cannot be written"),
    (["prove", "-i", "sim", "-o", ""], WRONG_USE, "needs a name"),
    (["params", "set", "X", "K26=1", "-b", "bridge.yaml"], WRONG_USE, "--allow-motion"),
    (["cml", "^.1", "-b", "bridge.yaml"], WRONG_USE, "--allow-motion"),
    (["cml", "?99.1", "^.1", "-b", "bridge.yaml"], FAILED, "--allow-motion"),
    (["reg", "write", "1", "0x130", "1", "-i", "sim"], WRONG_USE, "--allow-write"),
    (["foe", "write", "1", "bridge.yaml", "-i", "sim"], WRONG_USE, "--allow-write"),
    (["var", "set", "a=1", "-i", "sim"], WRONG_USE, "--allow-write"),
    (["io", "1.OUT1=1", "--for", "1", "-i", "sim"], WRONG_USE, "--allow-output"),
    (["params", "backup", "1", "bridge.yaml", "-i", "sim"], WRONG_USE, "--force"),
    (["init", "-i", "sim", "-o", "bridge.yaml"], WRONG_USE, "--force"),
    (["st", "build", "good.st", "-o", "good.st"], WRONG_USE, "would be lost"),
    (["st", "check", "bridge.yaml"], FAILED, "error"), (["check", "good.st"], FAILED, "known format"),
    (["check", "astray.yaml"], FAILED, "absent.yaml"), (["check", "bent.yaml"], FAILED, "good.st"),
    (["sii", "decode", "bridge.yaml"], FAILED, "not an SII image"),
    (["graph", "-i", "sim", "--svg", ""], WRONG_USE, "needs a name"), ([*TUNE, "--html", ""], WRONG_USE, "needs a name"),
    ([*TUNE, "--html", "-"], WRONG_USE, "standard output"),
    (["sii", "read", "1", "", "-i", "sim"], WRONG_USE, "needs a name"),
    (["params", "backup", "1", "", "-i", "sim"], WRONG_USE, "needs a name"),
    (["foe", "read", "1", "", "-i", "sim"], WRONG_USE, "needs a name"),
    (["generate", "ec-extend", "-o", "new.xml", "--program", ""], WRONG_USE, "needs a name"),
    (["new", "folder"], FAILED, "folder"),
]
faults = []


def check(words, status, says, folder):
    done = subprocess.run([CM1E, *words], capture_output=True, text=True, timeout=60, cwd=folder, stdin=subprocess.DEVNULL,
                          errors="replace")
    if done.returncode != status or says not in done.stderr or not done.stderr.strip():
        faults.append(f"cm1e {' '.join(words)}: expected {status} and \"{says}\", found {done.returncode}\n{done.stderr}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.mkdir(os.path.join(folder, "folder"))
        for name, text in (("bridge.yaml", BRIDGE), ("other.yaml", OTHER), ("astray.yaml", ASTRAY), ("bent.yaml", BENT),
                           ("swapped.yaml", SWAPPED), ("other_maker.yaml", OTHER_MAKER), ("digits.yaml", DIGITS),
                           ("long", 2000 * "x"),
                           ("good.st", "PROGRAM P VAR n : INT; END_VAR n := 1; END_PROGRAM\n")):
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        for words in READS:
            for path in UNREADABLE.values():
                check([word if word != "FILE" else path for word in words], WRONG_USE, "", folder)
        for words in WRITES:
            for path in UNWRITABLE.values():
                check([word if word != "FILE" else path for word in words], FAILED, path, folder)
        for words, status, says in CASES:
            check(words, status, says, folder)
        left = set(os.listdir(folder)) - {"folder", "bridge.yaml", "other.yaml", "astray.yaml", "bent.yaml", "swapped.yaml",
                                          "other_maker.yaml", "digits.yaml", "long", "good.st"}
        if left:
            faults.append(f"files are left: {left}")
    listed = subprocess.run([CM1E, "--help"], capture_output=True, text=True, timeout=60, check=True).stdout
    names = {line.split()[0] for line in listed.splitlines() if line.startswith("  ") and line[2:3].isalpha()}
    tried = {words[0] for words in [*READS, *WRITES, *(case[0] for case in CASES)]}
    if names - tried - {"jog"}: # which needs a terminal first
        faults.append(f"commands without a case: {names - tried}")
    print("\n".join(faults) or f"{len(READS) * len(UNREADABLE) + len(WRITES) * len(UNWRITABLE) + len(CASES)} exit statuses")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
