#!/usr/bin/env python3
"""The control socket of a running program, through its documented protocol and through the commands that attach: what is
told, what is refused, and that nothing sent or left unread disturbs the program.

test_control.py BIN-DIRECTORY
"""
import contextlib
import json
import os
import random
import re
import shutil
import struct
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import control_bench as bench  # noqa: E402
from control_bench import CM1E, ENVIRONMENT, FOLDER, RUNTIME, expect, wait_for  # noqa: E402
from control_client import Client, Program  # noqa: E402

BUS = """\
bus: {{interface: sim, control: {control}, lost_cycles_limit: 50}}
axes:
  - {{name: X, sim: {{no_stops: true}}}}
  - {{name: Y, sim: {{no_stops: true}}}}
"""


# ---- the program and its clients ------------------------------------------------------------------------------------

def started(control="observe"):
    return Program(CM1E, os.path.join(FOLDER, f"{control}.yaml"), ENVIRONMENT)


def moving(control="observe"):
    return bench.moving(f"{control}.yaml")


def running(control="observe"):
    return bench.running(f"{control}.yaml")


# ---- what is told ---------------------------------------------------------------------------------------------------

def check_requests():
    with running() as program, Client(program) as client:
        hello = client.ask("hello", id="mine", protocol=1)
        expect(hello["ok"] and hello["id"] == "mine" and hello["hello"]["pid"] == program.pid, "hello", hello)
        expect(hello["hello"]["program"] == "cm1e move" and hello["hello"]["control"] == "observe", "hello", hello)
        expect(abs(hello["hello"]["since"] - time.time()) < 60 and hello["hello"]["protocol"] == 1, "hello", hello)
        x, y = client.ask("axes")["axes"]
        expect((x["name"], y["name"], x["slave"], y["slave"]) == ("X", "Y", 1, 2), "axes", x)
        expect(x["command"] == "MC_MoveVelocity" and y["command"] is None and y["state"] == "Disabled", "axes", (x, y))
        expect(abs(x["lag"]) < 0.1 and isinstance(x["torque"], float) and x["text"] == "", "values of an axis", x)
        before, after = x["position"], client.ask("axes")["axes"][0]["position"]
        expect(after > before, "the position stands", (before, after))
        slaves = client.ask("slaves")["slaves"]
        expect([s["al_state"] for s in slaves] == [8, 8] and slaves[0]["kind"] == "cm1-e" and slaves[0]["coe"], "slaves",
               slaves)
        statistics = client.ask("statistics")["statistics"]
        expect(statistics["cycles"] > 0 and statistics["bus"]["foreign_frames"] == 0 and
               sum(statistics["cycle_time"]["histogram"]) == statistics["cycle_time"]["count"], "statistics", statistics)
        expect([(one["network"], one["interface"], one["sync_losses"]) for one in statistics["networks"]] ==
               [("", "sim", 0)], "networks", statistics["networks"])
        log = client.ask("log")["log"]
        expect([e["number"] for e in log["events"]] == list(range(1, log["last"] + 1)), "log", log)
        expect(any(e["text"] == "X: ContinuousMotion (was Standstill)" for e in log["events"]), "log", log)
        more = client.ask("log", after=log["last"] - 1)["log"]["events"]
        expect(more and more[0]["number"] == log["last"], "the log goes on where it was", more)
        identity = client.ask("sdo_read", slave=1, index=0x1018, subindex=2)
        expect(identity["data"] == "02204144", "reading an object", identity)
        absent = client.ask("sdo_read", slave=1, index=0x1234)
        expect(not absent["ok"] and absent["error"]["code"] == -26 and absent["error"]["foreign_code"] == 0x06020000,
               "an object that is not there", absent)
        nobody = client.ask("sdo_read", slave=77, index=0x1018)
        expect(not nobody["ok"] and nobody["error"]["code"] == -1, "a slave that is not there", nobody)
        client.send('{"request": "hello", "id": 1}')
        client.send('{"request": "statistics", "id": 2}')
        expect((client.receive()["id"], client.receive()["id"]) == (1, 2), "two requests at once are answered in turn")


def check_reading_slaves():
    """What is read beside objects: SDO information, SII, registers."""
    with running() as program, Client(program) as client:
        objects = client.ask("sdo_info", slave=1, kind=1, index=1)["data"]
        expect(objects.startswith("0100" "0010") and len(objects) > 200, "the list of objects", objects)
        entry = client.ask("sdo_info", slave=1, kind=5, index=0x1018, subindex=2)
        expect(entry["data"].startswith("1810" "02"), "an entry", entry)
        absent = client.ask("sdo_info", slave=1, kind=3, index=0x1234)
        expect(not absent["ok"] and absent["error"]["foreign_code"] == 0x06020000, "no such object", absent)
        vendor = client.ask("sii_read", slave=2, word=8, size=8)
        expect(vendor["data"] == "41440000" "02204144", "vendor and product of an SII", vendor)
        state = client.ask("registers", slave=1, address=0x130, size=2)
        expect(state["data"] == "0800", "AL status", state)
        clients = [Client(program) for _ in range(6)]
        for n in range(5):  # one errand at a time: the others wait
            for other in clients:
                other.send(json.dumps({"request": "sii_read", "slave": 1 + n % 2, "word": 64 * (n % 8), "size": 128}))
            for other in clients:
                expect(len(other.receive()["data"]) == 256, "one of six readers of the SII")
        for other in clients:  # gone before the answer
            other.send('{"request": "sii_read", "slave": 1, "word": 0, "size": 128}')
            other.socket.close()


def check_writing():
    with running("observe") as program, Client(program) as client:
        refused = client.ask("sdo_write", slave=2, index=0x2201, subindex=1, data="10270000")
        expect(not refused["ok"] and "control: maintain" in refused["error"]["text"], "writing by observe", refused)
    with running("maintain") as program, Client(program) as client:
        before = client.ask("sdo_read", slave=2, index=0x2201, subindex=1)["data"]
        written = client.ask("sdo_write", slave=2, index=0x2201, subindex=1, data="11270000")
        after = client.ask("sdo_read", slave=2, index=0x2201, subindex=1)["data"]
        expect(written["ok"] and after == "11270000" != before, "writing to an axis at rest", (before, written, after))
        refused = client.ask("sdo_write", slave=1, index=0x2201, subindex=1, data="11270000")
        expect(not refused["ok"] and '"X" is commanded' in refused["error"]["text"], "writing to a moving axis", refused)
        told = program.attached("sdo", "write", "2", "0x2201:1", "10002")
        expect(told.returncode == 0 and client.ask("sdo_read", slave=2, index=0x2201, subindex=1)["data"] == "12270000",
               "cm1e sdo write, attached", told)


# ---- what does no harm ----------------------------------------------------------------------------------------------

WRONG = (b"", b"{", b"[]", b"null", b'"hello"', b"{}", b'{"request": 5}', b'{"request": "hello", "request": "axes"}',
         b'{"request": "hello", "protocol": 2}', b'{"request": "nothing"}', b'{"request": "log", "after": -1}',
         b'{"request": "log", "after": "x"}', b'{"request": "sdo_read"}', b'{"request": "sdo_read", "slave": 0}',
         b'{"request": "sdo_read", "slave": 1, "index": 65536}', b'{"request": "sdo_read", "slave": 1.5, "index": 1}',
         b'{"request": "sdo_read", "slave": 1, "index": 1, "subindex": 256}', b'{"request": "\\ud800"}', b"\xff\xfe",
         b'{"request": "sdo_read", "slave": 1, "index": 4120, "size": 0}', b'{"request": "sdo_write", "slave": 2}',
         b'{"request": "sdo_write", "slave": 2, "index": 24677, "data": "1"}', b"[" * 60000, b'{"a":' * 10000,
         b'{"request": "sdo_write", "slave": 2, "index": 24677, "data": "zz"}',
         b'{"request": "registers", "slave": 1, "address": 2304}', b'{"request": "registers", "slave": 3, "address": 0}',
         b'{"request": "registers", "slave": 1, "address": 2303, "size": 2}', b'{"request": "registers", "slave": 1}',
         b'{"request": "sii_read", "slave": 1, "word": 0, "size": 3}', b'{"request": "sii_read", "slave": 1, "word": -1}',
         b'{"request": "sii_read", "slave": 1, "word": 0, "size": 129}', b'{"request": "sdo_info", "slave": 1}',
         b'{"request": "sdo_info", "slave": 1, "kind": 2, "index": 1}', b'{"request": "sdo_info", "slave": 0, "kind": 1}', b'{"request": "' + b"x" * 60000 + b'"}')


# What is wrong with each, as its answer says it.
NAMED = (({"request": "sdo_info", "slave": 1, "kind": 3, "index": 65536}, '"index" is expected to be 0 ... 65535'),
         ({"request": "sdo_info", "slave": 1, "kind": 5, "index": 1, "subindex": 256}, '"subindex" and "values" 0 ... 255'),
         ({"request": "sdo_read", "slave": 1, "index": 4120, "timeout_ms": 0}, '"timeout_ms" is expected to be 1 ... 60000'),
         ({"request": "sdo_read", "slave": 1, "index": 4120, "timeout_ms": 60001}, '"timeout_ms" is expected'),
         ({"request": "sdo_read", "slave": 1, "index": 4120, "complete_access": 1}, '"complete_access" is expected to be true'),
         ({"request": "variables", "from": -1}, '"from" is expected to be the number of a variable'),
         ({"request": "variables", "name": 5}, '"name" is expected to be the name of a variable'),
         ({"request": "record", "variables": 5}, '"variables" is expected to be a list of names'))


def check_wrong_messages():
    with running("maintain") as program:
        with Client(program) as client:
            for text in WRONG:
                client.send(text)
                reply = client.receive()
                expect(reply and not reply["ok"] and reply["error"]["text"], f"{text[:60]}", reply)
            for request, words in NAMED:
                reply = client.ask(**request)
                expect(not reply["ok"] and reply["error"]["code"] == -1 and words in reply["error"]["text"], request, reply)
            expect(client.ask("hello")["ok"], "the connection goes on after wrong messages")
        for length in (65537, 0x7FFFFFFF, 0xFFFFFFFF):
            with Client(program) as client:
                client.socket.sendall(struct.pack(">I", length))
                reply = client.receive()
                expect(reply and "longer" in reply["error"]["text"], f"a message of {length} bytes", reply)
                expect(client.receive() is None, "the connection ends then")
        chance = random.Random(20240)
        for _ in range(200):
            with Client(program) as client, contextlib.suppress(ConnectionError):
                client.socket.sendall(chance.randbytes(chance.randrange(1, 3000)))


def check_bad_clients():
    with running() as program:
        with contextlib.ExitStack() as stack:
            half = stack.enter_context(Client(program))
            half.socket.sendall(struct.pack(">I", 100) + b'{"request"')
            deaf = stack.enter_context(Client(program))
            deaf.socket.settimeout(0.2)
            with contextlib.suppress(OSError):
                for _ in range(20000):
                    deaf.send('{"request": "axes"}')
            others = [stack.enter_context(Client(program)) for _ in range(20)]
            for _ in range(20):
                for client in others:
                    client.send('{"request": "axes"}')
                for client in others:
                    expect(client.receive()["ok"], "one of 20 clients got no answer")
            crowd = [stack.enter_context(Client(program)) for _ in range(40)]
            told = crowd[-1].receive()
            expect(told and not told["ok"] and "at most 32" in told["error"]["text"], "the 60th client", told)
            expect(others[0].ask("hello")["ok"], "those that were there first are served")
            half.socket.settimeout(15)
            expect(half.receive() is None, "half a message is not waited for for ever")
        for _ in range(100):  # gone before the answer
            with Client(program) as client, contextlib.suppress(ConnectionError):  # or turned away
                client.send(random.choice(('{"request": "sdo_read", "slave": 1, "index": 4120, "subindex": 1}',
                                           '{"request": "axes"}')))

        def answered():  # turned away while their places are still taken
            reply = None
            with Client(program) as client, contextlib.suppress(ConnectionError):
                reply = client.ask("sdo_read", slave=2, index=0x1018, subindex=1)
            return bool(reply and reply["ok"])

        wait_for(answered, "no answer after clients that vanished")


def check_one_byte():
    """Nobody else wakes the server."""
    with running() as program, Client(program) as client:
        client.socket.sendall(b"\0")
        client.socket.settimeout(8)
        expect(client.receive() is None, "a message of which one byte came is not waited for for ever")


def check_end_beside_clients():
    for _ in range(5):
        program = moving()
        with contextlib.ExitStack() as stack:
            clients = [stack.enter_context(Client(program)) for _ in range(8)]
            for client in clients:
                for _ in range(20):
                    client.send('{"request": "sdo_read", "slave": 1, "index": 4104}')
            said = program.end()
            expect("ErrorStop" not in said, "ended beside waiting clients", said)


# ---- who may, and where ---------------------------------------------------------------------------------------------

def check_rights():
    with running() as program:
        expect(os.stat(program.path).st_mode & 0o777 == 0o600 and os.stat(RUNTIME).st_mode & 0o777 == 0o700,
               "rights of socket and directory")
        if os.geteuid() == 0 and shutil.which("setpriv"):
            os.chmod(FOLDER, 0o755)
            os.chmod(RUNTIME, 0o755)
            told = subprocess.run(["setpriv", "--reuid=65534", "--clear-groups", CM1E, "scan", "--attach",
                                   str(program.pid)], capture_output=True, text=True, timeout=60)
            os.chmod(RUNTIME, 0o700)
            expect(told.returncode == 1 and "another user" in told.stderr, "another user", told)


def check_no_socket():
    program = started("none")
    time.sleep(1)
    expect(not os.path.exists(program.path), "control: none has a socket")
    told = program.attached("scan")
    expect(told.returncode == 1 and "control: none" in told.stderr, "attaching to control: none", told)
    program.end()
    with open(os.path.join(FOLDER, "no-directory"), "w", encoding="utf-8"):
        pass
    for where, words in ((os.path.join(FOLDER, "no-directory"), "not a directory"), ("relative", "absolute path"),
                         ("/proc/1/nothing", "cannot be made"), (FOLDER + "/" + "x" * 90, "CM1E_RUNTIME_DIR")):
        told = subprocess.run([CM1E, "move", "-i", "sim", "1", "--by", "0.1"], capture_output=True, text=True,
                              timeout=60, env={**os.environ, "CM1E_RUNTIME_DIR": where})
        expect(told.returncode == 0 and words in told.stderr, f"runtime directory {where}", told)


def check_left_behind():
    killed = moving()
    killed.process.kill()
    killed.process.communicate()
    expect(os.path.exists(killed.path), "a killed program leaves its socket")
    with running():
        expect(not os.path.exists(killed.path), "the next program removes it")
    told = killed.attached("scan")
    expect(told.returncode == 1 and "has no control socket" in told.stderr, "attaching to a dead program", told)


# ---- commands, attached and alone -----------------------------------------------------------------------------------

def without_state(text):
    return re.sub(r"Operational|Pre-Operational|Safe-Operational", "STATE", text.replace("Pre-Operational", "STATE"))


def check_commands():
    bus_file = os.path.join(FOLDER, "observe.yaml")
    with running() as program:
        for words in (["scan"], ["scan", "--json"], ["sdo", "read", "1", "0x1018:2"], ["sdo", "read", "2", "0x100A"],
                      ["sdo", "read", "--json", "1", "0x1008"], ["sdo", "read", "1", "0x1234"], ["sdo", "read", "9", "1"],
                      ["scan", "-b", bus_file], ["sdo", "read", "-b", bus_file, "1", "0x1018:1"]):
            attached = program.attached(*words)
            alone = subprocess.run([CM1E, *words, "-b", bus_file, "-i", f"sim:{bus_file}"], capture_output=True, text=True,
                                   timeout=60)
            squeeze = lambda text: re.sub(r" +", " ", without_state(text))  # noqa: E731
            expect((squeeze(attached.stdout), attached.returncode) == (squeeze(alone.stdout), alone.returncode),
                   f"{words}: attached and alone differ", f"{attached}\n    {alone}")
            labels = re.compile(r'\("[XY]", CM1-E\)')
            expect(labels.sub("(CM1-E)", attached.stderr) == labels.sub("(CM1-E)", alone.stderr),
                   f"{words}: attached and alone complain otherwise", f"{attached}\n    {alone}")
        status = program.attached("status", "--json")
        drives = json.loads(status.stdout)
        expect(status.returncode == 0 and len(drives) == 2 and "Operation enabled" in json.dumps(drives[0]), "status",
               status)
        log = program.attached("log")
        expect("MC_MoveVelocity, velocity 0.5 u/s" in log.stdout and log.returncode == 0, "log", log)
        as_json = json.loads(program.attached("log", "--json").stdout)
        expect(as_json["lost"] == 0 and as_json["events"][0]["text"] == "the run began", "log --json", as_json)
        for words, why in ((("sii", "write", "1", bus_file, "--backup", os.path.join(FOLDER, "backup")), "no access to it"),
                           (("firmware", "update", CM1E, "-p", "1", "--yes"), "for Init and Bootstrap"),
                           (("tune", "step", "X", "--max-travel", "0.1", "--max-velocity", "1"),
                            "a target for every cycle")):
            refused = program.attached(*words)
            expect(refused.returncode == 1 and "needs the network for itself" in refused.stderr and why in refused.stderr
                   and f"in use by cm1e move (process {program.pid}) since" in refused.stderr,
                   f"{words}: what needs the network for itself is refused, with the reason", refused)
        by_path = subprocess.run([CM1E, "scan", "--attach", program.path], capture_output=True, text=True, timeout=60)
        expect(by_path.returncode == 0 and by_path.stdout.count("CM1-E") == 2, "attach by the path", by_path)
        follower = subprocess.Popen([CM1E, "log", "--follow", "--attach", str(program.pid)], stdout=subprocess.PIPE,
                                    stderr=subprocess.PIPE, text=True, env=ENVIRONMENT)
        time.sleep(0.5)
    out, err = follower.communicate(timeout=20)
    expect(follower.returncode == 0 and "Disabled (was" in out and "the run ended" in out, "log --follow ends with the program", out + err)


def check_more_commands():
    """params, diff, sdo list, sii and doctor give attached what they give alone."""
    bus_file, image, values = (os.path.join(FOLDER, name) for name in ("maintain.yaml", "s.bin", "values.yaml"))
    with running("maintain") as program:
        def alone(*words):
            return subprocess.run([CM1E, *words, "-b", bus_file, "-i", f"sim:{bus_file}"], capture_output=True, text=True,
                                  timeout=60)

        made = alone("sii", "read", "1", image)
        expect(made.returncode == 0 and os.path.getsize(image) == 2048, "sii read", made)
        for words in (["sdo", "list", "1"], ["sdo", "list", "2", "--json"], ["sii", "decode", "2"],
                      ["sii", "decode", "1", "--json"], ["diff", image, "-p", "1"], ["diff", image, "--json"],
                      ["params", "list", "1"], ["params", "get", "2", "K47", "H3", "--json"],
                      ["params", "set", "1", "K47=31", "--dry-run"], ["sdo", "list", "9"], ["params", "list", "9"]):
            one, other = program.attached(*words), alone(*words)
            expect((without_state(one.stdout), one.returncode) == (without_state(other.stdout), other.returncode),
                   f"{words}: attached and alone differ", f"{one}\n    {other}")
        moving = program.attached("params", "set", "1", "K47=31")
        expect(moving.returncode == 1 and '"X" is commanded' in moving.stderr and "not written: K47" in moving.stderr and
               "looked at" not in moving.stderr, "params set of a moving axis", moving)
        for words in (["backup", "2", values], ["set", "2", "K47=44"], ["restore", "2", values, "--yes"],
                      ["diff", "2", values]):
            told = program.attached("params", *words)
            expect(told.returncode == 0, f"params {words}", told)
        for word, status, says in (("Y", 0, "K47"), ("2", 0, "K47"), ("Z", 2, "axes of this network: X, Y")):
            told = program.attached("params", "get", word, "K47")
            expect(told.returncode == status and says in told.stdout + told.stderr, f"params get {word}, by name", told)
        told = program.attached("reg", "read", "Y", "0x0130", "2")
        expect(told.returncode == 0, "registers of a slave by its axis", told)
        doctor = program.attached("doctor", "--seconds", "0", "--json")
        found = {(row["subject"], row["level"]) for row in json.loads(doctor.stdout)}
        fact = next(row["fact"] for row in json.loads(doctor.stdout) if row["subject"] == "program")
        expect({("slaves", "ok"), ("connections", "ok"), ("motor power", "ok")} <= found and "cm1e move" in fact
               and str(program.pid) in fact and "Not done" in fact, "doctor", doctor)
    with running("observe") as program:
        told = program.attached("params", "set", "2", "K47=31")
        expect(told.returncode == 1 and "control: maintain" in told.stderr and "not written: K47" in told.stderr,
               "params set by observe", told)
        expect(program.attached("params", "get", "2", "K47").returncode == 0, "params get by observe")


def main():
    for control in ("none", "observe", "maintain"):
        bench.write(f"{control}.yaml", BUS.format(control=control))
    bench.run(check_one_byte, check_bad_clients, check_more_commands, check_end_beside_clients, check_no_socket, check_commands,
              check_requests, check_reading_slaves, check_writing, check_wrong_messages,
              alone=(check_rights, check_left_behind))  # these two look at the folder that all programs share


if __name__ == "__main__":
    main()
