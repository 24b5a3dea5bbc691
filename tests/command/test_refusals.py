#!/usr/bin/env python3
"""What cannot be meant, and files that cannot be written, are refused in words before anything moves: numbers out of
every bound, empty names, a homing without a method, traces and pcap files. The pcap file is the witness.

test_refusals.py BIN-DIRECTORY SOURCE-DIRECTORY
"""
import json
import os
import pty
import re
import resource
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import real_time  # noqa: E402

BIN, SOURCE = sys.argv[1], sys.argv[2]
FAILED, WRONG_USE = 1, 2
PCAP_HEADER = 24
faults = []


def run(program, *words, **more):
    return subprocess.run([os.path.join(BIN, program), *words], capture_output=True, text=True, timeout=60, **more)


def expect(condition, what, result):
    if not condition:
        faults.append(f"{what}: exit status {result.returncode}\n{result.stdout}{result.stderr}")


# Words after `cm1e`, and what the complaint must contain.
MOVE = ["move", "-i", "sim"]
HOME = ["home", "-i", "sim", "--method", "-1"]
NUMBERS = [
    (MOVE + ["--by", "1", "-v", "0"], "velocity"), (MOVE + ["--by", "1", "-a", "0"], "acceleration"),
    (MOVE + ["--by", "1", "-d", "0"], "deceleration"), (MOVE + ["--by", "1", "--jerk", "-0.0"], "jerk"),
    (MOVE + ["--by", "1", "-v", "1e-400"], "velocity"), (MOVE + ["--by", "nan"], "number"),
    (MOVE + ["--to", "inf"], "number"), (MOVE + ["--to", "1e400"], "up to 1.7e308"), (MOVE + ["--by", ""], "number"),
    (MOVE + ["--speed", "0", "--for", "1"], "speed"), (MOVE + ["--speed", "1", "--for", "0"], "time"),
    (MOVE + ["--speed", "1", "--for", "-1"], "time"), (MOVE + ["--speed", "1", "--for", "1e10"], "1000000"),
    (MOVE + ["--speed", "1", "--for", "nan"], "time"), (MOVE + ["--by", "1", "--for", "5"], "--for"),
    (MOVE + ["--speed", "1", "--for", "1", "-v", "2"], "--velocity"),
    (HOME + ["-v", "0"], "velocity"), (HOME + ["-a", "0"], "acceleration"), (HOME + ["--torque", "0"], "torque"),
    (HOME + ["--for", "0"], "time"), (HOME + ["--for", "-1"], "time"), (HOME + ["--for", "1e300"], "1000000"),
    (HOME + ["--offset", "inf"], "offset"), (HOME + ["--position", "-inf"], "position"),
    (MOVE + ["--by", "1", "-v", "-1"], "above 0"), (MOVE + ["--by", "1", "-a", "-1"], "above 0"), (MOVE + ["--by", "1", "-a", "1e400"], "up to 1.7e308"),
    (MOVE + ["--by", "1", "-d", "-0.5"], "above 0"), (MOVE + ["--by", "1", "--jerk", "-1"], "above 0"),
    (MOVE + ["--by", "1", "-v", "nan"], "number"), (MOVE + ["--by", "1", "-v", "1,5"], "point"),
    (MOVE + ["--by", "1", "-v", "0x10"], "number"), (MOVE + ["--by", "1", "-v", " 3"], "number"),
    (MOVE + ["--by", "1", "-v", "3 "], "number"), (MOVE + ["--by", "1", "-v", "fast"], "number"),
    (MOVE + ["--by"], "--by"), (MOVE, "motion is missing"), (MOVE + ["--by", "1", "--by", "2"], "exclude"),
    (MOVE + ["--speed", "1", "--for", "inf"], "time"), (MOVE + ["--speed", "1"], "--for"),
    (MOVE + ["--by", "1", "0"], "no axis"), (MOVE + ["--by", "1", "1.5"], "no axis"),
    (MOVE + ["--by", "1", "99999999999999999999"], "no axis"), (MOVE + ["--by", "1", "1", "2"], "one axis"),
    (HOME + ["-v", "-1"], "above 0"), (HOME + ["--torque", "101"], "10 ... 100"), (HOME + ["--torque", "9"], "10"),
    (HOME + ["--torque", "nan"], "torque"), (HOME + ["--for", "nan"], "time"), (HOME + ["--method", "99"], "-6 ... 4"),
    (HOME + ["--method", "1.5"], "-6 ... 4"), (["cml", "-i", "sim", "--timeout", "-1", "?99.1"], "3600"),
    (["cml", "-i", "sim", "--timeout", "nan", "?99.1"], "timeout"), (["cml", "-i", "sim", "--channel", "0"], "1 ... 4"),
    (["sdo", "-i", "sim", "read", "0", "0x1018:1"], "position"), (["sdo", "-i", "sim", "read", "99999", "1"], "512"),
    (["sdo", "-i", "sim", "read", "1", "0x10000"], "index"), (["sdo", "-i", "sim", "read", "1", "-1"], "index"),
    (["sdo", "-i", "sim", "read", "1", "0x1018:-1"], "sub-index"),
    (["sdo", "-i", "sim", "write", "1", "0x6060", "1000"], "127"),
    (["sdo", "-i", "sim", "write", "1", "0x6060", "1.5"], "whole number"),
    (["generate", "sii", "-o", "-", "--alias", "65536"], "65535"), (["generate", "sii", "-o", "-", "--alias", "-1"],
                                                                    "65535"),
    (["generate", "ec-extend", "-o", "-", "--device", "eb12", "--axes", "0"], "1 ... 4"),
    (["sii", "-i", "sim", "read", "0", "never"], "position"), (["diff", "x", "-i", "sim", "-p", "0"], "position"),
    (["cml", "-i", "sim", "--timeout", "1e10", "?99.1"], "3600"),
    (["sdo", "-i", "sim", "read", "-1", "0x1018:1"], "position"),
    (["sdo", "-i", "sim", "read", "1", "0x1018:256"], "sub-index"),
]
NAMES = [
    (["scan", "-i", "sim:"], "bus file behind the colon"),
    (["scan", "-i", "sim:nowhere.yaml"], "nowhere.yaml: cannot be"),
    (MOVE[:2] + ["sim:nowhere.yaml", "--by", "1"], "nowhere.yaml: cannot be"), (["scan", "-i", ""], "-i"),
    (["status", "-i", ""], "-i"), (["move", "-i", "", "--by", "1"], "-i"),
    (["sim", "-i", ""], "-i"), (["scan", "-b", ""], "-b"), (["scan", "-i", "sim", "--pcap", ""], "--pcap"),
    (MOVE + ["--by", "1", "--csv", ""], "--csv"), (MOVE + ["--by", "1", "--svg", ""], "--svg"),
    (MOVE + ["--by", "1", "--svg", "x", "--csv", "x"], "same file"),
    (MOVE + ["--by", "1", "--svg", "x", "--csv", "./x"], "same file"),
    (["generate", "ec-extend", "-o", "x.txt", "--program", os.path.join(os.getcwd(), "x.txt")], "same file"),
    (["run", "x.so", "-i", "sim", "--html", "x", "--csv", "x"], "--csv and --html write the same file"),
    (["trace", "-i", "sim", "--svg", "x", "--npy", "x"], "--svg and --npy write the same file"),
    (MOVE + ["--by", "1", "--csv", "-"], "--csv: standard output has the result"),
    (HOME + ["--svg", "-"], "--svg: standard output has the result"),
    (["run", "x.so", "-i", "sim", "--html", "-"], "--html: standard output has the result"),
    (["trace", "-i", "sim", "--for", "1", "--npy", "-"], "--npy: standard output has the result"),
    (["generate", "esi", "--json", "-o", "x"], "leave out --json"),
    (["generate", "esi", "--mapping", "csp", "--mapping", "csv", "-o", "x"], "--mapping is there twice"),
    (["generate", "esi", "--device", "cm1-e", "--dc", "--device", "cm1-e", "--dc", "--layout", "mdp", "--layout", "flat",
      "-o", "x"], "--layout is there twice"),
]


def check_wrong_words(folder):
    pcap = os.path.join(folder, "witness.pcap")
    for words, told in NUMBERS + NAMES:
        witnessed = words[0] in ("move", "home") and "" not in words and words[-1] != "--by"
        result = run("cm1e", *words, *(["--pcap", pcap] if witnessed else []))
        expect(result.returncode == WRONG_USE and told in result.stderr, f"cm1e {words}: \"{told}\"", result)
        expect(not os.path.exists(pcap), f"cm1e {words}: something was sent", result)
    for words, told in ((["10_electronic_gear", "-i", ""], "-i"), (["03_plc_program", "-i", ""], "-i"),
                        (["03_plc_program", "--seconds", "nan"], "seconds"),
                        (["03_plc_program", "--seconds", "1e300"], "seconds"),
                        (["03_plc_program", "--seconds", "-1"], "seconds")):
        result = run(*words)
        expect(result.returncode != 0 and told in result.stderr, f"{words}: \"{told}\"", result)


def check_no_homing_method():
    """Without a bus file there is none; what helps is the option."""
    for words in (["-i", "sim"], ["-i", "sim", "--method", "0"]):
        result = run("cm1e", "home", *words)
        expect(result.returncode == WRONG_USE and "--method" in result.stderr and "homing.method in the bus file" in
               result.stderr, f"home {words}", result)


def check_files_before_the_move(folder):
    """A trace that cannot be written is told before anything moves; nothing is left beside one that can."""
    pcap, inside, missing = (os.path.join(folder, name) for name in ("moved.pcap", "inside", "missing/trace"))
    os.mkdir(inside)
    for option in ("--csv", "--svg"):
        for path in (missing, inside, "/proc/trace"):
            for words in (MOVE + ["--by", "1"], HOME):
                result = run("cm1e", *words, option, path, "--pcap", pcap)
                expect(result.returncode == FAILED and path in result.stderr and "done" not in result.stdout,
                       f"{words[0]} {option} {path}", result)
                expect(not os.path.exists(pcap), f"{words[0]} {option} {path}: something was sent", result)
            for program in ("02_move_one_axis", "03_plc_program", "10_electronic_gear"):
                if program != "02_move_one_axis":
                    result = run(program, option, path)
                    expect(result.returncode != 0 and path in result.stderr and result.stdout == "",
                           f"{program} {option} {path}", result)
    failed = run("cm1e", *MOVE, "--by", "1", "--velocity", "1000", "--csv", os.path.join(inside, "trace.csv"))
    expect(failed.returncode == FAILED and set(os.listdir(inside)) <= {"trace.csv"}, "files beside a trace", failed)
    full = run("cm1e", *MOVE, "--by", "0.1", "--csv", "/dev/full")
    expect(full.returncode == FAILED and "/dev/full" in full.stderr, "trace on a full disk", full)
    link, victim = (os.path.join(inside, name) for name in ("trace.csv.part", "victim"))
    with open(victim, "w", encoding="utf-8") as file:
        file.write("of somebody else")
    os.symlink(victim, link)
    moved = run("cm1e", *MOVE, "--by", "0.1", "--csv", os.path.join(inside, "trace.csv"))
    with open(victim, encoding="utf-8") as file:
        expect(moved.returncode == 0 and file.read() == "of somebody else", "a link named FILE.part", moved)
    target, link, second = (os.path.join(inside, name) for name in ("new.svg", "link.svg", "second.svg"))
    os.symlink("new.svg", link)  # the file is not there yet
    os.symlink(link, second)
    for words in (("--csv", target, "--svg", link), ("--csv", second, "--svg", target)):
        moved = run("cm1e", *MOVE, "--by", "0.1", *words)
        expect(moved.returncode == WRONG_USE and not os.path.exists(target), f"a link to the other file: {words}", moved)


def check_json_of_failures(folder):
    """What fails without a result says so as JSON too; a result that tells of its error is the only document."""
    path = os.path.join(folder, "firmware.bin")
    with open(path, "wb") as file:
        file.write(bytes(2000))
    for words, status, says in ((["scan", "-i", "nosuch"], FAILED, 'no network interface "nosuch"'),
                                (["params", "get", "-i", "sim", "1", "K4711"], WRONG_USE, 'no parameter "K4711"'),
                                (["run", "nosuch.so", "-i", "sim"], WRONG_USE, "cannot be loaded"),
                                (["st", "check", "nosuch.st"], WRONG_USE, "nosuch.st"),
                                (["check", "nosuch.esi"], WRONG_USE, "nosuch.esi"),
                                (["firmware", "update", path, "-i", "sim", "-p", "1"], FAILED,
                                 "nothing was written: this needs --yes")):
        failed = run("cm1e", *words, "--json")
        expect(failed.stdout != "" and failed.returncode == status and says in json.loads(failed.stdout)["error"] and says in failed.stderr,
               f"JSON of a failure of {words[0]}", failed)
    values = os.path.join(folder, "values.yaml")
    run("cm1e", "params", "backup", "-i", "sim", "1", values)
    with open(values, "a", encoding="utf-8") as file:
        file.write("  K4711: 1\n  K4712: 1\n")
    both = run("cm1e", "params", "diff", "-i", "sim", "1", values, "--json")
    two = json.loads(both.stdout)["error"]
    expect('"K4711"; ' in two and '; there is no parameter "K4712"' in two and "?" not in two, "two complaints", both)
    moved = run("cm1e", "move", "-i", "sim", "--by", "1", "-v", "1000", "--json")
    expect(moved.returncode == FAILED and json.loads(moved.stdout)["done"] is False, "one document", moved)


def limit_files(size):
    """As a disk that is full after so many bytes; the signal that comes with it is ignored."""
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    return limit


def check_lost_frames(folder):
    """A pcap file that does not hold every frame is no success, whichever command wrote it."""
    pcap, image, bus = (os.path.join(folder, name) for name in ("lost.pcap", "lost.sii", "bridge.yaml"))
    run("cm1e", "generate", "sii", "-o", image)
    with open(bus, "w", encoding="utf-8") as file:
        file.write("bus: {interface: sim}\naxes:\n  - {position: 1, channel: 1, motor: CM1, k37: 10}\n")
    for words in (["scan", "-i", "sim"], ["status", "-i", "sim"], ["sdo", "-i", "sim", "read", "1", "0x1008"],
                  ["cml", "-b", bus, "?99.1"], ["sii", "-i", "sim", "read", "1", "-"],
                  ["diff", image, "-i", "sim", "--position", "1"], ["generate", "eni", "-i", "sim", "-o", "-"],
                  MOVE + ["--by", "0.01"]):
        full = run("cm1e", *words, "--pcap", "/dev/full")
        expect(full.returncode != 0 and "pcap file /dev/full" in full.stderr, f"{words[0]} --pcap /dev/full", full)
        late = subprocess.run([os.path.join(BIN, "cm1e"), *words, "--pcap", pcap], capture_output=True, timeout=60,
                              preexec_fn=limit_files(PCAP_HEADER + 10))
        told = subprocess.CompletedProcess(words, late.returncode, "", late.stderr.decode())
        expect(told.returncode == FAILED and f"pcap file {pcap}" in told.stderr, f"{words[0]} on a disk that fills",
               told)


def check_healthy_status():
    """0x4502 and 0xFF01 are states, not errors: no error line, and JSON has none."""
    text = run("cm1e", "status", "-i", "sim")
    expect(text.returncode == 0 and "  error" not in text.stdout, "status of a healthy motor", text)
    told = run("cm1e", "status", "-i", "sim", "--json")
    drive = json.loads(told.stdout)[0]
    expect(drive["error"] == "" and drive["note"] and drive["error_code"] in (0x4502, 0xFF01), "status as JSON", told)
    whole = ("statusword", "error_code", "mode", "position_counts", "temperature_celsius", "digital_inputs")
    expect(all(isinstance(drive[key], int) for key in whole), "whole numbers as JSON", told)
    expect(isinstance(drive["dc_link_volt"], float), "dc_link_volt as JSON", told)


def terminal(*words):
    """What a person sees, and the exit status."""
    pid, master = pty.fork()
    if pid == 0:
        os.execv(os.path.join(BIN, "cm1e"), ["cm1e", *words])
    seen = b""
    while True:
        try:
            data = os.read(master, 4096)
        except OSError:
            break
        if not data:
            break
        seen += data
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), seen.decode(errors="replace")


def check_what_is_told():
    """On a terminal position, time and a bar; on a pipe none of it; a simulated run says so, and the timing is there."""
    status, seen = terminal("move", "-i", "sim", "--by", "1", "-v", "2")
    lines = re.findall(r"axis1: +(-?[\d.]+) +([\d.]+) s  \[([= ]{30})\]", seen)
    if status != 0 or len(lines) < 4 or not lines[0][2].count("=") < lines[-1][2].count("=") or "done" not in seen:
        faults.append(f"progress on a terminal: {status} {seen!r}")
    piped = run("cm1e", *MOVE, "--by", "0.2")
    expect(piped.returncode == 0 and "\r" not in piped.stderr + piped.stdout and "\033" not in piped.stderr
           and piped.stdout.endswith("(simulated)\n"), "a simulated move on a pipe", piped)
    told = json.loads(run("cm1e", *MOVE, "--by", "0.2", "--json").stdout)
    if told["simulated"] is not True or told["timing"]["cycles"] < 100 or told["timing"]["lost_frames"] != 0:
        faults.append(f"what move tells of its timing: {told}")
    for words in (["scan"], ["status"]):
        text = run("cm1e", *words, "-i", "sim")
        expect(text.stdout.endswith("simulated network: no real device\n"), f"{words} is simulated", text)


def check_axes_in_status(folder):
    bus = os.path.join(folder, "status.yaml")
    with open(bus, "w", encoding="utf-8") as file:
        file.write("bus: {interface: sim}\naxes: [{name: lift, unit: {units_per_revolution: 5}}, {position: 2}]\n")
    text = run("cm1e", "status", "-b", bus)
    expect("slave 1, axis lift: CM1-E" in text.stdout and "slave 2, axis axis2: " in text.stdout
           and "0 counts = 0 u\n" in text.stdout, "axes in status", text)
    told = json.loads(run("cm1e", "status", "-b", bus, "--json").stdout)
    if [drive["axis"] for drive in told] != ["lift", "axis2"] or told[0]["position_units"] != 0:
        faults.append(f"axes in status as JSON: {told}")


def main():
    real_time.run_above_others()
    with tempfile.TemporaryDirectory() as folder:
        check_wrong_words(folder)
        check_files_before_the_move(folder)
        check_json_of_failures(folder)
        check_lost_frames(folder)
        check_axes_in_status(folder)
    check_what_is_told()
    check_no_homing_method()
    check_healthy_status()
    real_time.end(faults, f"refused before anything moves: {len(NUMBERS)} numbers, {len(NAMES)} names, files")


if __name__ == "__main__":
    main()
