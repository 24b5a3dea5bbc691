#!/usr/bin/env python3
"""The class behind the hardware interface for ROS 2: built without ROS, with what is installed from here, and run on
the simulator.

test_ros2.py BUILD-DIRECTORY SOURCE-DIRECTORY build|try
"""
import os
import re
import shutil
import subprocess
import sys

BUILD, SOURCE, PART = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), sys.argv[3]
sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
import real_time  # noqa: E402

HOME = os.path.join(BUILD, "ros2")
TRY = os.path.join(HOME, "build", "cm1e_try")
AGAIN = os.path.join(HOME, "build", "again")
BUS = os.path.join(SOURCE, "bindings", "linuxcnc", "example", "square.yaml")


def skip(why):
    print("SKIPPED: ros2:", why)
    sys.exit(real_time.SKIPPED)


def build():
    if not shutil.which("c++"):
        skip("there is no C++ compiler")
    prefix = os.path.join(HOME, "prefix")
    subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "DESTDIR": ""})
    folder, package = os.path.dirname(TRY), os.path.join(SOURCE, "bindings", "ros2", "cm1e_hardware")
    subprocess.run(["cmake", "-S", package, "-B", folder, f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_CXX_FLAGS=-Werror",
                    "-DCMAKE_C_FLAGS=-Werror"], check=True)
    subprocess.run(["cmake", "--build", folder], check=True)
    libraries = subprocess.run(["pkg-config", "--libs", "cm1e-busfile", "cm1e-sim", "cm1e-control", "cm1e"], check=True,
                               capture_output=True, text=True, env={
                                   **os.environ, "PKG_CONFIG_PATH": os.path.join(prefix, "lib", "pkgconfig")}).stdout.split()
    subprocess.run(["c++", "-std=c++17", "-Wall", "-Wextra", "-Werror", "-I", os.path.join(package, "include"), "-I",
                    os.path.join(SOURCE, "bindings", "stream"), os.path.join(SOURCE, "tests", "ros2", "again.cpp"), "-o", AGAIN,
                    "-L", folder, "-lcontrol_bus", *libraries, f"-Wl,-rpath,{os.path.join(prefix, 'lib')}"], check=True)


def run(*words):
    """Again after a pause of the machine, which stops the axes."""
    for _ in range(5):
        done = subprocess.run([TRY, *words], capture_output=True, text=True, timeout=60)
        if "paused or was silent" not in done.stderr and "no position in time" not in done.stderr:
            break
    return done


def swing():
    """There and back, the whole way; and a swing that is too fast for the limits, which stops the axes."""
    if not os.path.exists(TRY):
        skip("cm1e_try was not built")
    real_time.run_above_others()
    faults = []
    done = run(BUS, "sim", "5", "1")
    ways = re.findall(r"(?m)^([xyz]): came (\S+) far and ended (\S+) from", done.stdout)
    if done.returncode != 0 or len(ways) != 3 or any(abs(float(way) - 5) > 0.05 or abs(float(end)) > 0.01
                                                     for _, way, end in ways):
        faults.append(f"a swing of 5: {done}")
    done = run(BUS, "sim", "60", "1")
    if done.returncode == 0 or "a set-point from outside commanded" not in done.stderr:
        faults.append(f"a swing of 60 in a second: {done}")
    done = run("no-such-file.yaml")
    if done.returncode == 0 or "no-such-file.yaml" not in done.stderr:
        faults.append(f"without a bus file: {done}")
    done = subprocess.run([AGAIN, BUS], capture_output=True, text=True, timeout=120)
    if done.returncode != 0:
        faults.append(f"after a fault, and with wrong settings: {done}")
    real_time.end(faults, "three axes were there and back")


{"build": build, "try": swing}[PART]()
