#!/usr/bin/env python3
"""A master whose motor turns for a long time in real time over a veth pair, with a cycle of 1 ms and one of 250 us at the
same time. The counters of both ends agree: what one interface sent is what the other one received, and what the master
counts as lost is what did not come back; a frame that the simulator drops now and then shows that. Memory, descriptors
and threads of both programs stay as they were after a tenth of the time. `scripts/soak --wire` runs it for hours.

test_long_run.py CM1E [SECONDS]
"""
import json
import os
import re
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../support"))
import wire  # noqa: E402
from control_client import Client  # noqa: E402

CYCLES_US = (1000, 250)
SLAVES = "axes: [{sim: {no_stops: true}}]\n"
LOOKS = 10
SHORT_S = 18 if os.environ.get("CM1E_TEST_EFFORT") == "full" else 6
DROPPED = 2  # one after the other: one of them has the process data
GROWTH_KB = 256  # of what lies in memory: pages that were not touched before
NAMES = ("below 1 us", *(f"{2 ** n} ... {2 ** (n + 1)} us" for n in range(31)))


class Frames:
    """What an interface has sent, received and dropped."""

    def __init__(self, holder, interface):
        shown = subprocess.run(wire.enter(holder, ["cat", "/proc/net/dev"]), capture_output=True, text=True, check=True)
        words = re.search(rf"{interface}:(.*)", shown.stdout)[1].split()
        self.received, self.sent = int(words[1]), int(words[9])
        self.dropped = int(words[3]) + int(words[11])


def resources(pid):
    """Of a process: kB in memory and allocated, threads, open files."""
    with open(f"/proc/{pid}/status", encoding="ascii") as file:
        status = dict(line.split(":", 1) for line in file)
    number = {name: int(status[name].split()[0]) for name in ("VmRSS", "VmData", "Threads")}
    return {**number, "files": len(os.listdir(f"/proc/{pid}/fd"))}


def start(segment, cm1e, folder, cycle_us, seconds):
    command = [cm1e, "move", "-b", segment.bus_file(cycle_us), "X", "--speed", "1", "--for", str(seconds), "--json"]
    environment = {**os.environ, "CM1E_RUNTIME_DIR": folder}
    master = subprocess.Popen(segment.command(command), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              env=environment)
    path = os.path.join(folder, f"cm1e-{master.pid}-0.sock")
    wire.wait_for(lambda: os.path.exists(path) or master.poll() is not None, 20, "the master does not run")
    time.sleep(0.2)
    return master, path


def statistics(master, path):
    try:
        with Client(path) as client:
            return client.ask("statistics")["statistics"]
    except (OSError, TypeError) as error:
        wire.check(False, f"the master does not tell of itself ({error}): {master.communicate()}")


def look_on(segment, master, path, seconds):
    """Looks at both programs ten times, and lets the simulator drop frames each time. What was seen first and last, and
    the last statistics."""
    # The first client costs memory that all later ones use.
    seen, said, begin = [], statistics(master, path), time.monotonic()
    for number in range(LOOKS):
        time.sleep(max(0.0, begin + (number + 1) * 0.8 * seconds / LOOKS - time.monotonic()))
        if master.poll() is not None:
            wire.check(False, f"the master has ended: {master.communicate()}")
        # Before the master is asked, because it sees the end of the connection only later.
        seen.append({"master": resources(master.pid), "simulator": resources(segment.simulator.pid)})
        said = statistics(master, path)
        segment.console(f"lose {DROPPED}")
    return seen[0], seen[-1], said


def judge_flat(first, last):
    for program, before in first.items():
        after = last[program]
        wire.check(after["VmRSS"] - before["VmRSS"] <= GROWTH_KB, f"{program}: {before} grew to {after}")
        for name in ("VmData", "Threads", "files"):
            wire.check(after[name] == before[name], f"{program}: {name} was {before[name]} and is {after[name]}")


def judge_frames(segment, timing, said):
    """After the run. The kernel or a pause may have lost frames too: the master counts them all."""
    master, slave = Frames(segment.master, wire.MASTER_INTERFACE), Frames(segment.slave, wire.SLAVE_INTERFACE)
    wire.check(master.sent == slave.received + slave.dropped and slave.sent == master.received + master.dropped,
               f"the interfaces disagree: {vars(master)}, {vars(slave)}")
    missing, lost, late = master.sent - slave.sent, timing["lost_frames"], said["bus"]["late_frames"]
    wire.check(missing >= LOOKS * DROPPED, f"{LOOKS * DROPPED} frames were dropped, {missing} are missing")
    wire.check(lost >= LOOKS, f"frames were dropped at {LOOKS} times, the master counts {lost}")
    wire.check(said["bus"]["lost_frames"] <= missing + late, f"{missing} frames are missing: {said['bus']}")
    wire.check(master.sent >= timing["cycles"], f"{master.sent} frames in {timing['cycles']} cycles")
    return master.sent, missing


def latencies(distribution):
    return [(NAMES[n], count) for n, count in enumerate(distribution["histogram"]) if count]


def tell(cycle_us, timing, said, frames, looks):
    """What the run was like; `frames` and `looks` as judge_frames() and look_on() return them."""
    (sent, missing), (first, last) = frames, looks
    print(f"cycle {cycle_us} us: {timing['cycles']:,} cycles, {timing['overruns']:,} overruns\n"
          f"  frames          {sent:,} sent, {missing} did not come back, {LOOKS * DROPPED} of these dropped by the simulator\n"
          f"  for the master  {timing['lost_frames']:,} lost, {said['bus']['late_frames']:,} late")
    for program, before in first.items():
        after = last[program]
        print(f"  {program:15} {before['VmRSS']:,} kB resident at the first look, {after['VmRSS']:,} at the last; "
              f"{after['VmData']:,} allocated, {after['Threads']} threads, {after['files']} open files at both")
    for name, count in latencies(said["wake_up_latency"]):
        print(f"  wake-up latency {name:20} {count:>12,}")


def run(cm1e, cycle_us, seconds):
    with tempfile.TemporaryDirectory() as folder:
        slaves = os.path.join(folder, "slaves.yaml")
        with open(slaves, "w", encoding="utf-8") as file:
            file.write(SLAVES)
        with wire.segment(cm1e, slaves) as segment:
            master, path = start(segment, cm1e, folder, cycle_us, seconds)
            first, last, said = look_on(segment, master, path, seconds)
            out, told = master.communicate(timeout=seconds + 60)
            wire.check(master.returncode == 0, f"{cycle_us} us: exit status {master.returncode}: {out}{told}")
            timing = json.loads(out)["timing"]
            judge_flat(first, last)
            tell(cycle_us, timing, said, judge_frames(segment, timing, said), (first, last))


if __name__ == "__main__":
    LENGTH = float(sys.argv[2]) if len(sys.argv) > 2 else SHORT_S
    wire.together(*(lambda us=us: run(sys.argv[1], us, LENGTH) for us in CYCLES_US))
