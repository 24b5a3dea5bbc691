#!/usr/bin/env python3
"""Installs the library into fresh prefixes, once as static and once as shared library, takes the C program out of
README.md, builds it as a stranger's project with find_package(cm1e), and by hand with pkg-config, and runs it on the
simulated segment. Beside it, programs that define names which the library's sources might use (own_names.c), or that
link libpcap before and after the library (with_libpcap.c).

test_install.py BUILD-DIRECTORY SOURCE-DIRECTORY
"""
import os
import re
import subprocess
import sys
import tempfile

INSTALLED = ("bin/cm1e", "include/cm1e/plcopen.h", "share/doc/cm1e/LICENSE", "share/doc/cm1e/THIRD-PARTY.md",
             "share/doc/cm1e/licenses/SOEM.txt")
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


def install(build, kind, prefix):
    """The kind that the build is configured for as a user installs it, the other one by its component."""
    if (kind == "shared") == (configured(build, "BUILD_SHARED_LIBS") in ("ON", "1", "TRUE")):
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
    if libraries != (["libcm1e.a", "libcm1e_generate.a"] if kind == "static" else [so, soname, f"{so}.{version}"]):
        sys.exit(f"FAILED: the {kind} library is installed as {libraries}")
    return folder, soname


def check_with_cmake(source, prefix, project, program):
    run("cmake", "-G", "Ninja", "-S", os.path.join(source, "tests/install"), "-B", project,
        f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCM1E_PROGRAM={program}", "-DCMAKE_C_FLAGS=-Wall -Wextra -Werror")
    run("cmake", "--build", project)
    for name in PROGRAMS:
        print(run(os.path.join(project, name), cwd=project), end="")


def check_with_pkg_config(libraries, program, soname):
    environment = {**os.environ, "PKG_CONFIG_PATH": os.path.join(libraries, "pkgconfig"), "LD_LIBRARY_PATH": libraries}
    flags = run("pkg-config", "--cflags", "--libs", "cm1e", env=environment).split()
    built = os.path.join(libraries, "by_hand")
    run("cc", "-Wall", "-Wextra", "-Werror", "-o", built, program, *flags, env=environment)
    print(run(built, env=environment), end="")
    if (soname in run("ldd", built, env=environment)) != os.path.exists(os.path.join(libraries, soname)):
        sys.exit(f"FAILED: {soname} is not what the program needs")


def main(build, source):
    for kind in ("static", "shared"):
        with tempfile.TemporaryDirectory() as folder:
            print(f"{kind}:")
            program = program_of_readme(source, folder)
            prefix = os.path.join(folder, "prefix")
            libraries, soname = install(build, kind, prefix)
            check_with_cmake(source, prefix, os.path.join(folder, "project"), program)
            check_with_pkg_config(libraries, program, soname)


if __name__ == "__main__":
    main(*sys.argv[1:3])
