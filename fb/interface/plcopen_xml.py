"""The declarations as PLCopen XML (TC6, 2.01): for CODESYS, which has pointers and numbers of enumerators, and for
Beremiz, with the statements that call the adapter for MATIEC."""
import re
from xml.sax.saxutils import escape, quoteattr

import c_header
import dialects

HEAD = """<?xml version="1.0" encoding="utf-8"?>
<!-- The function blocks of cm1e. Made from fb/interface/ by fb/interface/adapters.py: change nothing here. -->
<project xmlns="http://www.plcopen.org/xml/tc6_0201" xmlns:xhtml="http://www.w3.org/1999/xhtml">
  <fileHeader companyName="cm1e" productName="cm1e" productVersion="1" creationDateTime="2000-01-01T00:00:00"/>
  <contentHeader name="cm1e">
    <coordinateInfo>
      <fbd><scaling x="1" y="1"/></fbd>
      <ld><scaling x="1" y="1"/></ld>
      <sfc><scaling x="1" y="1"/></sfc>
    </coordinateInfo>
  </contentHeader>
"""
TAIL = "  <instances>\n    <configurations/>\n  </instances>\n</project>\n"
SECTIONS = {"in_out": "inOutVars", "input": "inputVars", "output": "outputVars"}
DIALECTS = {
    "codesys": dialects.Dialect("codesys", "CODESYS", "STRING(80)", "TIME", True, True),
    "beremiz": dialects.DIALECTS["matiec"],
}


def xml_type(model, dialect, variable, in_struct=False):
    """The element of a type, from its text in ST."""
    return element(dialects.type_text(model, dialect, variable, in_struct))


def element(text):
    array = re.match(r"ARRAY \[1\.\.(\w+)\] OF (.*)", text)
    if array:
        return (f'<array><dimension lower="1" upper="{array.group(1)}"/>'
                f"<baseType>{element(array.group(2))}</baseType></array>")
    if text.startswith("REF_TO "):
        return f"<pointer><baseType>{element(text[7:])}</baseType></pointer>"
    if text == "STRING":
        return "<string/>"
    if text.startswith("STRING"):
        return f'<string length="{text[7:-1]}"/>'
    if re.fullmatch(r"BOOL|[SU]?INT|U?DINT|D?WORD|LWORD|LREAL|TIME", text):
        return f"<{text}/>"
    return f"<derived name={quoteattr(text)}/>"


def documentation(text, indent):
    text = " ".join(text.split())
    return f"{indent}<documentation><xhtml:p>{escape(text)}</xhtml:p></documentation>\n" if text else ""


def variable_text(name, kind, default, note, indent):
    text = f"{indent}<variable name={quoteattr(name)}>\n{indent}  <type>{kind}</type>\n"
    if default:
        text += f"{indent}  <initialValue><simpleValue value={quoteattr(default)}/></initialValue>\n"
    return text + documentation(note, indent + "  ") + f"{indent}</variable>\n"


def base_type(model, dialect, declaration):
    if declaration.kind == "enum":
        numbered = dialect.numbered
        values = "".join(f'          <value name="{name}"' + (f' value="{number}"' if numbered else "") + "/>\n"
                         for name, number, _ in dialects.enumerators(declaration, dialect))
        return f"<enum>\n        <values>\n{values}        </values>\n      </enum>"
    if declaration.kind == "struct":
        members = "".join(variable_text(dialects.name_of(variable), xml_type(model, dialect, variable, True), "",
                                        c_header.note(variable), "        ") for variable in declaration.variables)
        return f"<struct>\n{members}      </struct>"
    return element(model.type_name(declaration.base))


def data_type(model, dialect, declaration):
    return (f'      <dataType name="{model.type_name(declaration.name)}">\n      <baseType>'
            f"{base_type(model, dialect, declaration)}</baseType>\n{documentation(declaration.doc, '      ')}"
            "      </dataType>\n")


def interface(model, dialect, block):
    text, before = "", ""
    for section, name, variable, _ in dialects.variables_of(block, dialect):
        if section != before:
            text += (f"          </{SECTIONS[before]}>\n" if before else "") + f"          <{SECTIONS[section]}>\n"
            before = section
        kind = xml_type(model, dialect, variable) if variable else "<BOOL/>"
        note = c_header.note(variable) if variable else "TRUE: the next input is used"
        text += variable_text(name, kind, variable.default if variable else "", note, "            ")
    text += f"          </{SECTIONS[before]}>\n"
    if dialect.body:
        own = (("PrivReady", "BOOL"), ("Priv", f"ARRAY [1..{model.room(block)}] OF LWORD"))
        text += "          <localVars>\n" + "".join(variable_text(name, element(kind), "", "", "            ")
                                                    for name, kind in own) + "          </localVars>\n"
    return text + documentation(block.doc, "          ")


def block_text(model, dialect, block):
    statements = "(* The library has it. *)"
    if dialect.body:
        statements = dialect.body.strip() % (block.name, block.name.upper(), block.name)
    return (f'      <pou name="{block.name}" pouType="functionBlock">\n        <interface>\n'
            f"{interface(model, dialect, block)}        </interface>\n        <body>\n"
            f"          <ST><xhtml:p>{escape(statements)}</xhtml:p></ST>\n        </body>\n      </pou>\n")


def project(model, dialect):
    types = "".join(data_type(model, dialect, item) for item in model.types.values()
                    if not model.is_private(item.name)
                    and not model.is_alias_of_enum(item))
    blocks = "".join(block_text(model, dialect, block) for block in model.blocks)
    return (f"{HEAD}  <types>\n    <dataTypes>\n{types}    </dataTypes>\n    <pous>\n{blocks}    </pous>\n  </types>\n"
            f"{TAIL}")


def files(model):
    return {f"plcopen/cm1e_{name}.xml": project(model, dialect) for name, dialect in DIALECTS.items()}
