#!/usr/bin/env python3
"""One owner of an interface: beside a running `cm1e move`, commands on the same interface that look attach to it, others
are refused in words, and nothing disturbs it. A master that knows no lock is recognised by its frames, and named in the error that it causes.

test_two_masters.py CM1E
"""
import json
import os
import re
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

ROUNDS, LONGEST_S, MOVE_S = 3, 6, 12  # the move goes on while the others run, also where a sanitizer makes them slow
ETHERCAT, BWR, AL_CONTROL, INIT = 0x88A4, 8, 0x0120, 1
SOEM_ADDRESS, NETWORK_CARD_ADDRESS = b"\1" * 6, b"\x00\x1b\x21\x3c\x9d\xf8"
SLAVES = "axes: [{sim: {no_stops: true}}]\n"


def others(cm1e, bus_file, interface, control):
    """[(command, what it prints if it is let in; None: it is refused)]"""
    lookers = [([cm1e, "scan", "-i", interface], "Operational"), ([cm1e, "status", "-b", bus_file], "Operation enabled"),
               ([cm1e, "sdo", "read", "-i", interface, "1", "0x6041"], "0x1237"),
               ([cm1e, "log", "-i", interface], "MC_MoveVelocity"),
               ([cm1e, "params", "get", "-i", interface, "1", "K47"], "K47"),
               ([cm1e, "sdo", "list", "-i", interface, "1"], "Status LED Override"),
               ([cm1e, "sii", "decode", "-i", interface, "1"], "product 0x44412002")]
    movers = [([cm1e, "move", "-b", bus_file, "X", "--by", "0.1", "--velocity", "1"], None),
              ([cm1e, "home", "-b", bus_file, "X"], None),
              ([cm1e, "sii", "write", "-i", interface, "1", bus_file, "--backup", bus_file], None)]
    return [(command, told if control else None) for command, told in lookers] + movers


def start_move(segment, cm1e, bus_file):
    move = subprocess.Popen(segment.command([cm1e, "move", "-b", bus_file, "X", "--speed", "0.5", "--for", str(MOVE_S)]),
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wire.wait_for(lambda: "Operation enabled" in segment.console("status 1") or move.poll() is not None, 10,
                  "the motor was not enabled")
    return move


def doctor_tells(segment, cm1e, control):
    """It asks the program that has the interface, or says why the slaves were not looked at."""
    told = segment.run([cm1e, "doctor", "-i", wire.MASTER_INTERFACE, "--seconds", "0", "--json"]).stdout
    network = {row["subject"]: row for row in json.loads(told) if row["group"] == "network"}
    if control:
        wire.check("cm1e move" in network["program"]["fact"] and network["connections"]["level"] == "ok", told)
    else:
        wire.check("in use by cm1e move" in network["slaves"]["fact"] and "program" not in network, told)


def attached_by_process(segment, cm1e, move):
    """--attach names no interface: that of the program counts, which is no simulated one."""
    for words in (["scan"], ["status"]):
        told = segment.run([cm1e, *words, "--attach", str(move.pid)])
        wire.check(told.returncode == 0 and "Operation" in told.stdout and "simulated" not in told.stdout,
                   f"{words} --attach: {told.stdout}{told.stderr}")


def move_is_left_alone(segment, cm1e, bus_file, control):
    if not control:
        with open(bus_file, "r+", encoding="utf-8") as file:
            text = file.read().replace("bus:\n", "bus:\n  control: none\n", 1)
            file.seek(0)
            file.write(text)
    move = start_move(segment, cm1e, bus_file)
    began, first = time.strftime("%Y-%m-%d %H:"), time.monotonic()
    for number in range(ROUNDS):
        if time.monotonic() > first + LONGEST_S:
            break
        for command, expected in others(cm1e, bus_file, wire.MASTER_INTERFACE, control):
            wire.check(move.poll() is None, f"the move ended beside {command[1]}: {move.poll()}")
            result = segment.run(command)
            told = result.stdout + result.stderr
            if expected:
                wire.check(result.returncode == 0 and expected in told, f"{command[1]} beside a move: {told}")
                continue
            wire.check(result.returncode == 1, f"{command[1]} beside a move was not refused: {told}")
            wire.check(re.search(rf"in use by cm1e move \(process {move.pid}\) since", told),
                       f"{command[1]}: who has it is not said: {told}")
            wire.check(began[:10] in told, f"{command[1]}: since when is not said: {told}")
            if number == 0:
                print(told.strip())
    doctor_tells(segment, cm1e, control)
    if control:
        attached_by_process(segment, cm1e, move)
    out, err = move.communicate(timeout=60)
    wire.check(move.returncode == 0, f"the move did not end: {out}{err}")


def lock_ends_with_its_owner(segment, cm1e, bus_file):
    """However it ends: the interface is free at once."""
    for end in ("kill", "terminate"):
        move = start_move(segment, cm1e, bus_file)
        getattr(move, end)()
        move.communicate(timeout=20)
        result = segment.run([cm1e, "scan", "-i", wire.MASTER_INTERFACE])
        wire.check(result.returncode == 0, f"after {end} the interface is not free: {result.stderr}")


# ---- a master that takes no lock, in a process of its own in the master's namespace ----------------------------------

def interfere(address):
    """Asks all slaves for Init, as a scan of any master does."""
    datagram = bytes([BWR, 0x05, 0, 0]) + AL_CONTROL.to_bytes(2, "little") + (2).to_bytes(2, "little") + bytes(2)
    body = datagram + INIT.to_bytes(2, "little") + bytes(2)
    frame = b"\xff" * 6 + address + ETHERCAT.to_bytes(2, "big") + (0x1000 | len(body)).to_bytes(2, "little") + body
    with socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ETHERCAT)) as wire_socket:
        wire_socket.bind((wire.MASTER_INTERFACE, 0))
        for _ in range(20):
            wire_socket.send(frame.ljust(60, b"\0"))


def other_master_is_named(segment, cm1e, bus_file):
    for address in (SOEM_ADDRESS, NETWORK_CARD_ADDRESS):
        move = start_move(segment, cm1e, bus_file)
        segment.run([sys.executable, os.path.abspath(__file__), "interfere", address.hex()])
        out, err = move.communicate(timeout=30)
        told = out + err
        wire.check(move.returncode == 1, f"the move went on although all slaves were sent to Init: {told}")
        wire.check(re.search(r"Another master sends on this network: \d+ of its frames", told),
                   f"the other master ({address.hex(':')}) is not named: {told}")
        print(told.strip())


def nobody_is_named_alone(segment, cm1e, bus_file):
    """A slave that leaves Operational by itself: no other master is blamed."""
    move = start_move(segment, cm1e, bus_file)
    segment.console("power-cycle 1")
    out, err = move.communicate(timeout=30)
    wire.check(move.returncode == 1 and "nother master" not in out + err, f"without another master: {out}{err}")


def on_a_segment(check, cm1e, *arguments):
    with tempfile.TemporaryDirectory() as folder:
        slaves = os.path.join(folder, "slaves.yaml")
        with open(slaves, "w", encoding="utf-8") as file:
            file.write(SLAVES)
        with wire.segment(cm1e, slaves) as segment:
            check(segment, cm1e, segment.bus_file(), *arguments)


if __name__ == "__main__":
    if sys.argv[1] == "interfere":
        sys.exit(interfere(bytes.fromhex(sys.argv[2])))
    wire.together(lambda: on_a_segment(move_is_left_alone, sys.argv[1], True),
                  lambda: on_a_segment(move_is_left_alone, sys.argv[1], False),
                  lambda: on_a_segment(lock_ends_with_its_owner, sys.argv[1]),
                  lambda: on_a_segment(other_master_is_named, sys.argv[1]),
                  lambda: on_a_segment(nobody_is_named_alone, sys.argv[1]))
    print(f"{ROUNDS * 20} commands beside moves: all refused or attached, the moves done")
