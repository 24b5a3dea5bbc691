#!/usr/bin/env python3
"""Motion programs for TwinCAT that others wrote and published run unchanged on the simulated segment, or the line that
cannot is named. They are fetched from GitHub by commit, and checked by SHA-256; CM1E_FOREIGN_ST names a folder that has
them already, as SHA-256.

test_st_foreign.py BIN-DIRECTORY
"""
import csv
import hashlib
import os
import subprocess
import sys
import tempfile
import urllib.error
import urllib.parse
import urllib.request

BIN = os.path.abspath(sys.argv[1])
SKIPPED = 77
NESPOLO = "MatheusNespolo/TwinCAT/a2c987b975225412d596c68623db0495b6ba20fa/"
LCLS = "pcdshub/lcls-twincat-motion/3cec6ffe2ceeb9a2852dab8a508c346c0da3addf/lcls-twincat-motion/Library/POUs/"
OOP = "0w8States/PLC-OOP-Basics/fe25592e399383e6eb6cf4eeeb430787b3161091/Tutorials/AbstractDrive/AbstractDrive/PLC1/"
NIALL = "niallasmith/TwinCAT-ADS-MC/843e3cad02ee1b5af565b244d2d5bf739292e233/XAE/TwinCAT-ADS-MC/PLC-Project/"

# What an operator does at the panel of the machine.
PANEL = """PROGRAM Panel
VAR n : DINT; END_VAR
n := n + 1;
MAIN.MaquinaLigada := n < 9000;
MAIN.lrOverride_Eixo2 := 100;
MAIN.bMoverEixo1Rel := n > 500;
MAIN.bMoverEixo1Abs := n > 3500;
MAIN.bMoverEixo1Velo := n > 4000;
MAIN.bHaltEixo1 := n > 5000;
MAIN.lrPosicaoMod := 180;
MAIN.bMoverEixo1Mod := n > 6000;
MAIN.bPararEixo1 := n > 6100;
END_PROGRAM
"""
# Its MAIN asks a drive by an interface, and changes the drive while it runs.
DRIVES = """PROGRAM Panel
VAR n : DINT; END_VAR
n := n + 1;
MAIN.bCANDrive := n = 100;
MAIN.bNcDrive := n = 200;
MAIN.fbDriveNc.SetLimits(lrMax := 10, lrMin := -10);
END_PROGRAM
"""
SCOPE = """PROGRAM Panel
MAIN.MaquinaLigada := TRUE;
END_PROGRAM
"""
STEPS = """PROGRAM MAIN
VAR
    X : AXIS_REF;
    power : MC_Power;
    test : FB_MicroStepCountTest;
END_VAR
power(Axis := X, Enable := TRUE, Enable_Positive := TRUE, Enable_Negative := TRUE, Override := 100.0);
test(Axis := X, bExecute := power.Status, fStepSize := 0.5, nSteps := 4, fMicroStep := 0.25, fVelocity := 2,
     tSettleTime := T#200ms);
END_PROGRAM
"""


def machine(rows):
    """Moves of the axis as the panel asks for them, one after the other."""
    def at(n, name):
        return float(rows[n][f"Axis1 {name}"])
    assert abs(at(3400, "set position [u]") - 10) < 1e-6, "the relative move"
    assert abs(at(4900, "set velocity [u/s]") - 25) < 1e-6, "MC_MoveVelocity"
    assert at(5900, "set velocity [u/s]") == 0, "MC_Halt"
    assert rows[8000]["Axis1 state"] == "Stopping" and at(8000, "set velocity [u/s]") == 0, "MC_Stop"
    assert rows[-1]["Axis1 state"] == "Disabled", "the end"
    assert rows[3000]["Axis2 state"] == "Standstill", "the second axis"


def scope(rows):
    assert rows[1000]["Axis1 state"] == "Standstill" and rows[1000]["MAIN.bHabilita"] == "1", "power"


def drives(rows):
    assert rows[300]["MAIN.fbDriveNc.lrMax"] == "10" and rows[300]["MAIN.fbDriveNc.lrMin"] == "-10", "SetLimits"
    assert rows[300]["MAIN.fbDriveCan.lrMax"] == "0", "the other drive"


def steps(rows):
    assert rows[-1]["MAIN.test.nStepsCounted"] == "4", "steps"
    assert abs(float(rows[-1]["X set position [u]"]) - 2) < 1e-6, "position"
    assert abs(float(rows[-1]["MAIN.test.fEstMicroSize"]) - 0.5) < 1e-3, "the size of a step, by NcToPlc.ActPos"


# Name: files as (address, SHA-256), our driver of it, seconds of the run, what to look at.
PROGRAMS = {
    "machine": (((NESPOLO + "Motion-Control/MotionControl/MotionControl/MotionControl/POUs/MAIN.TcPOU", "7551c3c47e238d8c408408c0a8e66f23ba95fb189ca0fd47f4c845f1e8742705"),
                 (NESPOLO + "Motion-Control/MotionControl/MotionControl/MotionControl/GVLs/GVL_Axes.TcGVL", "13e83a6952a94e1c7c6d1ed12a1a73e211e2a99b50f81f758eab8fae6364c8a7")),
                PANEL, 10, machine),
    "scope": (((NESPOLO + "Inacabados/Motion-Control/ScopeTest/ScopeTest/ScopeTestPLC/POUs/MAIN.TcPOU", "2f46896209bdcdc7def9bc47bea262129c8fa869d539353eceb564faa1fcbbe6"),
               (NESPOLO + "Inacabados/Motion-Control/ScopeTest/ScopeTest/ScopeTestPLC/GVLs/Axes.TcGVL", "a1e3d2ee8aafe7b78e2cfd14e75fbf8d1d3cfaba50d52b76cd521ec9bc894eaf")),
              SCOPE, 2, scope),
    "drives": (((OOP + "FBs/Base/FB_DriveBase.TcPOU",
                 "0a3347472ad433a2bbe4b4f9f52a639d677a3029b2c878fa751e60ceaa163c8b"),
                (OOP + "FBs/Extended/FB_DriveCAN.TcPOU",
                 "7a4a9153de380bcf4346e00b2ed6158fcee107881bdf9d788c88d84d99d8c9f1"),
                (OOP + "FBs/Extended/FB_DriveNc.TcPOU",
                 "e7f247ad231a105d58f3505ffb66acd92df14ab39bcac4bbf3b0f1519c57cf33"),
                (OOP + "ITFs/I_DriveBase.TcIO",
                 "f2fd29a87a55ab39205d9ecb9d8d9b6a5f97f30ecb590768df222e76b9069dd8"),
                (OOP + "POUs/MAIN.TcPOU",
                 "fd761b1deca574b60b4930607a25218397732550494935938c8f3bd72b04dc65")),
               DRIVES, 1, drives),
    "steps": (((LCLS + "MotorTesting/FB_MicroStepCountTest.TcPOU", "736d38925a3d2c244fabd6e0c1e99c0d8fede621248de12748defa70e8c42336"),), STEPS, 4, steps),
}
# Name: files, and the line that cannot run.
REFUSED = {
    "remote": (((NIALL + "POUs/MAIN.TcPOU", "8b56722582117c5f6e6ead4fa14f9dc3a890e12e327caabce7d55c1a25e8ccdc"),), "ActiveControlLoopIndex"),
}


def fetch(address, sha256, path):
    """False: there is no network."""
    kept = os.path.join(os.environ.get("CM1E_FOREIGN_ST", ""), sha256)
    try:
        if os.path.exists(kept):
            with open(kept, "rb") as file:
                text = file.read()
        else:
            with urllib.request.urlopen("https://raw.githubusercontent.com/" + urllib.parse.quote(address), timeout=10) as file:
                text = file.read()
    except OSError as error:
        print(f"SKIPPED: st_foreign: {address} cannot be fetched ({error}), and CM1E_FOREIGN_ST names no folder that has it")
        return False
    if hashlib.sha256(text).hexdigest() != sha256:
        sys.exit(f"{address} is another file than the one that was tried: {hashlib.sha256(text).hexdigest()}")
    with open(path, "wb") as file:
        file.write(text)
    return True


def cm1e(*words):
    return subprocess.run([os.path.join(BIN, "cm1e"), *words], capture_output=True, text=True, timeout=60)


def fetch_all(files):
    names = [f"{i}_{address.rsplit('/', 1)[1]}" for i, (address, _) in enumerate(files)]
    if not all(fetch(address, sha256, name) for (address, sha256), name in zip(files, names)):
        sys.exit(SKIPPED)
    return names


def run(name, files, driver, seconds, look):
    sources = fetch_all(files)
    with open("driver.st", "w", encoding="ascii") as file:
        file.write(driver)
    for words in (("st", "build", *sources, "driver.st", "-o", "program.so"),
                  ("run", "program.so", "-i", "sim", "--virtual-time", "-s", str(seconds), "--csv", "trace.csv")):
        result = cm1e(*words)
        if result.returncode != 0:
            sys.exit(f"{name}: {' '.join(words)}: {result.stdout}{result.stderr}")
    with open("trace.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    try:
        look(rows)
    except AssertionError as error:
        sys.exit(f"{name}: {error} is not as it should be")
    print(f"{name}: runs")


def refuse(name, files, says):
    sources = fetch_all(files)
    result = cm1e("st", "check", *sources)
    lines = [line for line in result.stderr.splitlines() if says in line and ": error: " in line]
    if result.returncode != 1 or not lines:
        sys.exit(f"{name}: a line about {says} is expected in {result.stderr}")
    print(f"{name}: {lines[0]}")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for program, parts in PROGRAMS.items():
        run(program, *parts)
    for program, parts in REFUSED.items():
        refuse(program, *parts)
