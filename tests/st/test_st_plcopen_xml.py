#!/usr/bin/env python3
"""The PLCopen XML of the blocks has every block, variable, type and enumerator of the declarations, in their order, and
names no type that it has not. CM1E_TC6_SCHEMA names the schema (tc6_xml_v201.xsd of PLCopen), which is not a part of
this project: with it the files are validated too, by libxml2.

test_st_plcopen_xml.py ADAPTERS-DIRECTORY
"""
import ctypes
import os
import sys
import xml.etree.ElementTree as ElementTree

import every_value

ADAPTERS = sys.argv[1]
TC6 = "{http://www.plcopen.org/xml/tc6_0201}"
SECTIONS = {"inOutVars": "in_out", "inputVars": "input", "outputVars": "output"}
faults = []


def expect(name, found, wanted):
    if found != wanted:
        faults.append(f"{name}: {found}, expected {wanted}")


def variables(pou):
    """[(section, name)] without the private part and without what stands for a reference."""
    return [(SECTIONS[section.tag.removeprefix(TC6)], variable.get("name")) for section in pou.find(f"{TC6}interface")
            if section.tag.removeprefix(TC6) in SECTIONS for variable in section
            if not variable.get("name").startswith("Use")]


def compare(name, of, with_pointers):
    root = ElementTree.parse(os.path.join(ADAPTERS, "plcopen", name)).getroot()
    pous = {pou.get("name"): pou for pou in root.iter(f"{TC6}pou")}
    types = {kind.get("name"): kind for kind in root.iter(f"{TC6}dataType")}
    expect(f"{name}: blocks", list(pous), [block.name for block in of.blocks])
    for block in of.blocks:
        wanted = [(variable.section, variable.name) for variable in block.variables if variable.section != "private"]
        expect(f"{name}: {block.name}", variables(pous[block.name]), wanted)
    for used in sorted({derived.get("name") for derived in root.iter(f"{TC6}derived")} - set(types)):
        faults.append(f"{name}: {used} is no type")
    for declaration in of.types.values():
        if declaration.kind == "enum":
            found = types[of.type_name(declaration.name)].findall(f".//{TC6}value")
            numbers = {value.get("name"): int(value.get("value", place)) for place, value in enumerate(found)}
            for item in declaration.variables:
                expect(f"{name}: {item.name}", numbers.get(item.name), int(item.default))
            expect(f"{name}: what a {declaration.name} begins with", int(found[0].get("value", 0)), 0)
    expect(f"{name}: references", any(True for _ in root.iter(f"{TC6}pointer")), with_pointers)


def validate(schema, names):
    """Through libxml2, which the command uses too."""
    xml = ctypes.CDLL("libxml2.so.2")
    for function in ("xmlSchemaNewParserCtxt", "xmlSchemaParse", "xmlSchemaNewValidCtxt", "xmlReadFile"):
        getattr(xml, function).restype = ctypes.c_void_p
    parsed = xml.xmlSchemaParse(ctypes.c_void_p(xml.xmlSchemaNewParserCtxt(schema.encode())))
    if not parsed:
        sys.exit(f"{schema} is no schema")
    for name in names:
        document = xml.xmlReadFile(os.path.join(ADAPTERS, "plcopen", name).encode(), None, 0)
        if xml.xmlSchemaValidateDoc(ctypes.c_void_p(xml.xmlSchemaNewValidCtxt(ctypes.c_void_p(parsed))),
                                    ctypes.c_void_p(document)) != 0:
            faults.append(f"{name} is not as {schema} wants it")


of = every_value.model()
compare("cm1e_codesys.xml", of, True)
compare("cm1e_beremiz.xml", of, False)
schema = os.environ.get("CM1E_TC6_SCHEMA")
if schema:
    validate(schema, ("cm1e_codesys.xml", "cm1e_beremiz.xml"))
    print(f"compared with {schema}")
else:
    print("not compared with the schema of PLCopen: CM1E_TC6_SCHEMA names none")
print("\n".join(faults))
sys.exit(1 if faults else 0)
