"""Two network namespaces joined by a veth pair: `cm1e sim` serves a segment in one, a master runs in the other.

Needs root, or a kernel that lets a user make namespaces, and iproute2; without them a test says so and ends with the exit
status that ctest counts as skipped. The namespaces live as long as the processes that hold them: none is left behind.
"""
import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import real_time  # noqa: E402

SKIPPED = 77
NOT_JUDGED = 78  # tests/rt/real_time_runner.c
MASTER_INTERFACE, SLAVE_INTERFACE = "ecm0", "ecs0"
MASTER_SECOND, SLAVE_SECOND = "ecm1", "ecs1"  # of a ring
NOTICES = "notices.txt"
# Makes its namespace's home: no stray frames of the kernel's own on the wire, and it ends with the test, whose end closes
# its standard input. /proc/sys/net shows the namespace of the process that opens it.
HOLDER = "echo 1 >/proc/sys/net/ipv6/conf/default/disable_ipv6; echo made; exec cat"

# A machine without a real-time kernel pauses for milliseconds now and then: 50 ms without a frame are let pass, still
# below the 100 ms of the drive's own watchdog.
PAUSE_US = 50_000
BUS = """\
bus:
  interface: {interface}
  cycle_time_us: {cycle_time_us}
  lost_cycles_limit: {lost_cycles_limit}
axes:
  - name: X
    position: 1
    motor: CM1-E-17S30D
    homing: {{method: -2}}
"""


def skip(why):
    print("SKIPPED:", why)
    sys.exit(SKIPPED)


def become_root():
    """Root already, or root of a user namespace of our own, in which the program starts again."""
    if os.geteuid() == 0:
        return
    user_namespace = ["unshare", "--user", "--map-root-user"]
    if subprocess.run([*user_namespace, "unshare", "--net", "true"], capture_output=True).returncode != 0:
        skip("network namespaces need root on this machine")
    os.execvp(user_namespace[0], [*user_namespace, sys.executable, *sys.argv])


def enter(holder, command):
    """The command in the network namespace of a holder."""
    return ["nsenter", f"--net=/proc/{holder.pid}/ns/net", *command]


def make_namespace():
    holder = subprocess.Popen(["unshare", "--net", "sh", "-c", HOLDER], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True)
    if holder.stdout.readline() != "made\n":
        skip(f"this machine lets nobody make a network namespace: {holder.stderr.read().strip()}")
    return holder


def join(master, slave, master_end=MASTER_INTERFACE, slave_end=SLAVE_INTERFACE):
    """A wire between two namespaces."""
    def ip(holder, *words):
        return subprocess.run(enter(holder, ["ip", "link", *words]), capture_output=True, text=True)

    made = ip(master, "add", master_end, "type", "veth", "peer", "name", slave_end, "netns", str(slave.pid))
    if made.returncode != 0:
        skip(f"this machine has no virtual Ethernet (veth): {made.stderr.strip()}")
    for holder, interface in ((master, master_end), (slave, slave_end)):
        up = ip(holder, "set", interface, "up")
        check(up.returncode == 0, f"{interface} does not come up: {up.stderr}")
    for holder, interface in ((master, master_end), (slave, slave_end)):
        # The kernel tells of the link a moment later: until then cm1e says that there is none.
        wait_for(lambda: " state UP " in ip(holder, "show", interface).stdout, 10, f"{interface} has no link")


def with_priority(command, priority):
    """The command under SCHED_FIFO where that is allowed."""
    allowed = shutil.which("chrt") and subprocess.run(["chrt", "-f", str(priority), "true"],
                                                      capture_output=True).returncode == 0
    return (["chrt", "-f", str(priority)] if allowed else []) + command


class Segment:
    """A running `cm1e sim`, the namespaces of its master and its own, and a folder for files."""

    def __init__(self, master, slave, simulator, folder):
        self.master = master
        self.slave = slave
        self.simulator = simulator
        self.folder = folder

    def join(self):
        """A new wire in place of one that was deleted."""
        join(self.master, self.slave)

    def notices(self):
        """What `cm1e sim` has said unasked, and its errors."""
        with open(os.path.join(self.folder, NOTICES), encoding="utf-8") as file:
            return file.read()

    def bus_file(self, cycle_time_us=1000):
        """Writes the bus file of one axis X on the master's interface."""
        path = os.path.join(self.folder, f"{cycle_time_us}.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(BUS.format(interface=MASTER_INTERFACE, cycle_time_us=cycle_time_us,
                                  lost_cycles_limit=PAUSE_US // cycle_time_us))
        return path

    def console(self, line):
        """Sends a console line and returns its answer (one line)."""
        self.simulator.stdin.write(line + "\n")
        self.simulator.stdin.flush()
        return self.simulator.stdout.readline().rstrip("\n")

    def command(self, command, priority=50):
        return enter(self.master, with_priority(command, priority))

    def run(self, command, timeout=120):
        """Runs a program in the master's namespace; returns the finished process with its output."""
        return subprocess.run(self.command(command), capture_output=True, text=True, timeout=timeout)

    def run_beside(self, command, timeout=20):
        """Runs a program in the simulator's namespace."""
        return subprocess.run(enter(self.slave, command), capture_output=True, text=True, timeout=timeout)


@contextlib.contextmanager
def segment(cm1e, *arguments, ring=False):
    """Starts `cm1e sim -i <interface> <arguments>` and yields a Segment; a ring has a second wire behind the slaves."""
    if not shutil.which("ip"):
        skip("the package iproute2 is not installed")
    become_root()
    real_time.run_above_others()
    with contextlib.ExitStack() as stack:
        def ends_with_us(process):
            stack.callback(process.wait)
            stack.callback(process.kill)
            return process

        master, slave = ends_with_us(make_namespace()), ends_with_us(make_namespace())
        join(master, slave)
        if ring:
            join(master, slave, MASTER_SECOND, SLAVE_SECOND)
            arguments = ("--second-interface", SLAVE_SECOND, *arguments)
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        notices = stack.enter_context(open(os.path.join(folder, NOTICES), "w", encoding="utf-8"))
        simulator = ends_with_us(subprocess.Popen(
            enter(slave, with_priority([cm1e, "sim", "-i", SLAVE_INTERFACE, *arguments], 60)),
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=notices, text=True))
        running = Segment(master, slave, simulator, folder)
        greeting = simulator.stdout.readline()
        check("simulated slave" in greeting, f"cm1e sim did not start: {greeting!r} {running.notices()}")
        yield running
        simulator.send_signal(signal.SIGINT)
        check(simulator.wait(10) == 0, f"cm1e sim ended with {simulator.returncode} on SIGINT")


def together(*checks):
    """Checks with segments of their own, a few at a time."""
    become_root()
    real_time.together(*checks)


def check(condition, message):
    if not condition:
        real_time.skip_on_a_busy_machine([message])
        print("FAILED:", message)
        sys.exit(1)


def wait_for(condition, seconds, message):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.002)
    check(False, message)
