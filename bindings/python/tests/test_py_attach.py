"""Whom attach() trusts: sockets in a folder of the right owner, served by the process that they are named after. What
another user plants is refused in words. And that each request gets its own reply."""
import json
import os
import signal
import socket
import struct
import subprocess
import sys
import threading
import time

import pytest

import cm1e

SERVE = """
import socket, sys
s = socket.socket(socket.AF_UNIX); s.bind(sys.argv[1]); s.listen(); print("listens", flush=True); sys.stdin.read()
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    folder = tmp_path / "run"
    folder.mkdir(0o700)
    monkeypatch.setenv("CM1E_RUNTIME_DIR", str(folder))
    return folder


@pytest.fixture
def planted():
    """Binds a socket with the name of this process in a folder."""
    sockets = []

    def plant(folder):
        sockets.append(socket.socket(socket.AF_UNIX))
        sockets[-1].bind(os.path.join(folder, f"cm1e-{os.getpid()}-0.sock"))
    yield plant
    for planted in sockets:
        planted.close()


def test_folder_that_others_write_is_refused(folder, planted):
    planted(folder)
    assert [program.pid for program in cm1e.programs()] == [os.getpid()]
    folder.chmod(0o777)
    assert not cm1e.programs()
    for target in (None, os.getpid()):
        with pytest.raises(cm1e.Error, match="rights 777; expected user") as refused:
            cm1e.attach(target)
        assert refused.value.code == cm1e.ErrorCode.ERROR_PERMISSION


@pytest.mark.skipif(os.getuid() != 0, reason="only root looks into the folders of others")
def test_root_refuses_a_socket_that_another_user_planted(planted, monkeypatch):
    monkeypatch.delenv("CM1E_RUNTIME_DIR", raising=False)
    user = 400000000 + os.getpid()
    folder = f"/tmp/cm1e-{user}"
    os.mkdir(folder, 0o700)
    try:
        planted(folder)
        os.chown(folder, user + 1, -1)
        assert folder not in {os.path.dirname(program.path) for program in cm1e.programs()}
        with pytest.raises(cm1e.Error, match=f"belongs to user {user + 1} .* expected user {user}"):
            cm1e.attach(os.getpid())
        os.chown(folder, user, -1)
        assert folder in {os.path.dirname(program.path) for program in cm1e.programs()}
    finally:
        os.remove(f"{folder}/cm1e-{os.getpid()}-0.sock")
        os.rmdir(folder)


def test_socket_of_another_process_is_refused(folder):
    path = str(folder / f"cm1e-{os.getpid()}-0.sock")
    server = subprocess.Popen([sys.executable, "-c", SERVE, path], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    try:
        assert server.stdout.readline() == b"listens\n"
        with pytest.raises(cm1e.Error, match=f"name of process {os.getpid()}, and process {server.pid}"):
            cm1e.attach()
        said = subprocess.run(["cm1e", "status", "--attach", str(os.getpid())], capture_output=True, text=True, timeout=20)
        assert said.returncode == 1 and f"process {server.pid} of user {os.getuid()} serves it" in said.stderr
    finally:
        server.communicate(b"", timeout=20)


@pytest.fixture
def echo(tmp_path):
    """A program that answers a request with its name, "slow" after a while; yields the path of its socket."""
    path, server = str(tmp_path / "echo.sock"), socket.socket(socket.AF_UNIX)
    server.bind(path)
    server.listen()

    def serve():
        stream = server.accept()[0].makefile("rwb")
        while head := stream.read(4):
            name = json.loads(stream.read(struct.unpack(">I", head)[0]))["request"]
            time.sleep(0.5 if name == "slow" else 0)
            reply = json.dumps({"ok": True, name: name}).encode()
            try:
                stream.write(struct.pack(">I", len(reply)) + reply)
                stream.flush()
            except OSError:
                return
    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    yield path
    server.close()


def test_reply_of_a_request_that_is_broken_off_is_not_taken_for_that_of_the_next(echo):
    program, main = cm1e.attach(echo), threading.main_thread().ident
    timer = threading.Timer(0.1, lambda: signal.pthread_kill(main, signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        program.ask("slow")
    timer.join()
    with pytest.raises(cm1e.StateError, match="The connection is closed"):
        program.ask("next")


def test_function_of_a_signal_is_refused_within_a_request(echo):
    refused = []

    def act(*_):
        try:
            program.ask("stop")
        except cm1e.StateError as error:
            refused.append(str(error))
    before = signal.signal(signal.SIGUSR1, act)
    try:
        program, main = cm1e.attach(echo), threading.main_thread().ident
        timer = threading.Timer(0.1, lambda: signal.pthread_kill(main, signal.SIGUSR1))
        timer.start()
        assert program.ask("slow") == "slow"
        timer.join()
        assert len(refused) == 1 and "This thread waits for another request" in refused[0]
        assert program.ask("next") == "next"
    finally:
        signal.signal(signal.SIGUSR1, before)


def test_threads_that_share_a_connection_get_their_own_replies(echo):
    wrong = []
    with cm1e.attach(echo) as program:
        def ask(name):
            for _ in range(300):
                if (got := program.ask(name)) != name:
                    wrong.append((name, got))
        threads = [threading.Thread(target=ask, args=(name,)) for name in ("a", "b", "c")]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert not wrong
