#!/usr/bin/env python3
"""cm1e monitor through a terminal (tmux): what the screen shows, what its keys do, attached to a running program and
alone, and that a motor stops when the key, the terminal or the client is lost.

test_monitor.py BIN-DIRECTORY
"""
import contextlib
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import control_bench as bench  # noqa: E402
from control_bench import CM1E, FOLDER, RUNTIME, expect, faults, path_of, wait_for  # noqa: E402
from control_client import Client  # noqa: E402

BUS = """\
bus: {{interface: sim, control: {control}, lost_cycles_limit: 50}}
axes:
  - {{name: X, sim: {{no_stops: true}}}}
  - {{name: Y, homing: {{method: -2, velocity: 2, acceleration: 20, torque: 30}}}}
  - {{name: Z, sim: {{no_stops: true}}, software_limits: {{negative: -0.5, positive: 0.5}}}}
"""
X, Y, Z = 1, 2, 3
ENVIRONMENT = {**bench.ENVIRONMENT, "TERM": "xterm", "LC_ALL": "C.UTF-8",
               "ASAN_OPTIONS": "detect_leaks=0"}  # ncurses keeps what it knows of a terminal


def bus_file(control):
    return path_of(f"{control}.yaml")


def axis(client, number):
    return client.ask("axes")["axes"][number - 1]


@contextlib.contextmanager
def running(control):
    """A program that moves axis X only. Yields a client, and the program's process."""
    with bench.asked(f"{control}.yaml") as (client, program):
        yield client, program.pid


class Terminal:
    """A terminal with a command in it; afterwards it shows the exit status."""

    numbers = itertools.count()

    def __init__(self, *words, columns=100, lines=30, **environment):
        self.socket = os.path.join(FOLDER, f"tmux{next(Terminal.numbers)}")  # a server that ends may still be there
        settings = " ".join(f"{name}={value}" for name, value in environment.items())
        self.tmux("-f", "/dev/null", "new-session", "-d", "-x", str(columns), "-y", str(lines),
                  f"env {settings} {' '.join([CM1E, *words])}; echo status $?; sleep 600")

    def tmux(self, *words):
        return subprocess.run(["tmux", "-S", self.socket, *words], capture_output=True, text=True, timeout=20,
                              env=ENVIRONMENT).stdout

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.tmux("kill-server")

    def screen(self):
        return self.tmux("capture-pane", "-p")

    def shows(self, words, seconds=10):
        wait_for(lambda: words in " ".join(self.screen().split()), f"the screen does not show \"{words}\"", seconds)
        if words not in " ".join(self.screen().split()):
            faults.append(self.screen())

    def press(self, *keys):
        self.tmux("send-keys", *keys)

    def hold(self, key, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.press(key)
            time.sleep(0.03)

    def value(self, name, column):
        """Of the row of an axis: 0 = state, 1 = position, 2 = velocity ..."""
        row = re.search(rf"^[> ] {name} +(.*)$", self.screen(), re.MULTILINE)
        words = row.group(1).split() if row else []
        return words[column] if column < len(words) else ""


# ---- attached -------------------------------------------------------------------------------------------------------

def check_attached():
    with running("maintain") as (client, pid), Terminal("monitor", "--attach", str(pid)) as terminal:
        terminal.shows("X ContinuousMotion")
        terminal.shows(f"cm1e move (process {pid}) on sim, control: maintain")
        terminal.shows("lost frames 0")
        expect(0.4 < float(terminal.value("X", 2) or 0) < 0.6, "the velocity on the screen", terminal.screen())
        before = float(terminal.value("X", 1) or 0)
        time.sleep(0.5)
        expect(float(terminal.value("X", 1) or 0) > before, "the position on the screen", terminal.screen())
        terminal.press("Right")
        terminal.shows("commanded by the program (ContinuousMotion, MC_MoveVelocity)")
        terminal.press("e")
        terminal.shows("disables what the program has enabled")
        terminal.press("Down", "Right")
        terminal.shows("Enable it first")
        terminal.press("e")
        terminal.shows("Y Standstill")
        terminal.hold("Right", 1.0)
        expect(axis(client, Y)["position"] > 0.2, "a held key does not move the motor", terminal.screen())
        terminal.shows("Y Standstill", 2)
        expect(axis(client, Y)["powered"], "the axis stays enabled while the screen is there")
        stood = axis(client, Y)["position"]
        time.sleep(0.3)
        expect(abs(axis(client, Y)["position"] - stood) < 0.001, "the motor moves without a key")
        terminal.press("]", "]")
        terminal.shows("jog 2 u/s")
        terminal.press("h")
        terminal.shows("Home this axis? It moves")
        terminal.press("n")
        expect(axis(client, Y)["state"] == "Standstill", "n does not home")
        terminal.press("h", "y")
        terminal.shows("Y Homing", 3)
        terminal.press("Space")
        terminal.shows("Y Standstill", 3)
        terminal.press("e")
        terminal.shows("Y Disabled", 3)
        terminal.press("q")
        terminal.shows("status 0")


def check_observe():
    with running("observe") as (client, pid), Terminal("monitor", "--attach", str(pid)) as terminal:
        terminal.shows("control: observe")
        terminal.press("Down", "e")
        terminal.shows("needs `control: maintain` in its bus file")
        expect(axis(client, Y)["state"] == "Disabled", "observe has enabled an axis")


def check_error():
    with running("maintain") as (client, pid), Terminal("monitor", "--attach", str(pid), "-v", "8") as terminal:
        terminal.press("Down", "e")  # also before the screen is there
        terminal.shows("Y Standstill")
        terminal.hold("Right", 2.5)
        terminal.shows("Y ErrorStop")
        terminal.shows("Axis \"Y\"")
        terminal.press("r")
        terminal.shows("Y Disabled", 20)
        time.sleep(0.3)
        expect(axis(client, Y)["state"] == "Disabled", "power comes back by a reset")


def check_terminal_lost():
    with running("maintain") as (client, pid):
        with Terminal("monitor", "--attach", str(pid)) as terminal:
            terminal.press("Down", "e")
            terminal.shows("Y Standstill")
            terminal.hold("Right", 0.7)
            expect(abs(axis(client, Y)["velocity"]) > 0.3, "the motor does not move", terminal.screen())
        wait_for(lambda: abs(axis(client, Y)["set_velocity"]) < 1e-9, "the terminal is lost, and the motor goes on", 1)
        wait_for(lambda: not axis(client, Y)["powered"], "the terminal is lost, and the motor has torque", 3)


def check_jog():
    """cm1e jog and enable, attached."""
    with running("maintain") as (client, pid):
        with Terminal("jog", "--attach", str(pid), "Y", "-v", "1") as terminal:
            terminal.shows("at rest")
            terminal.hold("Right", 1.0)
            there = axis(client, Y)["position"]
            expect(there > 0.3, "a held key does not move the motor", terminal.screen())
            wait_for(lambda: abs(axis(client, Y)["set_velocity"]) < 1e-9, "the motor goes on without a key", 1)
            terminal.hold("Left", 0.5)
            terminal.press("q")
            terminal.shows("Y: jogged from 0 to")
            terminal.shows("status 0")
        expect(not axis(client, Y)["powered"], "torque after jog", axis(client, Y))
        with Terminal("jog", "--attach", str(pid), "X") as terminal:
            terminal.shows("moves")
            terminal.press("Right")
            terminal.shows("commanded by the program")
            terminal.shows("status 1")
        with Terminal("jog", "--attach", str(pid), "Y") as terminal:
            terminal.shows("at rest")
            terminal.hold("Right", 0.6)
            terminal.press("C-c")
            terminal.shows("status 0")
        expect(not axis(client, Y)["powered"], "torque after Ctrl-C", axis(client, Y))
        with Terminal("enable", "--attach", str(pid), "Z") as terminal:
            terminal.shows("Any key ends it")
            wait_for(lambda: axis(client, Z)["powered"], "enable")
            terminal.press("x")
            terminal.shows("Z: was enabled for")
        wait_for(lambda: not axis(client, Z)["powered"], "torque after enable")


def check_program_ends():
    with running("maintain") as (_, pid):
        terminal = Terminal("monitor", "--attach", str(pid))
        terminal.shows("X ContinuousMotion")
    with terminal:
        terminal.shows("status 0")
        expect("does not run any more" in terminal.screen() or "has ended" in terminal.screen(), "why it ends",
               terminal.screen())


# ---- terminals ------------------------------------------------------------------------------------------------------

def check_sizes():
    with running("maintain") as (client, pid), Terminal("monitor", "--attach", str(pid)) as terminal:
        terminal.shows("torque %")
        terminal.tmux("resize-window", "-x", "60", "-y", "12")
        wait_for(lambda: "torque" not in terminal.screen(), "columns that do not fit are left out")
        terminal.shows("X ContinuousMotion")
        terminal.tmux("resize-window", "-x", "40", "-y", "8")
        terminal.shows("X ContinuousMotion")
        for _ in range(2):
            terminal.press("Down")
        terminal.shows("> Z")
        terminal.tmux("resize-window", "-x", "30", "-y", "5")
        terminal.shows("40x8 at least")
        terminal.press("e")
        time.sleep(0.5)
        expect(axis(client, Z)["state"] == "Disabled", "a key acts that nothing is shown of")
        terminal.tmux("resize-window", "-x", "200", "-y", "50")
        terminal.shows("torque %")
        terminal.shows("pos[")
        terminal.press("q")
        terminal.shows("status 0")


def check_no_terminal():
    told = subprocess.run([CM1E, "monitor", "-i", "sim"], capture_output=True, text=True, timeout=30, env=ENVIRONMENT,
                          stdin=subprocess.DEVNULL)
    expect(told.returncode == 2 and "needs a terminal" in told.stderr, "no terminal", told)
    for name, words in (("nonsense", "TERM=nonsense is not known"), ("", "set TERM"), ("dumb", "cannot be moved")):
        with Terminal("monitor", "-i", "sim", TERM=name) as terminal:
            terminal.shows(words)
            terminal.shows("status 2")
    for words, why in ((["-i", "no-such-interface"], "no-such-interface"), (["--attach", "1"], "no control socket"),
                       (["-i", "sim", "X"], "too many"), (["-i", "sim", "-v", "0"], "velocity")):
        told = subprocess.run([CM1E, "monitor", "--json", *words], capture_output=True, text=True, timeout=30,
                              env=ENVIRONMENT)
        expect(told.returncode in (1, 2) and why in told.stderr, f"monitor {words}", told)


# ---- alone ----------------------------------------------------------------------------------------------------------

def check_alone():
    """Also where the bus file lets nobody look: this is the program itself."""
    for control in ("observe", "none"):
        with Terminal("monitor", "-b", bus_file(control)) as terminal:
            terminal.shows("X Disabled")
            terminal.press("e")
            terminal.shows("X Standstill")
            terminal.hold("Left", 1.0)
            wait_for(lambda: terminal.value("X", 0) == "Standstill", "the motor goes on without a key", 3)
            expect(float(terminal.value("X", 1) or 0) < -0.2, "a held key does not move the motor", terminal.screen())
            sockets = [name for name in os.listdir(RUNTIME) if name.endswith(".sock")]
            expect(len(sockets) == 1, "sockets", sockets)
            with Client(os.path.join(RUNTIME, sockets[0])) as client:
                reply = client.ask("enable", axis=Y) if control == "observe" else client.receive()
                words = "control: maintain" if control == "observe" else "control: none"
                expect(not reply["ok"] and words in reply["error"]["text"], f"{control} for others", reply)
            terminal.press("q")
            terminal.shows("status 0")
    with Terminal("monitor", "-i", "sim") as terminal:
        terminal.shows("axis1 Disabled")
        terminal.press("C-c")
        terminal.shows("status 0")


PROGRAM = """PROGRAM Main
VAR n : INT; text : STRING := 'hello'; many : ARRAY[1..40] OF BOOL; END_VAR
n := n + 1;
END_PROGRAM
"""


def check_variables():
    """The variables of a program in Structured Text: a page of them, and what is forced on either page."""
    bench.write("screen.st", PROGRAM)
    for words in (("st", "build", path_of("screen.st")), ("run", path_of("screen.so"), "-b", bus_file("maintain"), "-s", "60")):
        program = subprocess.Popen([CM1E, *words], cwd=FOLDER, env=ENVIRONMENT, stdout=subprocess.DEVNULL)
        expect(words[0] == "run" or program.wait(60) == 0, "the program is built", words)
    wait_for(lambda: any(f"-{program.pid}-" in name for name in os.listdir(RUNTIME)), "no socket", 20)
    with Terminal("monitor", "--attach", str(program.pid)) as terminal:
        terminal.shows("X Disabled")
        terminal.press("v")
        terminal.shows("Main.text 'hello'")
        terminal.press("Down")
        terminal.shows("variable value Main.text")
        force = subprocess.Popen([CM1E, "var", "force", "--attach", str(program.pid), "--allow-write", "Main.n=-7"],
                                 env=ENVIRONMENT, stderr=subprocess.DEVNULL)
        terminal.press("Up")
        terminal.shows("Main.n -7 FORCED")
        terminal.press("v")
        terminal.shows("FORCED (1): Main.n = -7 axis state")
        force.terminate()
        force.wait(10)
        wait_for(lambda: "FORCED" not in terminal.screen(), "the line of what is forced stays", 5)
    program.terminate()
    program.wait(20)


def check_json():
    alone = subprocess.run([CM1E, "monitor", "-b", bus_file("observe"), "--json"], capture_output=True, text=True,
                           timeout=60, env=ENVIRONMENT)
    with running("observe") as (_, pid):
        attached = subprocess.run([CM1E, "monitor", "--attach", str(pid), "--json"], capture_output=True, text=True,
                                  timeout=60, env=ENVIRONMENT)
    for told in (alone, attached):
        shown = json.loads(told.stdout)
        expect(told.returncode == 0 and [a["name"] for a in shown["axes"]] == ["X", "Y", "Z"] and
               shown["statistics"]["cycles"] > 0, "monitor --json", told)


if __name__ == "__main__":
    if not shutil.which("tmux"):
        print("SKIPPED: tmux is not installed")
        sys.exit(77)
    for consent in ("none", "observe", "maintain"):
        bench.write(f"{consent}.yaml", BUS.format(control=consent))
    bench.run(check_jog, check_sizes, check_attached, check_error, check_no_terminal, check_terminal_lost, check_json, check_variables,
              check_program_ends, check_observe, alone=(check_alone,))  # which looks at all sockets
