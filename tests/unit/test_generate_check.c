/* cm1e_check_file() on ESI files: what section by section of ours, broken in the text in one way, is found in that line
 * and nothing else is; ours as they are, and a real two-axis ESI, have no finding. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/generate.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

enum { EDITS = 3 };

/* Behind the first `after` in the text, the first `from` becomes `to`. */
typedef struct edit {
    const char *after, *from, *to;
} edit_t;

typedef struct broken_text {
    const char *rule;
    edit_t edits[EDITS];
    const char *after, *line; /* the finding stands in the line of the first `line` behind the first `after` */
    const char *text;
} broken_text_t;

#define FLAT "esi-cm1e-1.3.5-flat.xml"
#define MDP "esi-cm1e-1.3.5-mdp.xml"
#define ENTRY_6081 "<Index>#x6081</Index>\n            <SubIndex>"
#define RX_1602 "<Index>#x1602</Index>\n          <Name>"

static const broken_text_t flat[] = {
    {"pdo-entry-not-in-dictionary", {{"<Objects>", "<Index>#x6081</Index>", "<Index>#x2081</Index>"}},
     RX_1602, "<Entry>\n            <Index>#x6081",
     "RxPDO 0x1603 maps 0x6081:00, an object that is not in the dictionary"},
    {"pdo-entry-size",
     {{ENTRY_6081, "<BitLen>32", "<BitLen>16"}, {ENTRY_6081, "<DataType>UDINT", "<DataType>UINT"}},
     RX_1602, "<Entry>\n            <Index>#x6081", "RxPDO 0x1603 maps 0x6081:00 with 16 bits; the object has 32"},
    {"mapping-object", {{"<Index>#x1603</Index>", "10004060", "10004160"}},
     "<Index>#x1603</Index>", "<SubItem>\n                    <Name>Controlword mapping",
     "0x1603:01 maps by default 0x6041:00 with 16 bits; entry 1 of RxPDO 0x1603 is 0x6040:00 with 16 bits"},
    {"assignment-object", {{"<Name>Assigned RxPDO</Name>", "<DefaultData>0016", "<DefaultData>0116"}},
     "<Index>#x1C12</Index>", "<SubItem>\n                    <Name>Assigned RxPDO",
     "0x1C12:01 is by default 0x1601; by its Sm, PDO 1 of sync manager 2 is 0x1600"},
    {"sync-managers-overlap", {{"", "#x1400", "#x1126"}},
     "", "<Sm DefaultSize=\"21\"",
     "sync manager 3 begins at 0x1126, within sync manager 2, which takes 0x1100 to 0x1126, its length three times"},
    {"sync-manager-control", {{"", "ControlByte=\"#x64\"", "ControlByte=\"#x20\""}},
     "", "<Sm DefaultSize=\"13\"",
     "sync manager 2 is for outputs, but its control byte 0x20 is of another direction; usual is 0x64"},
    {"fmmu-missing", {{"", "<Fmmu>Outputs", "<Fmmu>Inputs"}},
     "", "<Fmmu>Inputs", "there are outputs, but no FMMU for them"},
    {"no-pdo-assigned",
     {{"", "<RxPdo Fixed=\"1\" Sm=\"2\">", "<RxPdo Fixed=\"1\">"},
      {"<Name>RxPDO assign</Name>", "<DefaultData>01", "<DefaultData>00"},
      {"<Data AdaptAutomatically=\"1\">0016", "\"1\">01", "\"1\">00"}},
     "", "<Sm DefaultSize=\"13\"",
     "none of the 4 RxPDOs is assigned to a sync manager: without a choice by hand there are no outputs"},
    {"mailbox-size", {{"", "DefaultSize=\"128\"", "DefaultSize=\"0\""}},
     "", "StartAddress=\"#x1000\"", "the mailbox in sync manager 0 has 0 bytes; an SDO needs at least 16"},
    {"object-twice", {{"<Index>#x6084</Index>", "<Index>#x6098</Index>", "<Index>#x6084</Index>"}},
     "", "<Object>\n                <Index>#x6084</Index>\n                <Name>Homing method",
     "the object 0x6084 (Homing method) is in the dictionary twice"},
    {"subindex-twice", {{"<Name>DT1018</Name>", "<SubIdx>4", "<SubIdx>3"}},
     "<Name>DT1018</Name>", "<SubItem>\n                  <SubIdx>3</SubIdx>\n                  <Name>Serial",
     "the type DT1018 has sub-index 3 twice"},
    {"exclude-one-sided", {{RX_1602, "<Exclude>#x1603</Exclude>", ""}},
     "<Index>#x1603</Index>\n          <Name>", "<Exclude>#x1602",
     "RxPDO 0x1603 excludes 0x1602, but 0x1602 does not exclude 0x1603"},
    {"type-item-offset", {{"<Name>DT1018</Name>", "<BitOffs>48", "<BitOffs>40"}},
     "<Name>DT1018</Name>", "<SubItem>\n                  <SubIdx>2",
     "Product Code in the type DT1018 begins at bit 40, within Vendor ID, which ends before bit 48"},
    {"type-item-size",
     {{"<Name>DT1018</Name>", "<Type>UDINT</Type>\n                  <BitSize>32",
       "<Type>UINT</Type>\n                  <BitSize>32"}},
     "<Name>DT1018</Name>", "<SubItem>\n                  <SubIdx>1",
     "Vendor ID in the type DT1018 has 32 bits; its type UINT has 16"},
    {"type-size", {{"<Name>SINT</Name>", "<BitSize>8", "<BitSize>9"}},
     "", "<DataType>\n                <Name>SINT", "the type SINT is defined with 9 bits; it has 8"},
    {"identity-object", {{"<Index>#x1018</Index>", "02204144", "03204144"}},
     "<Index>#x1018</Index>", "<SubItem>\n                    <Name>Product Code",
     "0x1018:02 gives the product code 0x44412003; the device is described with 0x44412002"},
    {"device-type", {{"", "<AddInfo>4", "<AddInfo>2"}},
     "<Objects>", "<Object>\n                <Index>#x1000",
     "0x1000 is 0x00040192; profile 402 with the additional information 2 is 0x00020192"},
    {"init-command-size", {{"<Comment>One TxPDO assigned</Comment>", "<Data>08", "<Data>0800"}},
     "<Comment>One TxPDO assigned</Comment>", "<InitCmd>",
     "the start-up command writes 2 bytes to 0x6060:00, which has 8 bits, 1 byte"},
};

/* In MDP layout the same after the slots are filled: the first is of the module that stands there by default, the other
 * of an alternative. */
static const broken_text_t mdp[] = {
    {"pdo-entry-size",
     {{"<Index DependOnSlot=\"1\">#x6060</Index>\n            <SubIndex>", "<BitLen>8", "<BitLen>16"},
      {"<Index DependOnSlot=\"1\">#x6060</Index>\n            <SubIndex>", "<DataType>SINT", "<DataType>INT"},
      {"", "DefaultSize=\"13\"", "DefaultSize=\"14\""}},
     "<Modules>", "<Entry>\n            <Index DependOnSlot=\"1\">#x6060",
     "RxPDO 0x1600 maps 0x6060:00 with 16 bits; the object has 8"},
    {"pdo-entry-size",
     {{"<Index DependOnSlot=\"1\">#x6081</Index>\n            <SubIndex>", "<BitLen>32", "<BitLen>16"},
      {"<Index DependOnSlot=\"1\">#x6081</Index>\n            <SubIndex>", "<DataType>UDINT", "<DataType>UINT"}},
     "<Modules>", "<Entry>\n            <Index DependOnSlot=\"1\">#x6081",
     "RxPDO 0x1603 maps 0x6081:00 with 16 bits; the object has 32"},
    {"slot-module-missing", {{"</ModuleIdent>", "<ModuleIdent>#x00", "<ModuleIdent>#x77"}},
     "</ModuleIdent>", "<ModuleIdent>", "slot 0 Axis names module 0x77219860, which is not in the file"},
    {"slot-dependence",
     {{"", "<Index DependOnSlot=\"1\">#x6081</Index>\n            <SubIndex>",
       "<Index>#x6081</Index>\n            <SubIndex>"}},
     "<Modules>", "<Entry>\n            <Index>#x6081",
     "RxPDO names 0x6081 as the same in every slot, but the object depends on the slot"},
};

/* ---- text -------------------------------------------------------------------------------------------------------- */

static char *load(const char *path)
{
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return NULL;
    fseek(stream, 0, SEEK_END);
    const size_t size = (size_t)ftell(stream);
    rewind(stream);
    char *text = calloc(1, size + 1);
    TEST_ASSERT_EQUAL(size, fread(text, 1, size, stream));
    fclose(stream);
    return text;
}

static char *load_golden(const char *name)
{
    char path[512];
    snprintf(path, sizeof path, CM1E_SOURCE_DIR "/tests/golden/%s", name);
    char *text = load(path);
    TEST_ASSERT_NOT_NULL_MESSAGE(text, path);
    return text;
}

static char *find(char *text, const char *after, const char *wanted)
{
    char *at = strstr(text, after);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, after);
    at = strstr(at, wanted);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, wanted);
    return at;
}

static char *apply(char *text, const edit_t *edit)
{
    char *at = find(text, edit->after, edit->from);
    char *edited = calloc(1, strlen(text) + strlen(edit->to) + 1);
    memcpy(edited, text, (size_t)(at - text));
    strcat(edited, edit->to);
    strcat(edited, at + strlen(edit->from));
    free(text);
    return edited;
}

static unsigned line_of(char *text, const char *after, const char *wanted)
{
    unsigned line = 1;
    for (const char *at = text, *end = find(text, after, wanted); at < end; at++)
        line += *at == '\n';
    return line;
}

/* ---- judging ----------------------------------------------------------------------------------------------------- */

static cm1e_findings_t *check(const char *text)
{
    cm1e_findings_t *findings = NULL;
    cm1e_diag_t diag;
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_check_file(&findings, text, strlen(text), &diag), diag.text);
    return findings;
}

static void print(const cm1e_findings_t *findings)
{
    for (size_t i = 0; i < cm1e_findings_count(findings); i++) {
        const cm1e_finding_t *finding = cm1e_findings_at(findings, i);
        printf("  line %u: %s: %s\n", (unsigned)finding->line, finding->rule, finding->text);
    }
}

static void assert_broken(const char *name, const broken_text_t *broken)
{
    char *text = load_golden(name);
    for (int i = 0; i < EDITS && broken->edits[i].from; i++)
        text = apply(text, &broken->edits[i]);
    cm1e_findings_t *findings = check(text);
    if (cm1e_findings_count(findings) != 1)
        print(findings);
    TEST_ASSERT_EQUAL_MESSAGE(1, cm1e_findings_count(findings), broken->rule);
    const cm1e_finding_t *finding = cm1e_findings_at(findings, 0);
    TEST_ASSERT_EQUAL_STRING(broken->rule, finding->rule);
    if (broken->text)
        TEST_ASSERT_EQUAL_STRING(broken->text, finding->text);
    TEST_ASSERT_EQUAL_MESSAGE(line_of(text, broken->after, broken->line), finding->line, broken->rule);
    cm1e_findings_free(findings);
    free(text);
}

static void test_each_mistake_in_a_flat_esi_is_found_in_its_line(void)
{
    for (size_t i = 0; i < sizeof flat / sizeof flat[0]; i++)
        assert_broken(FLAT, &flat[i]);
}

static void test_each_mistake_in_a_modular_esi_is_found_in_its_line(void)
{
    for (size_t i = 0; i < sizeof mdp / sizeof mdp[0]; i++)
        assert_broken(MDP, &mdp[i]);
}

static void assert_nothing_found(char *text)
{
    cm1e_findings_t *findings = check(text);
    print(findings);
    TEST_ASSERT_EQUAL(0, cm1e_findings_count(findings));
    cm1e_findings_free(findings);
    free(text);
}

static void test_golden_files_have_no_finding(void)
{
    static const char *const names[] = {"esi-cm1e-1.2.0-flat.xml", "esi-cm1e-1.2.0-mdp.xml", FLAT, MDP,
                                        "esi-cm1e-csp-dc-eeprom.xml", "esi-eb12-mdp.xml"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        assert_nothing_found(load_golden(names[i]));
}

#define TWO_AXES "ssc-cia402-two-axis-esi.xml"

static char *load_two_axes(void)
{
    char path[512];
    const char *schemas = getenv("CM1E_ESI_SCHEMAS");
    snprintf(path, sizeof path, "%s/../reference/" TWO_AXES, schemas ? schemas : CM1E_SOURCE_DIR "/../shared/schemas");
    char *text = load(path);
    if (!text)
        TEST_IGNORE_MESSAGE("the real two-axis ESI is not on this machine (beside CM1E_ESI_SCHEMAS)");
    return text;
}

static void test_real_two_axis_esi_has_no_finding(void)
{
    assert_nothing_found(load_two_axes());
}

/* The second axis, an alternative that is not the default, was checked too: a mistake in it is found. */
static void test_mistake_in_the_real_two_axis_esi_is_found(void)
{
    static const broken_text_t broken = {
        .rule = "pdo-entry-size",
        .edits = {{"<Modules>", "<BitLen>32", "<BitLen>31"}, {"<Modules>", "<DataType>DINT</DataType>", ""}},
        .after = "<Modules>", .line = "<Entry>\n\t\t\t\t\t\t<Index DependOnSlot=\"true\">#x607A",
        .text = "RxPDO 0x1600 maps 0x607A:00 with 31 bits; the object has 32"};
    char *text = load_two_axes();
    for (int i = 0; i < 2; i++)
        text = apply(text, &broken.edits[i]);
    cm1e_findings_t *findings = check(text);
    print(findings);
    TEST_ASSERT_EQUAL(1, cm1e_findings_count(findings));
    TEST_ASSERT_EQUAL_STRING(broken.rule, cm1e_findings_at(findings, 0)->rule);
    TEST_ASSERT_EQUAL_STRING(broken.text, cm1e_findings_at(findings, 0)->text);
    cm1e_findings_free(findings);
    free(text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_mistake_in_a_flat_esi_is_found_in_its_line);
    RUN_TEST(test_each_mistake_in_a_modular_esi_is_found_in_its_line);
    RUN_TEST(test_golden_files_have_no_finding);
    RUN_TEST(test_real_two_axis_esi_has_no_finding);
    RUN_TEST(test_mistake_in_the_real_two_axis_esi_is_found);
    return UNITY_END();
}
