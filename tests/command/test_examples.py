#!/usr/bin/env python3
"""The examples from 04 on, on the simulated segment and virtual time: what their traces show is what they are about.
The traces stay in the output folder, as plots, for a person to look at.

test_examples.py BIN-DIRECTORY OUTPUT-DIRECTORY
"""
import csv
import math
import os
import pty
import re
import select
import signal
import socket
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import real_time  # noqa: E402

BIN, OUTPUT = sys.argv[1], sys.argv[2]
COLUMNS = ("time", "state", "set_position", "actual_position", "set_velocity", "actual_velocity", "torque")
faults = []


def expect(condition, what):
    if not condition:
        faults.append(what)


def check_texts(program, svg):
    """No text of a plot runs into another one, none is cut at the edge; 6 pixels a letter."""
    picture = xml.etree.ElementTree.parse(svg).getroot()
    placed = []
    for element in picture.iter("{http://www.w3.org/2000/svg}text"):
        if "tick" not in element.get("class"):
            continue
        x, y, width = float(element.get("x")), float(element.get("y")), 6 * len(element.text)
        begin = x - width * {"end": 1, "middle": 0.5}.get(element.get("text-anchor"), 0)
        expect(0 <= begin and begin + width <= float(picture.get("width")) and y > 8,
               f"{program}: \"{element.text}\" is cut at the edge of the plot")
        for other, other_y, other_begin, other_end in placed:
            expect(abs(y - other_y) >= 9 or begin >= other_end or begin + width <= other_begin,
                   f"{program}: \"{element.text}\" is printed over \"{other}\" in the plot")
        placed.append((element.text, y, begin, begin + width))


def run(program, stdin="", arguments=()):
    """What it printed, its trace as a list of dictionaries, and the words of its plot."""
    svg, table = (os.path.join(OUTPUT, f"{program}.{kind}") for kind in ("svg", "csv"))
    done = subprocess.run([os.path.join(BIN, program), "-i", "sim", "--virtual-time", "--svg", svg, "--csv", table,
                           *arguments], capture_output=True, text=True, timeout=60, input=stdin)
    if done.returncode != 0:
        sys.exit(f"{program}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    with open(table, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))[1:]
    trace = [{name: cell if name == "state" else float(cell) for name, cell in zip(COLUMNS, row)} for row in rows]
    check_texts(program, svg)
    words = [element.text for element in xml.etree.ElementTree.parse(svg).iter("{http://www.w3.org/2000/svg}text")]
    return done.stdout, trace, words


def crossings(trace, position):
    """The samples in which the set position gets to or past a position."""
    return [now for before, now in zip(trace, trace[1:])
            if (before["set_position"] < position) != (now["set_position"] < position)]


def check_follows(name, trace, acceleration=80, lag=0.1, turn=math.inf):
    """No step of the set velocity is beyond the acceleration, and the motor is where it should be."""
    for before, now in zip(trace, trace[1:]):
        change = abs(now["set_velocity"] - before["set_velocity"])
        expect(change <= acceleration * 0.001 * (1 + 1e-6), f"{name}: the set velocity steps by {change} at {now['time']} s")
    lags = (sample["set_position"] - sample["actual_position"] for sample in trace)
    worst = max(abs(math.remainder(one, turn)) for one in lags)
    expect(worst < lag, f"{name}: the motor is {worst} u away from its set position")


# 2.4.2: the velocity at the end of the first of two moves, 8 u/s and then 4 u/s; 4 u/s and then 8 u/s on the way back.
JUNCTIONS = (("mcAborting", 4, 8), ("mcBuffered", 0, 0), ("mcBlendingLow", 4, 4), ("mcBlendingPrevious", 8, 4),
             ("mcBlendingNext", 4, 8), ("mcBlendingHigh", 8, 8))


def check_buffer_modes():
    printed, trace, words = run("04_buffer_modes")
    check_follows("04_buffer_modes", trace)
    passed = crossings(trace, 2)
    expect(len(passed) == 2 * len(JUNCTIONS), f"04_buffer_modes: {len(passed)} ways past the end of the first moves")
    for (mode, there, back), on_way_there, on_way_back in zip(JUNCTIONS, passed[::2], passed[1::2]):
        for expected, sample in ((there, on_way_there["set_velocity"]), (-back, on_way_back["set_velocity"])):
            # One cycle past the junction the next command has begun to change the velocity.
            expect(abs(sample - expected) <= 80 * 0.001, f"{mode}: passes with {sample} u/s instead of {expected}")
        table = re.search(rf"^{mode} +([\d.]+) +([\d.]+)$", printed, re.MULTILINE)
        expect(table and abs(float(table[1]) - there) < 0.1 and abs(float(table[2]) - back) < 0.1,
               f"{mode}: the table says {table and table.groups()}")
    fastest = max(abs(sample["set_velocity"]) for sample in trace)
    expect(abs(fastest - 8) < 1e-6, f"04_buffer_modes: {fastest} u/s are reached")
    expect([word for word in words if word.startswith("mc")] == [mode for mode, _, _ in JUNCTIONS],
           f"04_buffer_modes: the plot's marks are not the modes: {words}")


def check_touch_probe():
    printed, trace, _ = run("05_touch_probe")
    rows = re.findall(r"^ *(\d+) +([\d.]+) +([\d.]+) +([\d.]+) +([\d.]+) +-?\d+ us$", printed, re.MULTILINE)
    expect([row[0] for row in rows] == ["1", "3", "9"], f"05_touch_probe: {printed}")
    for velocity, on, off, uncertainty, between in (map(float, row) for row in rows):
        half = velocity * 0.001 / 2  # of a cycle; the simulated switch is at 3 u, whichever way it is passed
        expect(abs(uncertainty - half) < 1e-4, f"05_touch_probe: +-{uncertainty} u at {velocity} u/s")
        for what, position, within in (("on", on, half), ("off", off, half), ("between", between, half)):
            expect(abs(position - 3) <= within + 1e-4, f"05_touch_probe: {what} at {position} u, {velocity} u/s")
    expect(len(crossings(trace, 3)) == 6, "05_touch_probe: the switch is not passed six times")


# What each line does to the axis: key, milliseconds, where it is afterwards. Limits at +-4 u, 1 u/s and 8 u/s.
KEYS = (("e", 300, 0), ("l", 1000, 1), ("-", 500, 1), ("2", 100, 1), ("l", 2000, 4), ("-", 100, 4), ("h", 2000, -4),
        ("-", 100, -4), ("1", 100, -4), ("l", 500, None), ("b", 500, None), ("l", 500, None), ("-", 100, None),
        ("5", 100, None), ("l", 50, None), ("-", 800, -3), ("4", 100, -3), ("h", 50, None), ("-", 800, -3.5),
        ("e", 200, -3.5))


def check_jog_panel():
    printed, trace, _ = run("06_jog_panel", "".join(f"{key} {ms}\n" for key, ms, _ in KEYS))
    expect("-3.500 u" in printed, f"06_jog_panel: {printed}")
    position_at = {round(sample["time"] * 1000): sample["set_position"] for sample in trace}
    end_ms, ends = 0, []
    for key, ms, position in KEYS:
        end_ms += ms
        ends.append(position_at[end_ms - 1])
        if position is not None:
            expect(abs(ends[-1] - position) < 0.05,
                   f"06_jog_panel: {key} for {ms} ms ends at {ends[-1]}, not {position}")
    both = [key for key, _, _ in KEYS].index("b")
    expect(abs(ends[both + 1] - ends[both]) < 1e-9, "06_jog_panel: the button that is left of two moves the axis")
    expect(all(abs(sample["set_position"]) <= 4 + 1e-9 for sample in trace), "06_jog_panel: a limit is overrun")
    expect(not any(sample["state"] == "ErrorStop" for sample in trace), "06_jog_panel: ErrorStop")


def check_jog_panel_on_a_terminal():
    """Keys that repeat move the axis; when they come no more it stops by itself; q ends the program."""
    terminal, other_end = pty.openpty()
    panel = subprocess.Popen([os.path.join(BIN, "06_jog_panel")], stdin=other_end, stdout=other_end, stderr=other_end)
    os.close(other_end)
    shown = ""

    def type_in(text, seconds):
        nonlocal shown
        os.write(terminal, text)
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                if select.select([terminal], [], [], 0.05)[0]:
                    shown = (shown + os.read(terminal, 4096).decode(errors="replace"))[-4000:]
            except OSError:
                return  # the program has ended

    def position():
        found = re.findall(r"(-?\d+\.\d+) u ", shown)
        return float(found[-1]) if found else None

    type_in(b"", 1)
    type_in(b"e", 1)
    type_in(b"l", 0.4)
    for _ in range(20):
        type_in(b"l", 0.05)
    held = position()
    type_in(b"", 1.2)
    stopped = position()
    type_in(b"", 0.4)
    expect(held is not None and held > 0.5, f"06_jog_panel: a key that repeats leads to {held} u: {shown[-300:]}")
    expect(stopped == position(), f"06_jog_panel: released, and it goes on from {stopped} to {position()}")
    type_in(b"q", 0.5)
    expect(panel.wait(timeout=20) == 0, "06_jog_panel: exit status")
    os.close(terminal)


def check_jog_panel_whose_terminal_goes():
    """A terminal that is closed while a key is held ends the program in order: the trace ends at rest."""
    table = os.path.join(OUTPUT, "06_jog_panel_terminal.csv")
    terminal, other_end = pty.openpty()
    panel = subprocess.Popen([os.path.join(BIN, "06_jog_panel"), "--csv", table], stdin=other_end,
                             stdout=subprocess.DEVNULL)
    os.close(other_end)
    time.sleep(1)
    for text in (b"2", b"e"):
        os.write(terminal, text)
        time.sleep(0.5)
    os.write(terminal, b"\033[C")
    time.sleep(0.4)
    panel.send_signal(signal.SIGHUP)
    os.close(terminal)
    try:
        expect(panel.wait(timeout=20) == 0, f"06_jog_panel: exit status {panel.returncode} without its terminal")
    except subprocess.TimeoutExpired:
        panel.kill()
        expect(False, "06_jog_panel: goes on without its terminal")
        return
    with open(table, newline="", encoding="utf-8") as file:
        velocities = [float(row[4]) for row in list(csv.reader(file))[1:]]
    expect(max(velocities) > 1 and abs(velocities[-1]) < 0.05,
           f"06_jog_panel: {max(velocities)} u/s, and {velocities[-1]} u/s when its terminal is gone")


def check_homing_steps():
    printed, trace, _ = run("07_homing_steps")
    check_follows("07_homing_steps", trace, 100)
    changes = [float(change) for change in re.findall(r"change by (-?[\d.]+) u$", printed, re.MULTILINE)]
    # 0.1 u/s: half a cycle's way is 0.00005 u, for the homing before as well; the simulated switch is at 3 u.
    expect(len(changes) == 3 and all(abs(change) <= 1.2e-4 for change in changes), f"07_homing_steps: {printed}")
    homings = [before for before, now in zip(trace, trace[1:]) if before["state"] != "Homing" == now["state"]]
    expect(len(homings) == 3, f"07_homing_steps: {len(homings)} homings")
    expect(abs(trace[-1]["set_position"] - 2.5) < 0.01, f"07_homing_steps: ends at {trace[-1]['set_position']}")


def check_cool_muscle_bridge():
    """All four arrive in the same cycle, and the first one moves while the fourth answers."""
    printed, trace, _ = run("08_cool_muscle_bridge")
    rows = re.findall(r"^(\w+) +([\d.]+) s +([-+][\d.]+) rev +([\d.]+) s$", printed, re.MULTILINE)
    expect([row[0] for row in rows] == ["left", "right", "feed", "lift"], f"08_cool_muscle_bridge: {printed}")
    expect(len({row[3] for row in rows}) == 1, f"08_cool_muscle_bridge: they arrive one after the other: {rows}")
    expect(all(0 < float(row[1]) < float(row[3]) for row in rows), f"08_cool_muscle_bridge: homed when? {rows}")
    farthest = min(sample["set_position"] for sample in trace)
    expect(abs(farthest + 3) < 1e-6, f"08_cool_muscle_bridge: left is at {farthest} at most, not at -3")
    answer = re.search(r"^lift answers K37\.4=10 and Ux\.4=16; left moves with ([\d.]+) rev/s just then$", printed,
                       re.MULTILINE)
    expect(answer and float(answer[1]) > 0.01, f"08_cool_muscle_bridge: {printed}")
    expect(not any(sample["state"] == "ErrorStop" for sample in trace), "08_cool_muscle_bridge: ErrorStop")


def check_mixed_network():
    printed, trace, _ = run("09_mixed_network")
    rows = re.findall(r"^(\w+) +(-[\d.]+) rev +(.+)$", printed, re.MULTILINE)
    expect([row[0] for row in rows] == ["cm1e", "cm1", "cm2"], f"09_mixed_network: {printed}")
    expect(all(abs(float(row[1]) + 2) < 0.01 for row in rows), f"09_mixed_network: not at -2 rev: {rows}")
    expect("%" in rows[0][2] and all("mapping lacks" in row[2] for row in rows[1:]),
           f"09_mixed_network: a CM1-E tells its torque, a bridge does not: {rows}")
    expect(abs(trace[-1]["set_position"] + 1) < 0.01, f"09_mixed_network: ends at {trace[-1]['set_position']}")


def run_axes(program, *names, arguments=()):
    """What it printed, the trace of each of these axes, and the words of its plot."""
    printed, _, words = run(program, arguments=arguments)
    with open(os.path.join(OUTPUT, f"{program}.csv"), newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    traces = {}
    for name in names:
        at = head.index(f"{name} state")
        traces[name] = [{column: cell if column == "state" else float(cell) for column, cell in
                         zip(COLUMNS, [row[0]] + row[at:at + len(COLUMNS) - 1])} for row in rows]
    return printed, traces, words


def turned(trace, key="set_position", turn=360):
    """A column of a modulo axis without its turns."""
    total, result = trace[0][key], [trace[0][key]]
    for before, now in zip(trace, trace[1:]):
        total += math.remainder(now[key] - before[key], turn)
        result.append(total)
    return result


def check_electronic_gear():
    """In gear both rollers turn with the shaft, whatever it does; after the phasing both are in register."""
    name = "10_electronic_gear"
    printed, traces, words = run_axes(name, "shaft", "left", "right")
    rows = dict((row[0], [float(cell) for cell in row[1:]]) for row in
                re.findall(r"^(left|right) +(-?[\d.]+) +(-?[\d.]+) +([\d.]+)$", printed, re.MULTILINE))
    expect(set(rows) == {"left", "right"}, f"{name}: {printed}")
    count = 360 / 50000
    expect(abs(rows["left"][0]) > 5, f"{name}: the left roller is in register before it is phased: {rows}")
    for roller, (_, after, within) in rows.items():
        expect(abs(after) <= count and within <= count, f"{name}: {roller}: {rows[roller]}")
    shaft, left, right = (turned(traces[axis]) for axis in ("shaft", "left", "right"))
    end = next(i for i, sample in reversed(list(enumerate(traces["left"]))) if sample["state"] == "SynchronizedMotion")
    begin = end - 1000  # it turns back and halts there
    for roller, way in (("left", left), ("right", right)):
        off = max(abs((way[i] - way[begin]) - (shaft[i] - shaft[begin])) for i in range(begin, end))
        expect(off <= count, f"{name}: {roller} is {off} degrees out of gear")
        check_follows(name, traces[roller], 36000, 3, 360)
    expect(max(s["set_velocity"] for s in traces["left"]) > 700 and min(s["set_velocity"] for s in traces["left"]) < -350,
           f"{name}: the rollers do not turn both ways")
    expect("phasing" in words and "reverse" in words, f"{name}: {words}")


def check_gear_behind_pauses():
    """A pause of the cycle aborts a phasing; what is left of it is phased then."""
    example = subprocess.Popen([os.path.join(BIN, "10_electronic_gear")], stdout=subprocess.PIPE, text=True)
    while not catches(example, signal.SIGINT):
        time.sleep(0.02)
    for _ in range(10):
        time.sleep(0.3)
        example.send_signal(signal.SIGSTOP)
        time.sleep(0.01)
        example.send_signal(signal.SIGCONT)
    try:
        printed = example.communicate(timeout=60)[0]
    except subprocess.TimeoutExpired:
        example.kill()
        printed = "no end"
    phased = re.findall(r"^(?:left|right) +-?[\d.]+ +(-?[\d.]+) +", printed, re.MULTILINE)
    expect(example.returncode == 0 and len(phased) == 2 and all(abs(float(one)) <= 360 / 50000 for one in phased),
           f"10_electronic_gear behind pauses: {example.returncode} {printed}")


def check_flying_shear():
    name = "11_flying_shear"
    printed, traces, words = run_axes(name, "belt", "carriage")
    pieces = [float(piece) for piece in re.findall(r"^piece \d+: +([\d.]+) mm$", printed, re.MULTILINE)]
    slip = re.search(r"within ([\d.]+) mm/s$", printed, re.MULTILINE)
    # The belt is seen a cycle later than the carriage: while it gets faster, by 100 mm/s2, a piece seems longer.
    expect([round(piece) for piece in pieces] == 4 * [400] + 4 * [600] and
           all(abs(piece - round(piece)) < 0.11 for piece in pieces), f"{name}: {printed}")
    expect(slip and float(slip[1]) < 5, f"{name}: {printed}")
    carriage = traces["carriage"]
    expect(all(-0.5 < sample["set_position"] < 215 for sample in carriage), f"{name}: the carriage leaves its way")
    check_follows(name, carriage, 6000, 1.5)
    expect(abs(carriage[-1]["set_position"]) < 0.01, f"{name}: ends at {carriage[-1]['set_position']}")
    expect(words.count("cut") == 2 * (len(pieces) + 1), f"{name}: in the plots of both axes, each cut is marked: {words}")


def check_winder():
    name = "12_winder"
    printed, traces, _ = run_axes(name, "line", "spool", "guide")
    told = re.search(r"^8 layers: from 60 mm to 92 mm; the surface goes with the wire within ([\d.e+-]+) of", printed)
    expect(told and float(told[1]) < 1e-6, f"{name}: {printed}")
    for axis in ("spool", "guide"):
        check_follows(name, traces[axis], 101 * (10 if axis == "guide" else 1))
    guide = [sample["set_position"] for sample in traces["guide"]]
    expect(abs(max(guide) - min(guide) - 14) < 1e-3, f"{name}: the guide goes {max(guide) - min(guide)} mm")
    turns = [i for i in range(1, len(guide) - 1) if guide[i] == max(guide[max(0, i - 500):i + 500]) and guide[i] > 13.9]
    speeds = [s["set_velocity"] for s in traces["spool"] if s["state"] == "SynchronizedMotion"]
    expect(len(turns) >= 4, f"{name}: {len(turns)} turns of the guide")
    fastest, late = max(speeds), max(speeds[-1500:-1200])
    expect(late < 0.8 * fastest, f"{name}: the spool does not get slower as it grows: {fastest}, {late}")


def check_xy_table():
    """On the lines and the arc but for the corners, and there no farther away than the rounding; never at rest."""
    name, outline = "13_xy_table", os.path.join(OUTPUT, "outline.svg")
    path = os.path.join(os.path.dirname(__file__), "..", "..", "examples", "outline.csv")
    with open(path, encoding="utf-8") as file:
        rows = [[cell.strip() for cell in line.split(",")] for line in file if line[0] != "#"]
    printed, traces, _ = run_axes(name, "X", "Y", arguments=(path, "--outline", outline))
    slowest = re.search(r"^8 rows of .*never slower than ([\d.]+) mm/s$", printed)
    expect(slowest and float(slowest[1]) > 20, f"{name}: {printed}")
    ends = [(0.0, 0.0)] + [(float(row[1]), float(row[2])) for row in rows]
    worst = {"edge": 0.0, "corner": 0.0}
    for x, y in ((a["set_position"], b["set_position"]) for a, b in zip(traces["X"], traces["Y"])):
        off = min(distance(row, begin, end, x, y) for row, begin, end in zip(rows, ends, ends[1:]))
        part = "corner" if min(math.dist((x, y), end) for end in ends[1:]) < 20 else "edge"
        worst[part] = max(worst[part], off)
    expect(worst["edge"] < 1e-6, f"{name}: {worst['edge']} mm beside a line or the arc")
    expect(0.01 < worst["corner"] <= 1 + 1e-6, f"{name}: a corner is {worst['corner']} mm away")
    expect(max(math.dist((a["set_position"], b["set_position"]), (a["actual_position"], b["actual_position"]))
               for a, b in zip(traces["X"], traces["Y"])) < 0.2, f"{name}: the motors are not where they should be")
    with open(outline, encoding="utf-8") as file:
        expect(file.read().count("<polyline") == 2, f"{name}: no outline is drawn")
    bad = os.path.join(OUTPUT, "bad_outline.csv")
    for text, told in (("line, 10, 10\nline, 20\n", "bad_outline.csv:2: not"), ("arc, 9, 9, nan, 1\n", "finite"),
                       ("line, 1000, 0\n", "150")):
        with open(bad, "w", encoding="utf-8") as file:
            file.write(text)
        done = subprocess.run([os.path.join(BIN, name), "--virtual-time", bad], capture_output=True, text=True, timeout=60)
        expect(done.returncode == 1 and told in done.stderr, f"{name}: {text!r}: {done.returncode} {done.stderr}")


def check_bus_file_is_followed(name, bus_file):
    """Its interface and its virtual time count; an interface of the command line counts before."""
    path = os.path.join(os.path.dirname(__file__), "..", "..", "examples", bus_file)
    changed = os.path.join(OUTPUT, f"followed_{name}.yaml")
    for new, words, told in (("interface: cm1e-none", [], '"cm1e-none"'),
                             ("interface: cm1e-none", ["-i", "sim", "--virtual-time"], ""),
                             ("virtual_time: true", ["-i", "cm1e-none"], "virtual_time is on with the interface cm1e-none")):
        with open(path, encoding="utf-8") as file, open(changed, "w", encoding="utf-8") as other:
            other.write(file.read().replace("interface: sim", new, 1))
        done = subprocess.run([os.path.join(BIN, name), "-b", changed, *words], capture_output=True, text=True, timeout=60)
        expect((done.returncode == 0) == (not told) and told in done.stderr, f"{name} with {new}, {words}: {done}")


def check_machine_io():
    """The curtain stops the axis within its deceleration, and the cam switches where it says, to a cycle."""
    name = "15_machine_io"
    printed, trace, words = run(name)
    told = re.search(r"Glue from ([\d.]+) mm on, off at ([\d.]+) mm\. Pressure 1250 of 1000.*\n.*interrupted at ([\d.]+) "
                     r"mm\. The axis stood (\d+) ms later, at ([\d.]+) mm", printed)
    expect(told, f"{name}: {printed}")
    on, off, interrupted, late, stood = (float(part) for part in told.groups())
    cycle = 60 * 0.001
    expect(20 <= on <= 20 + 2 * cycle and 60 <= off <= 60 + 2 * cycle, f"{name}: {printed}")
    expect(80 <= interrupted < 80 + 10 * cycle and 100 <= late < 160 and stood - interrupted < 6, f"{name}: {printed}")
    still = [sample for sample in trace if sample["set_velocity"] == 0 and abs(sample["set_position"] - stood) < 0.01]
    expect(len(still) > 300, f"{name}: it stands for {len(still)} cycles")
    expect(abs(trace[-1]["set_position"] - 150) < 0.01, f"{name}: it ends at {trace[-1]['set_position']}")
    expect("curtain" in words and "go on" in words, f"{name}: {words}")
    wrong = os.path.join(OUTPUT, "machine_without_curtain.yaml")
    path = os.path.join(os.path.dirname(__file__), "..", "..", "examples", "machine.yaml")
    with open(path, encoding="utf-8") as file, open(wrong, "w", encoding="utf-8") as other:
        other.write(file.read().replace("name: curtain", "name: fence"))
    done = subprocess.run([os.path.join(BIN, name), "--virtual-time", "-b", wrong], capture_output=True, text=True,
                          timeout=60)
    expect(done.returncode == 1 and 'has no signal "curtain"' in done.stderr and '"fence"' in done.stderr, f"{name}: {done}")


def check_encoder_master():
    """The feeder has the velocity of the belt, 30720 counts/s of 204.8 counts/mm, and keeps its distance."""
    name = "17_encoder_master"
    printed, trace, words = run(name)
    told = re.search(r"The belt runs at ([\d.]+) mm/s, the feeder at ([\d.]+) mm/s. "
                     r"Their distance changed by ([\d.]+) mm", printed)
    expect(told, f"{name}: {printed}")
    belt, feeder, change = (float(part) for part in told.groups())
    expect(abs(belt - 150) < 1 and abs(feeder - 150) < 1 and change < 0.1, f"{name}: {printed}")
    expect("with the belt" in words and "gear in" in words, f"{name}: {words}")
    wrong = os.path.join(OUTPUT, "belt_without_counter.yaml")
    path = os.path.join(os.path.dirname(__file__), "..", "..", "examples", "belt.yaml")
    with open(path, encoding="utf-8") as file, open(wrong, "w", encoding="utf-8") as other:
        other.write(file.read().replace("encoder_signal: counter.position", "encoder_signal: counter.place"))
    done = subprocess.run([os.path.join(BIN, name), "--virtual-time", "-b", wrong], capture_output=True, text=True,
                          timeout=60)
    expect(done.returncode == 1 and 'no signal "place"' in done.stderr, f"{name}: {done}")


def distance(row, begin, end, x, y):
    """Of a point from a row of the outline; the arc of this one is a quarter of a circle around (80, 40)."""
    if row[0] == "arc":
        return abs(math.dist((x, y), (80, 40)) - 20) if x >= 80 and y >= 40 else math.inf
    way = (end[0] - begin[0], end[1] - begin[1])
    along = ((x - begin[0]) * way[0] + (y - begin[1]) * way[1]) / (way[0] ** 2 + way[1] ** 2)
    along = min(max(along, 0), 1)
    return math.dist((x, y), (begin[0] + along * way[0], begin[1] + along * way[1]))


def catches(process, number):
    """The program has come to where it handles this signal, however busy the machine is. Or it has ended."""
    with open(f"/proc/{process.pid}/status", encoding="ascii") as file:
        caught = re.search(r"SigCgt:\s*(\w+)", file.read())
    return not caught or int(caught[1], 16) >> (number - 1) & 1 or process.poll() is not None


def check_interrupted():
    """Ctrl-C is no success, and is said."""
    commands = [["02_move_one_axis"], ["03_plc_program"], *([name, "-i", "sim"] for name in (
        "04_buffer_modes", "08_cool_muscle_bridge", "10_electronic_gear", "11_flying_shear", "12_winder",
        "13_xy_table", "15_machine_io"))]
    running = [subprocess.Popen([os.path.join(BIN, words[0]), *words[1:]], stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True) for words in commands]
    for example in running:
        while not catches(example, signal.SIGINT):
            time.sleep(0.02)
        time.sleep(0.05)
        example.send_signal(signal.SIGINT)
    for words, example in zip(commands, running):
        printed, complaint = example.communicate(timeout=30)
        told = "not moved" in printed if words[0][:2] == "02" else complaint == "Interrupted before its end.\n"
        expect(example.returncode == 1 and told, f"{words[0]}: Ctrl-C: {example.returncode} {printed}{complaint}")


def check_error_in_words():
    """A motor that runs into a stop: what happened, and the key that is there for it."""
    slaves = os.path.join(OUTPUT, "stop.yaml")
    with open(slaves, "w", encoding="utf-8") as file:
        file.write("axes: [{sim: {stop_positive_counts: 10000}}]\n")
    done = subprocess.run([os.path.join(BIN, "02_move_one_axis"), f"sim:{slaves}"], capture_output=True, text=True,
                          timeout=60)
    expect(done.returncode == 1 and "did not follow" in done.stderr and "limits.position_lag" in done.stderr,
           f"02_move_one_axis at a stop: {done.returncode} {done.stdout}{done.stderr}")


def check_from_elsewhere():
    """The XY table finds its outline in whatever folder it is started."""
    done = subprocess.run([os.path.join(BIN, "13_xy_table"), "--virtual-time"], capture_output=True, text=True,
                          timeout=60, cwd=OUTPUT)
    expect(done.returncode == 0 and "8 rows of" in done.stdout, f"13_xy_table elsewhere: {done.stdout}{done.stderr}")


def check_two_networks():
    """16_two_networks on two simulated segments, in real time."""
    done = subprocess.run([os.path.join(BIN, "16_two_networks")], capture_output=True, text=True, timeout=60)
    told = re.fullmatch(r"3000 cycles on two networks, (\d+) of them in step; there the velocities differed by at most "
                        r"(\S+) u/s; (\d+) frames lost, (\d+) overruns\n", done.stdout)
    expect(done.returncode == 0 and told and float(told[2]) < 1e-12, f"16_two_networks: {done}")
    if told: # a ramp of both axes, after each disturbance
        expect(int(told[1]) >= 3000 - 700 * (int(told[3]) + int(told[4])), f"16_two_networks: {done}")
    wrong = subprocess.run([os.path.join(BIN, "16_two_networks"), "one.yaml", "two.yaml"], capture_output=True, text=True, timeout=60)
    expect(wrong.returncode == 2 and "usage" in wrong.stderr, f"16_two_networks: {wrong}")


def check_service():
    """14_service tells systemd that it is ready, feeds its watchdog, and ends in order on SIGTERM."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "notify")
        listener = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        listener.bind(path)
        listener.settimeout(10)
        process = subprocess.Popen([os.path.join(BIN, "14_service")], env={**os.environ, "NOTIFY_SOCKET": path})
        heard = []
        try:
            while sum(line == "WATCHDOG=1" for line in heard) < 5 or not any("READY=1" in line for line in heard):
                heard.append(listener.recv(1000).decode())
            process.send_signal(signal.SIGTERM)
            while heard[-1] != "STOPPING=1":
                heard.append(listener.recv(1000).decode())
        except TimeoutError:
            faults.append(f"14_service: what systemd would hear is {heard}")
        expect(process.wait(20) == 0, f"14_service ended with {process.returncode} on SIGTERM")


def check_traces():
    check_buffer_modes()
    check_cool_muscle_bridge()
    check_mixed_network()
    check_electronic_gear()
    check_flying_shear()
    check_winder()
    check_xy_table()
    check_machine_io()
    check_encoder_master()
    for name, bus_file in (("03_plc_program", "three_axes.yaml"), ("15_machine_io", "machine.yaml"),
                           ("17_encoder_master", "belt.yaml")):
        check_bus_file_is_followed(name, bus_file)
    check_touch_probe()
    check_homing_steps()
    check_jog_panel()


def main():
    real_time.run_above_others()
    real_time.together(check_jog_panel_on_a_terminal, check_jog_panel_whose_terminal_goes, check_traces,
                       check_interrupted, check_gear_behind_pauses, check_error_in_words, check_from_elsewhere,
                       check_two_networks, check_service)
    real_time.end(faults, "the examples: their traces show what they are about")


if __name__ == "__main__":
    main()
