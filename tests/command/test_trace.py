#!/usr/bin/env python3
"""cm1e trace of a running program: the same samples as the program records itself, counted gaps, triggers, many at a
time; and alone.

test_trace.py BIN-DIRECTORY
"""
import csv
import json
import os
import re
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import control_bench as bench  # noqa: E402
from control_bench import CM1E, ENVIRONMENT, RUNTIME, expect, path_of, wait_for  # noqa: E402
from control_client import Client  # noqa: E402

BUS = """\
bus: {interface: sim, lost_cycles_limit: 50}
axes:
  - {name: X, sim: {no_stops: true}}
  - {name: Y}
"""


def rows(name):
    with open(path_of(name), encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


def running(*options):
    return bench.asked("bus.yaml", *options)


# ---- the same as the program's own ----------------------------------------------------------------------------------

def check_same_samples():
    with running("--csv", path_of("own.csv")) as (_, program):
        files = [word for kind in ("csv", "svg", "html", "npy") for word in (f"--{kind}", path_of(f"a.{kind}"))]
        told = program.attached("trace", "--for", "2", "--object", "X:0x603F", "--object", "2:0x6064:0", *files)
        every = program.attached("trace", "--for", "1", "--every", "5", "--csv", path_of("every.csv"))
        names = program.attached("trace", "--list")
    expect(told.returncode == 0 and "lost" not in told.stderr and "20 signals" in told.stdout, "trace", told)
    own, attached = rows("own.csv"), rows("a.csv")
    width = len(own[0])
    expect(attached[0][:width] == own[0] and [name.split()[0] for name in attached[0][width:]] == ["X", "Y"],
           "columns", (own[0], attached[0]))
    of_time = {row[0]: row for row in own[1:]}
    first = list(of_time).index(attached[1][0])
    expect([row[0] for row in attached[1:]] == list(of_time)[first:first + len(attached) - 1],
           "cycles that the program records are missing in what is recorded attached")
    expect(all(row[:width] == of_time.get(row[0]) for row in attached[1:]), "values differ")
    expect(len(attached) > 1500, "samples", len(attached))
    for name, begin in (("a.svg", b"<svg"), ("a.html", b"<!DOCTYPE html>"), ("a.npy", b"\x93NUMPY\x03")):
        with open(path_of(name), "rb") as file:
            expect(file.read(len(begin)) == begin, name)
    steps = [round(1e3 * (float(b[0]) - float(a[0]))) for a, b in zip(rows("every.csv")[1:], rows("every.csv")[2:])]
    expect(every.returncode == 0 and steps.count(5) > 0.9 * len(steps), "--every 5", steps[:20])
    expect("X actual velocity [u/s]" in names.stdout.splitlines() and "overruns" in names.stdout, "--list", names)


def check_gaps_are_counted():
    """A client that is suspended for longer than the program keeps samples for it."""
    with running() as (_, program):
        child = subprocess.Popen([CM1E, "trace", "--attach", str(program.pid), "--for", "8", "--csv",
                                  path_of("gap.csv"), "--html", path_of("gap.html"), "--json"], stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, text=True, env=ENVIRONMENT)
        time.sleep(1)
        os.kill(child.pid, signal.SIGSTOP)
        time.sleep(6)
        os.kill(child.pid, signal.SIGCONT)
        out, err = child.communicate(timeout=30)
    told, times = json.loads(out), [round(1e3 * float(row[0])) for row in rows("gap.csv")[1:]]
    missing = times[-1] - times[0] + 1 - len(times)
    expect(child.returncode == 0 and "samples were lost" in err and told["lost"] > 500, "a gap", out + err)
    expect(told["lost"] <= missing <= told["lost"] + 100, "lost samples are counted", (told, missing))  # and overruns
    gap, before = max((b - a, a) for a, b in zip(times, times[1:]))
    expect(gap >= told["lost"] // 2, "the gap is one", told)
    with open(path_of("gap.html"), encoding="utf-8") as file:
        marks = re.findall(r'{"t": ([0-9.]+), "text": "samples were lost"}', file.read())
    expect(before in [round(1e3 * float(mark)) for mark in marks], "the gap is marked where it is", (before, marks))


def check_many_and_gone():
    with running() as (client, program):
        children = [subprocess.Popen([CM1E, "trace", "--attach", str(program.pid), "--for", "2", "--csv",
                                      path_of(f"many{n}.csv")], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                     text=True, env=ENVIRONMENT) for n in range(4)]
        for child in children:
            out, err = child.communicate(timeout=30)
            expect(child.returncode == 0 and "lost" not in err, "one of four", out + err)
        for _ in range(60):  # more than there are places: each is free again
            with Client(client.socket.getpeername()) as other:
                expect(other.ask("record")["ok"], "record")
                other.send('{"request": "samples"}')
        with Client(client.socket.getpeername()) as other:
            expect("send \"record\"" in other.ask("samples")["error"]["text"], "samples without a recording")
            for wrong in ({"every": 0}, {"every": "1"}, {"objects": 1}, {"objects": [1]}, {"objects": [{"axis": 9}]},
                          {"objects": [{"axis": 1, "index": 0x1018}]}, {"objects": [{"axis": 1, "index": 0x6064}] * 2}):
                reply = other.ask("record", **wrong)
                expect(not reply["ok"] and reply["error"]["text"], f"record {wrong}", reply)
            expect(other.ask("record")["ok"], "record after refused ones")
            expect("records already" in other.ask("record")["error"]["text"], "two recordings of one connection")


# ---- triggers and ends ----------------------------------------------------------------------------------------------

def check_triggers():
    with running() as (client, program):
        at = client.ask("axes")["axes"][0]["position"] + 0.75
        told = program.attached("trace", "--for", "1", "--before", "0.25", "--trigger", f"rising:X actual position:{at}", "--csv",
                     path_of("trigger.csv"))
        expect(told.returncode == 0, "trigger", told)
        positions = [float(row[rows("trigger.csv")[0].index("X actual position [u]")]) for row in
                     rows("trigger.csv")[1:]]
        before = sum(position < at for position in positions)
        expect(before == 250 and len(positions) == 1001, "samples around the trigger", (before, len(positions)))
        for words, why in ((["--trigger", "rising:X actual position", "--for", "1"], "expected error-stop"),
                           (["--trigger", "sometimes", "--for", "1"], "sometimes"),
                           (["--trigger", "change:nothing", "--for", "1"], "no signal \"nothing\""),
                           (["--trigger", "rising:X actual positoin:1", "--for", "1"], 'did you mean "X actual position"'),
                           (["--trigger", "error-stop"], "needs --for"), (["--before", "1"], "--before"),
                           (["--object", "X"], "AXIS:INDEX"), (["--object", "X:0x1018"], "not in the process data"),
                           (["--for", "80000"], "--every"), (["--every", "0"], "whole number 1 ... 10000")):
            told = program.attached("trace", *words, "--csv", path_of("no.csv"))
            expect(told.returncode in (1, 2) and why in told.stderr, f"trace {words}", told)
        expect(not os.path.exists(path_of("no.csv")), "a file of nothing")
        child = subprocess.Popen([CM1E, "trace", "--attach", str(program.pid), "--for", "60", "--trigger", "error-stop",
                                  "--csv", path_of("never.csv")], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                 text=True, env=ENVIRONMENT)
        time.sleep(1)
        child.terminate()
        out, err = child.communicate(timeout=20)
        expect(child.returncode == 1 and "did not come" in err and len(rows("never.csv")) > 100, "no trigger",
               out + err)


def check_end_of_program():
    with running() as (_, program):
        child = subprocess.Popen([CM1E, "trace", "--attach", str(program.pid), "--csv", path_of("end.csv")],
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT)
        time.sleep(1)
        program.process.terminate()
        out, err = child.communicate(timeout=20)
        program.process.wait(timeout=20)
        states = [row[1] for row in rows("end.csv")[1:]]
        expect(child.returncode == 0 and "has ended" in err and "What came until then is written" in err, "end",
               out + err)
        expect(len(states) > 500 and states[-1] == "Disabled", "the end of the run is recorded", states[-3:])


def check_variables():
    """Those of a program that keeps no trace itself."""
    process = subprocess.Popen([os.path.join(os.path.dirname(CM1E), "03_plc_program"), "-i", "sim", "--seconds", "60"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT)
    wait_for(lambda: os.path.exists(os.path.join(RUNTIME, f"cm1e-{process.pid}-0.sock")), "no control socket")
    def trace(*words):
        return subprocess.run([CM1E, "trace", "--attach", str(process.pid), *words], capture_output=True, text=True,
                              timeout=60, env=ENVIRONMENT)

    names = trace("--list").stdout.splitlines()
    expect("step" in names and "homed" in names, "variables are listed", names)
    told = trace("--for", "1.5", "--before", "0.5", "--trigger", "change:step", "--csv", path_of("step.csv"))
    process.terminate()
    process.communicate(timeout=30)
    head, *samples = rows("step.csv")
    steps = [row[head.index("step")] for row in samples]
    expect(told.returncode == 0 and len(set(steps)) > 1 and steps[0] == steps[400] != steps[-1],
           "a variable and its trigger", (told, steps[::100]))


def check_alone():
    told = subprocess.run([CM1E, "trace", "-b", path_of("bus.yaml"), "--for", "0.5", "--csv", path_of("alone.csv"),
                           "--json"], capture_output=True, text=True, timeout=60, env=ENVIRONMENT)
    expect(told.returncode == 0 and json.loads(told.stdout)["samples"] >= 400 and rows("alone.csv")[5][1] == "Disabled",
           "alone", told)
    told = subprocess.run([CM1E, "trace", "-i", "sim", "--list"], capture_output=True, text=True, timeout=60,
                          env=ENVIRONMENT)
    expect(told.returncode == 0 and "axis1 torque [%]" in told.stdout, "--list, alone", told)


def check_nothing_to_record():
    """A run that nobody can attach to, or that a signal ends in its first moments: no file, and no status 0."""
    nowhere = {**ENVIRONMENT, "CM1E_RUNTIME_DIR": "/proc/none"}
    for words in (("trace", "--for", "0.5", "--csv", path_of("none.csv")), ("trace", "--list"), ("monitor", "--json")):
        told = subprocess.run([CM1E, *words, "-i", "sim"], env=nowhere, capture_output=True, text=True, timeout=20)
        expect(told.returncode == 1 and "No control socket" in told.stderr, f"{words} without a socket", told)
    for words in (("trace", "--for", "5", "--csv", path_of("none.csv")), ("monitor", "--json"), ("reset",)):
        for ms in range(20, 60, 4):
            child = subprocess.Popen([CM1E, *words, "-i", "sim"], env=ENVIRONMENT, stdout=subprocess.PIPE,
                                     stderr=subprocess.PIPE, text=True)
            time.sleep(ms / 1000)
            child.send_signal(signal.SIGINT)
            out, err = child.communicate(timeout=20)
            expect(child.returncode != 0 or out, f"{words}, interrupted after {ms} ms", (child.returncode, out, err))
            expect("still there" not in err, "an error that there is not", err)


def check_who_watches_has_real_time():
    """In virtual time nobody could attach, and a run until a key would take no time."""
    bench.write("virtual.yaml", "bus: {interface: sim, virtual_time: true}\naxes: [{}]\n")
    begin = time.monotonic()
    for words in (("trace", "--list"), ("trace", "--for", "0.5", "--csv", path_of("virtual.csv")), ("monitor", "--json")):
        told = subprocess.run([CM1E, *words, "-b", path_of("virtual.yaml")], capture_output=True, text=True, timeout=60,
                              env=ENVIRONMENT)
        expect(told.returncode == 0 and ("axis1" in told.stdout or "samples" in told.stdout), words, told)
    expect(time.monotonic() - begin > 0.5 and len(rows("virtual.csv")) > 400, "in real time", rows("virtual.csv")[-2:])


if __name__ == "__main__":
    bench.write("bus.yaml", BUS)
    bench.run(check_gaps_are_counted, check_same_samples, check_many_and_gone, check_triggers, check_variables,
              check_end_of_program, check_alone, check_nothing_to_record, check_who_watches_has_real_time)
