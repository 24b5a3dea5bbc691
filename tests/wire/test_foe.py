#!/usr/bin/env python3
"""`cm1e foe read` and `write` over a veth pair, with lost frames; pysoem reads what we wrote and writes what we read.

test_foe.py CM1E PYTHON: runs itself with --master in the master's namespace.
"""
import json
import os
import sys
import tempfile
import threading
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

SLAVES = """\
axes:
  - {name: X, device: cia402, drive: {counts_per_revolution: 10000, max_speed_rpm: 3000}}
  - {name: Y}
"""
ROOM = 128 - 6 - 6  # bytes of a file in one packet


def run_master(action, name, path):
    import pysoem
    master = pysoem.Master()
    master.open(wire.MASTER_INTERFACE)
    wire.check(master.config_init() == 2, "two slaves expected")
    slave = master.slaves[0]
    slave.state_check(pysoem.PREOP_STATE, 3_000_000)
    if action == "read":
        data = slave.foe_read(name, 0, 100000, 1_000_000)
        with open(path, "wb") as file:
            file.write(bytes(data))
    else:
        with open(path, "rb") as file:
            wire.check(slave.foe_write(name, 0, file.read(), 1_000_000) > 0, "foe_write")
    master.close()


class Bench:
    def __init__(self, cm1e, python, segment, folder):
        self.cm1e, self.python, self.segment, self.folder = cm1e, python, segment, folder

    def file(self, size, seed=0):
        path = os.path.join(self.folder, f"file-{size}-{seed}.bin")
        with open(path, "wb") as file:
            file.write(bytes((n * 7 + n // 251 + seed) % 256 for n in range(size)))
        return path

    def foe(self, *words):
        return self.segment.run([self.cm1e, "foe", *words, "-i", wire.MASTER_INTERFACE])

    def pysoem(self, *words):
        told = self.segment.run([self.python, os.path.abspath(__file__), "--master", *words])
        wire.check(told.returncode == 0, f"pysoem {words}: {told}")

    def same(self, one, other, what):
        with open(one, "rb") as a, open(other, "rb") as b:
            wire.check(a.read() == b.read(), what)


def both_ways(bench):
    back = os.path.join(bench.folder, "back.bin")
    for size in (1, ROOM - 1, ROOM, ROOM + 1, 30000):
        path = bench.file(size)
        told = bench.foe("write", "1", path, "--name", "drive.par", "--allow-write")
        wire.check(told.returncode == 0 and f"drive.par of {size} bytes was written" in told.stderr, f"{told}")
        told = bench.foe("read", "1", back, "--name", "drive.par", "--json")
        wire.check(told.returncode == 0 and json.loads(told.stdout) ==
                   {"position": 1, "action": "read", "name": "drive.par", "bytes": size}, f"{told}")
        bench.same(path, back, f"{size} bytes come back changed")


def refused(bench):
    path = bench.file(1000)
    told = bench.foe("write", "1", path)
    wire.check(told.returncode == 2 and "--allow-write" in told.stderr, f"without consent: {told}")
    told = bench.foe("read", "1", os.path.join(bench.folder, "none"), "--name", "other")
    wire.check(told.returncode == 1 and "FoE error 0x8001, file not found" in told.stderr, f"{told}")
    wire.check(not os.path.exists(os.path.join(bench.folder, "none")), "a file of an error")
    told = bench.foe("read", "1", "-", "--name", "drive.par", "--maximum", "100")
    wire.check(told.returncode == 1 and "more than 100 bytes" in told.stderr and told.stdout == "", f"{told}")
    told = bench.foe("write", "2", path, "--allow-write")
    wire.check(told.returncode == 1 and "0x8008, in Bootstrap only" in told.stderr, f"a CM1-E: {told}")
    told = bench.foe("read", "3", "-", "--name", "x")
    wire.check(told.returncode == 1 and "no slave 3" in told.stderr, f"{told}")


def disturbed(bench):
    """Frames are lost, damaged and late: the file is whole."""
    path, back, ended = bench.file(60000, 5), os.path.join(bench.folder, "back.bin"), threading.Event()
    faults = 0

    def disturb():
        nonlocal faults
        while not ended.wait(0.02):
            bench.segment.console(("lose 1", "corrupt 1", "delay 1 3000")[faults % 3])
            faults += 1

    thread = threading.Thread(target=disturb)
    thread.start()
    try:
        written = bench.foe("write", "1", path, "--name", "f", "--allow-write")
        read = bench.foe("read", "1", back, "--name", "f")
    finally:
        ended.set()
        thread.join()
    wire.check(written.returncode == 0 and read.returncode == 0, f"with {faults} faults: {written} {read}")
    bench.same(path, back, "a file that lost frames is changed")
    print(f"{faults} times lost, damaged or late frames")


def second_opinion(bench):
    path, back = bench.file(12345, 1), os.path.join(bench.folder, "pysoem.bin")
    wire.check(bench.foe("write", "1", path, "--name", "ours", "--allow-write").returncode == 0, "write")
    bench.pysoem("read", "ours", back)
    bench.same(path, back, "pysoem reads something else than was written")
    path = bench.file(40 * ROOM, 2)
    bench.pysoem("write", "theirs", path)
    wire.check(bench.foe("read", "1", back, "--name", "theirs").returncode == 0, "read")
    bench.same(path, back, "pysoem's file is read changed")


def main(cm1e, python):
    with tempfile.TemporaryDirectory() as folder:
        slaves = os.path.join(folder, "slaves.yaml")
        with open(slaves, "w", encoding="utf-8") as file:
            file.write(SLAVES)
        with wire.segment(cm1e, slaves) as segment:
            bench = Bench(cm1e, python, segment, folder)
            for check in (both_ways, refused, disturbed, second_opinion):
                begin = time.monotonic()
                check(bench)
                print(f"{check.__name__}: {time.monotonic() - begin:.1f} s", flush=True)


if __name__ == "__main__":
    if sys.argv[1] == "--master":
        run_master(*sys.argv[2:])
    else:
        main(*sys.argv[1:])
