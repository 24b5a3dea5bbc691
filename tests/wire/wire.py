"""Two network namespaces joined by a veth pair: `cm1e sim` serves a segment in one, a master runs in the other.

Needs root and iproute2; without them a test ends with the exit status that ctest counts as skipped.
"""
import contextlib
import os
import shutil
import signal
import subprocess
import sys
import time

SKIPPED = 77
MASTER_INTERFACE, SLAVE_INTERFACE = "ecm0", "ecs0"


def skip_unless_possible():
    if os.geteuid() != 0 or not shutil.which("ip"):
        print("SKIPPED: network namespaces need root and the package iproute2")
        sys.exit(SKIPPED)
    probe = subprocess.run(["ip", "netns", "add", f"cm1e-probe-{os.getpid()}"], capture_output=True, text=True)
    if probe.returncode != 0:
        print("SKIPPED: this machine lets nobody make a network namespace:", probe.stderr.strip())
        sys.exit(SKIPPED)
    subprocess.run(["ip", "netns", "del", f"cm1e-probe-{os.getpid()}"], check=True)


def real_time(command, priority):
    """The command under SCHED_FIFO where that is allowed."""
    allowed = shutil.which("chrt") and subprocess.run(["chrt", "-f", str(priority), "true"],
                                                      capture_output=True).returncode == 0
    return (["chrt", "-f", str(priority)] if allowed else []) + command


class Segment:
    """A running `cm1e sim` and the namespace of its master."""

    def __init__(self, master_namespace, simulator):
        self.master_namespace = master_namespace
        self.simulator = simulator

    def console(self, line):
        """Sends a console line and returns its answer (one line)."""
        self.simulator.stdin.write(line + "\n")
        self.simulator.stdin.flush()
        return self.simulator.stdout.readline().rstrip("\n")

    def command(self, command, priority=50):
        return ["ip", "netns", "exec", self.master_namespace] + real_time(command, priority)

    def run(self, command, timeout=120):
        """Runs a program in the master's namespace; returns the finished process with its output."""
        return subprocess.run(self.command(command), capture_output=True, text=True, timeout=timeout)


@contextlib.contextmanager
def segment(cm1e, *arguments):
    """Starts `cm1e sim -i <interface> <arguments>` and yields a Segment."""
    skip_unless_possible()
    master, slave = f"cm1e-m-{os.getpid()}", f"cm1e-s-{os.getpid()}"
    ip = lambda *words: subprocess.run(["ip", *words], check=True, capture_output=True)
    simulator = None
    try:
        for namespace in (master, slave):
            ip("netns", "add", namespace)
            # No stray frames of the kernel's own on the EtherCAT wire.
            subprocess.run(["ip", "netns", "exec", namespace, "sysctl", "-qw", "net.ipv6.conf.default.disable_ipv6=1"],
                           capture_output=True)
        ip("link", "add", MASTER_INTERFACE, "netns", master, "type", "veth", "peer", "name", SLAVE_INTERFACE,
           "netns", slave)
        ip("-n", master, "link", "set", MASTER_INTERFACE, "up")
        ip("-n", slave, "link", "set", SLAVE_INTERFACE, "up")
        simulator = subprocess.Popen(
            ["ip", "netns", "exec", slave] + real_time([cm1e, "sim", "-i", SLAVE_INTERFACE, *arguments], 60),
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        greeting = simulator.stdout.readline()
        assert "simulated slave" in greeting, f"cm1e sim did not start: {greeting!r}"
        yield Segment(master, simulator)
        simulator.send_signal(signal.SIGINT)
        assert simulator.wait(10) == 0, f"cm1e sim ended with {simulator.returncode} on SIGINT"
    finally:
        if simulator and simulator.poll() is None:
            simulator.kill()
            simulator.wait()
        for namespace in (master, slave):
            subprocess.run(["ip", "netns", "del", namespace], capture_output=True)


def check(condition, message):
    if not condition:
        print("FAILED:", message)
        sys.exit(1)


def wait_for(condition, seconds, message):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.002)
    check(False, message)
