#!/usr/bin/env python3
"""A master that knows nothing but an ENI file: sends its InitCmds as they stand there, with their checks and through
the mailbox where they are SDOs, and then its cyclic frames. For tests: it says at once what is not as the file has it.

eni_player.py FILE INTERFACE PLAY     PLAY is Python: a function play(master), to be executed here
"""
import socket
import struct
import sys
import time
import xml.etree.ElementTree as ElementTree

ETHER_TYPE, OUTGOING = 0x88A4, 4
APRD, APWR, FPRD, FPWR, BRD, BWR, LRD, LWR, LRW, ARMW = 1, 2, 4, 5, 7, 8, 10, 11, 12, 13
DC_TIMES, DC_SYSTEM_TIME, DC_OFFSET, DC_DELAY, DC_DIFFERENCE, DC_START = 0x0900, 0x0910, 0x0920, 0x0928, 0x092C, 0x0990
DC_LEAD_NS = 200_000_000  # from the setting of SYNC0 to its first pulse
DATAGRAM_HEADER = 10
STATES = {"I": "INIT", "P": "PREOP", "S": "SAFEOP", "O": "OP"}


class Failed(Exception):
    pass


def number(text):
    return int(text.replace("#x", "0x"), 0)


def numbers(node, *names):
    """The numbers of children; None where there is no such child."""
    texts = [node.findtext(name) for name in names]
    return [None if text is None else number(text) for text in texts]


def octets(node, name):
    text = node.findtext(name)
    return bytes.fromhex(text) if text else b""


class Datagram:
    def __init__(self, node):
        self.comment = node.findtext("Comment") or "?"
        self.transitions = [t.text for t in node.findall("Transition")]
        self.states = [s.text for s in node.findall("State")]
        self.before_slave = (node.findtext("BeforeSlave") or "0") in ("1", "true")
        self.code, adp, ado, address = numbers(node, "Cmd", "Adp", "Ado", "Addr")
        self.address = struct.pack("<I", address) if address is not None else struct.pack("<HH", adp & 0xFFFF, ado)
        self.logical = address
        self.ado = ado
        self.data = octets(node, "Data") or bytes(numbers(node, "DataLength")[0])
        self.count, self.input, self.output = numbers(node, "Cnt", "InputOffs", "OutputOffs")
        self.retries = numbers(node, "Retries")[0] or 0
        validate = node.find("Validate")
        self.expected = None if validate is None else octets(validate, "Data")
        self.mask = None if validate is None else octets(validate, "DataMask") or b"\xff" * len(self.expected)
        self.timeout_s = None if validate is None else numbers(validate, "Timeout")[0] / 1000

    def satisfied(self, data):
        return all((a ^ b) & m == 0 for a, b, m in zip(data, self.expected, self.mask))


class Sdo:
    def __init__(self, node):
        self.comment = node.findtext("Comment") or "?"
        self.transitions = [t.text for t in node.findall("Transition")]
        timeout, self.specifier, self.index, self.subindex = numbers(node, "Timeout", "Ccs", "Index", "SubIndex")
        self.timeout_s = timeout / 1000
        self.data = octets(node, "Data")
        self.disabled = (node.findtext("Disabled") or "0") in ("1", "true")


class Slave:
    def __init__(self, node):
        self.name = node.findtext("Info/Name")
        self.station, self.position = numbers(node, "Info/PhysAddr", "Info/AutoIncAddr")
        self.commands = [Datagram(c) for c in node.findall("InitCmds/InitCmd")]
        self.sdos = [Sdo(c) for c in node.findall("Mailbox/CoE/InitCmds/InitCmd")]
        self.send, self.send_length, self.receive, self.receive_length = numbers(
            node, "Mailbox/Send/Start", "Mailbox/Send/Length", "Mailbox/Recv/Start", "Mailbox/Recv/Length")
        self.out, self.into = numbers(node, "ProcessData/Send/BitStart", "ProcessData/Recv/BitStart")
        self.counter = 0
        dc = node.find("DC")
        self.has_clock = dc is not None
        self.reference = dc is not None and dc.findtext("ReferenceClock") in ("1", "true")
        self.sync0_ns, self.shift_ns = (0, 0) if dc is None else numbers(dc, "CycleTime0", "ShiftTime")
        self.ours = {}            # what the master puts in place of the zeros of the file, by register


class Master:
    def __init__(self, path, interface):
        config = ElementTree.parse(path).getroot().find("Config")
        self.commands = [Datagram(c) for c in config.findall("Master/InitCmds/InitCmd")]
        self.slaves = [Slave(s) for s in config.findall("Slave")]
        self.frames = [[Datagram(c) for c in f.findall("Cmd")] for f in config.findall("Cyclic/Frame")]
        self.cycle_s = number(config.findtext("Cyclic/CycleTime")) / 1e6
        self.inputs, self.variables = self.image(config.find("ProcessImage/Inputs"))
        self.outputs, variables = self.image(config.find("ProcessImage/Outputs"))
        self.variables = {"in": self.variables, "out": variables}
        self.destination = octets(config.find("Master/Info"), "Destination")
        self.state = "INIT"
        self.cyclic = {}          # working counter and data of every cyclic command, as they came last
        self.cycles = self.lost = 0
        self.dc_time = 0          # of the reference clock, as the last cycle brought it
        self.next = time.monotonic()
        self.socket = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ETHER_TYPE))
        self.socket.bind((interface, ETHER_TYPE))
        self.header = self.destination + self.socket.getsockname()[4] + struct.pack(">H", ETHER_TYPE)
        self.check_places()

    @staticmethod
    def image(node):
        variables = {v.findtext("Name"): numbers(v, "BitOffs", "BitSize") for v in node.findall("Variable")}
        if len(variables) != len(node.findall("Variable")):
            raise Failed("two variables have one name")
        return bytearray(number(node.findtext("ByteSize"))), variables

    def check_places(self):
        """The places that the file states in two ways agree: logical addresses, and bits of the image."""
        for slave in self.slaves:
            for command in slave.commands:
                if command.ado is None or not 0x600 <= command.ado < 0x700 or not any(command.data):
                    continue
                logical, length = struct.unpack_from("<IH", command.data)
                start = slave.into if command.data[11] == 1 else slave.out
                places = [c for f in self.frames for c in f if c.logical is not None and c.logical <= logical
                          and logical + length <= c.logical + len(c.data)]
                if len(places) != 1:
                    raise Failed(f"{slave.name}: {len(places)} cyclic commands reach {command.comment}")
                byte = places[0].input + DATAGRAM_HEADER + logical - places[0].logical
                if byte * 8 != start:
                    raise Failed(f"{slave.name}: {command.comment}: bit {start}, but its data come at byte {byte}")

    # ---- frames ----------------------------------------------------------------------------------------------------

    def exchange(self, datagrams, timeout_s=0.05):
        """Sends datagrams (code, address, data) as one frame; returns [(data, working counter)]; None: it is lost."""
        self.index = (getattr(self, "index", 0) + 1) & 0xFF
        body = b""
        for i, (code, address, data) in enumerate(datagrams):
            more = 0x8000 if i + 1 < len(datagrams) else 0
            body += struct.pack("<BB", code, self.index) + address + struct.pack("<HH", len(data) | more, 0)
            body += data + b"\0\0"
        if len(body) > 1498:
            raise Failed(f"a frame of {len(body)} bytes")
        self.socket.send(self.header + struct.pack("<H", len(body) | 0x1000) + body)
        end = time.monotonic() + timeout_s
        while time.monotonic() < end:
            self.socket.settimeout(max(end - time.monotonic(), 0.0001))
            try:
                frame, sender = self.socket.recvfrom(2048)
            except socket.timeout:
                break
            if sender[2] == OUTGOING or frame[17] != self.index:
                continue
            answers, at = [], 16
            for _, _, data in datagrams:
                at += DATAGRAM_HEADER + len(data)
                answers.append((frame[at - len(data):at], struct.unpack_from("<H", frame, at)[0]))
                at += 2
            return answers
        return None

    def cycle(self):
        """One cycle: waits for its time, sends the frames that the file has for the state, takes the answers in."""
        self.next = max(self.next + self.cycle_s, time.monotonic() - 10 * self.cycle_s)
        time.sleep(max(self.next - time.monotonic(), 0))
        self.cycles += 1
        for frame in self.frames:
            commands = [c for c in frame if self.state in c.states]
            if commands:
                self.send_cyclic(commands)

    def send_cyclic(self, commands):
        datagrams = []
        for c in commands:
            start = c.output + DATAGRAM_HEADER
            data = bytes(self.outputs[start:start + len(c.data)]) if c.code in (LWR, LRW) else bytes(c.data)
            datagrams.append((c.code, c.address, data))
        answers = self.exchange(datagrams)
        if answers is None:
            self.lost += 1
            return
        for c, (data, count) in zip(commands, answers):
            self.cyclic[c] = data, count
            if c.code == ARMW and count > 0:
                self.dc_time = int.from_bytes(data, "little")
            if c.code in (LRD, LRW):
                start = c.input + DATAGRAM_HEADER
                self.inputs[start:start + len(data)] = data
            if c.count is not None and count != c.count:
                raise Failed(f"cycle {self.cycles}, {self.state}: {c.comment}: working counter {count}, not {c.count}")

    # ---- start-up --------------------------------------------------------------------------------------------------

    def measure_clocks(self):
        """Delays along the line and offsets, from the times at which the latched frame came in at the ports: a frame is
        as long on its way back. The clock of the reference is the system time."""
        clocks, loops, locals_ns = [s for s in self.slaves if s.has_clock], [], []
        for slave in clocks:
            answer = self.exchange([(FPRD, struct.pack("<HH", slave.station, DC_TIMES), bytes(32))])
            if not answer or answer[0][1] != 1:
                raise Failed(f"{slave.name}: its receive times cannot be read")
            first, second = struct.unpack_from("<II", answer[0][0])
            loops.append((second - first) & 0xFFFFFFFF if slave is not self.slaves[-1] else 0)
            locals_ns.append(struct.unpack_from("<Q", answer[0][0], 24)[0])
        reference = next(i for i, slave in enumerate(clocks) if slave.reference)
        delay = 0
        for i, slave in enumerate(clocks):
            delay += (loops[i - 1] - loops[i]) // 2 if i > 0 else 0
            offset = (locals_ns[reference] + delay - locals_ns[i]) & 0xFFFFFFFFFFFFFFFF
            slave.ours = {DC_OFFSET: struct.pack("<Q", offset), DC_DELAY: struct.pack("<I", delay)}

    def start_time(self, slave):
        period = max(slave.sync0_ns, round(self.cycle_s * 1e9))
        slave.starts = (self.dc_time + DC_LEAD_NS) // period * period + slave.shift_ns
        return struct.pack("<Q", slave.starts)

    def data_of(self, slave, command):
        """As the file has it, but for what only a master can know."""
        if slave is None or command.code != FPWR or not slave.has_clock:
            return command.data
        return self.start_time(slave) if command.ado == DC_START else slave.ours.get(command.ado, command.data)

    def differences(self):
        """What each clock deviates from the reference, ns."""
        found = {}
        for slave in (s for s in self.slaves if s.has_clock and not s.reference):
            answer = self.exchange([(FPRD, struct.pack("<HH", slave.station, DC_DIFFERENCE), bytes(4))])
            if answer and answer[0][1] == 1:
                found[slave.name] = int.from_bytes(answer[0][0], "little") & 0x7FFFFFFF
        return found

    def send(self, who, command, slave=None):
        """One InitCmd, in a cycle of its own; again where nobody answered, or the answer is not the one awaited."""
        end = time.monotonic() + (command.timeout_s or 0)
        tries = 0
        while True:
            self.cycle()
            answer = self.exchange([(command.code, command.address, self.data_of(slave, command))])
            data, count = answer[0] if answer else (b"", 0)
            answered = answer is not None and (command.count is None or count == command.count)
            if answered and (command.expected is None or command.satisfied(data)):
                if command.code == BWR and command.ado == DC_TIMES:
                    self.measure_clocks()
                return
            tries += 1
            if command.expected is not None and time.monotonic() < end:
                continue
            if command.expected is None and tries <= command.retries:
                continue
            what = f"{data.hex()}, not {command.expected.hex()}" if answered else f"working counter {count}"
            raise Failed(f"{who}: {command.comment}: {what}")

    def download(self, slave, sdo):
        if sdo.specifier != 1 or not 1 <= len(sdo.data) <= 4:
            raise Failed(f"{slave.name}: {sdo.comment}: this player makes short downloads only")
        slave.counter = slave.counter % 7 + 1
        request = struct.pack("<BHB", 0x23 | (4 - len(sdo.data)) << 2, sdo.index, sdo.subindex)
        request += sdo.data.ljust(4, b"\0")
        mail = struct.pack("<HHBBH", 2 + len(request), 0, 0, 3 | slave.counter << 4, 2 << 12) + request
        end = time.monotonic() + sdo.timeout_s
        self.mailbox(slave, FPWR, slave.send, mail.ljust(slave.send_length, b"\0"), end)
        while True:
            mail = self.mailbox(slave, FPRD, slave.receive, bytes(slave.receive_length), end)
            service = struct.unpack_from("<H", mail, 6)[0] >> 12
            if mail[5] & 0x0F != 3 or service != 3:
                continue   # an emergency, or another protocol
            command, index, subindex, code = struct.unpack_from("<BHBI", mail, 8)
            if (index, subindex) != (sdo.index, sdo.subindex):
                raise Failed(f"{slave.name}: {sdo.comment}: the answer is about 0x{index:04X}:{subindex}")
            if command >> 5 != 3:
                raise Failed(f"{slave.name}: {sdo.comment}: refused, 0x{code:08X}")
            return

    def mailbox(self, slave, code, start, data, end):
        while time.monotonic() < end:
            self.cycle()
            answer = self.exchange([(code, struct.pack("<HH", slave.station, start), data)])
            if answer and answer[0][1] == 1:
                return answer[0][0]
        raise Failed(f"{slave.name}: its mailbox at 0x{start:04X} does not answer")

    def transition(self, name):
        """All slaves, one after the other: the master's commands that come first, SDOs, the slave's commands."""
        while name == "SO" and any(self.dc_time < getattr(slave, "starts", 0) for slave in self.slaves):
            self.cycle()  # a slave may refuse Operational before its first SYNC0
        for command in self.commands:
            if name in command.transitions and command.before_slave:
                self.send("master", command)
        for slave in self.slaves:
            for sdo in slave.sdos:
                if name in sdo.transitions and not sdo.disabled:
                    self.download(slave, sdo)
            for command in slave.commands:
                if name in command.transitions:
                    self.send(slave.name, command, slave)
        for command in self.commands:
            if name in command.transitions and not command.before_slave:
                self.send("master", command)
        self.state = STATES[name[1]]

    def start(self):
        for name in ("IP", "PS", "SO"):
            self.transition(name)

    def stop(self):
        """Back, one state after the other. From here on the working counters of slaves that have left are missing."""
        for frame in self.frames:
            for command in frame:
                command.count = None
        for name in ("OS", "SP", "PI"):
            self.transition(name)

    # ---- variables -------------------------------------------------------------------------------------------------

    def names(self, direction, slave, entry):
        return [n for n in self.variables[direction] if n.startswith(slave + ".") and n.endswith("." + entry)]

    def find(self, direction, slave, entry):
        names = self.names(direction, slave, entry)
        if len(names) != 1:
            raise Failed(f"{slave} has {len(names)} variables {entry}")
        return self.variables[direction][names[0]]

    def read(self, slave, entry, signed=False):
        offset, bits = self.find("in", slave, entry)
        value = int.from_bytes(self.inputs, "little") >> offset & (1 << bits) - 1
        return value - (1 << bits) if signed and value >> (bits - 1) else value

    def write(self, slave, entry, value):
        offset, bits = self.find("out", slave, entry)
        mask = ((1 << bits) - 1) << offset
        image = int.from_bytes(self.outputs, "little") & ~mask | (value & (1 << bits) - 1) << offset
        self.outputs[:] = image.to_bytes(len(self.outputs), "little")

    def al_states(self):
        """States of all slaves, or-ed together, and how many answered, as the last cycle saw them."""
        return next(((data[0] & 0x1F, count) for c, (data, count) in self.cyclic.items()
                     if c.code == BRD and c.ado == 0x0130), None)


if __name__ == "__main__":
    try:
        scope = {"Failed": Failed}
        exec(sys.argv[3], scope)
        scope["play"](Master(sys.argv[1], sys.argv[2]))
    except Failed as failed:
        print("FAILED:", failed)
        sys.exit(1)
