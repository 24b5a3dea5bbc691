#!/usr/bin/env python3
"""`cm1e reset`, `led` and `alias` over the wire, on a motor that goes on when the command has ended; `jog` and `monitor`
in a terminal, alone and the one beside the other.

test_wire_by_hand.py CM1E
"""
import json
import os
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402
from terminal import RIGHT, Terminal  # noqa: E402


def check_reset(segment, cm1e):
    bus = segment.bus_file()
    segment.console("error 1 7310 hold")
    stays = segment.run([cm1e, "reset", "-b", bus])
    wire.check(stays.returncode == 1 and "did not clear" in stays.stderr and "7310" in stays.stderr,
               f"an error whose cause is still there: {stays}")
    segment.console("error 1 clear")
    segment.console("error 1 7310")
    told = segment.run([cm1e, "reset", "-b", bus, "--json"])
    axis = json.loads(told.stdout)[0]
    wire.check(told.returncode == 0 and axis["had_error"] and axis["good"] and axis["device_error"] == 0x7310
               and "Over speed" in axis["details"], f"reset: {told}")
    again = segment.run([cm1e, "reset", "-b", bus])
    wire.check(again.returncode == 0 and again.stdout == "X: has no error\n", f"after the reset: {again}")
    moved = segment.run([cm1e, "move", "-b", bus, "--by", "0.1"])
    wire.check(moved.returncode == 0 and "simulated" not in moved.stdout, f"a move after the reset: {moved}")


def check_led(segment, cm1e):
    bus = segment.bus_file()
    red = segment.run([cm1e, "led", "-b", bus, "X", "red", "--flash"])
    value = segment.run([cm1e, "sdo", "-b", bus, "read", "1", "0xFF01", "--json"])
    wire.check(red.returncode == 0 and json.loads(value.stdout)["value"] == 0x01000003, f"a red LED: {red}{value}")
    found = segment.run([cm1e, "led", "-b", bus, "X", "--for", "0.3", "--json"])
    wire.check(json.loads(found.stdout)["now"] == 0x01000003, f"the LED is as it was before: {found}")


def check_alias(segment, cm1e, folder):
    bus, backup = segment.bus_file(), os.path.join(folder, "backup.sii")
    written = segment.run([cm1e, "alias", "-b", bus, "1", "77", "--backup", backup])
    wire.check(written.returncode == 0, f"alias: {written}")
    segment.console("power-cycle 1 100")

    def has_alias(wanted):
        scan = segment.run([cm1e, "scan", "-b", bus, "--json"])
        return scan.returncode == 0 and json.loads(scan.stdout)[0]["alias"] == wanted
    wire.wait_for(lambda: has_alias(77), 10, "the alias is not there after the power-on")
    back = segment.run([cm1e, "sii", "write", "1", backup, "--own-alias-and-serial", "-b", bus, "--backup",
                        os.path.join(folder, "other.sii")])
    wire.check(back.returncode == 0, f"the backup written back: {back}")
    segment.console("power-cycle 1 100")
    wire.wait_for(lambda: has_alias(0), 10, "the alias is still there after the backup was written back")


def shows(terminal, words, what):
    wire.check(terminal.wait(words), f"{what}: {terminal.seen}")


def jog_by(segment, cm1e, bus):
    """Returns what a jog of half a second says at its end."""
    jog = Terminal(segment.command([cm1e, "jog", "-b", bus, "-v", "1", "--json"]))
    shows(jog, "at rest", "jog does not begin")
    jog.hold(RIGHT, 0.5)
    jog.look(0.7)
    os.write(jog.master, b"q")
    status, out = jog.end()
    wire.check(status == 0, f"jog: {status} {out} {jog.seen}")
    return json.loads(out)


def check_jog_and_monitor(segment, cm1e, folder):
    bus = os.path.join(folder, "maintain.yaml")
    with open(segment.bus_file(), encoding="utf-8") as plain, open(bus, "w", encoding="utf-8") as file:
        file.write(plain.read().replace("bus:\n", "bus:\n  control: maintain\n", 1))
    way = jog_by(segment, cm1e, bus)
    wire.check(way["done"] and 0.1 < way["to"] - way["from"] < 1.2, f"jog alone: {way}")
    screen = ["env", "TERM=xterm", "ASAN_OPTIONS=detect_leaks=0"]  # ncurses keeps what it knows of a terminal
    monitor = Terminal(segment.command([*screen, cm1e, "monitor", "-b", bus]), screen=True)
    shows(monitor, "Disabled", "monitor alone does not show the axis")
    watched = Terminal(segment.command([*screen, cm1e, "monitor", "-b", bus]), screen=True)
    shows(watched, "Disabled", "monitor beside the other one")
    way = jog_by(segment, cm1e, bus)
    wire.check(way["done"] and 0.1 < way["to"] - way["from"] < 1.2, f"jog beside the monitor that has the bus: {way}")
    for terminal in (watched, monitor):
        os.write(terminal.master, b"q")
        status, _ = terminal.end()
        wire.check(status == 0, f"q ends the monitor: {status} {terminal.seen}")


def main(cm1e):
    with wire.segment(cm1e) as segment, tempfile.TemporaryDirectory() as folder:
        check_reset(segment, cm1e)
        check_led(segment, cm1e)
        check_jog_and_monitor(segment, cm1e, folder)
        check_alias(segment, cm1e, folder)
    print("reset, led, jog, monitor and alias over the wire")


if __name__ == "__main__":
    main(sys.argv[1])
