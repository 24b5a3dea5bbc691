#!/usr/bin/env python3
"""`cm1e var` at a running program: values from outside, once and forced; consent; and that what is forced ends with the
one who forces, however that ends.

test_st_force.py BIN-DIRECTORY SOURCE-DIRECTORY
"""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from control_client import Client  # noqa: E402

CM1E, SOURCE = os.path.join(os.path.abspath(sys.argv[1]), "cm1e"), os.path.abspath(sys.argv[2])
PROGRAM = """TYPE E_Mode : (OFF := -1, SLOW := 2, FAST) INT; END_TYPE
TYPE Share : INT (0..100); END_TYPE
TYPE Point : STRUCT here : INT; END_STRUCT END_TYPE
PROGRAM Main
VAR
    n : INT;
    big : LINT;
    least : LINT := LINT#-9223372036854775808;
    most : ULINT := ULINT#18446744073709551614;
    r : REAL := 0.1;
    goal : LREAL := 3;
    mode : E_Mode := SLOW;
    part : Share := 5;
    wait : TIME := T#20ms;
    day : DATE;
    clock : TOD;
    stamp : DT;
    mask : LWORD;
    small : SINT;
    lamp AT %QX2.0.2 : BOOL;
    seen AT %IX3.0.2 : BOOL;
    copy, cause : BOOL;
    text : STRING[6] := 'it$'s';
    wide : WSTRING[4] := "\u00e4";
    table : ARRAY[1..2, -100..99] OF Point;
END_VAR
n := n + 1;
copy := seen;
lamp := cause;
table[2, 99].here := n;
END_PROGRAM
"""
faults = []


def expect(condition, what, told=""):
    if not condition:
        faults.append(f"{what}: {told}")


class Run:
    def __init__(self, bus):
        self.process = subprocess.Popen([CM1E, "run", "force.so", "-b", bus, "-s", "600"], stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True)
        end = time.monotonic() + 20
        while not any(name.startswith(f"cm1e-{self.process.pid}-") for name in os.listdir("run")):
            if time.monotonic() > end or self.process.poll() is not None:
                sys.exit(f"no control socket: {self.process.communicate(timeout=30)[0]}")
            time.sleep(0.02)

    def words(self, *words):
        return [CM1E, "var", words[0], "--attach", str(self.process.pid), *words[1:]]

    def var(self, *words, status=0, says=""):
        result = subprocess.run(self.words(*words), capture_output=True, text=True, timeout=30)
        expect(result.returncode == status and says in result.stderr, " ".join(words), (result.returncode, result.stderr))
        return result.stdout

    def log(self):
        return subprocess.run([CM1E, "log", "--attach", str(self.process.pid)], capture_output=True, text=True,
                              timeout=30).stdout

    def rows(self):
        return {row["name"]: row for row in json.loads(self.var("list", "--json"))}

    def value(self, name):
        return self.rows()[f"Main.{name}"]["value"]

    def force(self, *words):
        """A window that forces; it does when this returns."""
        process = subprocess.Popen(self.words("force", "--allow-write", *words), stderr=subprocess.PIPE, text=True)
        expect("forced" in process.stderr.readline(), "the window says that it forces")
        return process

    def counts_again(self, what):
        end = time.monotonic() + 10
        while self.rows()["Main.n"]["forced"] and time.monotonic() < end:
            time.sleep(0.05)
        first = self.value("n")
        time.sleep(0.1)
        expect(not self.rows()["Main.n"]["forced"] and self.value("n") != first, f"{what}: the program has n again", first)

    def end(self):
        self.process.send_signal(signal.SIGINT)
        text = self.process.communicate(timeout=30)[0]
        expect(self.process.returncode == 0, "the run ends well", text)


def check_values(run):
    expect(set(run.rows()) >= {"Main.n", "Main.goal", "Main.seen"}, "list", run.rows().keys())
    expect("3" in run.var("get", "main.goal"), "get")
    run.var("get", "Main.goat", status=2, says='did you mean "Main.goal"')
    run.var("set", "--allow-write", "Main.goal=-1.5", "Main.big=-9007199254740993")
    expect(run.value("goal") == -1.5 and run.value("big") == -9007199254740993, "set", run.rows())
    run.var("set", "Main.goal=1", status=2, says="--allow-write")
    run.var("set", "--allow-write", "Main.nothing=1", status=2, says="no variable")
    run.var("set", "--allow-write", "goal=1", status=2, says='did you mean "Main.goal"')
    for wrong, says in (("Main.n=32768", "Main.n (INT) takes -32768 ... 32767."), ("Main.n=1.5", "takes -32768 ... 32767."),
                        ("Main.copy=2", "Main.copy (BOOL) takes TRUE or FALSE."), ("Main.small=-129", "takes -128 ... 127."),
                        ("Main.r=1e39", "Main.r (REAL) takes a finite number up to 3.402823e+38."),
                        ("Main.most=18446744073709551616", "Main.most (ULINT) takes 0 ... 18446744073709551615."),
                        ("Main.least=9223372036854775808", "takes -9223372036854775808 ... 9223372036854775807."),
                        ("Main.part=101", "Main.part (INT (0..100)) takes 0 ... 100.")):
        run.var("set", "--allow-write", wrong, status=2, says=says)
    run.var("set", "--allow-write", "Main.n=x", status=2, says="no value")
    run.var("set", "--allow-write", "Main.goal=7", "Main.part=101", status=2, says="takes 0 ... 100.")
    expect(run.value("goal") == -1.5, "where one of several is refused, none is written", run.value("goal"))
    run.var("set", "--allow-write", "Main.goat=1", status=2, says='did you mean "Main.goal"')


def check_literals(run):
    """Values as a program writes them, and the enumerators of an enumeration."""
    hour = 3600 * 10**9
    for word, value in (("wait=T#1h1s", hour + 10**9), ("wait=TIME#-2ms", -2 * 10**6), ("wait=LT#1us", 1000),
                        ("day=D#1970-01-02", 24 * hour), ("clock=TOD#23:59:59.999999999", 24 * hour - 1),
                        ("mask=16#FF", 255), ("mask=2#1010_0001", 161), ("mask=0x10", 16),
                        ("mask=18446744073709551615", str(2**64 - 1)), ("mask=16#8000_0000_0000_0000", str(2**63)),
                        ("small=010", 10), ("small=SINT#7", 7), ("small=-16", -16), ("small=-128", -128), ("copy=BOOL#1", 1),
                        ("goal=LREAL#0.5", 0.5), ("goal=16#10", 16), ("goal=10000000000000000000", 1e19),
                        ("goal=-9223372036854775809", -2.0**63), ("goal=16#FFFF_FFFF_FFFF_FFFF", 2.0**64), ("goal=1_000", 1000),
                        ("mask=1_0", 10), ("mode=FAST", 3), ("mode=off", -1), ("mode=E_Mode.SLOW", 2),
                        ("mode=E_Mode#FAST", 3), ("mode=2", 2), ("mode=16#3", 3), ("part=100", 100)):
        name = word.split("=")[0]
        run.var("set", "--allow-write", f"Main.{word}")
        if name != "copy":  # which the program writes
            expect(run.value(name) == value, word, run.value(name))
    for literal in ("wait=T#0ms", "wait=T#-2ms", "wait=T#49d17h2m47s295ms", "wait=T#1us1ns", "day=D#2024-02-29",
                    "clock=TOD#00:00:00", "clock=TOD#23:59:59.05", "stamp=DT#1999-12-31-23:59:59.5",
                    "stamp=DT#2024-01-02-03:04:00"):
        name, right = literal.split("=")  # a value is shown as it can be given
        run.var("set", "--allow-write", f"Main.{literal}")
        shown = run.var("get", f"Main.{name}").split()
        expect(right in shown, f"{name} is shown as {right}", shown)
    row = run.rows()["Main.mode"]
    expect((row["enumerator"], row["value"], row["declared"], row["type"]) == ("FAST", 3, "E_Mode", "INT"), "an enumeration", row)
    expect("E_Mode     FAST" in run.var("get", "Main.mode"), "an enumerator is shown", run.var("get", "Main.mode"))
    expect("enumerator" not in run.rows()["Main.n"], "a number has no enumerator")
    for wrong, says, status in (("mode=77", "Main.mode (E_Mode) takes OFF, SLOW, FAST.", 2), ("mode=FATS", "takes OFF, SLOW, FAST.", 2),
                                ("mode=Point.FAST", "takes OFF", 2), ("mode=", "the name of an enumerator", 2),
                                ("wait=T#1", "right is for instance T#1h30m", 2), ("wait=1m5s", "a time as T#1m5s", 2),
                                ("clock=-1", "TOD#23:59:59", 2), ("wait=5", "\"5\" is no value: expected a time as T#1m5s", 2),
                                ("wait=D#2024-01-01", "Main.wait is TIME, and \"D#2024-01-01\" is DATE", 2),
                                ("n=T#5ms", "Main.n is INT, and \"T#5ms\" is TIME", 2), ("wait=16#FF", "is a number", 2),
                                ("mask=16#1_0000_0000_0000_0000", "at most 64 bits", 2), ("mask=-1", "takes 0 ...", 2),
                                ("n=3#12", "a base is 2, 8 or 16", 2), ("n=REAL#1.5x", "is no number", 2),
                                ("text=long", "a text in quotes", 2),
                                *((f"n={number}", "an underscore is between two digits", 2)
                                  for number in ("1__0", "_1", "1_", "16#F__F", "16#_F", "16#F_", "INT#1__0", "INT#_1", "1_e1")),
                                ("goal=1__0.5", "an underscore", 2), ("goal=1_.5", "an underscore", 2),
                                ("goal=1._5", "an underscore", 2), ("wait=T#1__0s", "an underscore", 2),
                                ("lamp=TR_UE", "an underscore", 2), ("lamp=BOOL#TR_UE", "is no number", 2),
                                ("n= 5", "a number, as 12", 2), ("n=5 ", "a number, as 12", 2), ("goal= 5", "a number", 2),
                                ("goal=0x1p3", "a number, as 12", 2), ("goal=0x1.8", "a number, as 12", 2),
                                ("goal=infinity", "a number", 2), ("small=TRUE", "takes -128 ... 127.", 2),
                                ("wait=TRUE", "a time as T#1m5s", 2), ("mask=BOOL#1", "takes 0 ...", 2), ("copy=yes", "expected TRUE or FALSE", 2)):
        run.var("set", "--allow-write", f"Main.{wrong}", status=status, says=says)
    window = run.force("Main.mode=OFF", "Main.wait=T#3s")
    expect(run.value("mode") == -1 and run.value("wait") == 3 * 10**9, "literals are forced", run.rows()["Main.mode"])
    log = run.log()
    for text in ("Main.mode was forced to OFF from", "Main.mode was set to SLOW from",
                 "Main.wait was forced to 3000000000 ns from", "Main.copy was set to TRUE from"):
        expect(text in log, f"the log says \"{text}\"", log)
    window.send_signal(signal.SIGINT)
    window.wait(10)


def check_exact(run):
    """Numbers of 64 bits to the last digit, and a REAL by the digits that it has."""
    rows = run.rows()
    for name, value, shown in (("least", -2**63, str(-2**63)), ("most", "18446744073709551614", "18446744073709551614"),
                               ("r", 0.1, "0.1\n")):
        expect(rows[f"Main.{name}"]["value"] == value, f"{name} as JSON", rows[f"Main.{name}"])
        expect(shown in run.var("get", f"Main.{name}"), f"{name} for people", run.var("get", f"Main.{name}"))
    for value in (2**63 - 1, -2**63 + 1, 9007199254740993):
        run.var("set", "--allow-write", f"Main.least={value}")
        expect(run.value("least") == value, "a LINT is written", (value, run.value("least")))
    with Client(os.path.join("run", f"cm1e-{run.process.pid}-0.sock")) as program:
        for value in (2**64 - 1, 2**63, 2**63 - 1, 12345678901):
            program.ask("variable", name="Main.most", value=value if value < 2**63 else str(value))
            expect(int(run.value("most")) == value, "a ULINT is written", (value, run.value("most")))
        for wrong in (str(2**64), "-1", "", "1.5", "0x1"):
            reply = program.ask("variable", name="Main.most", value=wrong)
            expect(not reply["ok"], f"a ULINT is not {wrong}", reply)
        for wrong in (24 * 3600 * 10**9, -1):  # in JSON a time is ns
            reply = program.ask("variable", name="Main.clock", value=wrong)
            expect("Main.clock (TOD) takes 0 ... 86399999999999 ns." in str(reply), f"a TOD is not {wrong}", reply)
        program.ask("variable", name="Main.clock", value=15)
        expect(run.value("clock") == 15, "a TOD is written", run.value("clock"))
        program.ask("variable", name="Main.r", value=0.3)
        both = program.ask("variables", name="Main.r", forced=True)
        expect(not both["ok"] and "exclude each other" in both["error"]["text"], "name and forced", both)
    log = run.log()
    for text in ("Main.least was set to 9007199254740993 from", "Main.least was set to -9223372036854775807 from",
                 "Main.most was set to 18446744073709551615 from", "Main.most was set to 12345678901 from",
                 "Main.r was set to 0.3 from"):
        expect(text in log, f"the log says \"{text}\"", log)


def check_all(run):
    """Every variable is seen, more than one reply has; texts are read and written."""
    rows = run.rows()
    expect(len(rows) == 20 + 400, "all variables", len(rows))
    expect(rows["Main.table[1,-100].here"]["value"] == 0, "an element", rows["Main.table[1,-100].here"])
    expect(run.value("table[2,99].here") != 0, "the last element")
    expect(rows["Main.text"]["declared"] == "STRING[6]" and rows["Main.text"]["value"] == "it's", "a text", rows["Main.text"])
    expect("'it$'s'" in run.var("get", "Main.text"), "a text in quotes")
    run.var("set", "--allow-write", "Main.text='grün'")
    expect(run.value("text") == "grün", "a text is written", run.rows()["Main.text"])
    expect(rows["Main.wide"]["value"] == "\u00e4" and rows["Main.wide"]["type"] == "WSTRING", "a wide text", rows["Main.wide"])
    run.var("set", "--allow-write", "Main.text='\u009b3m'")
    expect("'$9B3m'" in run.var("get", "Main.text"), "no control character reaches the terminal", run.var("get", "Main.text"))
    run.var("set", "--allow-write", "Main.text='grün'")
    run.var("set", "--allow-write", "Main.wide='\U0001f600\u20ac'")
    expect(run.value("wide") == "\U0001f600\u20ac", "a wide text is written", run.rows()["Main.wide"])
    for wrong, says, status in (("Main.text='longer!'", "Main.text (STRING[6]) takes a text of at most 6 bytes.", 2),
                                ("Main.wide='12345'", "at most 4 characters of 16 bits", 2),
                                ("Main.wide='123\U0001f600'", "takes", 2), ("Main.text=5", "a text in quotes", 2),
                                ("Main.n='5'", "a number, as 12", 2)):
        run.var("set", "--allow-write", wrong, status=status, says=says)


def check_trace(run):
    def columns(status, says, *words):
        result = subprocess.run([CM1E, "trace", "--list", "--json", "--attach", str(run.process.pid), *words],
                                capture_output=True, text=True, timeout=30)
        expect(result.returncode == status and says in result.stderr, words, (result.returncode, result.stderr))
        return [row["name"] for row in json.loads(result.stdout)] if status == 0 else []
    expect(len([name for name in columns(0, "") if name.startswith("Main.")]) == 128, "the first variables are recorded")
    chosen = columns(0, "", "--variable", "main.n", "--variable", "Main.table[2,-100]")
    expect(chosen[-2:] == ["Main.n", "Main.table[2,-100].here"], "chosen variables are recorded", chosen)
    columns(2, 'no variable "Main.goall"; did you mean "Main.goal"', "--variable", "Main.goall")
    columns(2, "is a text", "--variable", "Main.text")
    columns(1, "256 variables", "--variable", "Main.table")


def check_forced(run):
    window = run.force("Main.n=77", "Main.seen=TRUE")
    for _ in range(5):
        expect(run.value("n") == 77 and run.value("copy") == 1, "forced values hold", run.rows())
        time.sleep(0.05)
    expect("FORCED" in run.var("get", "Main.n"), "forced variables are marked")
    seen = json.loads(subprocess.run([CM1E, "monitor", "--json", "--attach", str(run.process.pid)], capture_output=True,
                                     text=True, timeout=30).stdout)["forced"]
    expect([row["name"] for row in seen] == ["Main.n", "Main.seen"], "the monitor has what is forced", seen)
    run.var("set", "--allow-write", "Main.n=3", status=1, says="is forced")
    run.var("set", "--allow-write", "Main.goal=8", "Main.n=3", status=1, says="is forced")
    expect(run.value("goal") != 8, "beside a forced variable none is written", run.value("goal"))
    run.var("force", "--allow-write", "Main.n=3", status=1, says="is forced")
    run.var("force", "--allow-write", "Main.goal=8", "Main.n=3", status=1, says="is forced")
    expect(run.value("goal") != 8, "beside what another one forces none is forced, however shortly", run.value("goal"))
    with Client(os.path.join("run", f"cm1e-{run.process.pid}-0.sock")) as program:
        program.ask("variable", name="Main.n", value=None, check=True)
        expect(run.value("n") == 77, "a release that is only checked releases nothing", run.value("n"))
    window.send_signal(signal.SIGINT)
    expect(window.wait(10) == 0, "the window ends well")
    run.counts_again("Ctrl-C")
    expect(run.value("copy") == 0, "the input is that of the terminal again", run.rows())
    for number, what in ((signal.SIGKILL, "killed"), (signal.SIGSTOP, "suspended")):
        window = run.force("Main.n=78", "Main.text='held'")
        window.send_signal(number)
        run.counts_again(what)
        window.kill()
        window.wait(10)
    window = run.force("Main.n=79")
    run.var("release", "Main.n")
    run.counts_again("released, while the window goes on")
    expect(window.wait(10) == 1, "a window without a variable ends, and has not done what it was told")
    window = run.force("Main.n=80", "Main.text='held'")
    run.var("release", "Main.n")
    run.counts_again("one of two released")
    time.sleep(0.5)
    expect(window.poll() is None and "FORCED" in run.var("get", "Main.text"), "the other one stays forced",
           run.var("get", "Main.text"))
    window.send_signal(signal.SIGINT)
    expect(window.wait(10) == 1, "a window that has lost a variable says so")
    log = run.log()
    for text in ("Main.n was forced to 77", "Main.n is no longer forced to 77", "Main.goal was set to -1.5",
                 "Main.text was forced to a text"):
        expect(text in log, f"the log says \"{text}\"", log)


def check_log_that_is_full(run):
    """What the log has no room for any more is counted, also for programs that read it."""
    with Client(os.path.join("run", f"cm1e-{run.process.pid}-0.sock")) as program:
        for n in range(1100):
            program.ask("variable", name="Main.goal", value=n)
    log = json.loads(subprocess.run([CM1E, "log", "--json", "--attach", str(run.process.pid)], capture_output=True, text=True,
                                    timeout=30).stdout)
    expect(log["lost"] > 0 and log["events"][0]["number"] == log["lost"] + 1, "lost records", (log["lost"], log["events"][:1]))
    expect("was set to 1099" in log["events"][-1]["text"], "the last record", log["events"][-1])


def check_consent(run):
    expect(run.value("goal") == 3, "who may look sees values")
    run.var("set", "--allow-write", "Main.goal=1", status=1, says="control: maintain")
    run.var("force", "--allow-write", "Main.goal=1", status=1, says="control: maintain")
    run.var("release", "Main.goal", status=1, says="control: maintain")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    os.environ["CM1E_RUNTIME_DIR"] = os.path.join(folder, "run")
    os.mkdir("run", 0o700)
    with open(os.path.join(SOURCE, "examples", "machine.yaml"), encoding="utf-8") as file:
        observe = file.read()
    for name, text in (("force.st", PROGRAM), ("observe.yaml", observe),
                       ("maintain.yaml", observe.replace("  interface: sim", "  interface: sim\n  control: maintain", 1))):
        with open(name, "w", encoding="utf-8") as file:
            file.write(text)
    built = subprocess.run([CM1E, "st", "build", "force.st"], capture_output=True, text=True, timeout=60)
    if built.returncode:
        sys.exit(built.stderr)
    for bus, checks in (("observe.yaml", (check_consent,)), ("maintain.yaml", (check_all, check_exact, check_values, check_literals, check_trace, check_forced,
                                                                             check_log_that_is_full))):
        program = Run(bus)
        for check in checks:
            check(program)
        program.end()
if faults:
    sys.exit("\n".join(faults) + f"\n{len(faults)} faults")
