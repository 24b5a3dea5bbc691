#!/usr/bin/env python3
"""Writes the folder cm1e-VERSION.dist-info for the Debian package from pyproject.toml, as pip would.

python_facts.py FOLDER-OF-PYPROJECT VERSION OUTPUT-FOLDER
"""
import os
import sys
import tomllib


def write(folder, name, text):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write(text)


def main(source, version, folder):
    with open(os.path.join(source, "pyproject.toml"), "rb") as file:
        project = tomllib.load(file)["project"]
    with open(os.path.join(source, project["readme"]), encoding="utf-8") as file:
        readme = file.read()
    os.makedirs(folder, exist_ok=True)
    needs = "".join(f"Requires-Dist: {need}\n" for need in project["dependencies"])
    write(folder, "METADATA", f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {version}\n"
          f"Summary: {project['description']}\nRequires-Python: {project['requires-python']}\n{needs}"
          f"Description-Content-Type: text/markdown\n\n{readme}")
    points = "".join(f"[{group}]\n" + "".join(f"{name} = {value}\n" for name, value in values.items())
                     for group, values in project["entry-points"].items())
    write(folder, "entry_points.txt", points)
    write(folder, "INSTALLER", "debian\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
