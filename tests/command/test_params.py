#!/usr/bin/env python3
"""`cm1e params` on the simulated segment: every parameter with unit, range and meaning; by name and number; wrong values
and files are refused with their line before anything is written; what a file changes is shown.

test_params.py BIN-DIRECTORY SOURCE-DIRECTORY
"""
import json
import os
import pty
import re
import subprocess
import sys
import tempfile

BIN, SOURCE = sys.argv[1], sys.argv[2]
FAILED, WRONG_USE = 1, 2
faults = []


def run(*words):
    return subprocess.run([os.path.join(BIN, "cm1e"), "params", *words], capture_output=True, text=True, timeout=60,
                          stdin=subprocess.DEVNULL)


def on_sim(action, *words):
    return run(action, "-i", "sim", *words)


def expect(condition, what, result):
    if not condition:
        faults.append(f"{what}: exit status {result.returncode}\n{result.stdout}{result.stderr}")


def check_list():
    result = on_sim("list", "1", "--json")
    told = json.loads(result.stdout)
    names = [row["name"] for row in told]
    expect(result.returncode == 0 and len(names) == len(set(names)), "list", result)
    for wanted in [f"K{n}" for n in range(21, 102)] + [f"H{n}" for n in range(9)] + ["Home offset", "Homing method",
                                                                                   "Status LED brightness"]:
        expect(wanted in names, f"list lacks {wanted}", result)
    for row in told:
        expect(row["meaning"] and "UG" in row["meaning"] and row["minimum"] <= row["value"] <= row["maximum"], str(row),
               result)
    for never in ("Controlword", "Target position", "Target velocity", "Digital outputs", "Modes of operation"):
        expect(never not in names, f"{never} is no parameter", result)
    for word in ("K47", "k47", "0x60F6:1B", "60f6:1b"):
        one = on_sim("get", "1", word, "--json")
        expect(one.returncode == 0 and [(row["name"], row["value"], row["unit"]) for row in json.loads(one.stdout)]
               == [("K47", 30, "%")], f"get {word}", one)
    for word in ("home_offset", "Home offset", "home-offset", "0x607C", "607c"):
        one = on_sim("get", "1", word, "--json")
        expect(one.returncode == 0 and json.loads(one.stdout)[0]["number"] == "0x607C:00", f"get {word}", one)


def check_set():
    good = on_sim("set", "1", "K47=44", "home_offset=-1250", "h3=-7")
    expect(good.returncode == 0 and "K47                      30 -> 44 %" in good.stdout and "0 -> -1300 counts (rounded)"
           in good.stdout and "3 values written" in good.stdout, "set", good)
    same = on_sim("set", "1", "K47=30")
    expect(same.returncode == 0 and "nothing to change" in same.stdout, "set of the same", same)
    dry = on_sim("set", "1", "K47=44", "--dry-run")
    expect(dry.returncode == 0 and "30 -> 44" in dry.stdout and "nothing was written" in dry.stdout, "dry run", dry)
    for words, told in ((["K47=101"], "10 ... 100"), (["K47=9"], "10 ... 100"), (["K47=nan"], "whole number"),
                        (["K47=1.5"], "whole number"), (["K47="], "whole number"), (["K47"], "NAME=VALUE"),
                        (["=5"], "there is no parameter"), (["K477=5"], 'did you mean "K47"?'),
                        (["K47=40", "homing_metod=-1"], 'did you mean "Homing method"?'), (["K47=40", "K48=70000"], "65535"),
                        (["Homing method=-7"], "-6 ... 0"), (["0x6040=6"], "there is no parameter"), ([], "NAME=VALUE")):
        wrong = on_sim("set", "1", *words)
        expect(wrong.returncode == WRONG_USE and told in wrong.stderr and "->" not in wrong.stdout, f"set {words}: {told}",
               wrong)
    for words, told in ((["lst", "1"], '"list"'), (["get", "1"], "names"), (["list"], "position"), (["list", "0"], "512"),
                        (["backup", "1"], "file"), (["list", "1", "--yes"], "--yes"), (["list", "X"], "no axis")):
        wrong = on_sim(*words)
        expect(wrong.returncode == WRONG_USE and told in wrong.stderr, f"{words}: {told}", wrong)


def check_files(folder):
    path = os.path.join(folder, "motor.yaml")
    made = on_sim("backup", "1", path)
    with open(path, encoding="utf-8") as file:
        text = file.read()
    expect(made.returncode == 0 and "  K47: 30                  # 0x60F6:1B, 10 ... 100 %: torque limit" in text
           and 'firmware: "1.3.5"' in text and len(re.findall(r"^  \S.*# 0x", text, re.MULTILINE)) == 102, "backup", made)
    again = on_sim("backup", "1", path)
    expect(again.returncode == WRONG_USE and "exists; --force writes over it" in again.stderr, "a backup is kept", again)
    again = on_sim("backup", "1", path, "--force")
    expect(again.returncode == 0 and "102 parameters" in again.stdout, "a backup is written over", again)
    same = on_sim("diff", "1", path)
    expect(same.returncode == 0 and "0 of 102 parameters differ" in same.stdout, "diff of the same", same)
    restored = on_sim("restore", "1", path)
    expect(restored.returncode == 0 and "nothing to change" in restored.stdout, "restore of the same", restored)
    check_changed(folder, text)
    check_asked(folder)
    check_broken(folder, text)


def check_changed(folder, text):
    path = os.path.join(folder, "changed.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace("K47: 30 ", "K47: 55 ").replace("  H3: 0 ", "  0x60FB:04: -9 "))
    differs = on_sim("diff", "1", path, "--json")
    told = {row["name"]: (row["motor"], row["file"]) for row in json.loads(differs.stdout)}
    expect(differs.returncode == FAILED and told == {"K47": (30, 55), "H3": (0, -9)}, "diff", differs)
    asks = on_sim("restore", "1", path)
    expect(asks.returncode == FAILED and "30 -> 55" in asks.stdout and "nothing was written" in asks.stderr
           and "--yes" in asks.stderr, "restore without a terminal", asks)
    dry = on_sim("restore", "1", path, "--dry-run", "--json")
    expect(dry.returncode == 0 and json.loads(dry.stdout)["would_write"] == ["K47", "H3"], "dry run of a restore", dry)
    done = on_sim("restore", "1", path, "--yes", "--json")
    expect(done.returncode == 0 and json.loads(done.stdout) == {"done": True, "written": ["K47", "H3"], "failed": None,
                                                                "not_written": []}, "restore", done)


def check_asked(folder):
    """On a terminal a person is asked; nothing but "y" writes."""
    path = os.path.join(folder, "changed.yaml")
    for answer, status, told in (("n\n", FAILED, "nothing was written"), ("\n", FAILED, "nothing was written"),
                                 ("y\n", 0, "2 values written")):
        pid, master = pty.fork()
        if pid == 0:
            os.execv(os.path.join(BIN, "cm1e"), ["cm1e", "params", "restore", "-i", "sim", "1", path])
        seen, answered = "", False
        while True:
            try:
                data = os.read(master, 4096).decode(errors="replace")
            except OSError:
                break
            seen += data
            if not data:
                break
            if "[y/N]" in seen and not answered:
                os.write(master, answer.encode())
                answered = True
        code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
        os.close(master)
        if code != status or told not in seen or "Write 2 values?" not in seen:
            faults.append(f"restore, answered with {answer!r}: {code} {seen}")


def check_broken(folder, text):
    path = os.path.join(folder, "broken.yaml")
    line = text[:text.index("  K47")].count("\n") + 1
    for change, told in ((("K47: 30", "K47: 300"), f"broken.yaml:{line}"), (("K47: 30", "K4711: 30"), f":{line}"),
                         (("K47: 30", "K47: [30]"), f":{line}"), (("K47: 30", "K46: 0"), "already"),
                         (('kind: "cm1-e"', 'kind: "bridge"'), 'is of a device "bridge"'),
                         (('  kind: "cm1-e"\n', ""), "does not say of which device it is"),
                         (('"1.3.5"', '"1.3.2"'), "--other-firmware"), (("parameters:", "parametres:"), "parametres"),
                         (("K47: 30", "K47 30\n  x"), "broken.yaml"), ((text, "a: [\n"), "not YAML"), ((text, text[:text.index("K47: 30") + 6]), "cut off"), ((text, ""), "no param"),
                         ((text, "- 1\n"), "expected names"), (('  name: "CM1-E', '  nmae: "x'), "nmae")):
        with open(path, "w", encoding="utf-8") as file:
            file.write(text.replace(*change, 1))
        wrong = on_sim("restore", "1", path, "--yes")
        expect(wrong.returncode == WRONG_USE and told in wrong.stderr and "written to" not in wrong.stdout,
               f"{change[1][:40]!r}: {told}", wrong)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace('"1.3.5"', '"1.3.2"').replace("K47: 30", "K47: 31"))
    other = on_sim("diff", "1", path)
    expect(other.returncode == FAILED and "1 of 102" in other.stdout and "is of firmware 1.3.2; slave 1 has 1.3.5" in
           other.stderr, "diff of another firmware", other)
    other = on_sim("restore", "1", path, "--yes", "--other-firmware")
    expect(other.returncode == 0 and "1 value written" in other.stdout, "another firmware, allowed", other)
    missing = on_sim("restore", "1", os.path.join(folder, "missing"))
    expect(missing.returncode == WRONG_USE and "missing" in missing.stderr, "no such file", missing)


def check_bridge(folder):
    bus = os.path.join(folder, "bridge.yaml")
    with open(bus, "w", encoding="utf-8") as file:
        file.write("bus: {interface: sim}\naxes:\n  - {name: X, position: 1, channel: 1, motor: CM1, k37: 10}\n"
                   "  - {name: lift, position: 1, channel: 3, motor: CM2, k37: 10}\n  - {name: Z, position: 2}\n")
    lists = {where: json.loads(run("list", "-b", bus, where, "--json").stdout) for where in ("X", "1.1", "lift", "1.4")}
    names = {where: [row["name"] for row in rows] for where, rows in lists.items()}
    expect(lists["X"] == lists["1.1"] and names["lift"] == names["1.4"] and "K52" in names["X"] and
           "K52" not in names["lift"] and "Servo Stiffness Adjustment" in names["lift"] and "K37" not in names["X"] and
           [row["number"][:6] for row in lists["lift"]] == ["0x70F6"] * 16 + ["0x70FB"], "the parameters of CM1 and CM2",
           run("list", "-b", bus, "X"))
    for row in lists["X"] + lists["lift"]:
        expect(row["kept"] and "(BR " in row["meaning"], f"meaning: {row}", run("list", "-b", bus, "X"))
    result = run("set", "-b", bus, "X", "K42=200", "K53=7")
    expect(result.returncode == 0 and "K42                      100 -> 200 100 pulses/s" in result.stdout and
           "2 values written to slave 1, connector 1" in result.stdout, "set behind a bridge", result)
    result = run("set", "-b", bus, "X", "K53=7", "K26=1")
    expect(result.returncode == WRONG_USE and "nothing was written" in result.stderr and "--allow-motion" in result.stderr,
           "what may move", result)
    result = run("set", "-b", bus, "X", "K26=1", "--allow-motion")
    expect(result.returncode == 0 and "1 value written" in result.stdout, "what may move, allowed", result)
    for words, why in ((("list", "1"), "name the connector of the motor, 1.1 ... 1.4"), (("list", "1.5"), "1.1 ... 1.4"),
                       (("list", "2.1"), "is no bridge"), (("get", "X", "K37"), "cm1e cml"),
                       (("set", "X", "K42=0"), "1 ... 5000"), (("list", "9.1"), "no slave 9")):
        result = run(words[0], "-b", bus, *words[1:])
        expect(result.returncode in (FAILED, WRONG_USE) and why in result.stderr, f"{words}", result)
    kept = os.path.join(folder, "lift.yaml")
    result = run("backup", "-b", bus, "lift", kept)
    expect(result.returncode == 0 and "17 parameters of slave 1, connector 3" in result.stdout, "backup", result)
    for where, good in (("lift", True), ("1.4", True), ("X", False), ("Z", False)):
        result = run("restore", "-b", bus, where, kept, "--yes")
        expect((result.returncode == 0) == good, f"restore to {where}", result)
    for action in ("restore", "diff"):
        result = run(action, "-b", bus, "Z", kept)
        expect(result.returncode == WRONG_USE and result.stderr.count("\n") == 1 and 'is of a device "bridge"' in result.stderr,
               f"{action} of another device is one sentence", result)
    with open(bus, "w", encoding="utf-8") as file:
        file.write("bus: {interface: sim}\naxes: [{name: a}, {name: lift}]\n")
    named = run("get", "-b", bus, "lift", "K47")
    expect(named.returncode == 0 and "K47" in named.stdout, "a motor by its axis", named)


def main():
    with tempfile.TemporaryDirectory() as folder:
        check_list()
        check_set()
        check_files(folder)
        check_bridge(folder)
    print("\n".join(faults) or "parameters: listed, set, kept in files, restored, refused")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
