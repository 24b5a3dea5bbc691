#!/usr/bin/env python3
"""`cm1e run` as a user calls it, on the simulated segment: axes by name, located variables, RETAIN, a program with the names of TwinCAT, and faults, after
which the axes come to rest.

test_st_run.py BIN-DIRECTORY SOURCE-DIRECTORY
"""
import csv
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

BIN, SOURCE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
MACHINE = os.path.join(SOURCE, "examples", "machine.yaml")
BUS = "bus: {interface: sim, cycle_time_us: 1000}\naxes:\n" \
      "  - {name: X, position: 1, motor: CM1-E-17S30D, unit: {counts_per_unit: 5000}, sim: {no_stops: true}}\n"
MOVE = "VAR_GLOBAL X : AXIS_REF; END_VAR\nPROGRAM Main\nVAR power : MC_Power := (EnablePositive := TRUE, EnableNegative := " \
       "TRUE); turn : MC_MoveVelocity; n, zero : INT; a : ARRAY[1..400] OF INT; END_VAR\n" \
       "power(Axis := X, Enable := TRUE); turn(Axis := X, Execute := power.Status, Velocity := 20);\n" \
       "n := n + 1;\n{}\nEND_PROGRAM\n"
PASSED = "VAR_GLOBAL X : AXIS_REF; END_VAR\nFUNCTION_BLOCK FB_Axis VAR_IN_OUT ax : AXIS_REF; END_VAR VAR p : MC_ReadActualPosition; " \
         "END_VAR METHOD Ask p(Axis := ax, Enable := TRUE); END_METHOD END_FUNCTION_BLOCK\n" \
         "FUNCTION_BLOCK FB_Unit VAR a : FB_Axis; END_VAR METHOD Cyclic VAR_IN_OUT ax : AXIS_REF; END_VAR a(ax := ax); a.Ask(); " \
         "END_METHOD END_FUNCTION_BLOCK\nPROGRAM Main VAR u : FB_Unit; END_VAR u.Cyclic(ax := X); END_PROGRAM\n"
faults = []


def cm1e(*words):
    return subprocess.run([os.path.join(BIN, "cm1e"), *words], capture_output=True, text=True, timeout=60)


def build(name, text):
    with open(name + ".st", "w", encoding="ascii") as file:
        file.write(text)
    result = cm1e("st", "build", name + ".st")
    if result.returncode != 0:
        sys.exit(f"{name}: {result.stderr}")
    return name + ".so"


def run(program, *words, bus="bus.yaml", status=0, says=""):
    result = cm1e("run", program, "-b", bus, "--virtual-time", *words)
    if result.returncode != status or says not in result.stderr:
        faults.append(f"{program} {' '.join(words)}: exit status {result.returncode}, \"{says}\" expected in: {result.stderr}")
    return result


def trace(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return rows


def check_faults():
    run(build("passed", PASSED), "-s", "0.1") # an axis that a method passes on
    run(build("many", "".join(f"PROGRAM P{i} END_PROGRAM\n" for i in range(17))), status=1, says="16 are the most: in a CONFIGURATION")
    for name, statement, says in (("index", "a[n] := 1;", "index.st:6: the index 401 is outside 1..400"),
                                  ("zero", "IF n > 400 THEN a[1] := n / zero; END_IF", "zero.st:6: 401 is divided by zero"),
                                  ("loop", "WHILE n > 400 DO ; END_WHILE", "loop.st:6: this loop")):
        csv_file = name + ".csv"
        run(build(name, MOVE.format(statement)), "-s", "3", "--csv", csv_file, status=1, says=says)
        rows = trace(csv_file)
        velocities = [float(row["X set velocity [u/s]"]) for row in rows]
        steps = [abs(b - a) for a, b in zip(velocities, velocities[1:])]
        if max(velocities) < 19 or velocities[-1] != 0 or rows[-1]["X state"] != "Disabled" or max(steps) > 5:
            faults.append(f"{name}: top velocity {max(velocities)}, last {velocities[-1]}, state {rows[-1]['X state']}, "
                          f"largest step {max(steps)}")
        if len(rows) > 1500:
            faults.append(f"{name}: {len(rows)} samples, so the fault did not end the run")
    run("loop.so", "-s", "3", "--loop-limit", "100", status=1, says="more than 100 times")


def check_files_that_miss_cycles():
    for seconds, misses in (("1", False), ("121", True)):
        text = run(build("longer", PASSED), "-s", seconds, "--csv", "longer.csv").stderr
        if ("the files have the last 120000 of 12" in text) != misses or len(trace("longer.csv")) > 120000:
            faults.append(f"{seconds} s, what the files miss: {text}")


def check_what_build_leaves_alone():
    """Devices, sources, and files of others beside the program; a link stays a link."""
    build("kept", "PROGRAM Main END_PROGRAM")
    for name, text in (("kept.so.c", "mine"), ("other.c", "mine")):
        with open(name, "w", encoding="ascii") as file:
            file.write(text)
    os.mkfifo("pipe")
    os.symlink("other", "link")
    with open("other", "w", encoding="ascii"):
        pass
    before = set(os.listdir())
    for words, says in ((("-o", "pipe"), "is not a file"), (("-o", "kept.st"), "kept.st is a source"), (("-o", "."), "is not a file"),
                        (("--c", "kept.st"), "kept.st is a source"), (("-o", "no/program"), "cannot be written"),
                        (("-o", "same", "--c", "same"), "the same file"), (("-o", "link"), None), ((), None)):
        result = cm1e("st", "build", "kept.st", *words)
        if (result.returncode != 0) != bool(says) or (says or "") not in result.stderr:
            faults.append(f"st build kept.st {words}: status {result.returncode}, {result.stderr}")
    texts = [open(name, encoding="ascii").read() for name in ("kept.so.c", "other.c", "kept.st")]
    if texts != ["mine", "mine", "PROGRAM Main END_PROGRAM"] or not os.path.islink("link") or os.path.getsize("other") == 0:
        faults.append(f"st build wrote over other files: {texts}, {os.listdir()}")
    programs = []
    for _ in range(2):
        build("kept", "PROGRAM Main END_PROGRAM")
        with open("kept.so", "rb") as file:
            programs.append(file.read())
    if programs[0] != programs[1]:
        faults.append("the same source gives two programs")
    if set(os.listdir()) != before:
        faults.append(f"st build leaves {set(os.listdir()) ^ before}")


def check_names():
    program = build("names", "VAR_GLOBAL XX : AXIS_REF; END_VAR PROGRAM Main END_PROGRAM")
    run(program, status=1, says='did you mean "X"?')
    run("nothing.so", status=2, says="cannot be loaded")
    for name in ("names.st", "MAIN.TcPOU"):
        run(name, status=2, says=f'{name} is a source: "cm1e st build {name}" makes {name.split(".")[0]}.so of it')
    run(os.path.join(BIN, "cm1e"), status=1, says="cannot")
    build("slow", "CONFIGURATION C RESOURCE R ON P TASK t(INTERVAL := T#1500us); PROGRAM a WITH t : Main; END_RESOURCE "
          "END_CONFIGURATION PROGRAM Main END_PROGRAM")
    run("slow.so", status=1, says="interval")
    for left in (30, os.path.getsize("slow.so") // 2, os.path.getsize("slow.so") - 1):
        with open("slow.so", "rb") as whole, open("cut.so", "wb") as cut:
            cut.write(whole.read(left))
        run("cut.so", status=1, says="cut off" if left > 100 else "cannot be loaded")


LOCATED = """PROGRAM Main
VAR lamp AT %QX2.0.2 : BOOL; seen AT %IX3.0.2 : BOOL; all AT %QB2.0 : BYTE; n : INT; END_VAR
    n := n + 1;
    lamp := n MOD 20 >= 10;
END_PROGRAM
"""


def check_located():
    run(build("located", LOCATED.replace(" all AT %QB2.0 : BYTE;", "")), "-s", "0.2", "--csv", "located.csv", bus=MACHINE)
    rows = trace("located.csv")
    lamp = [row["Main.lamp"] for row in rows]
    seen = [row["Main.seen"] for row in rows]
    delay = next((d for d in range(1, 6) if lamp[20:180] == seen[20 + d:180 + d]), 0)
    if delay == 0 or len(set(lamp)) != 2:
        faults.append(f"the input does not follow the output: {lamp[20:50]} {seen[20:50]}")
    run(build("nowhere", "PROGRAM P VAR x AT %QX9.0.0 : BOOL; END_VAR END_PROGRAM"), bus=MACHINE, status=1,
        says="P.x AT %QX9.0.0")
    run(build("padding", "PROGRAM P VAR x AT %IX3.0.5 : BOOL; END_VAR END_PROGRAM"), bus=MACHINE, status=1,
        says="slave 3 has only padding")
    run(build("beyond", "PROGRAM P VAR x AT %QW2.7 : WORD; END_VAR END_PROGRAM"), bus=MACHINE, status=1,
        says="P.x AT %QW2.7")


TWINCAT = """PROGRAM MAIN
VAR
    X : AXIS_REF;
    fbPower : MC_Power;
    fbMove, fbNext : MC_MoveAbsolute;
    {attribute 'hide'}
    nErrorId : UDINT;
    bDone : BOOL;
END_VAR
fbPower(Axis := X, Enable := TRUE, Enable_Positive := TRUE, Enable_Negative := TRUE);
IF fbPower.Status THEN
    fbMove(Axis := X, Execute := TRUE, Position := 10.0, Velocity := 50.0, BufferMode := MC_Aborting);
    fbNext(Axis := X, Execute := fbMove.Active OR fbMove.Done, Position := 30.0, Velocity := 50.0,
           BufferMode := MC_BufferMode.mcBlendingPrevious, Done => bDone, ErrorID => nErrorId);
END_IF;
END_PROGRAM
"""


def check_twincat():
    program = build("twincat", TWINCAT.replace("Enable := TRUE,", "Enable := X.NcToPlc.ActPos < 100.0, Override := 50.0,"))
    run(program, "-s", "2", "--csv", "twincat.csv")
    rows = trace("twincat.csv")
    if rows[-1]["MAIN.bDone"] != "1" or float(rows[-1]["X set position [u]"]) != 30:
        faults.append(f"the TwinCAT program ends at {rows[-1]['X set position [u]']}")
    fastest = max(float(row["X set velocity [u/s]"]) for row in rows)
    if not 24.9 < fastest <= 25.001:
        faults.append(f"with an Override of 50 % the axis reaches {fastest} u/s")
    for text, says in (("Enable := X.NcToPlc.ActPoss > 3.0", 'did you mean "ActPos"'),
                       ("Enable := X.Status.ControlLoopClosed", "MC_ReadStatus"),
                       ("Enable := X.nAxisState = 3", "MC_ReadStatus shows the state"),
                       ("bRegulatorOn := TRUE", "Enable switches the power on")):
        with open("refused.st", "w", encoding="ascii") as file:
            file.write(TWINCAT.replace("Enable := TRUE, Enable_Positive", text + ", Enable_Positive"))
        result = cm1e("st", "check", "refused.st")
        if result.returncode != 1 or "refused.st:10:" not in result.stderr or says not in result.stderr:
            faults.append(f"{text}: {result.stderr}")


TURN = "VAR_GLOBAL X : AXIS_REF; END_VAR\nPROGRAM Main VAR power : MC_Power := (EnablePositive := TRUE, EnableNegative := TRUE); " \
       "turn : {}; END_VAR\npower(Axis := X, Enable := TRUE);\n" \
       "turn(Axis := X, Execute := power.Status, Position := 350, Velocity := 360);\nEND_PROGRAM\n"


NAMES = """VAR_GLOBAL X : AXIS_REF; END_VAR
PROGRAM Main
VAR set : MC_SetPosition; v : MC_ReadActualVelocity; velocity : LREAL := 9; known : BOOL;
  sr : SR; rs : RS; up : CTU := (RESET := TRUE); ud : CTUD := (PV := 3, LOAD := TRUE); p : MC_Power := (Enable_Positive := TRUE); END_VAR
sr(SET1 := TRUE, RESET := TRUE); rs.SET := TRUE; rs(RESET1 := FALSE); ud(CU := TRUE, RESET := up.RESET AND FALSE);
known := sr.Q1 AND rs.Q1 AND ud.CV = 3 AND p.EnablePositive;
set(Axis := X, Execute := TRUE, Position := 4.0, Mode := TRUE);
v(Axis := X, Enable := TRUE, ActualVelocity => velocity);
velocity := v.ActualVelocity;
END_PROGRAM
"""


def check_names_of_twincat():
    """Inputs and outputs that Tc2_MC2 and the standard library of TwinCAT and CODESYS call otherwise."""
    run(build("names", NAMES), "-s", "0.1", "--csv", "names.csv")
    last = trace("names.csv")[-1]
    if (last["Main.set.Relative"], last["Main.velocity"], float(last["X actual position [u]"]), last["Main.known"]) != ("1", "0", 4, "1"):
        faults.append(f"names of Tc2_MC2: {last}")


def check_direction():
    """A Direction that the program leaves out is 0 (mcShortestWay), as the page of the block and a program in C have it;
    that of Tc2_MC2's MC_MoveModulo is positive there."""
    with open("table.yaml", "w", encoding="ascii") as file:
        file.write("bus: {interface: sim}\naxes:\n  - {name: X, position: 1, sim: {no_stops: true}, unit: "
                   "{units_per_revolution: 360, modulo_range: 360}}\n")
    for block, backwards in (("MC_MoveAbsolute", True), ("MC_MoveAbsolute := (Direction := mcPositiveDirection)", False),
                             ("ARRAY[1..1] OF MC_MoveAbsolute", True), ("MC_MoveModulo", False)):
        text = TURN.format(block).replace("turn(", "turn[1](" if "ARRAY" in block else "turn(")
        run(build("turn", text), "-s", "2", "--csv", "turn.csv", bus="table.yaml")
        rows = [float(row["X set position [u]"]) for row in trace("turn.csv")]
        if abs(rows[-1] - 350) > 0.01 or backwards != all(at < 1e-6 or at > 349 for at in rows):
            faults.append(f"{block} turned {'by 350' if backwards else 'back by 10'} u and ended at {rows[-1]}")


RETAIN = "VAR_GLOBAL RETAIN parts : DINT := 5; name : STRING[8] := 'ab'; END_VAR PROGRAM Main VAR plain : DINT; END_VAR\n" \
         "IF plain = 0 THEN parts := parts + 1; name := CONCAT(name, 'c'); END_IF plain := plain + 1; END_PROGRAM"


def retained(expected, *words, program="retain.so", status=0, says=""):
    run(program, "-s", "0.05", "--csv", "retain.csv", *words, status=status, says=says)
    if status == 0:
        found = trace("retain.csv")[-1]["parts"]
        if found != str(expected):
            faults.append(f"RETAIN {words}: parts is {found}; expected {expected}")


def check_end():
    """The end of a run as JSON, and a file of RETAIN variables that there are none of."""
    program = build("ends", "PROGRAM Main VAR n : INT; t : ARRAY[1..9] OF INT; END_VAR n := n + 1; t[n] := 1; END_PROGRAM")
    told = run(program, "-s", "0.005", "--json", "--retain", "none.retain", says="no RETAIN variables, and none.retain is not used")
    row = json.loads(told.stdout)
    if (row["end"], row["simulated"]) != ("time", True) or not 0 <= row["overruns"] <= row["cycles"] or "error" in row or \
            row["cycles"] < 5 or os.path.exists("none.retain"):
        faults.append(f"the end as JSON: {row}")
    told = run(program, "-s", "1", "--json", status=1, says="the index 10 is outside 1..9")
    if "the index 10 is outside 1..9" not in json.loads(told.stdout)["error"]:
        faults.append(f"a fault as JSON: {told.stdout}")
    with open("slow.yaml", "w", encoding="ascii") as file: # the ramp at the end lasts 4 s, beyond the time of the run
        file.write("bus: {interface: sim}\naxes: [{name: X, limits: {deceleration: 5}, sim: {no_stops: true}}]\n")
    with subprocess.Popen([os.path.join(BIN, "cm1e"), "run", build("turns", MOVE.format("")), "-b", "slow.yaml", "-s", "3", "--json"],
                          stdout=subprocess.PIPE, text=True) as child:
        time.sleep(2.9) # of which the start may take 3 s on a busy machine: a motor that turns for 0.2 s has its velocity
        child.terminate()
        row = json.loads(child.communicate(timeout=30)[0])
    if row["seconds"] < 3 or row["end"] != "signal":
        faults.append(f"a run that a signal ended: {row}")


def check_errors_of_axes():
    """What an axis says when it fails is told, although the program goes on; not without end."""
    stop = BUS.replace(", sim: {no_stops: true}", "")
    with open("stop.yaml", "w", encoding="ascii") as file:
        file.write(stop)
    program = build("stops", MOVE.format(";"))
    told = run(program, "-s", "5", bus="stop.yaml", says="cm1e run: X: the position lag is above its limit")
    if told.stderr.count("position lag") != 1:
        faults.append(f"an error is told once: {told.stderr}")
    again = MOVE.replace("VAR power", "VAR reset : MC_Reset; power").format("reset(Axis := X, Execute := NOT reset.Busy AND NOT reset.Done);")
    told = run(build("again", again), "-s", "300", bus="stop.yaml", says="further errors of axes are not told here")
    if told.stderr.count("cm1e run: X: ") != 100:
        faults.append(f"{told.stderr.count('cm1e run: X: ')} errors are told")


    # So many commands that the log is overwritten before anybody looks at it, also on a slow machine
    names = ("X", "Y", "Z", "U")
    busy = "VAR_GLOBAL {} : AXIS_REF; END_VAR PROGRAM Main VAR go : BOOL; {} END_VAR\n{}go := p{}.Status AND NOT go;\nEND_PROGRAM\n".format(
        ", ".join(names), " ".join(f"p{n} : MC_Power; m{n} : MC_MoveRelative;" for n in names),
        "".join(f"p{n}(Axis := {n}, Enable := TRUE, EnablePositive := TRUE, EnableNegative := TRUE);\n"
                f"m{n}(Axis := {n}, Execute := go, Distance := 0.0001, Velocity := 5);\n" for n in names), names[-1])
    with open("busy.yaml", "w", encoding="ascii") as file:
        file.write("bus: {interface: sim}\naxes:\n" + "".join(f"  - {{name: {n}, sim: {{no_stops: true}}}}\n" for n in names))
    run(build("busy", busy), "-s", "100", bus="busy.yaml", says="records of the event log were overwritten before they were looked at")


def check_retain():
    build("retain", RETAIN)
    for expected in (6, 7, 8):
        retained(expected)
    retained(6, "--cold-start")
    retained(7)
    retained(6, "--retain", "other.retain")
    with open("retain.retain", "rb") as file:
        good = file.read()
    if not good.startswith(b"cm1e retain ") or b"abcc" not in good:
        faults.append(f"the file of RETAIN variables is {good!r}")
    for at in (0, 14, 40, len(good) - 1):
        with open("retain.retain", "wb") as file:
            file.write(good[:at] + bytes([good[at] ^ 1]) + good[at + 1:])
        retained(0, status=1, says="--cold-start")
    for text in (b"", good[:-1], good + b"x"):
        with open("retain.retain", "wb") as file:
            file.write(text)
        retained(0, status=1, says="damaged")
    with open("retain.retain", "wb") as file:
        file.write(good)
    build("changed", RETAIN.replace("parts : DINT := 5;", "parts : LINT := 5;"))
    retained(0, "--retain", "retain.retain", program="changed.so", status=1, says="other RETAIN variables")
    with open("retain.retain", "rb") as file:
        if file.read() != good:
            faults.append("a refused file of RETAIN variables was changed")
    retained(8)
    check_owner_of_retain()
    check_interrupted_build()


def check_interrupted_build():
    """A build that is interrupted while the compiler runs leaves nothing behind."""
    with open("slow-cc", "w", encoding="ascii") as file:
        file.write("#!/bin/sh\nexec sleep 60\n")
    os.chmod("slow-cc", 0o755)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT):
        building = subprocess.Popen([os.path.join(BIN, "cm1e"), "st", "build", "retain.st", "-o", "stopped.so"], text=True,
                                    stderr=subprocess.PIPE, env={**os.environ, "CC": os.path.abspath("slow-cc")})
        end = time.monotonic() + 30
        while not any(name.startswith("stopped.so") and os.listdir(name) for name in os.listdir()) and time.monotonic() < end:
            time.sleep(0.02)
        time.sleep(0.1)
        building.send_signal(number)
        text = building.communicate(timeout=30)[1]
        left = [name for name in os.listdir() if name.startswith("stopped.so")]
        if building.returncode != 1 or "interrupted: no program was made" not in text or left:
            faults.append(f"a build after signal {number}: exit status {building.returncode}, {left}: {text}")


def check_owner_of_retain():
    """The file belongs to the program that runs, also after it has been replaced; a FIFO is no such file."""
    first = subprocess.Popen([os.path.join(BIN, "cm1e"), "run", "retain.so", "-b", "bus.yaml", "--virtual-time", "-s", "86400"], stdout=subprocess.DEVNULL)
    number, end = os.stat("retain.retain").st_ino, time.monotonic() + 30
    while os.stat("retain.retain").st_ino == number and time.monotonic() < end:
        time.sleep(0.02)
    retained(0, status=1, says="a program that runs keeps its RETAIN variables in retain.retain")
    retained(0, "--cold-start", status=1, says="--retain")
    retained(6, "--retain", "second.retain")
    first.send_signal(signal.SIGINT)
    if first.wait(30) != 0:
        faults.append(f"the run with the file of RETAIN variables ends with {first.returncode}")
    retained(10)
    check_first_file_of_retain()
    os.mkfifo("fifo.retain")
    retained(0, "--retain", "fifo.retain", status=1, says="is not a regular file")


def check_first_file_of_retain():
    """In a first run the file is there, and the program's, before anything starts; one that was killed has no file."""
    first = subprocess.Popen([os.path.join(BIN, "cm1e"), "run", "retain.so", "-b", "bus.yaml", "-s", "60", "--retain", "new.retain"], stdout=subprocess.DEVNULL)
    end = time.monotonic() + 30
    while not os.path.exists("new.retain") and time.monotonic() < end:
        time.sleep(0.005)
    with open("new.retain", "rb") as file:
        begun = file.read()
    if not begun.endswith(b"ab" + bytes(7) + b"\x05\0\0\0"):
        faults.append(f"a first file of RETAIN variables does not begin with the initial values: {begun!r}")
    retained(0, "--retain", "new.retain", status=1, says="a program that runs keeps its RETAIN variables in new.retain")
    first.kill()
    first.wait(30)
    run("retain.so", "-s", "0.05", "--retain", "new.retain")


def check_without_bus_file():
    program = build("alone", MOVE.format(";"))
    result = cm1e("run", program, "-i", "sim", "--virtual-time", "-s", "1", "--csv", "alone.csv")
    ran = f"{program} (simulated) ran for 1."
    if result.returncode != 0 or not result.stdout.startswith(ran) or "its time was over" not in result.stdout:
        faults.append(f"without a bus file: {result.returncode} {result.stdout}{result.stderr}")
    if max(float(row["X set velocity [u/s]"]) for row in trace("alone.csv")) < 19:
        faults.append("without a bus file the axis does not turn")
    for words in ((), ("-i", "eth9")):
        result = cm1e("run", program, *words)
        if result.returncode == 0 or "-b BUS-FILE is needed" not in result.stderr:
            faults.append(f"run {words}: {result.returncode} {result.stderr}")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    with open("bus.yaml", "w", encoding="ascii") as file:
        file.write(BUS)
    check_faults()
    check_files_that_miss_cycles()
    check_what_build_leaves_alone()
    check_names()
    check_without_bus_file()
    check_located()
    check_end()
    check_errors_of_axes()
    check_retain()
    check_twincat()
    check_direction()
    check_names_of_twincat()
if faults:
    sys.exit("\n".join(faults) + f"\n{len(faults)} faults")
