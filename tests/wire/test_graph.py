#!/usr/bin/env python3
"""The picture of `cm1e graph` of a tree, and of a ring that is broken at every place: each cable is drawn, the broken
one as such, nothing is cut off, and no text is on another one or on the edge of a box.

test_graph.py CM1E
"""
import contextlib
import itertools
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

SVG = "{http://www.w3.org/2000/svg}"
LETTER, LETTER_BOLD, HEIGHT = 5.7, 6.4, 10  # pixels; measured in Chromium, of a usual mix of letters
TREE = "axes:\n" + "".join(f"  - {{name: A{n}, position: {n}}}\n" for n in range(1, 7)) + """\
slaves:
  - {name: coupler, position: 7, sim: {device: coupler}}
  - {name: out, position: 8, sim: {device: digital, outputs: 4}}
"""
LONG = '"feed of the long conveyor belt"'
RING = f"axes:\n  - {{name: {LONG}, position: 1}}\n  - {{name: Y, position: 2}}\n  - {{name: Z, position: 3}}\n"


LINE = """\
axes:
  - {name: X, position: 1}
  - {name: Y, position: 2}
  - {name: Z, position: 3}
slaves:
  - {name: out, position: 4, sim: {device: digital, outputs: 4}}
"""


class Picture:
    def __init__(self, text):
        root = xml.etree.ElementTree.fromstring(text)
        self.size = int(root.get("width")), int(root.get("height"))
        self.boxes = [tuple(int(r.get(n)) for n in ("x", "y", "width", "height")) for r in root.iter(SVG + "rect")
                      if r.get("x")]
        self.red_boxes = sum(r.get("stroke") == "#c62828" for r in root.iter(SVG + "rect"))
        self.cables = [[tuple(map(int, p.split(","))) for p in line.get("points").split()]
                       for line in root.iter(SVG + "polyline")]
        self.broken = [line.get("stroke-dasharray") is not None for line in root.iter(SVG + "polyline")]
        self.texts = [(t.text, int(t.get("x")), int(t.get("y")) - HEIGHT,
                       len(t.text) * (LETTER_BOLD if t.get("font-weight") else LETTER), HEIGHT)
                      for t in root.iter(SVG + "text")]

    def check(self, what):
        for text, x, y, width, height in self.texts:
            wire.check(x >= 0 and y >= 0 and x + width <= self.size[0] and y + height <= self.size[1],
                       f"{what}: \"{text}\" is cut off")
            for left, top, wide, high in self.boxes:
                inside = left < x and x + width < left + wide and top < y and y + height < top + high
                outside = x + width < left or x > left + wide or y + height < top or y > top + high
                wire.check(inside or outside, f"{what}: \"{text}\" is on the edge of a box")
        for (one, *a), (other, *b) in itertools.combinations(self.texts, 2):
            apart = a[0] + a[2] <= b[0] or b[0] + b[2] <= a[0] or a[1] + a[3] <= b[1] or b[1] + b[3] <= a[1]
            wire.check(apart, f"{what}: \"{one}\" is on \"{other}\"")
        for a, b in itertools.combinations(self.boxes, 2):
            wire.check(a[0] + a[2] < b[0] or b[0] + b[2] < a[0] or a[1] + a[3] < b[1] or b[1] + b[3] < a[1],
                       f"{what}: two boxes are one on the other")
        for cable in self.cables:
            wire.check(self.edge(cable[0], right=True) and self.edge(cable[-1], right=False), f"{what}: a loose {cable}")

    def edge(self, point, right):
        return any(point[0] == left + (wide if right else 0) and top < point[1] < top + high
                   for left, top, wide, high in self.boxes)

    def words(self):
        return [text for text, *_ in self.texts]


class Bench:
    def __init__(self, cm1e, segment, folder, text, bus):
        self.cm1e, self.segment = cm1e, segment
        self.path = os.path.join(folder, "bus.yaml")
        with open(self.path, "w", encoding="utf-8") as file:
            file.write(f"bus: {{interface: {wire.MASTER_INTERFACE}, {bus}}}\n" + text)

    def picture(self, what):
        told = self.segment.run([self.cm1e, "graph", "-b", self.path, "--svg", "-"])
        wire.check(told.returncode == 0, f"{what}: {told}")
        picture = Picture(told.stdout)
        picture.check(what)
        return picture

    def dot(self):
        return self.segment.run([self.cm1e, "graph", "-b", self.path]).stdout


def tree(bench):
    for position, branch in ((2, 3001), (4, 1001), (6, 2001)):
        wire.check("quirk" in bench.segment.console(f"quirk {position} branch {branch}"), "quirk")
    picture = bench.picture("a tree")
    wire.check(len(picture.boxes) == 9 and len(picture.cables) == 8 and not any(picture.broken), "a tree")
    wire.check([picture.words().count(port) for port in "0123"] == [8, 5, 1, 1], f"ports: {picture.words()}")


def ring(bench):
    whole = bench.picture("a ring")
    wire.check(len(whole.boxes) == 5 and len(whole.cables) == 4 and not any(whole.broken), "a ring")
    wire.check({wire.MASTER_INTERFACE, wire.MASTER_SECOND} <= set(whole.words()), f"interfaces: {whole.words()}")
    for number, cable in enumerate(("1", "2", "3", "3 behind")):
        bench.segment.console(f"unplug {cable}")
        picture = bench.picture(f"broken at {cable}")
        wire.check(picture.broken == [place == number for place in range(4)] and picture.red_boxes == 0 and
                   picture.boxes == whole.boxes, f"broken at {cable}: {picture.broken}")
        wire.check(bench.dot().count("color=red") == 1, f"broken at {cable}: {bench.dot()}")
        bench.segment.console(f"replug {cable}")


@contextlib.contextmanager
def running(bench):
    program = subprocess.Popen(bench.segment.command([bench.cm1e, "trace", "-b", bench.path, "--for", "60", "--csv", os.devnull]),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        wire.wait_for(lambda: bench.segment.run([bench.cm1e, "log", "-b", bench.path]).returncode == 0, 10, "nothing runs")
        yield
    finally:
        program.kill()
        program.wait()


def lost_branch(bench):
    """A branch of which the cable is out takes no place of another one."""
    for position, branch in ((2, 3001), (3, 1001)):
        wire.check("quirk" in bench.segment.console(f"quirk {position} branch {branch}"), "quirk")
    with running(bench):
        dot = bench.dot()
        wire.check("s1 -> s2 [taillabel=\"3\"" in dot and "s1 -> s3 [taillabel=\"1\"" in dot, dot)
        bench.segment.console("unplug 2")
        wire.wait_for(lambda: "color=red" in bench.dot(), 10, "the slave is there")
        dot = bench.dot()
        wire.check("s1 -> s2 [style=dotted, color=red]" in dot and "s1 -> s3 [taillabel=\"1\"" in dot and
                   "s3 -> s4 [taillabel" in dot, dot)


def lost(bench):
    """Beside a program that runs: what does not answer any more is drawn as such, with the others where they are."""
    with running(bench):
        bench.segment.console("unplug 3")
        picture = bench.picture("slaves behind a cable that is out")
        wire.check(picture.broken == [False, False, True, True] and picture.red_boxes == 2 and len(picture.boxes) == 5,
                   f"lost slaves: {picture.broken}, {picture.red_boxes}")
        dot = bench.dot()
        wire.check("s1 -> s2 [taillabel" in dot and "s2 -> s3 [style=dotted, color=red]" in dot, dot)
        bench.segment.console("replug 3")
        bench.segment.console("power-cycle 2 20")  # it has no address then, and lets frames pass
        wire.wait_for(lambda: "s3 -> s4 [taillabel" in bench.dot(), 10, "the slaves behind it answer")
        dot = bench.dot()
        wire.check("s1 -> s2 [style=dotted, color=red]" in dot and "s2 -> s3 [taillabel" in dot and "s1 -> s3" not in dot, dot)
        picture = bench.picture("a slave that restarted, between others")
        wire.check(picture.broken == [False, True, False, False], f"a slave that restarted: {picture.broken}")


def main(cm1e):
    def on_a_segment(check, text, bus, **more):
        with tempfile.TemporaryDirectory() as folder:
            slaves = os.path.join(folder, "slaves.yaml")
            with open(slaves, "w", encoding="utf-8") as file:
                file.write(text)
            with wire.segment(cm1e, slaves, **more) as segment:
                check(Bench(cm1e, segment, folder, text, bus))

    wire.together(lambda: on_a_segment(tree, TREE, "cycle_time_us: 1000"),
                  lambda: on_a_segment(lost, LINE, "lost_cycles_limit: 50"),
                  lambda: on_a_segment(lost_branch, LINE, "lost_cycles_limit: 50"),
                  lambda: on_a_segment(ring, RING, f"second_interface: {wire.MASTER_SECOND}", ring=True))


if __name__ == "__main__":
    main(sys.argv[1])
