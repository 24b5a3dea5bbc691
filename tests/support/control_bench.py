"""What the tests of the control socket share: a folder of their own, programs that move axis X, and the way in which
checks are made and judged. The first word of the command line is the folder of the programs."""
import atexit
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
import traceback

import real_time
from control_client import Client, Program

CM1E = os.path.join(os.path.abspath(sys.argv[1]), "cm1e")
FOLDER = tempfile.mkdtemp()
atexit.register(shutil.rmtree, FOLDER, ignore_errors=True)
RUNTIME = os.path.join(FOLDER, "run")
ENVIRONMENT = {**os.environ, "CM1E_RUNTIME_DIR": RUNTIME}
faults = []


def expect(condition, what, told=""):
    if not condition:
        faults.append(f"{what}\n    {told}")


def wait_for(condition, what, seconds=10):
    end = time.monotonic() + seconds
    met = condition()
    while not met and time.monotonic() < end:
        time.sleep(0.01)
        met = condition()
    expect(met, what)


def path_of(name):
    return os.path.join(FOLDER, name)


def write(name, text):
    """A file of the folder. What several checks use is written before they begin."""
    with open(path_of(name), "w", encoding="utf-8") as file:
        file.write(text)


def moving(bus_file, *options):
    """A program that moves axis X of the bus file, from the moment on at which it does."""
    program = Program(CM1E, path_of(bus_file), ENVIRONMENT, *options)
    wait_for(program.listens, "no control socket")
    wait_for(program.moves, "the axis does not move")
    return program


@contextlib.contextmanager
def running(bus_file, *options):
    """Yields a program that moves axis X. It still does so afterwards, unless it was ended."""
    program = moving(bus_file, *options)
    try:
        yield program
        if program.process.poll() is None:
            wait_for(program.moves, "the program's own axis was disturbed")
    finally:
        said = program.end()
        expect("ErrorStop" not in said, "the run ended with an error", said)
        expect(not os.path.exists(program.path), "the socket is left behind")


@contextlib.contextmanager
def asked(bus_file, *options):
    """As running(), with a client: yields both."""
    with running(bus_file, *options) as program, Client(program) as client:
        yield client, program


def judge(check):
    begin = time.monotonic()
    try:
        check()
    except (KeyError, TypeError, OSError, ValueError, IndexError, subprocess.TimeoutExpired) as error:
        faults.append(f"{check.__name__}: {error!r}\n{traceback.format_exc()}")
    print(f"{check.__name__}: {time.monotonic() - begin:.1f} s, {len(faults)} faults so far", flush=True)


def run(*checks, alone=()):
    """Makes the checks a few at a time, then those that nothing may go on beside, and ends the test."""
    real_time.together(*(lambda check=check: judge(check) for check in checks))
    for check in alone:
        judge(check)
    if faults:
        real_time.skip_on_a_busy_machine(faults)
        print("FAILED:", *faults, sep="\n")
        sys.exit(1)
