/* Every rule about EC_EXTEND: a good file is broken in exactly that way, and exactly that is found, in its line. And
 * the comparison with a device. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "description/describe.h"
#include "generate/ec_extend.h"
#include "unity.h"

static cm1e_file_t file;       /* a good one */
static cm1e_diag_t diag;
static cm1e_findings_t *findings;
static cm1e_ec_extend_t document;
static cm1e_description_file_t described;

static void generate(cm1e_mapping_t mapping, const char *firmware, cm1e_pdo_order_t order)
{
    cm1e_device_options_t device = {.mapping = mapping, .order = order};
    const cm1e_generate_options_t options = {.format = CM1E_FILE_EC_EXTEND, .devices = &device, .device_count = 1};
    snprintf(device.firmware, sizeof device.firmware, "%s", firmware);
    cm1e_file_free(&file);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_generate(&file, &options, &diag), diag.text);
}

void setUp(void)
{
    generate(CM1E_MAPPING_DYNAMIC, "", CM1E_PDO_ORDER_UG_4_4);
}

static void forget(void)
{
    cm1e_findings_free(findings);
    cm1e_ec_extend_free(&document);
    cm1e_description_file_free(&described);
    findings = NULL;
}

void tearDown(void)
{
    forget();
    cm1e_file_free(&file);
}

/* The good file with the nth (from 1) `what` replaced; the caller frees it. */
static char *broken(const char *what, int nth, const char *with)
{
    const char *text = (const char *)file.bytes, *at = text - 1;
    while (nth-- > 0) {
        at = strstr(at + 1, what);
        TEST_ASSERT_NOT_NULL_MESSAGE(at, what);
    }
    char *made = malloc(file.size + strlen(with) + 1);
    sprintf(made, "%.*s%s%s", (int)(at - text), text, with, at + strlen(what));
    return made;
}

static unsigned line_of(const char *text, const char *what)
{
    const char *end = strstr(text, what);
    TEST_ASSERT_NOT_NULL_MESSAGE(end, what);
    unsigned line = 1;
    for (; text < end; text++)
        line += *text == '\n';
    return line;
}

static void check(const char *text)
{
    cm1e_findings_free(findings);
    findings = NULL;
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_check_file(&findings, text, strlen(text), &diag), diag.text);
}

static void expect_nothing(const char *text)
{
    check(text);
    if (cm1e_findings_count(findings) > 0)
        TEST_FAIL_MESSAGE(cm1e_findings_at(findings, 0)->text);
}

/* Exactly one finding: this rule, in the line where `where` stands first, with `part` in its text. */
static void expect_one(const char *rule, bool is_error, unsigned line, const char *part)
{
    const cm1e_finding_t *finding = cm1e_findings_at(findings, 0);
    TEST_ASSERT_NOT_NULL_MESSAGE(finding, rule);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(rule, finding->rule, finding->text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(finding->text, part), finding->text);
    if (cm1e_findings_count(findings) > 1)
        TEST_FAIL_MESSAGE(cm1e_findings_at(findings, 1)->text);
    TEST_ASSERT_EQUAL(is_error, finding->is_error);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(line, finding->line, finding->text);
}

/* The device is another one, so that rules about our own do not join in. */
static void be_a_stranger(void)
{
    char *stranger = broken("<Pid>0x44412002</Pid>", 1, "<Pid>0x44412003</Pid>");
    memcpy(file.bytes, stranger, file.size);
    free(stranger);
}

#define ENTRY(name, length)                                                                                         \
    "<Entry>\n        <Name>" name "</Name>\n        <Length>" length "</Length>\n        <Flags>0</Flags>\n"       \
    "      </Entry>"
#define SM(function) "<Function>" function "</Function>"
#define DATA_OF(index, sub, length, data)                                                                           \
    "<Index>" index "</Index>\n        <SubIndex>" sub "</SubIndex>\n        <Length>" length "</Length>\n"        \
    "        <Data>" data "</Data>"
#define VENDOR "<Vendor>\n      <Vid>0x00004441</Vid>\n      <Name>Myostat Motion Control Inc.</Name>\n    </Vendor>"

static const struct {
    const char *rule, *what;
    int nth;
    const char *with;
    const char *where; /* in the broken file: the line of its first place, */
    int offset;        /* and so many lines on */
    const char *part;
} breaks[] = {
    {"trio-index", "</RxPdo>\n", 1, "</RxPdo><RxPdo><Index>0</Index><Name>B</Name></RxPdo>\n", "<Name>B</Name>", 0,
     "RxPdo 0 is there twice"},
    {"trio-index", "</Profile>\n", 1, "</Profile><Profile><Index>0</Index><Vid>0x4441</Vid><Pid>1</Pid><Rev>1</Rev>"
     "<SlvCfgIndex>0</SlvCfgIndex></Profile>\n", "<Pid>1</Pid>", 0, "Profile 0 is there twice"},
    {"trio-name", "</TxPdo>\n", 1, "</TxPdo><TxPdo><Index>1</Index><Name>TXPDO_PROFILE</Name></TxPdo>\n",
     "<TxPdo><Index>1", 0, "TXPDO_PROFILE"},
    {"trio-name", "</SdoInitCmd>\n", 1,
     "</SdoInitCmd><SdoInitCmd><Index>1</Index><Name>SDO_APP_CSP</Name></SdoInitCmd>\n",
     "<SdoInitCmd><Index>1", 0, "SDO_APP_CSP"},
    {"trio-reference", "<RxPdoIndex>RXPDO_PROFILE<", 1, "<RxPdoIndex>RXPDO_PROFIL<", "<RxPdoIndex>", 0,
     "RXPDO_PROFIL\""},
    {"trio-reference", "<TxPdoIndex>TXPDO_PROFILE<", 1, "<TxPdoIndex>7<", "<TxPdoIndex>", 0, "\"7\""},
    {"trio-reference", "<SdoInitCmdIndex>SDO_APP_CSP<", 1, "<SdoInitCmdIndex>SDO_APP_CSV<", "<SdoInitCmdIndex>", 0,
     "CSV"},
    {"trio-reference", "<EscCfgIndex>0<", 1, "<EscCfgIndex>1<", "<EscCfgIndex>", 0, "EscCfgIndex"},
    {"trio-reference", "<SlvCfgIndex>0<", 1, "<SlvCfgIndex>3<", "<SlvCfgIndex>", 0, "SlvCfgIndex"},
    {"trio-vendor", "<Vendor>\n      <Vid>0x00004441", 1, "<Vendor>\n      <Vid>0x00004442", "<Profile>", 0,
     "0x00004441"},
    {"trio-vendor", VENDOR, 1, VENDOR "\n\n" VENDOR, "</Vendors>", -4, "twice"},
    {"trio-profile", "</Profile>\n", 1, "</Profile>\n<Profile><Index>1</Index><Vid>0x4441</Vid><Pid>0x44412003</Pid>"
     "<Rev>0x20020103</Rev><SlvCfgIndex>0</SlvCfgIndex></Profile>\n", "<Pid>0x44412003</Pid><Rev>", 0, "never used"},
    {"trio-pdo-entry", ENTRY("NULL", "0"), 1, ENTRY("NULL", "2"), "<Name>NULL<", -1, "ends a list"},
    {"trio-pdo-entry", ENTRY("DOUT", "2"), 1, ENTRY("NULL", "0"), "<Name>NULL<", -1, "ends a list"},
    {"trio-pdo-entry", ENTRY("DOUT", "2"), 1, ENTRY("DOUT", "0"), "<Name>DOUT<", -1, "length 0"},
    {"trio-pdo-entry", ENTRY("DOUT", "2"), 1, ENTRY("DIN", "2"), "<Name>DIN<", -1, "device sends"},
    {"trio-pdo-entry", ENTRY("DIN", "2"), 1, ENTRY("DOUT", "2"), "<TxPdos>", 29, "controller sends"},
    {"trio-pdo-size", "<Controlbyte>0x64<", 1, "<Size>14</Size><Controlbyte>0x64<", "<Size>14", -3, "13"},
    {"trio-pdo-size", "<Controlbyte>0x20<", 1, "<Size>20</Size><Controlbyte>0x20<", "<Size>20", -3, "21"},
    {"trio-pdo-size", "<Controlbyte>0x64<", 1, "<Size>0</Size><Controlbyte>0x64<", "<Size>0<", -3, "13"},
    {"sync-managers-overlap", "<Startaddress>0x1080<", 1, "<Startaddress>0x1070<", "0x1070", -2, "0x1070"},
    {"sync-managers-overlap", "<Startaddress>0x1400<", 1, "<Startaddress>0x1126<", "0x1126", -2, "three times"},
    {"trio-sync-manager", "<Controlbyte>0x26<", 1, "<Controlbyte>0x22<", "<Sm>", 0, "device writes"},
    {"trio-sync-manager", "<Controlbyte>0x20<", 1, "<Controlbyte>0x24<", SM("INPUTS"), -5, "controller writes"},
    {"trio-sync-manager", "<Size>128</Size>\n        <Controlbyte>0x22<", 1,
     "<Size>40</Size>\n        <Controlbyte>0x20<", SM("MBOXIN"), -6, "are 2"},
    {"trio-sync-manager", "<Size>128</Size>", 1, "", "<Sm>", 0, "needs a Size"},
    {"trio-sync-manager", "<Size>128</Size>", 2, "<Size>0</Size>", "<Size>0<", -3, "needs a Size"},
    {"trio-sync-manager", "<Index>3</Index>\n        <Startaddress>0x1400", 1,
     "<Index>2</Index>\n        <Startaddress>0x1400", "0x1400", -2, "is there twice"},
    {"trio-init-command", DATA_OF("0x6060", "0", "1", "8"), 1, DATA_OF("0x6060", "0", "1", "256"), "0x6060", -1,
     "does not fit"},
    {"trio-init-command", DATA_OF("0x6060", "0", "1", "8"), 1, DATA_OF("0x6060", "0", "1", "-129"), "0x6060", -1,
     "does not fit"},
    {"trio-init-command", DATA_OF("0x6060", "0", "1", "8"), 1, DATA_OF("0x6060", "0", "0", "0"), "0x6060", -1,
     "0 bytes"},
    {"trio-init-command", DATA_OF("0x1C12", "1", "2", "0x1600"), 1, DATA_OF("0x1C12", "1", "4", "0x1600"), "0x1600", -4,
     "a PDO 2"},
    {"trio-init-command", DATA_OF("0x1C13", "0", "1", "0"), 1, DATA_OF("0x1C13", "0", "2", "0"), "0x1C13", -1,
     "number of PDOs has 1"},
    {"trio-assignment", DATA_OF("0x1C13", "0", "1", "1"), 1, DATA_OF("0x1C13", "0", "1", "2"), "<Data>2<", -4,
     "1 PDOs"},
    {"trio-assignment", DATA_OF("0x1C12", "0", "1", "0"), 1, DATA_OF("0x1C12", "0", "1", "1"), "0x1600", -4, "refuse"},
    {"trio-mailbox", "<MbxStartupProtocol>COE<", 1, "<MbxStartupProtocol>EOE<", "<SlvCfg>", 0, "EOE"},
    {"trio-axes", "<Axes>1<", 1, "<Axes>0<", "<SlvCfg>", 0, "not 0"},
    {"trio-axes", "<Axes>1<", 1, "<Axes>2<", "<SlvCfg>", 0, "SlotPdoIncrement"},
    {"trio-axes", ENTRY("CTRL_WORD", "2"), 1, ENTRY("TARGET_VR_UINT", "2"), "<SlvCfg>", 0, "CTRL_WORD"},
    {"trio-axes", ENTRY("STATUS_WORD", "2"), 1, ENTRY("ACTUAL_VR_UINT", "2"), "<SlvCfg>", 0, "STATUS_WORD"},
};

static void test_each_rule_finds_its_fault_and_nothing_else(void)
{
    be_a_stranger();
    expect_nothing((const char *)file.bytes);
    for (size_t i = 0; i < sizeof breaks / sizeof breaks[0]; i++) {
        char *text = broken(breaks[i].what, breaks[i].nth, breaks[i].with);
        check(text);
        expect_one(breaks[i].rule, true, line_of(text, breaks[i].where) + (unsigned)breaks[i].offset, breaks[i].part);
        free(text);
    }
}

static void test_an_assignment_that_assigns_nothing(void)
{
    be_a_stranger();
    char *text = broken(DATA_OF("0x1C12", "1", "2", "0x1600"), 1, DATA_OF("0x6060", "0", "1", "8"));
    char *last = strstr(text, DATA_OF("0x1C12", "0", "1", "1"));
    TEST_ASSERT_NOT_NULL(last);
    memcpy(last, DATA_OF("0x1C12", "0", "1", "0"), strlen(DATA_OF("0x1C12", "0", "1", "0")));
    check(text);
    expect_one("trio-assignment", true, line_of(text, "<SdoInitCmd>"), "no PDO is assigned");
    free(text);
}

static void test_commands_need_coe(void)
{
    be_a_stranger();
    char *text = broken("<MbxStartupProtocol>COE</MbxStartupProtocol>\n      <MbxProtocols>COE</MbxProtocols>", 1,
                        "<MbxStartupProtocol>FOE</MbxStartupProtocol>");
    check(text);
    expect_one("trio-mailbox", true, line_of(text, "<SlvCfg>"), "need COE");
    free(text);
}

/* Trio's file has a list without commands, for slaves that need none. */
static void test_a_list_without_commands_needs_no_coe(void)
{
    static const char whole[] = "<MbxStartupProtocol>COE</MbxStartupProtocol>\n      <MbxProtocols>COE</MbxProtocols>";
    be_a_stranger();
    char *text = broken(whole, 1, "<MbxStartupProtocol>FOE</MbxStartupProtocol>");
    cm1e_file_free(&file);
    file = (cm1e_file_t){.bytes = (uint8_t *)text, .size = strlen(text)};
    char *none = broken("</SdoInitCmd>\n", 1,
                        "</SdoInitCmd><SdoInitCmd><Index>1</Index><Name>SDO_NONE</Name></SdoInitCmd>\n");
    text = strstr(none, "<SdoInitCmdIndex>SDO_APP_CSP<");
    TEST_ASSERT_NOT_NULL(text);
    memcpy(text, "<SdoInitCmdIndex>SDO_NONE   <", strlen("<SdoInitCmdIndex>SDO_APP_CSP<"));
    expect_nothing(none);
    free(none);
}

/* Warnings: the format is not public, so what is unknown may be right. */
static void test_what_is_not_known_is_worth_a_warning(void)
{
    static const struct {
        const char *what, *with, *where;
        int offset;
        const char *part;
    } unknown[] = {
        {"<Dc>", "<Dcc/><Dc>", "<Dcc/>", 0, "<Dcc> in <SlvCfg>"},
        {"<Version>", "<Strange><Index>x</Index></Strange><Version>", "<Strange>", 0, "<Strange> in <EtherCAT>"},
        {"<Flags>0</Flags>", "<Flags kind=\"a\">0</Flags>", "<Flags kind", 0, "attribute"},
        {"<SlaveType>SERVO<", "<SlaveType>SERVOS<", "<SlvCfg>", 0, "SERVOS"},
        {SM("OUTPUTS"), SM("OUTPUT"), SM("OUTPUT"), -5, "OUTPUT\""},
        {SM("INPUTS"), SM("BOOTINPUTS"), SM("BOOTINPUTS"), -5, "BOOTINPUTS"},
        {ENTRY("TARGET_SPEED", "4"), ENTRY("TARGET_SPED", "4"), "TARGET_SPED", -1, "TARGET_SPED"},
        {"<Transition>2<", "<Transition>3<", "<Transition>3<", -6, "Transition 3"},
    };
    be_a_stranger();
    for (size_t i = 0; i < sizeof unknown / sizeof unknown[0]; i++) {
        char *text = broken(unknown[i].what, 1, unknown[i].with);
        check(text);
        expect_one("trio-unknown", false, line_of(text, unknown[i].where) + (unsigned)unknown[i].offset,
                   unknown[i].part);
        free(text);
    }
}

/* Sync managers of Bootstrap lie where those of the other states do, and may be buffered (Trio's file has such). */
static void test_the_mailbox_of_bootstrap_is_judged_by_itself(void)
{
    static const char boot[] = "<Sm><Index>0</Index><Startaddress>0x1000</Startaddress><Size>64</Size><Controlbyte>0x64"
                               "</Controlbyte><Enable>1</Enable>" SM("BOOTMBOXOUT") "</Sm>\n";
    static const char over[] = "<Sm><Index>1</Index><Startaddress>0x10BF</Startaddress><Size>64</Size><Controlbyte>0x20"
                               "</Controlbyte><Enable>1</Enable>" SM("BOOTMBOXIN") "</Sm>\n";
    char both[512];
    snprintf(both, sizeof both, "%s</EscCfg>", boot);
    char *text = broken("</EscCfg>", 1, both);
    expect_nothing(text);
    free(text);
    snprintf(both, sizeof both, "%s%s</EscCfg>", boot, over);
    text = broken("</EscCfg>", 1, both);
    check(text);
    expect_one("sync-managers-overlap", true, line_of(text, "0x10BF"), "0x10BF");
    free(text);
}

/* ---- our own device: order and length of the process data, sync managers, objects ------------------------------- */

static const struct {
    const char *what, *with, *where;
    int offset;
    const char *part;
} foreign[] = {
    /* two entries of the same length changed places: the motor would take a position for a speed */
    {ENTRY("TARGET_POS", "4") "\n      " ENTRY("TARGET_SPEED", "4"), ENTRY("TARGET_SPEED", "4") "\n      "
     ENTRY("TARGET_POS", "4"), "TARGET_SPEED", -1, "0x607A:00"},
    {ENTRY("DOUT", "2"), ENTRY("DOUT", "4"), "<Name>DOUT", -1, "0x60FE:00"},
    {ENTRY("TARGET_CTRL_MODE", "1"), "", "<RxPdo>", 0, "0x6060:00"},
    {ENTRY("TARGET_CTRL_MODE", "1"), ENTRY("TARGET_CTRL_MODE", "1") ENTRY("TARGET_VR_UINT", "2"), "TARGET_VR_UINT", -1,
     "ends before it"},
    {"<Data>0x1600<", "<Data>0x1604<", "0x1604", -4, "does not have"},
    {"<Startaddress>0x1100<", "<Startaddress>0x1180<", "0x1180", -2, "0x1100 in the device"},
    {"<Controlbyte>0x64<", "<Controlbyte>0x44<", "0x44<", -3, "0x64 in the device"},
    {"<Size>128<", "<Size>64<", "<Size>64", -3, "128 in the device"},
    {"<Index>0x6060<", "<Index>0x6062<", "0x6062", -1, "0x6062:00"},
    {"<Index>0x6060<", "<Index>0x6061<", "0x6061", -1, "only be read"},
    {DATA_OF("0x6060", "0", "1", "8"), DATA_OF("0x6060", "0", "2", "8"), "0x6060", -1, "in the device it has 1"},
};

static void test_our_own_device_is_compared_with_its_tables(void)
{
    for (size_t i = 0; i < sizeof foreign / sizeof foreign[0]; i++) {
        char *text = broken(foreign[i].what, 1, foreign[i].with);
        check(text);
        expect_one("trio-device", true, line_of(text, foreign[i].where) + (unsigned)foreign[i].offset, foreign[i].part);
        free(text);
    }
}

static void test_more_sync_managers_than_the_device_has(void)
{
    char *text = broken("</EscCfg>", 1, "<Sm><Index>4</Index><Startaddress>0x1800</Startaddress><Size>16</Size>"
                        "<Controlbyte>0x26</Controlbyte><Enable>1</Enable>" SM("MBOXOUT") "</Sm></EscCfg>");
    check(text);
    expect_one("trio-device", true, line_of(text, "<Index>4<"), "the device has 4");
    free(text);
    text = broken(SM("INPUTS"), 1, SM("OUTPUTS"));
    check(text);
    TEST_ASSERT_EQUAL_STRING("trio-device", cm1e_findings_at(findings, 0)->rule);
    free(text);
}

static void test_the_revision_selects_the_firmware(void)
{
    /* 0x1603 has no mode before V1.3.0: a file for one is wrong for the other. */
    generate(CM1E_MAPPING_PROFILE, "1.2.0", CM1E_PDO_ORDER_UG_4_4);
    char *text = broken("<Rev>537001985<", 1, "<Rev>0x20020103<");
    check(text);
    TEST_ASSERT_EQUAL_UINT(2, cm1e_findings_count(findings)); /* outputs and inputs */
    TEST_ASSERT_EQUAL_STRING("trio-device", cm1e_findings_at(findings, 0)->rule);
    TEST_ASSERT_NOT_NULL(strstr(cm1e_findings_at(findings, 0)->text, "0x6060:00"));
    TEST_ASSERT_NOT_NULL(strstr(cm1e_findings_at(findings, 1)->text, "0x6061:00"));
    free(text);
    generate(CM1E_MAPPING_DYNAMIC, "", CM1E_PDO_ORDER_UG_7_2);
    text = broken("<Rev>537002243<", 1, "<Rev>5<");
    check(text);
    expect_one("trio-revision", false, line_of(text, "<Profile>"), "0x00000005");
    free(text);
}

/* ---- beside a device -------------------------------------------------------------------------------------------- */

/* The comparison of the good file, `what` replaced, with a CM1-E of these options; the first finding, or NULL. */
static const cm1e_finding_t *compare(const char *what, const char *with, const cm1e_device_options_t *options)
{
    char *text = broken(what, 1, with);
    forget();
    findings = cm1e_findings_create();
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_ec_extend_read(&document, text, strlen(text), &diag));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&described, options, CM1E_ESI_FLAT, &diag));
    cm1e_ec_extend_compare(findings, &document, &described.devices.at[0]);
    free(text);
    if (cm1e_findings_count(findings) > 0)
        TEST_ASSERT_EQUAL_STRING("differs", cm1e_findings_at(findings, 0)->rule);
    return cm1e_findings_at(findings, 0);
}

static void expect_difference(const char *what, const char *with, const cm1e_device_options_t *options,
                              const char *part)
{
    const cm1e_finding_t *finding = compare(what, with, options);
    TEST_ASSERT_NOT_NULL_MESSAGE(finding, part);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(finding->text, part), finding->text);
}

static void test_comparison_with_a_device(void)
{
    const cm1e_device_options_t same = {0}, other_order = {.order = CM1E_PDO_ORDER_UG_7_2}, old = {.firmware = "1.2.0"};
    TEST_ASSERT_NULL(compare("<Version>", "<Version>", &same));
    expect_difference("<Version>", "<Version>", &other_order, "0x607A:00");
    expect_difference("<Version>", "<Version>", &old, "0x20020103 in the file, 0x20020001 in the device");
    expect_difference("<Pid>0x44412002<", "<Pid>1<", &same, "has no profile");
    expect_difference("<Data>0x1600<", "<Data>0x1603<", &same, "TARGET_CTRL_MODE");
    /* No assignment: what the device has assigned by itself counts. */
    TEST_ASSERT_NULL(compare(DATA_OF("0x1C12", "1", "2", "0x1600"), DATA_OF("0x6060", "0", "1", "8"), &same));
    TEST_ASSERT_NULL(compare("<Rev>537002243<", "<Rev>0x00000000<", &old));
    TEST_ASSERT_NULL(compare("<SlvCfgIndex>0<", "<SlvCfgIndex>9<", &same));
}

static void test_the_profile_of_the_right_revision_is_compared(void)
{
    const cm1e_device_options_t devices[] = {{.firmware = "1.3.5", .mapping = CM1E_MAPPING_PROFILE},
                                             {.firmware = "1.2.0"}};
    const cm1e_generate_options_t options = {.format = CM1E_FILE_EC_EXTEND, .devices = devices, .device_count = 2};
    cm1e_file_free(&file);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_generate(&file, &options, &diag));
    TEST_ASSERT_NULL(compare("<Version>", "<Version>", &devices[0]));
    TEST_ASSERT_NULL(compare("<Version>", "<Version>", &devices[1]));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_rule_finds_its_fault_and_nothing_else);
    RUN_TEST(test_an_assignment_that_assigns_nothing);
    RUN_TEST(test_commands_need_coe);
    RUN_TEST(test_a_list_without_commands_needs_no_coe);
    RUN_TEST(test_what_is_not_known_is_worth_a_warning);
    RUN_TEST(test_the_mailbox_of_bootstrap_is_judged_by_itself);
    RUN_TEST(test_our_own_device_is_compared_with_its_tables);
    RUN_TEST(test_more_sync_managers_than_the_device_has);
    RUN_TEST(test_the_revision_selects_the_firmware);
    RUN_TEST(test_comparison_with_a_device);
    RUN_TEST(test_the_profile_of_the_right_revision_is_compared);
    return UNITY_END();
}
