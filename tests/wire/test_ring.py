#!/usr/bin/env python3
"""A redundant ring over two veth pairs with the simulated slaves between them: while a motor turns, the cable is broken
and mended at every place. All slaves stay Operational, the place is told in words, and no cycle is lost that did not
have a frame on that cable.

test_ring.py CM1E
"""
import os
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import control_client  # noqa: E402
import wire  # noqa: E402

SLAVES = 3
BUS = """\
bus:
  interface: {first}
  second_interface: {second}
  cycle_time_us: {cycle_time_us}
  lost_cycles_limit: {lost_cycles_limit}
axes:
  - {{name: X, position: 1, sim: {{no_stops: true}}}}
  - {{name: Y, position: 2}}
  - {{name: Z, position: 3}}
"""
NAMES = [f'this computer ("{wire.MASTER_INTERFACE}")', 'slave 1 ("X", CM1-E)', 'slave 2 ("Y", CM1-E)',
         'slave 3 ("Z", CM1-E)', f'this computer ("{wire.MASTER_SECOND}")']
LAST, ATTEMPTS = SLAVES + 1, 6
LINKS = {wire.SLAVE_INTERFACE: 1, wire.SLAVE_SECOND: LAST}
# The process data, or a frame of the supervision, may be on the cable when it breaks.
LOST_ON_THE_CABLE = 1


def bus_file(folder, cycle_time_us):
    path = os.path.join(folder, f"ring_{cycle_time_us}.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(BUS.format(first=wire.MASTER_INTERFACE, second=wire.MASTER_SECOND, cycle_time_us=cycle_time_us,
                              lost_cycles_limit=wire.PAUSE_US // cycle_time_us))
    return path


def set_cable(segment, place, plugged):
    """Place 1 is before the first slave, LAST behind the last one. A link is the veth pair at an end of the ring."""
    if place in LINKS:
        done = segment.run_beside(["ip", "link", "set", place, "up" if plugged else "down"])
        wire.check(done.returncode == 0, f"{place}: {done.stderr}")
    else:
        cable = f"{SLAVES} behind" if place == LAST else str(place)
        answer = segment.console(f"{'replug' if plugged else 'unplug'} {cable}")
        wire.check("plugged" in answer, answer)


class Ended(Exception):
    """The master has ended by itself."""


class Master:
    """`cm1e move` of X, looked at through its control socket."""

    def __init__(self, segment, cm1e, path):
        self.segment, self.cm1e, self.path = segment, cm1e, path
        self.environment = dict(os.environ, CM1E_RUNTIME_DIR=segment.folder)
        self.process = subprocess.Popen(segment.command([cm1e, "move", "-b", path, "X", "--speed", "2", "--for", "600"]),
                                        env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                        text=True)
        self.socket = os.path.join(segment.folder, f"cm1e-{self.process.pid}-0.sock")
        wire.wait_for(self.moves, 15, "X does not move")

    def moves(self):
        axes = self.ask("axes")
        return bool(axes) and axes["axes"][0]["state"] == "ContinuousMotion"

    def check_alive(self):
        if self.process.poll() is not None:
            raise Ended(self.process.communicate()[1])

    def ask(self, request, **arguments):
        """None: it does not listen yet."""
        try:
            with control_client.Client(self.socket) as client:
                return client.ask(request, **arguments)
        except (FileNotFoundError, ConnectionRefusedError):
            return None
        finally:
            self.check_alive()

    def take(self, request, key):
        """A part of the reply. A master that ends does not have it any more."""
        reply = self.ask(request)
        if not reply or key not in reply:
            self.process.wait(20)
            self.check_alive()
        return reply[key]

    def counted(self):
        """Cycles without an answer, and with a wrong working counter."""
        bus = self.take("statistics", "statistics")["bus"]
        return bus["lost_frames"] + bus["working_counter_errors"]

    def ring(self):
        return self.take("slaves", "ring")

    def events(self):
        return [event["text"] for event in self.take("log", "log")["events"] if event["kind"] == "ring"]

    def states(self):
        return [slave["al_state"] for slave in self.take("slaves", "slaves")]

    def status(self):
        done = subprocess.run(self.segment.command([self.cm1e, "status", "-b", self.path]), env=self.environment,
                              capture_output=True, text=True, timeout=20)
        self.check_alive()
        wire.check(done.returncode == 0, f"status: {done}")
        return done.stdout

    def end(self):
        self.process.terminate()
        return self.process.communicate(timeout=30)[1]


def check_place(segment, master, place):
    """Breaks one cable and mends it. Returns the cycles that each of the two has cost."""
    number = LINKS.get(place, place)
    expected = f"broken between {NAMES[number - 1]} and {NAMES[number]}."
    before = master.counted()
    set_cable(segment, place, False)
    wire.wait_for(lambda: expected in master.ring()["text"], 5, f"cable {place}: {master.ring()}, not {expected}")
    time.sleep(0.15)
    broken = master.counted() - before
    wire.check(expected in master.events()[-1], f"cable {place}: the event log has {master.events()[-1:]}")
    if place == 2:
        told = master.status()
        wire.check('The ring is broken between slave 1 ("X", CM1-E) and slave 2 ("Y", CM1-E)' in told, f"status says {told}")
    before = master.counted()
    set_cable(segment, place, True)
    wire.wait_for(lambda: not master.ring()["broken"], 5, f"cable {place}: mended, but {master.ring()}")
    time.sleep(0.15)
    mended = master.counted() - before
    wire.check(master.events()[-1] == "The ring is whole again.", f"cable {place}: the event log has {master.events()}")
    wire.check(master.states() == [8] * SLAVES and master.moves(), f"cable {place}: {master.states()}")
    return broken, mended


def check_cost(segment, master, place, cycle_time_us):
    """A busy machine loses frames of its own beside a break, but not beside each."""
    costs = []
    while len(costs) < ATTEMPTS and (not costs or max(costs[-1]) > LOST_ON_THE_CABLE):
        costs.append(check_place(segment, master, place))
    wire.check(max(costs[-1]) <= LOST_ON_THE_CABLE, f"{cycle_time_us} us, cable {place}: {costs} cycles lost")
    return costs[-1]


def check_cables(segment, cm1e, cycle_time_us):
    master = Master(segment, cm1e, bus_file(segment.folder, cycle_time_us))
    try:
        costs = {place: check_cost(segment, master, place, cycle_time_us) for place in range(1, LAST + 1)}
        print(f"{cycle_time_us} us, cycles lost when a cable is broken, and mended: {costs}")
    finally:
        told = master.end()
    wire.check("X: move was interrupted" in told, f"the master ended by itself: {told}")


def check_links(segment, cm1e):
    """Takes the interfaces down, one after the other. The kernel swallows frames for some 25 ms before it tells their
    owner, the simulator; together with a pause of this machine that may be more than a bus lets pass."""
    for link in LINKS:
        for attempt in range(ATTEMPTS):
            master = Master(segment, cm1e, bus_file(segment.folder, 1000))
            try:
                costs = check_place(segment, master, link)
                print(f"{link} down and up: {costs} cycles lost")
                break
            except Ended as ended:
                wire.check("frames are lost" in str(ended) and attempt + 1 < ATTEMPTS, f"{link}: {ended}")
                set_cable(segment, link, True)
            finally:
                master.end()


def check_start(segment, cm1e, cycle_time_us):
    """A ring that is broken when the master starts."""
    set_cable(segment, 3, False)
    master = Master(segment, cm1e, bus_file(segment.folder, cycle_time_us))
    wire.wait_for(lambda: master.events(), 5, "the event log does not tell that the ring is broken")
    wire.check(f"between {NAMES[2]} and {NAMES[3]}" in master.events()[0], f"the event log has {master.events()}")
    master.end()
    set_cable(segment, 3, True)


def main(cm1e):
    wire.become_root()
    with tempfile.TemporaryDirectory() as folder:
        slaves = bus_file(folder, 1000)
        with wire.segment(cm1e, slaves, ring=True) as segment:
            try:
                for cycle_time_us in (1000, 250):
                    check_cables(segment, cm1e, cycle_time_us)
                check_links(segment, cm1e)
                check_start(segment, cm1e, 1000)
            except Ended as ended:
                wire.check(False, f"the master ended: {ended}")


if __name__ == "__main__":
    main(sys.argv[1])
