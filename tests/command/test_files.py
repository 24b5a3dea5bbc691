#!/usr/bin/env python3
"""Files of a slave (FoE) through the control socket, while the program goes on: `cm1e foe` attached, and the requests;
who may not, what is refused, and clients that vanish in the middle.

test_files.py BIN-DIRECTORY
"""
import json
import os
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import control_bench as bench  # noqa: E402
from control_bench import CM1E, ENVIRONMENT, expect, path_of, wait_for  # noqa: E402
from control_client import Client  # noqa: E402

BUS = """\
bus: {{interface: sim, control: {control}, lost_cycles_limit: 50}}
axes:
  - {{name: X, sim: {{no_stops: true}}}}
  - {{name: Y, device: cia402, drive: {{counts_per_revolution: 10000, max_speed_rpm: 3000}}}}
"""
X, Y = 1, 2
PIECE = 16384


def file_of(name, size):
    with open(path_of(name), "wb") as file:
        file.write(bytes((n * 7 + n // 251) % 256 for n in range(size)))
    return path_of(name)


def same(one, other):
    with open(path_of(one), "rb") as a, open(path_of(other), "rb") as b:
        return a.read() == b.read()


def begin(client, slave, name, data=None, again=False):
    """Reads, or writes `data`, or what was written before. The reply to the beginning."""
    for at in range(0, len(data or b""), PIECE):
        client.ask("file_data", offset=at, data=data[at:at + PIECE].hex())
    return client.ask("file_begin", slave=slave, name=name, write=again or data is not None)


def begin_soon(client, *words):
    """As begin(), after the file of somebody who is gone has ended."""
    end = time.monotonic() + 10
    while not (reply := begin(client, *words))["ok"] and time.monotonic() < end:
        time.sleep(0.01)
    expect(reply["ok"], f"no file {words[1]} after another one", reply)


def ended(client, **more):
    """The reply after the end."""
    reply = client.ask("file", **more)
    while reply["ok"] and not reply["file"]["ended"]:
        time.sleep(0.01)
        reply = client.ask("file")
    return reply


def refused(reply, words, what):
    expect(reply and not reply["ok"] and words in reply["error"]["text"], what, reply)


def check_command():
    with bench.running("maintain.yaml") as program:
        for size in (0, 1, PIECE, PIECE + 1):
            path = file_of(f"{size}.bin", size)
            told = program.attached("foe", "write", "2", path, "--name", "drive.par", "--allow-write")
            expect(told.returncode == 0 and f"drive.par of {size} bytes was written" in told.stderr, "write", told)
            told = program.attached("foe", "read", "2", path_of("back.bin"), "--name", "drive.par", "--json")
            expect(told.returncode == 0 and json.loads(told.stdout)["bytes"] == size and same(f"{size}.bin", "back.bin"),
                   f"{size} bytes come back changed", told)
        for words, said in ((("read", "2", "-", "--name", "other"), "FoE error 0x8001, file not found"),
                            (("read", "2", "-", "--name", "drive.par", "--maximum", "100"), "more than 100 bytes"),
                            (("write", "1", path, "--allow-write"), '"X" is commanded'),
                            (("read", "1", "-", "--name", "x"), "0x8008, in Bootstrap only"),
                            (("read", "2", "-", "--name", "x", "--bootstrap"), "takes the slave out of the cycle"),
                            (("read", "9", "-", "--name", "x"), "no slave 9")):
            told = program.attached("foe", *words)
            expect(told.returncode == 1 and said in told.stderr and told.stdout == "", f"foe {words}", told)
        with Client(program) as client:
            lost = client.ask("statistics")["statistics"]["bus"]
        expect(lost["working_counter_errors"] == 0, "a slave missed process data", lost)


def check_observe():
    with bench.asked("observe.yaml") as (client, program):
        for request in ("file_data", "file_begin", "file"):
            refused(client.ask(request, slave=Y, name="x"), "control: maintain", f"{request} by observe")
        told = program.attached("foe", "read", "2", "-", "--name", "x")
        expect(told.returncode == 1 and "control: maintain" in told.stderr, "foe read by observe", told)


def check_requests():
    with bench.asked("maintain.yaml") as (client, _):
        refused(client.ask("file"), "file_begin", "nothing is on its way")
        for wrong in ({}, {"slave": 0, "name": "x"}, {"slave": Y}, {"slave": Y, "name": "x" * 256}, {"slave": Y, "name": 1},
                      {"slave": Y, "name": "x", "write": 1}, {"slave": Y, "name": "x", "timeout_ms": 0},
                      {"slave": Y, "name": "x", "maximum": 1 << 40}, {"slave": Y, "name": "x", "password": -1}):
            refused(client.ask("file_begin", **wrong), "expected", f"file_begin {wrong}")
        refused(client.ask("file_begin", slave=77, name="x"), "no slave 77", "a slave that is not there")
        for wrong in ({"offset": 1}, {"data": "zz"}, {"data": "1"}, {"data": 5}, {"data": "00" * (PIECE + 1)}):
            refused(client.ask("file_data", **wrong), "expected", f"file_data {str(wrong)[:40]}")
        expect(begin(client, Y, "")["ok"], "an empty name is the slave's matter")
        refused(ended(client), "empty", "an empty name")


def check_one_at_a_time():
    """A second file is refused while the first is on its way, also in the same connection; `stop` ends it."""
    data = bytes(60000)
    with bench.asked("maintain.yaml") as (client, program), Client(program) as other:
        begin_soon(client, Y, "long", data)
        refused(begin(other, Y, "second"), "one at a time", "a second file")
        refused(client.ask("file_begin", slave=Y, name="third"), "on its way", "a second one of the same connection")
        refused(client.ask("file_data", offset=0, data="00"), "on its way", "other bytes")
        told = client.ask("file")
        expect(told["ok"] and told["file"]["size"] == len(data) and not told["file"]["ended"], "progress", told)
        refused(ended(client, stop=True), "Broken off after", "stop")
        begin_soon(client, Y, "long", None, True)
        expect(ended(client)["file"]["done"] == len(data), "all bytes go again after a part of them went")
        begin_soon(other, Y, "second", b"abc")
        expect(ended(other)["ok"], "the next one")
        identity = other.ask("sdo_read", slave=Y, index=0x1018, subindex=1)
        expect(identity["ok"], "an object after files", identity)


def catches_interrupts(pid):
    """From just before its transfer on."""
    with open(f"/proc/{pid}/status", encoding="ascii") as file:
        caught = next(line.split()[1] for line in file if line.startswith("SigCgt"))
    return int(caught, 16) >> signal.SIGINT - 1 & 1


def check_vanished():
    """Of a client that is gone, killed or that stops reading, nothing is left: the next file is whole."""
    with bench.asked("maintain.yaml") as (client, program):
        for _ in range(5):
            with Client(program) as other:
                begin_soon(other, Y, "gone", bytes(60000))
        child = subprocess.Popen([CM1E, "foe", "write", "2", file_of("long.bin", 60000), "--allow-write", "--attach",
                                  str(program.pid)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                 env=ENVIRONMENT)
        wait_for(lambda: catches_interrupts(child.pid), "the child does not transfer")
        time.sleep(0.1)
        child.send_signal(signal.SIGINT)
        _, err = child.communicate(timeout=20)
        expect(child.returncode == 1 and "Broken off after" in err, "Ctrl-C", err)
        begin_soon(client, Y, "after", b"whole")
        expect(ended(client)["ok"] and begin(client, Y, "after")["ok"] and ended(client)["ok"], "written and read")
        expect(bytes.fromhex(client.ask("file_data", offset=0)["data"]) == b"whole", "the file is another one")


def check_end_of_program():
    """It ends in the middle of a file."""
    program = bench.moving("maintain.yaml")
    with Client(program) as client:
        begin_soon(client, Y, "end", bytes(60000))
        program.process.terminate()
        reply = client.ask("file")
        while reply and reply["ok"] and not reply["file"]["ended"]:
            reply = client.ask("file")
        expect(reply is None or not reply["ok"], "a file that ends with the program", reply)
    expect("ErrorStop" not in program.end(), "the run ended with an error")


if __name__ == "__main__":
    for consent in ("observe", "maintain"):
        bench.write(f"{consent}.yaml", BUS.format(control=consent))
    bench.run(check_command, check_vanished, check_one_at_a_time, check_requests, check_observe, check_end_of_program)
