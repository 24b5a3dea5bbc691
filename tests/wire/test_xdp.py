#!/usr/bin/env python3
"""The way behind the comma: `-i ecm0,xdp` sends and receives by AF_XDP. A start, a move, a lost link, a killed process, a
ring with one end by each way, two masters and the lock, an unknown word, missing rights, a program that is at the interface
already, several queues, a large MTU; who else sees the frames. A machine or container that refuses AF_XDP is a skip.

test_xdp.py CM1E
"""
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

NAME = wire.MASTER_INTERFACE
XDP = f"{NAME},xdp"
SLAVES = "axes: [{firmware: 1.3.5, sim: {no_stops: true}}]\n"
RING = """\
bus: {{interface: "{first}", second_interface: "{second}", lost_cycles_limit: 50}}
axes: [{{name: X, position: 1, sim: {{no_stops: true}}}}, {{name: Y, position: 2}}]
"""
# This machine gave the master, or the simulator, no processor for 50 ms.
PAUSED = ("no process data came in time", "frames are lost", "no frame was sent for")
ATTEMPTS = 5
NOT_ROOT = ("CAP_NET_RAW, CAP_NET_ADMIN and CAP_BPF", "offers no AF_XDP")


def slaves_file(folder, text=SLAVES):
    path = os.path.join(folder, "slaves.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def bus_file(segment):
    """That of one axis, with AF_XDP."""
    path = segment.bus_file()
    with open(path, encoding="utf-8") as file:
        text = file.read()
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace(f"interface: {NAME}\n", f"interface: {XDP}\n"))
    return path


def told(segment, command, status=0):
    done = segment.run(command)
    wire.check(done.returncode == status, f"{command[1:]} ended with {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def refused(segment, command, *words):
    text = told(segment, command, 1)
    for word in words:
        wire.check(word in text, f"{command[1:]}: {word!r} is not said: {text}")
    print(text.strip())


def has_program(segment, name=NAME):
    return "xdp" in segment.run(["ip", "link", "show", name]).stdout


def skip_where_refused(segment, cm1e):
    done = segment.run([cm1e, "scan", "-i", XDP])
    if done.returncode != 0 and any(words in done.stderr for words in NOT_ROOT):
        wire.skip(f"AF_XDP: {done.stderr.strip()}")
    wire.check(done.returncode == 0 and "CM1-E" in done.stdout, f"scan by AF_XDP: {done.stdout}{done.stderr}")
    print(done.stdout.strip())


def moves(segment, cm1e):
    path = bus_file(segment)
    for _ in range(ATTEMPTS):
        done = segment.run([cm1e, "move", "-b", path, "X", "--by", "1", "--velocity", "5"])
        if done.returncode == 0 or not any(words in done.stderr for words in PAUSED):
            break
    wire.check(done.returncode == 0, f"a move by AF_XDP: {done.stdout}{done.stderr}")
    print(done.stdout.strip())
    wire.check(not has_program(segment), "a program is left at the interface after an ordinary end")


def start(segment, cm1e, path):
    """A master whose motor turns, and the program of eBPF at its interface; the machine may have ended it at once."""
    for _ in range(ATTEMPTS):
        master = subprocess.Popen(segment.command([cm1e, "move", "-b", path, "X", "--speed", "1", "--for", "60"]),
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        wire.wait_for(lambda: "Operation enabled" in segment.console("status 1") or master.poll() is not None, 15,
                      "the motor was not enabled")
        time.sleep(0.3)
        if master.poll() is None:
            wire.check(has_program(segment), "there is no program at the interface: the frames went another way")
            return master
        text = master.communicate()[1]
        wire.check(any(words in text for words in PAUSED), f"the master ended by itself: {text}")
    wire.check(False, f"no master lived, {ATTEMPTS} times")
    return None


def killed_leaves_nothing(segment, cm1e):
    master = start(segment, cm1e, bus_file(segment))
    try:
        refused(segment, [cm1e, "move", "-i", NAME, "--by", "1", "--velocity", "1"], "in use by cm1e move")
        refused(segment, [cm1e, "move", "-i", XDP, "--by", "1", "--velocity", "1"], "in use by cm1e move")
        for name in (NAME, XDP):  # what looks only attaches, whichever way is named
            wire.check("Operation enabled" in told(segment, [cm1e, "status", "-i", name]), f"status -i {name}")
        master.send_signal(signal.SIGKILL)
        master.communicate(timeout=20)
    finally:
        master.kill()
    wire.wait_for(lambda: not has_program(segment), 2, "a program is left at the interface of a killed process")
    wire.check("CM1-E" in told(segment, [cm1e, "scan", "-i", XDP]), "AF_XDP right after a killed process")
    wire.check("CM1-E" in told(segment, [cm1e, "scan", "-i", NAME]), "a packet socket after AF_XDP")


def loses_link(segment, cm1e):
    master = start(segment, cm1e, bus_file(segment))
    try:
        told(segment, ["ip", "link", "set", NAME, "down"])
        text = master.communicate(timeout=60)[1]
    finally:
        master.kill()
    wire.check(master.returncode == 1, f"the master ended with {master.returncode}: {text}")
    refused(segment, [cm1e, "scan", "-i", XDP], f"ip link set {NAME} up")
    told(segment, ["ip", "link", "set", NAME, "up"])
    if not any(words in text for words in PAUSED):
        wire.check(re.search(r"did not take \d+ frames since the start: it is down", text), text)
    wire.wait_for(lambda: " state UP " in segment.run(["ip", "link", "show", NAME]).stdout, 10, "no link")
    moves(segment, cm1e)


def loses_interface(segment, cm1e):
    """An adapter that is pulled out."""
    master = start(segment, cm1e, bus_file(segment))
    try:
        told(segment, ["ip", "link", "del", NAME])
        text = master.communicate(timeout=60)[1]
    finally:
        master.kill()
    wire.check(master.returncode == 1, f"without an interface the master ended with {master.returncode}: {text}")
    print(text.strip())
    segment.join()
    wire.wait_for(lambda: "there again" in segment.notices(), 10, "the simulated segment does not come back")
    moves(segment, cm1e)


def is_chosen(segment, cm1e, folder):
    """A network of several is found by its interface, whichever way its file and the command state."""
    path = os.path.join(folder, "two.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(f'buses:\n- {{name: wire, bus: {{interface: "{XDP}"}}, axes: [{{name: x}}]}}\n'
                   "- {name: none, bus: {interface: sim}, axes: [{name: y}, {name: z}]}\n")
    for word in (NAME, XDP, f"{NAME},packet"):
        listed = json.loads(told(segment, [cm1e, "scan", "-b", path, "--network", word, "--json"]))
        wire.check(len(listed) == 1, f"--network {word}: {listed}")


def refuses_in_words(segment, cm1e):
    refused(segment, [cm1e, "scan", "-i", f"{NAME},xpd"], '"xpd"', "packet", "xdp")
    refused(segment, [cm1e, "scan", "-i", "nosuch,xdp"], 'no network interface "nosuch"')
    wire.check("CM1-E" in told(segment, [cm1e, "scan", "-i", f"{NAME},packet"]), "the word of a packet socket")
    done = segment.run_beside([cm1e, "sim", "-i", "lo,xdp"])
    wire.check(done.returncode != 0 and "packet socket" in done.stdout + done.stderr, f"cm1e sim: {done.stderr}")
    looked = json.loads(segment.run([cm1e, "doctor", "-i", XDP, "--seconds", "0", "--json"]).stdout)
    wire.check(any(row["group"] == "network" and row["subject"] == "connections" and row["level"] == "ok" for row in looked)
               and not any("does not exist" in row["fact"] for row in looked), f"doctor: {looked}")
    if shutil.which("setpriv"):
        for lost in ("bpf,-net_admin,-sys_admin", "net_raw"):
            all_of_them = f"-{lost}"
            refused(segment, ["setpriv", f"--bounding-set={all_of_them}", f"--inh-caps={all_of_them}", cm1e, "scan", "-i",
                              XDP], *NOT_ROOT[:1], "setcap", "Start the program with sudo")
        refused(segment, ["setpriv", "--bounding-set=-ipc_lock", "--inh-caps=-ipc_lock", "sh", "-c",
                          f"ulimit -l 64; exec {cm1e} scan -i {XDP}"], "locked memory", "CAP_IPC_LOCK", "memlock")
    else:
        print("SKIPPED: without privileges: setpriv (util-linux) is not there")


def refuses_a_taken_interface(segment, cm1e, folder):
    """What a firewall does: a program of its own, which passes every frame on."""
    clang = shutil.which("clang")
    source, program = os.path.join(folder, "pass.c"), os.path.join(folder, "pass.o")
    with open(source, "w", encoding="utf-8") as file:
        file.write('__attribute__((section("xdp"), used)) int pass(void *c) { (void)c; return 2; }\n'
                   'char licence[] __attribute__((section("license"), used)) = "MIT";\n')
    if not clang or subprocess.run([clang, "-target", "bpf", "-O2", "-c", source, "-o", program],
                                   capture_output=True).returncode != 0:
        print("SKIPPED: another program at the interface: no clang with target bpf")
        return
    done = segment.run(["ip", "link", "set", "dev", NAME, "xdp", "obj", program, "sec", "xdp"])
    if done.returncode != 0:
        print(f"SKIPPED: another program at the interface: {done.stderr.strip()}")
        return
    refused(segment, [cm1e, "scan", "-i", XDP], "XDP program", f"ip link set {NAME} xdp off")
    wire.check("CM1-E" in told(segment, [cm1e, "scan", "-i", NAME]), "a packet socket beside a program of others")
    told(segment, ["ip", "link", "set", NAME, "xdp", "off"])
    wire.check("CM1-E" in told(segment, [cm1e, "scan", "-i", XDP]), "AF_XDP after the program of others")


def refuses_a_card(segment, cm1e):
    """Several queues, and a large MTU, on interfaces of their own."""
    def ip(*words):
        told(segment, ["ip", "link", *words])

    ip("add", "many0", "numrxqueues", "2", "type", "veth", "peer", "name", "many1")
    for name in ("many0", "many1"):
        ip("set", name, "up")
    refused(segment, [cm1e, "scan", "-i", "many0,xdp"], "2 receive queues", "sudo ethtool -L many0 rx 1")
    if shutil.which("ethtool"):
        told(segment, ["ethtool", "-L", "many0", "rx", "1"])
        refused(segment, [cm1e, "scan", "-i", "many0,xdp"], "No EtherCAT slave answers")
    else:
        print("SKIPPED: the advice for several queues: ethtool is not installed")
    ip("add", "large0", "mtu", "9000", "type", "veth", "peer", "name", "large1", "mtu", "9000")
    for name in ("large0", "large1"):
        ip("set", name, "up")
    refused(segment, [cm1e, "scan", "-i", "large0,xdp"], "MTU is 9000", "sudo ip link set large0 mtu 1500")
    wire.check(not has_program(segment, "large0"), "a program is left at an interface that was refused")


def is_seen_by(segment, cm1e, folder):
    """tshark and tcpdump have packet sockets: they see no frame of AF_XDP; our own recording does."""
    if not shutil.which("tshark"):
        print("SKIPPED: who sees the frames: tshark is not installed")
        return
    counts = {}
    for name in (NAME, XDP):
        listener = subprocess.Popen(segment.command(["tshark", "-n", "-l", "-i", NAME, "-f", "ether proto 0x88a4"]),
                                    stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while "Capturing on" not in (line := listener.stderr.readline()):
            wire.check(line, "tshark does not listen")
        time.sleep(1)  # it says so before it does
        told(segment, [cm1e, "scan", "-i", name, "--pcap", os.path.join(folder, "own.pcap")])
        time.sleep(0.5)
        listener.send_signal(signal.SIGINT)
        counts[name] = len(listener.communicate(timeout=20)[0].splitlines())
    wire.check(counts[NAME] > 20 and counts[XDP] == 0, f"tshark sees {counts}")
    recorded = os.path.getsize(os.path.join(folder, "own.pcap"))
    wire.check(recorded > 2000, f"--pcap recorded {recorded} bytes")
    print(f"frames that tshark sees: {counts}; --pcap: {recorded} bytes")


def runs_a_ring(cm1e):
    """Both ends by AF_XDP, then each end by another way; a cable is broken and mended in a motion."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "ring.yaml")
        for first, second in ((XDP, f"{wire.MASTER_SECOND},xdp"), (NAME, f"{wire.MASTER_SECOND},xdp")):
            with open(path, "w", encoding="utf-8") as file:
                file.write(RING.format(first=first, second=second))
            with wire.segment(cm1e, path, ring=True) as segment:
                for _ in range(ATTEMPTS):
                    segment.console("replug 2")
                    master = subprocess.Popen(segment.command([cm1e, "move", "-b", path, "X", "--speed", "1", "--for", "3"]),
                                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                    wire.wait_for(lambda: "Operation enabled" in segment.console("status 1") or master.poll() is not None,
                                  15, "the motor was not enabled")
                    wire.check(master.poll() is not None or has_program(segment, wire.MASTER_SECOND), "no program")
                    segment.console("unplug 2")
                    time.sleep(0.5)
                    segment.console("replug 2")
                    text = "".join(master.communicate(timeout=60))
                    if master.returncode == 0 or not any(words in text for words in PAUSED):
                        break
                wire.check(master.returncode == 0, f"a ring on {first} and {second}: {text}")
                print(f"{first}, {second}: {text.strip()}")
        with open(path, "w", encoding="utf-8") as file:
            file.write(RING.format(first=NAME, second=XDP))
        done = subprocess.run([cm1e, "scan", "-b", path], capture_output=True, text=True)
        wire.check(done.returncode != 0 and "like the first" in done.stderr, f"one interface twice: {done.stderr}")


def main(cm1e):
    with tempfile.TemporaryDirectory() as folder:
        with wire.segment(cm1e, slaves_file(folder)) as segment:
            skip_where_refused(segment, cm1e)
            moves(segment, cm1e)
            is_seen_by(segment, cm1e, folder)
            is_chosen(segment, cm1e, folder)
            refuses_in_words(segment, cm1e)
            refuses_a_taken_interface(segment, cm1e, folder)
            refuses_a_card(segment, cm1e)
            killed_leaves_nothing(segment, cm1e)
            loses_link(segment, cm1e)
            loses_interface(segment, cm1e)
    runs_a_ring(cm1e)


if __name__ == "__main__":
    main(sys.argv[1])
