#!/usr/bin/env python3
"""What others may do to the axes of a running program through its control socket: only by its consent, never while it
commands the axis itself, and never longer than they renew it.

test_maintain.py BIN-DIRECTORY
"""
import json
import os
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import control_bench as bench  # noqa: E402
from control_bench import CM1E, ENVIRONMENT, expect, wait_for  # noqa: E402
from control_client import Client, Program  # noqa: E402

# Axis Y has stops 5 revolutions away, Z a software limit.
BUS = """\
bus: {{interface: sim, control: {control}, lost_cycles_limit: 50}}
axes:
  - {{name: X, sim: {{no_stops: true}}}}
  - {{name: Y, limits: {{position_lag: 20}}, homing: {{method: -2, velocity: 2, acceleration: 10, torque: 30}}}}
  - {{name: Z, sim: {{no_stops: true}}, software_limits: {{negative: -0.5, positive: 0.5}}}}
  - {{name: E, type: encoder}}
"""
X, Y, Z, E = 1, 2, 3, 4
VELOCITY_RANGE = -66  # CM1E_ERROR_AXIS_VELOCITY_RANGE


def running(control="maintain"):
    """A program that moves axis X only. Yields a client, and the program."""
    return bench.asked(f"{control}.yaml")


def axis(client, number):
    return client.ask("axes")["axes"][number - 1]


def text(reply):
    return "" if reply["ok"] else reply["error"]["text"]


def refused(reply, words, what):
    expect(not reply["ok"] and words in text(reply), what, reply)


def enable(client, number):
    reply = client.ask("enable", axis=number, keep_ms=2000)
    expect(reply["ok"], f"enable {number}", reply)
    wait_for(lambda: axis(client, number)["state"] == "Standstill", f"axis {number} is not enabled")


def jog_for(client, number, velocity, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        reply = client.ask("jog", axis=number, velocity=velocity)
        client.ask("keep")
        if not reply["ok"]:
            return reply
        time.sleep(0.03)
    return reply


def stands(client, number):
    return abs(axis(client, number)["set_velocity"]) < 1e-9


# ---- consent and precedence -----------------------------------------------------------------------------------------

def check_consent():
    with running("observe") as (client, _):
        for request in ("enable", "disable", "jog", "home", "stop", "reset", "keep"):
            refused(client.ask(request, axis=Y, velocity=0.1), "control: maintain", f"{request} by observe")
        expect(axis(client, Y)["state"] == "Disabled", "observe has enabled an axis")


def check_precedence():
    with running() as (client, _):
        for request in ("enable", "jog", "home", "reset"):
            refused(client.ask(request, axis=X, velocity=-0.1), "commanded by the program (ContinuousMotion, "
                    "MC_MoveVelocity)", f"{request} of an axis that the program moves")
        refused(client.ask("stop", axis=X), "not moved through", "stop of a motion of the program")
        refused(client.ask("disable", axis=X), "not enabled through", "disable of an axis of the program")
        refused(client.ask("enable", axis=E), "encoder", "enable of an encoder")
        refused(client.ask("jog", axis=Y, velocity=0.1), "Enable it first", "jog without power")
        refused(client.ask("home", axis=Y), "Enable it first", "home without power")
        for wrong in ({"axis": 0}, {"axis": 5}, {"axis": "Y"}, {}, {"axis": Y}, {"axis": Y, "velocity": 0},
                      {"axis": Y, "velocity": "1"}, {"axis": Y, "velocity": 1, "keep_ms": 49},
                      {"axis": Y, "velocity": 1, "keep_ms": 1001}, {"axis": Y, "velocity": 1, "acceleration": -1}):
            refused(client.ask("jog", **wrong), "expected", f"jog {wrong}")
        refused(client.ask("enable", axis=Y, keep_ms=100), "500 ... 10000", "enable for 100 ms")
        expect(axis(client, Y)["state"] == "Disabled" and axis(client, Y)["position"] == 0, "a refused request acted")


# ---- dead-man -------------------------------------------------------------------------------------------------------

def check_jog():
    with running() as (client, _):
        enable(client, Y)
        expect(axis(client, Y)["held"] and axis(client, Y)["state"] == "Standstill", "enabled", axis(client, Y))
        refused(client.ask("stop", axis=Y), "not moved through", "stop of an axis that is enabled and at rest")
        jog_for(client, Y, 0.5, 1.0)
        moved = axis(client, Y)
        expect(moved["state"] == "ContinuousMotion" and 0.3 < moved["position"] < 0.7, "a jog that is renewed", moved)
        time.sleep(0.4)
        after = axis(client, Y)
        expect(after["state"] == "Standstill" and after["position"] < moved["position"] + 0.3 and after["powered"],
               "a jog that is not renewed", after)
        jog_for(client, Y, 0.5, 0.3)
        jog_for(client, Y, -0.5, 0.5)
        expect(axis(client, Y)["velocity"] < 0, "a jog backwards right after one forwards", axis(client, Y))
        client.ask("jog", axis=Y, velocity=-0.5, keep_ms=2000)  # it goes on also where this client has to wait
        reply = client.ask("stop", axis=Y)
        expect(reply["ok"], "stop is refused", reply)
        wait_for(lambda: stands(client, Y), "after stop the motor goes on", 1)
        reply = client.ask("jog", axis=Y, velocity=1e6)
        refused(reply, "elocity", "a velocity above that of the axis")
        expect(reply["error"]["code"] == VELOCITY_RANGE, "the code of a velocity above that of the axis", reply)
        expect(client.ask("disable", axis=Y)["ok"], "disable")
        wait_for(lambda: not axis(client, Y)["powered"], "disable")
        expect(not axis(client, Y)["held"], "held after disable")


def check_jog_of_an_axis_that_the_program_enables():
    """A jog needs no "enable" through the socket then, and ends like any other one."""
    program = Program(CM1E, bench.path_of("maintain.yaml"), ENVIRONMENT, command=("enable",))
    wait_for(program.listens, "no control socket")
    with Client(program) as client:
        wait_for(lambda: axis(client, X)["state"] == "Standstill", "the program does not enable its axis")
        moved = jog_for(client, X, 0.5, 0.5)
        expect(moved["ok"] and not stands(client, X), "a jog of an axis that the program enables", moved)
        wait_for(lambda: stands(client, X), "a jog that is not renewed goes on", 3)
        expect(axis(client, X)["powered"], "the program's power is off")
    program.end()


def check_power_goes_off():
    with running() as (client, _):
        enable(client, Y)
        begin = time.monotonic()
        while time.monotonic() < begin + 3:
            client.ask("keep")
            time.sleep(0.1)
        expect(axis(client, Y)["powered"], "power that is renewed")
        time.sleep(2.3)
        expect(axis(client, Y)["state"] == "Disabled" and not axis(client, Y)["powered"], "power that is not renewed",
               axis(client, Y))


def check_software_limit():
    with running() as (client, _):
        enable(client, Z)
        reply = jog_for(client, Z, 1.0, 2.0)
        refused(reply, "software limit", "jog at the limit")
        stood = axis(client, Z)
        expect(abs(stood["position"] - 0.5) < 0.01 and stood["state"] == "Standstill", "a jog ends at the limit", stood)
        expect(stood["limits"] == {"lower": -0.5, "upper": 0.5, "velocity": stood["limits"]["velocity"],
                                   "lag": stood["limits"]["lag"]} and stood["limits"]["lag"] > 0, "limits", stood)


# ---- lost connections -----------------------------------------------------------------------------------------------

def check_connection_lost():
    with running() as (client, program):
        with Client(program) as other:
            enable(other, Y)
            jog_for(other, Y, 0.5, 0.5)
            refused(client.ask("jog", axis=Y, velocity=0.1), "held by another", "an axis that another one holds")
            refused(client.ask("disable", axis=Y), "held by another", "disable of another one's axis")
        lost = time.monotonic()
        wait_for(lambda: stands(client, Y), "the connection is lost, and the motor goes on", 1)
        expect(time.monotonic() - lost < 0.2, "the lost connection is not seen at once", time.monotonic() - lost)
        wait_for(lambda: not axis(client, Y)["powered"] and not axis(client, Y)["held"], "power after that", 2)
        with Client(program) as other:  # anybody may stop
            enable(other, Y)
            jog_for(other, Y, 0.5, 0.3)
            expect(client.ask("stop", axis=Y)["ok"], "stop of another one's motion")
            wait_for(lambda: stands(client, Y), "stop of another one's motion", 1)


def check_stop_of_a_jog_that_is_renewed():
    """It ends for good, until its own connection has let go of it for as long as one request lasts."""
    with running() as (client, program), Client(program) as other:
        enable(other, Y)
        jog_for(other, Y, 0.5, 0.3)
        expect(client.ask("stop", axis=Y)["ok"], "stop of a jog that goes on")
        end, replies = time.monotonic() + 0.8, []
        while time.monotonic() < end:
            other.ask("keep")
            replies.append(other.ask("jog", axis=Y, velocity=0.5 if len(replies) % 2 else -0.4))
            time.sleep(0.03)
        for reply in replies:
            refused(reply, "Another connection has stopped axis \"Y\"", "a jog that was stopped")
        expect(stands(client, Y), "a stopped jog moves on", axis(client, Y))
        other.ask("keep")
        time.sleep(0.35)
        expect(jog_for(other, Y, 0.5, 0.2)["ok"], "a jog after letting go")
        wait_for(lambda: stands(client, Y), "the own stop")
        for _ in range(5):
            other.ask("jog", axis=Y, velocity=-3, acceleration=20)
            time.sleep(0.05)
        other.ask("stop", axis=Y)  # which takes 0.15 s
        other.ask("jog", axis=Y, velocity=-3, acceleration=0.5)  # and let go: it would take 6 s with that
        wait_for(lambda: stands(client, Y), "a jog behind a stop makes the way to standstill longer", 1.5)
        for reply in (other.ask("jog", axis=Y, velocity=0.5), other.ask("stop", axis=Y), other.ask("jog", axis=Y, velocity=-0.5)):
            expect(reply["ok"], "a jog right after the own stop", reply)


CHILD = """
import sys, time
sys.path.insert(0, sys.argv[2])
from control_client import Client
with Client(sys.argv[1]) as client:
    client.ask("enable", axis=2)
    while not client.ask("axes")["axes"][1]["powered"]:
        client.ask("keep")
    while True:
        client.ask("jog", axis=2, velocity=0.5)
        client.ask("keep")
        time.sleep(0.03)
"""


def check_client_suspended():
    """A client that is killed, and one that is suspended with its connection open."""
    for how in (signal.SIGKILL, signal.SIGSTOP):
        with running() as (client, program):
            support = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support")
            child = subprocess.Popen([sys.executable, "-c", CHILD, program.path, support])
            try:
                wait_for(lambda: axis(client, Y)["position"] > 0.3, "the child does not jog")
                os.kill(child.pid, how)
                lost = time.monotonic()
                wait_for(lambda: stands(client, Y), f"{how}: the motor goes on", 1)
                expect(time.monotonic() - lost < 0.5, f"{how}: stopped late", time.monotonic() - lost)
                wait_for(lambda: not axis(client, Y)["powered"], f"{how}: power", 4)
            finally:
                child.kill()
                child.wait()


# ---- home, errors, end ----------------------------------------------------------------------------------------------

def check_home():
    with running() as (client, program):
        with Client(program) as other:
            enable(other, Y)
            expect(other.ask("home", axis=Y)["ok"], "home")
            wait_for(lambda: abs(axis(client, Y)["velocity"]) > 1, "Homing", 1)
            expect(axis(client, Y)["state"] == "Homing", "Homing", axis(client, Y))
            refused(other.ask("jog", axis=Y, velocity=0.1), "already moved", "jog beside a homing")
        wait_for(lambda: axis(client, Y)["state"] == "Disabled" and abs(axis(client, Y)["velocity"]) < 0.01,
                 "the connection is lost, and the homing goes on", 3)
        expect(not axis(client, Y)["homed"] and abs(axis(client, Y)["position"]) < 3, "broken off", axis(client, Y))
        enable(client, Y)
        again = client.ask("home", axis=Y)
        expect(again["ok"], "home again", again)

        def homed():
            client.ask("keep")
            return axis(client, Y)["homed"]

        wait_for(homed, "a homing that is renewed", 20)


def check_error_and_reset():
    with running() as (client, _):
        enable(client, Y)
        jog_for(client, Y, 8, 3)
        wait_for(lambda: axis(client, Y)["state"] == "ErrorStop", "no error at the mechanical stop")
        refused(client.ask("jog", axis=Y, velocity=-1), "Reset it first", "jog in ErrorStop")
        wait_for(lambda: not axis(client, Y)["powered"], "power in ErrorStop")
        expect(axis(client, Y)["text"] != "", "the text of the error", axis(client, Y))
        expect(client.ask("reset", axis=Y)["ok"], "reset")
        wait_for(lambda: axis(client, Y)["state"] == "Disabled" and not axis(client, Y)["resetting"], "reset", 5)
        time.sleep(0.3)
        expect(axis(client, Y)["state"] == "Disabled" and not axis(client, Y)["held"], "power comes back by itself",
               axis(client, Y))


def check_emergencies(client, attached):
    """Of a drive that stopped with an error of its own: told by the socket, by status and in the event log."""
    wait_for(lambda: client.ask("slaves")["slaves"][Y - 1]["emergencies"], "no emergency of the drive")
    slaves = client.ask("slaves")["slaves"]
    told = slaves[Y - 1]["emergencies"][0]
    expect(slaves[X - 1]["emergencies"] == [] and told["number"] == 1 and told["code"] != 0 and
           abs(told["time_ns"] / 1e9 - time.time()) < 60 and len(told["data"]) == 5, "emergencies", slaves)
    words = f"emergency 0x{told['code']:04X}, "
    expect(told["text"].startswith(words) and "Cure: " in told["text"], "the text of an emergency", told)
    shown = attached("status")
    expect("slave 1, axis X: " in shown.stdout and "slave 2, axis Y: " in shown.stdout and " u\n" not in shown.stdout,
           "status names the axes of the program, whose units it does not know", shown)
    drawn = attached("graph")
    expect('"1: X\\n' in drawn.stdout and '"2: Y\\n' in drawn.stdout, "graph names the axes of the program", drawn)
    expect(shown.returncode == 0 and shown.stdout.count("emergency") == 1 and words in shown.stdout, "status", shown)
    as_json = json.loads(attached("status", "--json").stdout)
    expect([len(s["emergencies"]) for s in as_json] == [0, 1, 0] and as_json[Y - 1]["emergencies"][0]["code"] ==
           told["code"], "status --json", as_json)
    error = axis(client, Y)["text"]
    expect(error != "" and error in shown.stdout and [s.get("axis_errors") for s in as_json] == [None, [error], None],
           "status has the error of the axis", (error, shown.stdout))
    events = [e for e in client.ask("log")["log"]["events"] if e["kind"] == "emergency"]
    expect([e["code"] for e in events] == [told["code"]] and words in events[0]["text"] and
           events[0]["text"].startswith('Slave 2 ("Y", '), "the event log", events)


def check_commands():
    """cm1e reset, enable and jog, attached."""
    def attached(pid, *words):
        return subprocess.run([CM1E, *words, "--attach", str(pid)], capture_output=True, text=True, timeout=60,
                              env=ENVIRONMENT, stdin=subprocess.DEVNULL)

    with running() as (client, program):
        pid = client.ask("hello")["hello"]["pid"]
        told = attached(pid, "reset")
        expect(told.returncode == 0 and told.stdout == "".join(f"{name}: has no error (simulated)\n" for name in "XYZ"),
               "reset without an error", told)
        enable(client, Y)
        jog_for(client, Y, 8, 3)
        wait_for(lambda: axis(client, Y)["state"] == "ErrorStop", "no error at the mechanical stop")
        check_emergencies(client, lambda *words: attached(pid, *words))
        told = attached(pid, "reset", "Y")
        expect(told.returncode == 0 and told.stdout.startswith("Y: error reset (simulated). It was: Axis \"Y\"") and
               told.stdout.count("Axis \"Y\"") == 1, "reset", told)
        as_json = json.loads(attached(pid, "reset", "--json").stdout)
        expect([a["axis"] for a in as_json] == ["X", "Y", "Z"] and not as_json[1]["had_error"], "reset --json", as_json)
        told = attached(pid, "reset", "nobody")
        expect(told.returncode == 2 and "no axis \"nobody\"" in told.stderr, "reset of an axis that is not there", told)
        told = attached(pid, "enable", "Z", "--for", "1")
        expect(told.returncode == 0 and told.stdout.startswith("Z: was enabled for 1.0 s"), "enable", told)
        expect(not axis(client, Z)["powered"], "enabled after the command", axis(client, Z))
        child = subprocess.Popen([CM1E, "enable", "Z", "--for", "60", "--attach", str(pid)], stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, text=True, env=ENVIRONMENT)
        wait_for(lambda: axis(client, Z)["powered"], "enable")
        child.terminate()
        out, err = child.communicate(timeout=20)
        expect(child.returncode == 0 and "was enabled" in out, "enable that is ended by a signal", out + err)
        expect(not axis(client, Z)["powered"], "enabled after a signal", axis(client, Z))
        told = attached(pid, "enable", "X", "--for", "0.2")  # which the program moves
        expect(told.returncode == 1 and told.stdout == "" and "commanded by the program" in told.stderr, "enable of the program's axis", told)
        told = attached(pid, "jog", "Z")
        expect(told.returncode == 2 and "needs a terminal" in told.stderr, "jog without a terminal", told)
    with running("numbers") as (client, program):
        told = attached(client.ask("hello")["hello"]["pid"], "enable", "2", "--for", "0.2")
        expect(told.stdout.startswith("2: was enabled") and "ErrorStop" not in told.stderr, "a name comes before a number", told)
    with running("observe") as (client, program):
        pid = client.ask("hello")["hello"]["pid"]
        for words in (("enable", "Z", "--for", "1"), ("enable", "Z", "--for", "1", "--json")):
            told = attached(pid, *words)
            expect(told.returncode == 1 and "control: maintain" in told.stderr, "enable by observe", told)


if __name__ == "__main__":
    for consent in ("observe", "maintain"):
        bench.write(f"{consent}.yaml", BUS.format(control=consent))
    bench.write("numbers.yaml", BUS.format(control="maintain").replace("name: Z", 'name: "2"').replace("name: Y", 'name: "3"'))
    bench.run(check_commands, check_client_suspended, check_error_and_reset, check_power_goes_off, check_home, check_jog,
              check_jog_of_an_axis_that_the_program_enables, check_connection_lost, check_stop_of_a_jog_that_is_renewed, check_software_limit, check_precedence, check_consent)
