#!/usr/bin/env python3
"""Many clients of the control socket at once, and clients that are gone in the midst of something: nobody is kept from the
cycle, sees a time before its own request, or keeps its place.

test_control_crowd.py BIN-DIRECTORY
"""
import contextlib
import json
import os
import resource
import sys
import threading
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import control_bench as bench  # noqa: E402
from control_bench import expect, wait_for  # noqa: E402
from control_client import Client  # noqa: E402

IDLE_AXES, PLACES = 24, 32
BUS = "bus: {interface: sim, control: maintain, lost_cycles_limit: 50}\naxes:\n  - {name: X, sim: {no_stops: true}}\n"
FILES = BUS + "  - {name: Y, device: cia402, drive: {counts_per_revolution: 10000, max_speed_rpm: 3000}}\n"
MANY = BUS + "".join(f"  - {{name: A{n}, sim: {{no_stops: true}}}}\n" for n in range(IDLE_AXES))


@contextlib.contextmanager
def others(program, number, request):
    """So many clients that connected first and ask all the time."""
    over = threading.Event()
    clients = [Client(program) for _ in range(number)]

    def ask(client):
        while not over.is_set():
            expect(client.ask(request)["ok"], request)

    threads = [threading.Thread(target=ask, args=(client,)) for client in clients]
    for thread in threads:
        thread.start()
    try:
        yield
    finally:
        over.set()
        for thread, client in zip(threads, clients):
            thread.join()
            client.socket.close()


def check_orders_have_their_turn():
    """Six clients in lower places only look: a seventh one stops and keeps its axis."""
    with bench.running("many.yaml") as program:
        with others(program, 6, "variables"), Client(program) as client:
            expect(client.ask("enable", axis=2, keep_ms=2000)["ok"], "enable")
            wait_for(lambda: client.ask("axes")["axes"][1]["state"] == "Standstill", "enabled")
            longest = 0
            for request, more in [("jog", {"axis": 2, "velocity": 1, "keep_ms": 1000}), ("keep", {})] * 20 + [("stop", {"axis": 2})]:
                began = time.monotonic()
                reply = client.ask(request, **more)
                longest = max(longest, time.monotonic() - began)
                expect(reply["ok"], request, reply)
            expect(longest < 0.5, "a request that moves or stops waits for those that look", longest)


def check_snapshots_are_new():
    """A snapshot of 25 axes with texts takes 25 cycles; who joins one that another client wanted sees what came before."""
    with bench.running("many.yaml") as program, Client(program) as client:
        for axis in range(2, 2 + IDLE_AXES):
            client.ask("jog", axis=axis, velocity=1.0)  # refused: it is not enabled, and has a text from now on
        expect(sum(bool(axis["text"]) for axis in client.ask("axes")["axes"]) == IDLE_AXES, "axes have texts")
        with others(program, 1, "axes"):
            for _ in range(15):
                expect(client.ask("enable", axis=2, keep_ms=2000)["ok"], "enable")
                expect(client.ask("axes")["axes"][1]["held"], "a snapshot is of the time before the request")
                client.ask("disable", axis=2)
                wait_for(lambda: not client.ask("axes")["axes"][1]["held"], "disabled")


def check_gone_before_the_file_is_decided():
    """AddressSanitizer sees the memory of the file."""
    with bench.running("files.yaml") as program:
        for _ in range(30):
            with Client(program) as client:
                client.ask("file_data", offset=0, data="55" * 16000)
                client.send(json.dumps({"request": "file_begin", "slave": 2, "name": "drive.par", "write": True}))
            time.sleep(0.005)
        wait_for(program.moves, "the program goes on")


def ended(client):
    reply = client.ask("file")
    return not reply["ok"] or reply["file"]["ended"]


def check_refused_file_gives_the_place_back():
    with bench.running("files.yaml") as program:
        for number in range(PLACES + 1):
            with Client(program) as client:
                expect(client.ask("file_data", offset=0, data="616263")["ok"], f"connection {number} is served")
                wait_for(lambda: client.ask("file_begin", slave=2, name="a", write=True)["ok"], "a file is begun")
                wait_for(lambda: ended(client), "a file ends")
                refused = client.ask("file_begin", slave=77, name="b")
                expect(not refused["ok"] and "There is no slave 77" in refused["error"]["text"], "refused", refused)
                expect("no file on its way" in client.ask("file")["error"]["text"], "nothing is on its way")


def check_times_that_are_too_large():
    with bench.running("files.yaml") as program, Client(program) as client:
        for request, more in (("enable", {"axis": 2}), ("jog", {"axis": 2, "velocity": 1}), ("home", {"axis": 2}),
                              ("output", {"name": "a", "value": 1}), ("variable", {"name": "Main.a", "value": 1})):
            for keep_ms in (2**63 - 1, -2**63, 10**13, True, 1.5, "100"):
                reply = client.ask(request, keep_ms=keep_ms, **more)
                expect(not reply["ok"], f"{request} for {keep_ms} ms", reply)


def check_deep_messages():
    """Lists within lists: the reply to one with such an id needed more stack than its thread has."""
    with bench.running("files.yaml") as program, Client(program) as client:
        for levels in (15, 16, 2000, 20000):
            client.send('{"request": "hello", "id": ' + "[" * levels + "]" * levels + "}")
            reply = client.receive()
            expect(reply["ok"] == (levels == 15) and ("id" in reply) == (levels == 15), f"{levels} levels", str(reply)[:200])
        expect(client.ask("hello")["ok"], "the connection goes on")


def computed(program):
    """s of a processor."""
    with open(f"/proc/{program.pid}/stat", encoding="ascii") as file:
        ticks = file.read().rsplit(")", 1)[1].split()
    return (int(ticks[11]) + int(ticks[12])) / os.sysconf("SC_CLK_TCK")


def check_without_descriptors():
    """One that cannot be accepted waits, and the thread of the socket does so too."""
    with bench.running("files.yaml") as program:
        held = [Client(program) for _ in range(20)]
        for client in held:
            client.ask("hello")
        used = 1 + max(int(name) for name in os.listdir(f"/proc/{program.pid}/fd"))
        before = resource.prlimit(program.pid, resource.RLIMIT_NOFILE)
        resource.prlimit(program.pid, resource.RLIMIT_NOFILE, (used, before[1]))
        with Client(program) as client:
            began = computed(program)
            time.sleep(1)
            usual = computed(program) - began
            resource.prlimit(program.pid, resource.RLIMIT_NOFILE, before)
            expect(client.ask("hello")["ok"], "served when there is a descriptor again")
            began = computed(program)
            time.sleep(1)
            expect(usual < computed(program) - began + 0.15, "the thread of the socket takes a processor", usual)
        for client in held:
            client.socket.close()


if __name__ == "__main__":
    for name, text in (("files.yaml", FILES), ("many.yaml", MANY)):
        bench.write(name, text)
    bench.run(check_orders_have_their_turn, check_snapshots_are_new, check_gone_before_the_file_is_decided,
              check_refused_file_gives_the_place_back, check_times_that_are_too_large, check_deep_messages, check_without_descriptors)
