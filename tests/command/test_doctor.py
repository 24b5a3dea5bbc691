"""`cm1e doctor` on machines that are made of files: each has one thing that is wrong, and the finding names it, says
what to do, and its commands are shell that parses. The machine without a fault has no finding.

Usage: test_doctor.py <folder of the binaries>
"""
import json
import os
import subprocess
import sys
import tempfile

CM1E = os.path.join(sys.argv[1], "cm1e")

GOOD = {
    "proc/version": "Linux version 6.1.0-rt (gcc) #1 SMP PREEMPT_RT Debian",
    "proc/cpuinfo": "processor\t: 0\nflags\t\t: fpu tsc\n",
    "proc/self/status": "Name:\tcm1e\nCapEff:\t000001ffffffffff\n",
    "sys/kernel/realtime": "1",
    "sys/devices/system/cpu/isolated": "1",
    "sys/devices/system/cpu/cpu0/cpufreq/scaling_governor": "performance",
    "sys/devices/system/cpu/cpu1/cpufreq/scaling_governor": "performance",
    "sys/devices/system/cpu/cpu0/cpuidle/state0/latency": "0",
    "sys/devices/system/cpu/cpu0/cpuidle/state0/name": "POLL",
    "sys/devices/system/cpu/cpu0/cpuidle/state0/disable": "0",
    "sys/devices/system/cpu/cpu0/cpuidle/state1/latency": "170",
    "sys/devices/system/cpu/cpu0/cpuidle/state1/name": "C6",
    "sys/devices/system/cpu/cpu0/cpuidle/state1/disable": "1",
    "sys/devices/system/clocksource/clocksource0/current_clocksource": "tsc",
    "sys/class/net/lo/type": "772",
    "sys/class/net/wlan9/type": "1",
    "sys/class/net/wlan9/phy80211/name": "phy0",
    "sys/class/net/eth9/type": "1",
    "sys/class/net/eth9/ifindex": "7",
    "sys/class/net/eth9/flags": "0x1003",
    "sys/class/net/eth9/carrier": "1",
    "sys/class/net/eth9/speed": "100",
    "sys/class/net/eth9/duplex": "full",
    "sys/class/net/eth9/device/driver": ("link", "/sys/bus/pci/drivers/igc"),
    "sys/class/net/eth9/device/msi_irqs/41": "msix",
    "sys/class/net/eth9/device/msi_irqs/42": "msix",
    "proc/irq/41/effective_affinity_list": "0",
    "proc/irq/42/smp_affinity_list": "0,2-3",
    "run/NetworkManager/devices/7": "[device]\nmanaged=false\n",
}
NET = "sys/class/net/eth9/"

# What is wrong (files that differ; None: it is not there), the subject of the finding, its level, a word of the fact,
# and a word of the commands ("": there are none).
FAULTS = [
    ({"sys/kernel/realtime": None, "proc/version": "Linux version 6.1.0 #1 SMP PREEMPT_DYNAMIC Debian"}, "kernel",
     "advice", "PREEMPT_DYNAMIC", "linux-image-rt"),
    ({"proc/cpuinfo": "flags\t\t: fpu hypervisor tsc\n"}, "virtual machine", "advice", "virtual", ""),
    ({"sys/devices/system/cpu/isolated": ""}, "isolated processors", "advice", "none", "isolcpus"),
    ({"sys/devices/system/cpu/cpu1/cpufreq/scaling_governor": "powersave"}, "frequency governor", "advice",
     '"powersave" at processor 1', "echo performance"),
    ({"sys/devices/system/cpu/cpu0/cpuidle/state1/disable": "0"}, "sleep states", "advice",
     "C6 of the processors takes 170", "udevadm trigger"),
    ({"sys/devices/system/clocksource/clocksource0/current_clocksource": "hpet"}, "clock source", "problem",
     "hpet", "echo tsc"),
    ({"proc/self/status": "CapEff:\t0000000000000000\n"}, "privileges", "problem", "may not open raw sockets", "setcap"),
    ({"proc/self/status": "CapEff:\t0000000000000000\nCapBnd:\t00000000a80425fb\n"}, "privileges", "problem",
     "may not open raw sockets", "setcap cap_net_raw+ep '"),  # Docker's default: no CAP_SYS_NICE, no CAP_IPC_LOCK
    ({NET + "flags": "0x1002"}, "link", "problem", "eth9 is down", "ip link set eth9 up"),
    ({NET + "carrier": "0"}, "link", "problem", "no link", ""),
    ({NET + "speed": "10"}, "link", "problem", "10 Mbit/s", "ethtool -s eth9"),
    ({NET + "duplex": "half"}, "link", "problem", "half duplex", "ethtool -s eth9"),
    ({NET + "master": ("link", "../br0")}, "bridge", "problem", "belongs to the bridge or bond br0", "nomaster"),
    ({NET + "bridge/bridge_id": "x"}, "bridge", "problem", "is a bridge", ""),
    ({NET + "device/driver": ("link", "/sys/bus/usb/drivers/ax88179_178a")}, "eth9", "advice", "connected by USB", ""),
    ({NET + "phy80211/name": "phy1"}, "eth9", "problem", "is wireless", ""),
    ({NET + "type": "772"}, "eth9", "problem", "not an Ethernet interface", ""),
    ({NET + "type": None}, "eth9", "problem", "does not exist. There are: wlan9 (wireless)", ""),
    ({"run/NetworkManager/devices/7": "[device]\nmanaged=true\n"}, "NetworkManager", "advice", "manages eth9",
     "unmanaged-devices=interface-name:eth9"),
    ({"proc/irq/41/effective_affinity_list": "1"}, "interrupts", "advice", "41 at processor 1",
     "for i in 41; do echo 0 > /proc/irq/$i/smp_affinity_list"),
    ({"proc/irq/42/smp_affinity_list": "0-3"}, "interrupts", "advice", "42 at processor 0-3", "for i in 42; do"),
    ({"sys/class/net/eth9/device/msi_irqs/41": None, "sys/class/net/eth9/device/msi_irqs/42": None,
      "sys/class/net/eth9/device/irq": "17", "proc/irq/17/smp_affinity_list": "1"}, "interrupts", "advice",
     "17 at processor 1", "for i in 17; do"),
    ({"run/systemd/netif/leases/7": "ADDRESS=10.0.0.7\n"}, "systemd-networkd", "advice", "by DHCP", "Unmanaged=yes"),
]


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def make_machine(root, changes):
    for path, content in {**GOOD, **changes}.items():
        if content is None:
            continue
        path = os.path.join(root, path)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        if isinstance(content, tuple):
            os.symlink(content[1], path)
        else:
            with open(path, "w", encoding="utf-8") as file:
                file.write(content + "\n")


def doctor(changes, *words):
    with tempfile.TemporaryDirectory() as root:
        make_machine(root, changes)
        return subprocess.run([CM1E, "doctor", "--root", root, "--seconds", "0", "-i", "eth9", *words],
                              capture_output=True, text=True, check=False, timeout=60)


def findings(changes):
    """Those that concern the machine of files; no slave answers on an interface that is none."""
    done = doctor(changes, "--json")
    expect(done.returncode == 1, f"exit status {done.returncode} without a network: {done.stderr}")
    return [f for f in json.loads(done.stdout) if f["level"] in ("advice", "problem") and f["group"] != "network"]


def check_faults():
    expect(findings({}) == [], f"findings on a machine without a fault: {findings({})}")
    forbidden_by_a_run = {"sys/devices/system/cpu/cpu0/cpuidle/state1/disable": "0", "dev/cpu_dma_latency": ""}
    expect(findings(forbidden_by_a_run) == [], f"sleep states that a run forbids: {findings(forbidden_by_a_run)}")
    for changes, subject, level, fact, fix in FAULTS:
        found = findings(changes)
        expect(len(found) == 1, f"{changes}: {found}")
        f = found[0]
        expect(f["subject"] == subject and f["level"] == level and fact in f["fact"], f"{changes}: {f}")
        expect(f["action"] and fix in f["fix"] and bool(fix) == bool(f["fix"]), f"{changes}: {f}")
        script = doctor(changes, "--fix").stdout
        expect(fix in script and f["action"] in script, f"{changes}: not in the script: {script}")
        parsed = subprocess.run(["sh", "-n"], input=script, capture_output=True, text=True, check=False)
        expect(parsed.returncode == 0, f"{changes}: the script is no shell: {parsed.stderr}{script}")


def check_container():
    """A privilege that root has in a container is none that it lacks; one that it lacks is given with the container."""
    for permitted, lacks in (("00000000a80425fb", False), ("00000000a80405fb", True)):
        found, = findings({"proc/self/status": f"CapEff:\t0000000000000000\nCapBnd:\t{permitted}\n"})
        expect(("Not even root has cap_net_raw" in found["action"]) == lacks and ("cap_net_raw" in found["fix"]) != lacks,
               f"the cure in a container: {found}")


def check_network():
    good = subprocess.run([CM1E, "doctor", "-i", "sim", "--seconds", "0.2", "--json"], capture_output=True, text=True,
                          check=False, timeout=60)
    found = {f["subject"]: f for f in json.loads(good.stdout) if f["group"] == "network"}
    expect(found["motor power"]["level"] == "ok" and found["connections"]["level"] == "ok" and "slaves" in found,
           f"the simulated network: {found}")
    latency = [f for f in json.loads(good.stdout) if f["subject"] == "wake-up latency"]
    expect(len(latency) == 1 and "of a cycle of 1000 us" in latency[0]["fact"], f"latency: {latency}")
    text = doctor({NET + "carrier": "0"}).stdout
    expect("  problem  link: eth9 has no link" in text and "do:   Check that the cable" in text, text)


def check_refusals():
    for words in (["--seconds", "-1"], ["--seconds", "nan"], ["--seconds", "1e9"], ["-i", ""], ["x"]):
        done = subprocess.run([CM1E, "doctor", *words], capture_output=True, text=True, check=False, timeout=60)
        expect(done.returncode == 2 and done.stderr, f"{words}: {done.returncode} {done.stderr}")


check_faults()
check_container()
check_network()
check_refusals()
