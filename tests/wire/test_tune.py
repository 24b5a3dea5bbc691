#!/usr/bin/env python3
"""`cm1e tune` over a veth pair: what it measures of the simulated motor, that parameters are written and restored, that
it keeps its limits, and what ends it.

test_tune.py CM1E
"""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

AXES = """bus: {{interface: {interface}, lost_cycles_limit: 50}}
axes: [{{name: X, {more}}}]
"""
PATIENCE_S = 60
# The simulated motor is behind its set-point by a time, whatever its velocity. That time depends on where in a cycle of the
# servo a frame arrives: 1.10 to 1.48 ms were seen.
LAG_S = (0.9e-3, 1.8e-3)


class Bench:
    def __init__(self, cm1e, segment, folder):
        self.cm1e, self.segment, self.folder = cm1e, segment, folder

    def bus_file(self, more="limits: {jerk: 20000}"):
        path = os.path.join(self.folder, "bus.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(AXES.format(interface=wire.MASTER_INTERFACE, more=more))
        return path

    def tune(self, kind, *words, bus_file=None):
        return self.segment.run([self.cm1e, "tune", kind, "X", "-b", bus_file or self.bus_file(), *words])

    def measured(self, kind, *words, bus_file=None):
        """The run, repeated on a machine that pauses: a table over time ends then."""
        end = time.monotonic() + PATIENCE_S
        told = self.tune(kind, *words, "--json", bus_file=bus_file)
        while "frames were lost or not sent" in told.stderr and time.monotonic() < end:
            told = self.tune(kind, *words, "--json", bus_file=bus_file)
        wire.check(told.returncode == 0, f"{kind} {words}: {told}")
        return json.loads(told.stdout)

    def parameter(self, name):
        told = self.segment.run([self.cm1e, "params", "get", "-b", self.bus_file(), "1", name, "--json"])
        return json.loads(told.stdout)[0]["value"]


def measurements(bench):
    limits = ("--max-travel", "0.5", "--max-velocity", "10")
    step = bench.measured("step", *limits)["before"]["parts"][0]
    wire.check(0.02 < step["rise_s"] < 0.3 and step["overshoot_percent"] < 5 and 0 <= step["settling_s"] < 0.3 and
               0 < step["largest_lag"] < 0.05, f"step: {step}")
    for travel, velocity in ((1, 2), (4, 8)):
        ramp = bench.measured("ramp", "--max-travel", str(travel), "--max-velocity", str(velocity))["before"]["parts"][0]
        behind_s = ramp["steady_lag"] / velocity
        wire.check(LAG_S[0] < behind_s < LAG_S[1] and ramp["steady_lag"] <= ramp["largest_lag"],
                   f"the lag at {velocity} u/s is that of {behind_s:.6f} s: {ramp}")
    for more in ("", "unit: {modulo_range: 1}, "):
        far = bench.measured("step", "--max-travel", "2.3", "--max-velocity", "10",
                             bus_file=bench.bus_file(more + "limits: {jerk: 20000}"))["before"]["parts"][0]
        wire.check(0.15 < far["rise_s"] < 0.5 and far["overshoot_percent"] < 1 and 0 <= far["settling_s"] < 0.1 and
                   0 < far["largest_lag"] < 0.05, f"2.3 turns: {far}")
    chirp = bench.measured("chirp", *limits, "--frequency", "6", "--to", "40", "--steps", "4")["before"]["parts"]
    wire.check([round(part["frequency"], 2) for part in chirp] == [6, 11.29, 21.25, 40], f"frequencies: {chirp}")
    for slow, fast in zip(chirp, chirp[1:]):
        wire.check(fast["phase_degrees"] < slow["phase_degrees"] < 0 and fast["amplitude"] < slow["amplitude"],
                   f"phase: {chirp}")
    wire.check(abs(chirp[0]["gain"] - 1) < 0.05, f"gain: {chirp}")
    one = bench.measured("sine", *limits, "--frequency", "6")["before"]["parts"][0]
    wire.check(abs(one["phase_degrees"] - chirp[0]["phase_degrees"]) < 2, f"sine and chirp differ: {one} {chirp[0]}")


def settings(bench):
    page = os.path.join(bench.folder, "page.html")
    words = ("--max-travel", "0.2", "--max-velocity", "5", "--set", "K47=44", "--set", "H3=5")
    both = bench.measured("step", *words, "--html", page)
    wire.check(both["before"]["parameters"] == {"K47": 30, "H3": 0} and both["after"]["parameters"] == {"K47": 44, "H3": 5}
               and both["after"]["parts"][0]["rise_s"] > 0, f"{both}")
    with open(page, encoding="utf-8") as file:
        text = file.read()
    wire.check("before K47=30 H3=0: actual position" in text and "after K47=44 H3=5: lag" in text, "the page")
    wire.check((bench.parameter("K47"), bench.parameter("H3")) == (30, 0), "the values are not restored")
    table = bench.tune("step", *words, "--keep")
    wire.check((bench.parameter("K47"), bench.parameter("H3")) == (44, 5), "--keep does not keep")
    wire.check("rise time" in table.stdout and "K47" in table.stdout and "before and after" in table.stdout, f"{table}")


def limits(bench):
    """Refused before anything moves, or stopped."""
    def refused(said, *words, bus_file=None):
        told = bench.tune("step", *words, bus_file=bus_file)
        wire.check(told.returncode != 0 and said in told.stderr, f"expected \"{said}\": {told}")

    refused("are needed", "--max-travel", "1")
    refused("limits.velocity is 100", "--max-travel", "1", "--max-velocity", "100")
    refused("leaves the software limits; nothing was moved", "--max-travel", "1", "--max-velocity", "5",
            bus_file=bench.bus_file("software_limits: {positive: 0.5, negative: -0.5}"))
    refused("there is no parameter", "--max-travel", "1", "--max-velocity", "5", "--set", "K999=1")
    refused("10 ... 100", "--max-travel", "1", "--max-velocity", "5", "--set", "K47=7")
    high = bench.tune("sine", "--max-travel", "1", "--max-velocity", "5", "--frequency", "200")
    wire.check(high.returncode != 0 and "allow an amplitude of" in high.stderr, f"{high}")
    for low in ("0.01", "1e-300"):
        low = bench.tune("sine", "--max-travel", "1", "--max-velocity", "5", "--frequency", low)
        wire.check(low.returncode != 0 and "200 s are recorded at most" in low.stderr, f"{low}")
    for more in ("limits: {jerk: 20000}", "unit: {modulo_range: 0.02}"):
        pushed = subprocess.Popen(bench.segment.command([bench.cm1e, "tune", "step", "X", "-b", bench.bus_file(more),
                                                         "--max-travel", "0.012", "--max-velocity", "0.03"]),
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        wire.wait_for(lambda: "Operation enabled" in bench.segment.console("status 1"), 10, "the motor was not enabled")
        time.sleep(0.6)
        load = 0.0
        while pushed.poll() is None and load < 1: # slowly: what is pushed by more is too fast before the guard acts
            load += 0.02
            bench.segment.console(f"load 1 {load}")
        bench.segment.console("load 1 0")
        out, err = pushed.communicate(timeout=30)
        wire.check(pushed.returncode == 1 and "left the travel of 0.012 u" in err,
                   f"{more}: a load that pushes it out: {out}{err}")


def interrupted(bench):
    """The motor stops and has no torque; the second run's values go back."""
    def status():
        return bench.segment.console("status 1")

    before = bench.parameter("K47")
    for second in (False, True):
        words = [bench.cm1e, "tune", "step", "X", "-b", bench.bus_file(), "--max-travel", "3", "--max-velocity", "2",
                 "--set", "K47=77"]
        process = subprocess.Popen(bench.segment.command(words), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        wire.wait_for(lambda: "Operation enabled" in status(), 10, "the motor was not enabled")
        if second:
            wire.wait_for(lambda: "Operation enabled" not in status(), 15, "the first run did not end")
            wire.wait_for(lambda: "Operation enabled" in status(), 10, "the second run did not begin")
        time.sleep(0.8)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=30)
        wire.check(process.returncode == 1 and "interrupted" in err and "Operation enabled" not in status(), f"{out}{err}")
        wire.check(bench.parameter("K47") == before, f"K47 after an interruption: {bench.parameter('K47')}")


def signalled_beside_the_runs(bench):
    """A signal while the bus of the second run starts: the motor has the value of that run already."""
    words = [bench.cm1e, "tune", "step", "X", "-b", bench.bus_file(), "--max-travel", "0.1", "--max-velocity", "2", "--set",
             "K47=77"]
    for number, what in enumerate((signal.SIGHUP, signal.SIGTERM, signal.SIGQUIT, signal.SIGHUP, signal.SIGINT)):
        process = subprocess.Popen(bench.segment.command(words), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for there in (True, False):
            wire.wait_for(lambda: ("Operation enabled" in bench.segment.console("status 1")) == there, 15, "the first run")
        time.sleep(0.02 + 0.01 * number)
        process.send_signal(what)
        out, err = process.communicate(timeout=30)
        wire.check(bench.parameter("K47") == 30, f"{what.name} {number}: K47 is {bench.parameter('K47')}: {out}{err}")


def main(cm1e):
    def on_a_segment(check):
        with tempfile.TemporaryDirectory() as folder:
            slaves = os.path.join(folder, "slaves.yaml")
            with open(slaves, "w", encoding="utf-8") as file:
                file.write("axes: [{name: X, sim: {no_stops: true}}]\n")
            with wire.segment(cm1e, slaves) as segment:
                begin = time.monotonic()
                check(Bench(cm1e, segment, folder))
                print(f"{check.__name__}: {time.monotonic() - begin:.1f} s", flush=True)

    wire.together(*(lambda check=check: on_a_segment(check) for check in (interrupted, measurements, settings, limits,
                                                                              signalled_beside_the_runs)))


if __name__ == "__main__":
    main(*sys.argv[1:])
