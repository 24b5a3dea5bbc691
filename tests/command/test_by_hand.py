#!/usr/bin/env python3
"""Commands for a person at a motor: `jog` and `enable` in a terminal of their own (a pty), `led`, `alias`, `reset`. A
motor moves only while a key repeats, and has no torque after the end, whatever ends it.

test_by_hand.py BIN-DIRECTORY SOURCE-DIRECTORY
"""
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import termios
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import real_time  # noqa: E402
from terminal import LEFT, RIGHT, Terminal  # noqa: E402

BIN, SOURCE = sys.argv[1], sys.argv[2]
FAILED, WRONG_USE = 1, 2
faults = []


def run(*words):
    told = subprocess.run([os.path.join(BIN, "cm1e"), *words], capture_output=True, text=True, timeout=60,
                          stdin=subprocess.DEVNULL)
    for line in told.stderr.splitlines() + ([] if "--json" in words else told.stdout.splitlines()):
        said = [part for part in re.split(r"[.:] ", line) if len(part) > 12]
        expect(len(said) == len(set(said)) and line.count('Axis "') < 2, f"{words}: said twice", line)
    return told


def expect(condition, what, result=""):
    if not condition:
        faults.append(f"{what}\n{result}")


def in_terminal(*words):
    return Terminal([os.path.join(BIN, "cm1e"), *words])


def check_jog():
    """Velocity 1: held for a second it goes about one revolution, and no further when the key is let go."""
    jog = in_terminal("jog", "-i", "sim", "-v", "1", "--json")
    expect(jog.wait("at rest"), "jog does not begin", jog.seen)
    start = time.monotonic()
    jog.hold(RIGHT, 1.0)
    held = time.monotonic() - start
    jog.look(1.0)
    there = jog.position("axis1")
    expect(there is not None and 0.3 < there < held + 0.4, f"jog to the right for {held:.2f} s: at {there}", jog.seen)
    jog.look(0.5)
    expect(jog.position("axis1") == there, "the motor moves without a key", jog.seen)
    jog.hold(LEFT, 0.5)
    jog.look(1.0)
    back = jog.position("axis1")
    expect(back is not None and back < there - 0.1, f"jog to the left: from {there} to {back}", jog.seen)
    os.write(jog.master, b"[[")
    jog.look(0.2)
    os.write(jog.master, RIGHT)
    jog.look(1.0)
    tap = jog.position("axis1")
    expect(tap is not None and 0 < tap - back < 0.25, f"a tap at a quarter of the velocity: from {back} to {tap}", jog.seen)
    os.write(jog.master, b"q")
    status, out = jog.end()
    told = json.loads(out or "{}")
    expect(status == 0 and told.get("done") and abs(told["to"] - tap) < 0.001, f"q ends the jog: {status}", out)
    expect(termios.tcgetattr(jog.slave)[3] == jog.before[3], "the terminal is not as it was after the jog")


def check_end_of_jog(what):
    """Ctrl-C and a closed terminal while the key is held end in order: ramp, disabled, the terminal as it was."""
    jog = in_terminal("jog", "-i", "sim", "--dead-man", "1")
    expect(jog.wait("at rest"), "jog does not begin", jog.seen)
    jog.hold(RIGHT, 0.4)
    if what == "Ctrl-C":
        os.write(jog.master, b"\x03")
    else:
        os.close(jog.slave)
        os.close(jog.master)
        jog.look = lambda seconds: ""
    status, out = jog.end()
    expect(status is not None and status >= 0, f"{what} while the motor moves: {status}", out)
    if what == "Ctrl-C":
        expect(termios.tcgetattr(jog.slave)[3] == jog.before[3], "the terminal is not as it was after Ctrl-C")


def check_enable():
    enable = in_terminal("enable", "-i", "sim")
    expect(enable.wait("Any key ends it"), "enable does not begin", enable.seen)
    enable.look(0.5)
    os.write(enable.master, b"x")
    status, out = enable.end()
    expect(status == 0 and re.search(r"was enabled for \d\.\d s, at 0, and was displaced by 0 \(simulated\)", out),
           f"enable until a key: {status}", out)
    for_time = run("enable", "-i", "sim", "--for", "0.3", "--json")
    told = json.loads(for_time.stdout)
    expect(for_time.returncode == 0 and told["enabled"] and 0.29 < told["seconds"] < 1 and told["way"] == 0,
           "enable for a time", for_time)


def check_refused():
    for words, told in ((["jog", "-i", "sim"], "needs a terminal"), (["enable", "-i", "sim"], "--for"),
                        (["jog", "-i", "sim", "-v", "0"], "above 0"), (["jog", "-i", "sim", "--dead-man", "9"], "0.05"),
                        (["jog", "-i", "sim", "--dead-man", "nan"], "number"), (["enable", "-i", "sim", "--for", "-1"],
                                                                              "above 0"),
                        (["led", "-i", "sim"], "which motor"), (["led", "-i", "sim", "1", "gren"], '"green"'),
                        (["led", "-i", "sim", "1", "red", "blue"], "one colour"), (["led", "-i", "sim", "0"], "512"),
                        (["led", "-i", "sim", "1", "--brightness", "17"], "0 ... 16"), (["led", "-i", "sim", "x"], "axis"),
                        (["alias", "-i", "sim"], "POSITION"), (["alias", "-i", "sim", "1", "7"], "--backup"),
                        (["alias", "-i", "sim", "1", "65536", "--backup", "never"], "65535"),
                        (["reset", "-i", "sim", "9"], "no axis"), (["reset", "-i", "sim", "1", "2"], "too many")):
        result = run(*words)
        expect(result.returncode == WRONG_USE and told in result.stderr, f"cm1e {words}: \"{told}\"",
               f"{result.returncode} {result.stderr}")
    for words in (["led", "-i", "sim", "2"], ["alias", "-i", "sim", "2"]):
        result = run(*words)
        expect(result.returncode == FAILED and "there is no slave 2" in result.stderr, f"cm1e {words}", result.stderr)


def check_led():
    for words, now in ((["red"], 0x01000001), (["red", "--flash"], 0x01000003), (["white"], 0x01010101),
                       (["off"], 0x00000001), (["motor"], 0), (["cyan", "--for", "0.1"], 0), (["--for", "0.1"], 0)):
        result = run("led", "-i", "sim", "1", *words, "--json")
        told = json.loads(result.stdout or "{}")
        expect(result.returncode == 0 and told.get("now") == now and told["before"] == 0, f"led {words}", result)
    bright = run("led", "-i", "sim", "1", "--brightness", "16", "--json")
    expect(json.loads(bright.stdout)["brightness"] == 16, "brightness", bright)


def check_alias():
    with tempfile.TemporaryDirectory() as folder:
        check_alias_in(folder)


def check_alias_in(folder):
    backup = os.path.join(folder, "backup.sii")
    shown = run("alias", "-i", "sim", "1", "--json")
    expect(json.loads(shown.stdout) == {"position": 1, "alias": 0}, "alias", shown)
    written = run("alias", "-i", "sim", "1", "0x1234", "--backup", backup, "--json")
    told = json.loads(written.stdout or "{}")
    expect(written.returncode == 0 and (told["before"], told["alias"]) == (0, 0x1234) and os.path.getsize(backup) == 2048,
           "alias written", written)
    again = run("alias", "-i", "sim", "1", "7", "--backup", backup)
    expect(again.returncode == FAILED and "backup" in again.stderr, "a backup that exists", again)
    bus = os.path.join(folder, "alias.yaml")
    with open(bus, "w", encoding="utf-8") as file:
        file.write("bus: {interface: sim}\naxes: [{name: a}, {name: b, alias: 9}]\n")
    shown = run("alias", "-b", bus, "b", "--json")
    expect(shown.returncode == 0 and json.loads(shown.stdout)["alias"] == 9, "alias by the name of an axis", shown)
    taken = run("alias", "-b", bus, "a", "9", "--backup", os.path.join(folder, "none"))
    expect(taken.returncode == FAILED and "has the alias 9 already" in taken.stderr
           and not os.path.exists(os.path.join(folder, "none")), "an alias that is taken", taken)


def check_move_interrupted():
    """What is said of it is where the motor stands then, as the trace says too."""
    with tempfile.TemporaryDirectory() as folder:
        csv_file = os.path.join(folder, "interrupted.csv")
        with subprocess.Popen([os.path.join(BIN, "cm1e"), "move", "-i", "sim", "--by", "4", "-v", "0.5", "--json", "--csv", csv_file],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as move:
            time.sleep(2.5)
            move.send_signal(signal.SIGINT)
            output, complaint = move.communicate(timeout=30)
        told = json.loads(output)
        with open(csv_file, encoding="utf-8") as file:
            last = file.read().splitlines()[-1].split(",")
    ended = subprocess.CompletedProcess("move", move.returncode, output, complaint + str(last))
    expect(move.returncode == FAILED and not told["done"] and "interrupted" in told["details"] and
           0 < told["to"] < 4 and abs(told["to"] - float(last[3])) < 0.01 and
           abs(told["deviation"] - (told["to"] - 4)) < 1e-9, "move interrupted", ended)


def check_reset():
    good = run("reset", "-b", f"{SOURCE}/examples/three_axes.yaml", "-i", "sim", "--json")
    expect(good.returncode == 0 and [axis["had_error"] for axis in json.loads(good.stdout)] == [False] * 3, "reset", good)
    one = run("reset", "-i", "sim", "1")
    expect(one.returncode == 0 and one.stdout == "axis1: has no error (simulated)\n", "reset of one", one)


def main():
    real_time.run_above_others()
    real_time.together(check_jog, *(lambda what=what: check_end_of_jog(what) for what in ("Ctrl-C", "closed")),
                       check_enable, check_alias, check_refused, check_led, check_reset, check_move_interrupted)
    real_time.end(faults, "jog and enable in a terminal, led, alias, reset")


if __name__ == "__main__":
    main()
