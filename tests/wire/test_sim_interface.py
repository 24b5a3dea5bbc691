#!/usr/bin/env python3
"""`cm1e sim` and its network interface: it takes it before it says so, alone, sleeps while nothing arrives, waits for
one that goes away, and lets no frame go round between two simulated segments.

test_sim_interface.py CM1E
"""
import os
import select
import socket
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

ETHERCAT, LOCALLY_ADMINISTERED, CIRCULATED = 0x88A4, 0x02, 0x4000
BRD, FPRD = 7, 4
IDLE_S, WAKE_UPS_PER_S = 2, 100


# ---- a master of single frames, in the namespace of the master ------------------------------------------------------

def frame(command, source, working_counter=0, circulated=False):
    """One datagram of two bytes; FPRD addresses nobody."""
    length = 2 | (CIRCULATED if circulated else 0)
    datagram = bytes([command, 0x33, 0x77, 0x77, 0x00, 0x00]) + length.to_bytes(2, "little") + bytes(4)
    body = datagram + working_counter.to_bytes(2, "little")
    header = b"\xff" * 6 + bytes([source]) + b"\x10\x10\x10\x10\x10" + ETHERCAT.to_bytes(2, "big")
    return (header + (0x1000 | len(body)).to_bytes(2, "little") + body).ljust(60, b"\0")


def exchange(wire_socket, sent):
    """(working counter, marked as circulated) of the answer; None: no answer."""
    wire_socket.send(sent)
    if not select.select([wire_socket], [], [], 0.3)[0]:
        return None
    answer = wire_socket.recv(2048)
    return int.from_bytes(answer[28:30], "little"), bool(int.from_bytes(answer[22:24], "little") & CIRCULATED)


def open_wire():
    wire_socket = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ETHERCAT))
    wire_socket.setsockopt(263, 23, 1)  # SOL_PACKET, PACKET_IGNORE_OUTGOING
    wire_socket.bind((wire.MASTER_INTERFACE, 0))
    return wire_socket


def play_masters():
    """New frames are answered, whatever the master's address; so is one that a redundant master sends again."""
    with open_wire() as wire_socket:
        for source in (0x00, 0x01, 0x04, 0x50, 0x52, LOCALLY_ADMINISTERED, 0xFE):
            for _ in range(3):
                wire.check(exchange(wire_socket, frame(BRD, source)) == (1, False), f"BRD from {source:02X}:...")
                answer = exchange(wire_socket, frame(FPRD, source))
                wire.check(answer and answer[0] == 0, f"FPRD to nobody from {source:02X}:...: {answer}")
                answer = exchange(wire_socket, frame(BRD, source, 1))
                wire.check(answer and answer[0] == 2, f"sent again by {source:02X}:...: {answer}")
        # What two segments have processed, and came back, is no master's.
        answer = exchange(wire_socket, frame(BRD, 0x00, 2, True))
        wire.check(answer and answer[0] == 3, "a mark alone destroys no frame")
        answer = exchange(wire_socket, frame(BRD, LOCALLY_ADMINISTERED, 2, True))
        wire.check(answer is None, f"a frame that has gone round is answered: {answer}")


def send_once():
    with open_wire() as wire_socket:
        wire_socket.send(frame(BRD, 0x01))
        wire_socket.send(frame(FPRD, 0x01))


# ---- the tests ------------------------------------------------------------------------------------------------------

def scan(segment, cm1e):
    result = segment.run([cm1e, "scan", "-i", wire.MASTER_INTERFACE])
    return result.returncode == 0 and "CM1-E" in result.stdout


def check_missing(cm1e):
    result = subprocess.run([cm1e, "sim", "-i", "eth77"], capture_output=True, text=True, timeout=20)
    wire.check(result.returncode == 1 and "eth77" in result.stderr, f"an interface that is missing: {result}")
    wire.check(result.stdout == "", f"it announced itself before it failed: {result.stdout}")


def check_second(segment, cm1e):
    result = segment.run_beside([cm1e, "sim", "-i", wire.SLAVE_INTERFACE])
    owner = f"in use by cm1e sim (process {segment.simulator.pid}) since"
    wire.check(result.returncode == 1 and owner in result.stderr,
               f"a second simulator on the interface: {result}")
    wire.check(result.stdout == "", f"it announced itself before it was refused: {result.stdout}")
    wire.check(scan(segment, cm1e), "the first one is disturbed")


def wake_ups(pid):
    with open(f"/proc/{pid}/status", encoding="utf-8") as file:
        return sum(int(line.split()[1]) for line in file if "ctxt_switches" in line)


def check_sleep(segment):
    time.sleep(0.5)
    before = wake_ups(segment.simulator.pid)
    time.sleep(IDLE_S)
    count = wake_ups(segment.simulator.pid) - before
    wire.check(count < WAKE_UPS_PER_S * IDLE_S, f"{count} wake-ups in {IDLE_S} s while nothing arrives")
    print(f"{count / IDLE_S:.0f} wake-ups a second while nothing arrives")


def check_away(segment, cm1e):
    for away, back in ((["set", wire.SLAVE_INTERFACE, "down"], ["set", wire.SLAVE_INTERFACE, "up"]),
                       (["del", wire.SLAVE_INTERFACE], None)):
        said = segment.notices().count("is there again")
        segment.run_beside(["ip", "link", *away])
        wire.wait_for(lambda: "waits for it" in segment.notices().split("is there again")[-1], 5, f"{away}: no word")
        wire.check("CM1-E" in segment.console("status 1"), f"{away}: the console does not answer")
        if back:
            segment.run_beside(["ip", "link", *back])
        else:
            segment.join()
        wire.wait_for(lambda: segment.notices().count("is there again") == said + 1, 5, f"{away}: it stays deaf")
        wire.check(scan(segment, cm1e), f"{away}: no slave answers after it is there again")


def received(segment):
    with_numbers = segment.run(["cat", "/proc/net/dev"]).stdout.split(wire.MASTER_INTERFACE + ":")[1]
    return int(with_numbers.split()[1])


def check_facing(segment, cm1e):
    command = segment.command([cm1e, "sim", "-i", wire.MASTER_INTERFACE])
    other = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        wire.check("simulated slave" in other.stdout.readline(), "the other segment did not start")
        for _ in range(5):
            before = received(segment)
            sent = segment.run([sys.executable, os.path.abspath(__file__), "send-once"])
            wire.check(sent.returncode == 0, f"not sent: {sent.stderr}")
            time.sleep(0.5)
            count = received(segment) - before
            wire.check(1 < count <= 10, f"two frames became {count} between two segments")
    finally:
        other.terminate()
        said = segment.notices() + other.communicate(timeout=10)[1]
    wire.check(said.count("face each other") in (1, 2), f"each segment says it once: {said}")
    wire.check(scan(segment, cm1e), "a master in the place of the other segment")


def main(cm1e):
    wire.become_root()
    check_missing(cm1e)
    with wire.segment(cm1e) as segment:
        wire.check(scan(segment, cm1e), "no slave answers")
        check_second(segment, cm1e)
        check_sleep(segment)
        result = segment.run([sys.executable, os.path.abspath(__file__), "play-masters"])
        wire.check(result.returncode == 0, f"single frames: {result.stdout}{result.stderr}")
        check_away(segment, cm1e)
        check_facing(segment, cm1e)
    print("an interface that is missing, taken, down, deleted; masters of every address; two segments face to face")


if __name__ == "__main__":
    {"play-masters": play_masters, "send-once": send_once}.get(sys.argv[1], lambda: main(sys.argv[1]))()
