#!/usr/bin/env python3
"""Installs the library into a fresh prefix, as the kind that the build makes, and with full effort into a second one as
the other kind (static, shared). Takes the C program out of README.md, builds it as a stranger's project with
find_package(cm1e), and by hand with pkg-config, and runs it on the simulated segment. Beside it, programs that define
names which the library's sources might use (own_names.c), or that link libpcap before and after the library
(with_libpcap.c); and a program for network interfaces only, which holds no simulator, also where pkg-config finds
neither libcyaml nor libxml2. A program that is linked by hand registers the simulator itself.

test_install.py BUILD-DIRECTORY SOURCE-DIRECTORY
"""
import os
import re
import resource
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../wire_only"))
from test_wire_only import guests

INSTALLED = ("bin/cm1e", "include/cm1e/plcopen.h", "share/doc/cm1e/LICENSE", "share/doc/cm1e/THIRD-PARTY.md",
             "share/doc/cm1e/licenses/SOEM.txt", "share/man/man1/cm1e.1", "share/man/man1/cm1e-move.1",
             "share/bash-completion/completions/cm1e", "share/zsh/site-functions/_cm1e",
             "share/doc/cm1e/FIRST-HOUR.md", "share/doc/cm1e/blocks/MC_Home.md", "share/doc/cm1e/examples/01_scan.c",
             "share/cm1e/st/st_program.h", "share/cm1e/st/rusty/cm1e_rusty.c", "share/cm1e/st/matiec/cm1e_matiec.st",
             "share/cm1e/st/strucpp/cm1e_strucpp.hpp", "share/cm1e/st/plcopen/cm1e_codesys.xml")
APART = ("busfile", "control", "generate", "plot", "sim")
PROGRAMS = ("consumer", "own_names", "before_libpcap", "after_libpcap")


def run(*command, **options):
    result = subprocess.run(command, capture_output=True, text=True, timeout=240, **options)
    if result.returncode != 0:
        sys.exit(f"FAILED: {' '.join(command)}\n{result.stdout}{result.stderr}")
    return result.stdout


def program_of_readme(source, folder):
    with open(os.path.join(source, "README.md"), encoding="utf-8") as file:
        programs = re.findall(r"```c\n(.*?)```", file.read(), re.DOTALL)
    if len(programs) != 1 or len(programs[0].splitlines()) > 40:
        sys.exit(f"FAILED: README.md should hold one C program of at most 40 lines, found "
                 f"{[len(program.splitlines()) for program in programs]}")
    path = os.path.join(folder, "readme.c")
    with open(path, "w", encoding="utf-8") as file:
        file.write(programs[0])
    return path


def configured(build, variable):
    with open(os.path.join(build, "CMakeCache.txt"), encoding="utf-8") as file:
        return re.search(rf"^{variable}:\w+=(.*)$", file.read(), re.MULTILINE)[1]


def is_shared(build):
    return configured(build, "BUILD_SHARED_LIBS") in ("ON", "1", "TRUE")


def install(build, kind, prefix):
    """The kind that the build is configured for as a user installs it, the other one by its component."""
    if (kind == "shared") == is_shared(build):
        run("cmake", "--install", build, "--prefix", prefix)
    else:
        for component in ("Unspecified", kind):
            run("cmake", "--install", build, "--prefix", prefix, "--component", component)
    for needed in INSTALLED:
        if not os.path.exists(os.path.join(prefix, needed)):
            sys.exit(f"FAILED: {needed} is not installed")
    folder = os.path.join(prefix, configured(build, "CMAKE_INSTALL_LIBDIR"))
    libraries = sorted(name for name in os.listdir(folder) if name.startswith("lib"))
    so = "libcm1e.so"
    version = run(os.path.join(prefix, "bin/cm1e"), "--version").split()[1]
    soname = so + "." + ".".join(version.split(".")[:2 if version.startswith("0.") else 1])
    names = ["libcm1e"] + [f"libcm1e_{room}" for room in APART]
    endings = [".a"] if kind == "static" else [".so", soname.removeprefix("libcm1e"), f".so.{version}"]
    if libraries != sorted(name + ending for name in names for ending in endings):
        sys.exit(f"FAILED: the {kind} library is installed as {libraries}")
    return folder, soname


def build_consumer(source, prefix, project, program, components, *settings, **options):
    run("cmake", "-G", "Ninja", "-S", os.path.join(source, "tests/install"), "-B", project,
        f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCM1E_PROGRAM={program}", f"-DCM1E_COMPONENTS={components}",
        "-DCMAKE_C_FLAGS=-Wall -Wextra -Werror", "-DCMAKE_EXE_LINKER_FLAGS=-Wl,--as-needed", *settings, **options)
    run("cmake", "--build", project)
    return os.path.join(project, "consumer")


def check_with_cmake(source, prefix, project, program, kind):
    build_consumer(source, prefix, project, program, "fb;scheduler;sim", "-DCM1E_BESIDE_OTHERS=ON")
    for name in PROGRAMS:
        print(run(os.path.join(project, name), cwd=project), end="")
    usual = build_consumer(source, prefix, project + "_usual", program, "cm1e")
    print(run(usual, cwd=project), end="")
    needed = run("nm", "-D", usual) if kind == "shared" else run("nm", usual)
    if "cm1e_control_register" not in needed and "libcm1e_control" not in run("ldd", usual):
        sys.exit("FAILED: a program that links cm1e::cm1e has no control socket")


def check_wire_only(source, prefix, folder, kind):
    """A machine without the libraries for bus files and XML: the package is found, the program holds no guest."""
    project, program = os.path.join(folder, "wire"), os.path.join(source, "tests/wire_only/wire_only.c")
    bare = dict(os.environ, PKG_CONFIG_LIBDIR=folder)
    consumer = build_consumer(source, prefix, project, program, "fb;scheduler", env=bare)
    found = set().union(*guests(consumer, os.path.join(project, "consumer.map")))
    if found:
        sys.exit(f"FAILED: a program that links cm1e::fb and cm1e::scheduler holds {sorted(found)[:10]}")
    refused = subprocess.run(["cmake", "-S", os.path.join(source, "tests/install"), "-B", os.path.join(folder, "no"),
                              f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCM1E_PROGRAM={program}", "-DCM1E_COMPONENTS=sim"],
                             env=bare, capture_output=True, text=True)
    if kind == "static" and (refused.returncode == 0 or "sim needs libcyaml" not in refused.stderr):
        sys.exit(f"FAILED: the component sim was found without libcyaml:\n{refused.stdout}{refused.stderr}")


def check_with_pkg_config(libraries, program, soname):
    environment = {**os.environ, "PKG_CONFIG_PATH": os.path.join(libraries, "pkgconfig"), "LD_LIBRARY_PATH": libraries}
    flags = run("pkg-config", "--cflags", "--libs", "cm1e-sim", "cm1e", env=environment).split()
    built = os.path.join(libraries, "by_hand")
    run("cc", "-Wall", "-Wextra", "-Werror", "-o", built, program, "-Wl,--as-needed", *flags, env=environment)
    print(run(built, env=environment), end="")
    if (soname in run("ldd", built, env=environment)) != os.path.exists(os.path.join(libraries, soname)):
        sys.exit(f"FAILED: {soname} is not what the program needs")


def check_can_be_watched(program, project, environment):
    """`cm1e status` and others attach to a program that was made so."""
    runtime = os.path.join(project, "run")
    process = subprocess.Popen([program], cwd=project, env={**environment, "CM1E_RUNTIME_DIR": runtime},
                               stdout=subprocess.PIPE, text=True)
    seen = False
    while process.poll() is None:
        seen = seen or (os.path.isdir(runtime) and any(name.endswith(".sock") for name in os.listdir(runtime)))
        time.sleep(0.02)
    if process.communicate()[0] != "there and back\n" or not seen:
        sys.exit(f"FAILED: {program} has no control socket")


def check_new(prefix, libraries, folder):
    """What `cm1e new` makes builds against the installed package, with CMake and with make, and runs; after a change of
    one line it is linked in less than a second. The installed examples build too."""
    environment = {**os.environ, "PKG_CONFIG_PATH": os.path.join(libraries, "pkgconfig"), "LD_LIBRARY_PATH": libraries}
    project, build = os.path.join(folder, "new"), os.path.join(folder, "new/build")
    run(os.path.join(prefix, "bin/cm1e"), "new", project)
    run("cmake", "-G", "Ninja", "-S", project, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}",
        "-DCMAKE_C_FLAGS=-Wall -Wextra -Werror")
    run("cmake", "--build", build)
    run("make", "-C", project, env=environment)
    for program in (os.path.join(build, "motion"), os.path.join(project, "motion")):
        told = run(program, cwd=project, env=environment)
        if told != "there and back\n" or os.path.getsize(os.path.join(project, "trace.csv")) < 10000:
            sys.exit(f"FAILED: {program}: {told}")
        check_can_be_watched(program, project, environment)
    with open(os.path.join(project, "main.c"), "a", encoding="utf-8") as file:
        file.write("/* one more line */\n")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run("cmake", "--build", build)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"a program is compiled and linked again in {seconds:.2f} s of computing")
    if seconds > 1:
        sys.exit("FAILED: a change of one line takes more than a second")
    examples = os.path.join(prefix, "share/doc/cm1e/examples")
    run("cmake", "-G", "Ninja", "-S", examples, "-B", os.path.join(folder, "examples"), f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", os.path.join(folder, "examples"), "--target", "02_move_one_axis", "13_xy_table")
    run("make", "-C", examples, "02_move_one_axis", "13_xy_table", env=environment)


def check_no_compiler_code(libraries):
    """Archives with code of the compiler are compiled anew when they are linked."""
    for name in os.listdir(libraries):
        if name.endswith(".a") and ".gnu.lto_" in run("readelf", "-SW", os.path.join(libraries, name)):
            sys.exit(f"FAILED: {name} carries the code of link-time optimisation")


def check_registered_by_hand(source, libraries):
    """Nobody tells the linker about the registration here: the program calls it, or has no simulator."""
    environment = {**os.environ, "PKG_CONFIG_PATH": os.path.join(libraries, "pkgconfig"), "LD_LIBRARY_PATH": libraries}
    flags = run("pkg-config", "--cflags", "--libs", "cm1e-sim", "cm1e", env=environment).split()
    flags = [flag for flag in flags if not flag.startswith("-Wl,")]
    for define, expected in (("-DREGISTER_SIM", 0), ("-DPLAIN", 1)):
        program = os.path.join(libraries, "registered")
        run("cc", define, os.path.join(source, "tests/wire_only/wire_only.c"), "-o", program, "-Wl,--as-needed", *flags,
            env=environment)
        result = subprocess.run([program, "sim"], capture_output=True, text=True, env=environment)
        if result.returncode != expected:
            sys.exit(f"FAILED: linked by hand with {define}, exit status {result.returncode}: {result.stderr}")


def main(build, source):
    kinds = ("shared", "static") if is_shared(build) else ("static", "shared")
    for kind in kinds if os.environ.get("CM1E_TEST_EFFORT") == "full" else kinds[:1]:
        with tempfile.TemporaryDirectory() as folder:
            print(f"{kind}:")
            program = program_of_readme(source, folder)
            prefix = os.path.join(folder, "prefix")
            libraries, soname = install(build, kind, prefix)
            check_with_cmake(source, prefix, os.path.join(folder, "project"), program, kind)
            check_with_pkg_config(libraries, program, soname)
            check_wire_only(source, prefix, folder, kind)
            check_registered_by_hand(source, libraries)
            check_no_compiler_code(libraries)
            check_new(prefix, libraries, folder)


if __name__ == "__main__":
    main(*sys.argv[1:3])
