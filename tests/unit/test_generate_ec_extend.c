/* EC_EXTEND: what is generated, beside the five views of UG 11.2 that stand here as tables. The document is asked by
 * XPath, not by our reader. */
#include <libxml/parser.h>
#include <libxml/xpath.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/generate.h"
#include "golden.h"
#include "unity.h"

static cm1e_file_t file;
static cm1e_diag_t diag;
static xmlDoc *doc;

void setUp(void) {}

void tearDown(void)
{
    xmlFreeDoc(doc);
    doc = NULL;
    cm1e_file_free(&file);
}

static void generate_all(const cm1e_device_options_t *devices, size_t count)
{
    const cm1e_generate_options_t options = {.format = CM1E_FILE_EC_EXTEND, .devices = devices, .device_count = count};
    tearDown();
    memset(&diag, 0, sizeof diag);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_generate(&file, &options, &diag), diag.text);
    doc = xmlReadMemory((const char *)file.bytes, (int)file.size, NULL, NULL, XML_PARSE_NONET);
    TEST_ASSERT_NOT_NULL(doc);
}

static void generate(cm1e_mapping_t mapping, const char *firmware, cm1e_pdo_order_t order)
{
    cm1e_device_options_t options = {.mapping = mapping, .order = order};
    snprintf(options.firmware, sizeof options.firmware, "%s", firmware);
    generate_all(&options, 1);
}

/* The text at a path below EtherCAT; "" where there is no such element. */
static const char *cell(const char *path)
{
    static char text[256];
    char whole[256];
    snprintf(whole, sizeof whole, "string(/EtherCAT/%s)", path);
    xmlXPathContext *context = xmlXPathNewContext(doc);
    xmlXPathObject *found = xmlXPathEvalExpression((const xmlChar *)whole, context);
    TEST_ASSERT_NOT_NULL_MESSAGE(found, path);
    snprintf(text, sizeof text, "%s", (const char *)found->stringval);
    xmlXPathFreeObject(found);
    xmlXPathFreeContext(context);
    return text;
}

static int count(const char *path)
{
    char whole[256];
    snprintf(whole, sizeof whole, "count(/EtherCAT/%s)", path);
    xmlXPathContext *context = xmlXPathNewContext(doc);
    xmlXPathObject *found = xmlXPathEvalExpression((const xmlChar *)whole, context);
    TEST_ASSERT_NOT_NULL_MESSAGE(found, path);
    const int number = (int)found->floatval;
    xmlXPathFreeObject(found);
    xmlXPathFreeContext(context);
    return number;
}

/* Row n (from 1) of a view beside the cells below `path`. A cell "-" is not legible in the manual. */
static void expect_row(const char *path, int n, const char *const columns[], const char *const cells[])
{
    for (int c = 0; columns[c]; c++) {
        char at[256];
        snprintf(at, sizeof at, "%s[%d]/%s", path, n, columns[c]);
        if (strcmp(cells[c], "-") != 0)
            TEST_ASSERT_EQUAL_STRING_MESSAGE(cells[c], cell(at), at);
    }
}

/* ---- UG 11.2: the five views of Motion Perfect; the revision there is that of firmware 1.2.0 -------------------- */

static void test_view_1_vendors_and_profiles(void)
{
    static const char *const columns[] = {"Index", "Name", "Vid", "Pid", "Rev", "Atype", "ProfileIndex", "SlvCfgIndex",
                                          NULL};
    static const char *const row[] = {"0", "CM1-E", "0x00004441", "0x44412002", "537001985", "POSITION", "0", "0"};
    generate(CM1E_MAPPING_DYNAMIC, "1.2.0", CM1E_PDO_ORDER_UG_4_4);
    TEST_ASSERT_EQUAL_STRING("Myostat Motion Control Inc.", cell("Vendors/Vendor/Name"));
    TEST_ASSERT_EQUAL_HEX32(0x0004441, strtoul(cell("Vendors/Vendor/Vid"), NULL, 0));
    TEST_ASSERT_EQUAL_INT(1, count("Vendors/Vendor"));
    TEST_ASSERT_EQUAL_INT(1, count("Profiles/Profile"));
    expect_row("Profiles/Profile", 1, columns, row);
}

static void test_view_2_slave_configurations(void)
{
    static const char *const columns[] = {"Index", "SlaveType", "Axes", "Din", "Dout", "Ain", "Aout", "EscCfgIndex",
                                          "SdoInitCmdIndex", "RxPdoIndex", "TxPdoIndex", NULL};
    static const char *const row[] = {"0", "SERVO", "1", "4", "2", "1", "0", "0", "SDO_APP_CSP", "RXPDO_PROFILE",
                                      "TXPDO_PROFILE"};
    generate(CM1E_MAPPING_DYNAMIC, "1.2.0", CM1E_PDO_ORDER_UG_4_4);
    TEST_ASSERT_EQUAL_INT(1, count("SlvCfgs/SlvCfg"));
    expect_row("SlvCfgs/SlvCfg", 1, columns, row);
}

static void test_view_3_esc_configurations(void)
{
    static const char *const columns[] = {"Index", "Startaddress", "Size", "Controlbyte", "Enable", "Function", NULL};
    static const char *const rows[4][6] = {
        {"0", "-", "-", "0x26", "1", "MBOXOUT"}, /* the column's name lies over both cells */
        {"1", "0x1080", "128", "0x22", "1", "MBOXIN"},
        {"2", "0x1100", "", "0x64", "1", "OUTPUTS"},
        {"3", "0x1400", "", "0x20", "1", "INPUTS"},
    };
    generate(CM1E_MAPPING_DYNAMIC, "1.2.0", CM1E_PDO_ORDER_UG_4_4);
    TEST_ASSERT_EQUAL_INT(1, count("EscCfgs/EscCfg"));
    TEST_ASSERT_EQUAL_STRING("0", cell("EscCfgs/EscCfg/Index"));
    TEST_ASSERT_EQUAL_INT(4, count("EscCfgs/EscCfg/Sm"));
    TEST_ASSERT_EQUAL_INT(2, count("EscCfgs/EscCfg/Sm/Size"));
    for (int i = 0; i < 4; i++)
        expect_row("EscCfgs/EscCfg/Sm", i + 1, columns, rows[i]);
    /* What lies under the name follows from the second row. */
    TEST_ASSERT_EQUAL_STRING("0x1000", cell("EscCfgs/EscCfg/Sm[1]/Startaddress"));
    TEST_ASSERT_EQUAL_STRING("128", cell("EscCfgs/EscCfg/Sm[1]/Size"));
}

static void test_view_4_initialization_commands(void)
{
    static const char *const columns[] = {"Index", "SubIndex", "Length", "Data", "Flags", "Transition", NULL};
    static const char *const rows[7][6] = {
        {"0x1C12", "0", "1", "0", "NONE", "2"},      {"0x1C13", "0", "1", "0", "NONE", "2"},
        {"0x1C12", "1", "2", "0x1600", "NONE", "2"}, {"0x1C12", "0", "1", "1", "NONE", "2"},
        {"0x1C13", "1", "2", "0x1A00", "NONE", "2"}, {"0x1C13", "0", "1", "1", "NONE", "2"},
        {"0x6060", "0", "1", "8", "NONE", "2"},
    };
    generate(CM1E_MAPPING_DYNAMIC, "1.2.0", CM1E_PDO_ORDER_UG_4_4);
    TEST_ASSERT_EQUAL_INT(1, count("SdoInitCmds/SdoInitCmd"));
    TEST_ASSERT_EQUAL_STRING("0", cell("SdoInitCmds/SdoInitCmd/Index"));
    TEST_ASSERT_EQUAL_STRING("SDO_APP_CSP", cell("SdoInitCmds/SdoInitCmd/Name"));
    TEST_ASSERT_EQUAL_INT(7, count("SdoInitCmds/SdoInitCmd/Entry"));
    for (int i = 0; i < 7; i++)
        expect_row("SdoInitCmds/SdoInitCmd/Entry", i + 1, columns, rows[i]);
}

static void test_view_5_pdo_definitions(void)
{
    static const char *const columns[] = {"Name", "Length", "Flags", NULL};
    /* Length and flags of the row NULL are blank in the view; in the file of Trio's both are 0. */
    static const char *const rx[6][3] = {
        {"CTRL_WORD", "2", "0"},    {"DOUT", "2", "0"},             {"TARGET_POS", "4", "0"},
        {"TARGET_SPEED", "4", "0"}, {"TARGET_CTRL_MODE", "1", "0"}, {"NULL", "-", "-"},
    };
    static const char *const tx[10][3] = {
        {"STATUS_WORD", "2", "0"},  {"ERR_STATUS", "2", "0"},    {"ACTUAL_POS", "4", "0"},
        {"ACTUAL_SPEED", "4", "0"}, {"ACTUAL_TORQUE", "2", "0"}, {"DIN", "2", "0"},
        {"ACTUAL_VR_INT", "2", "0"}, {"ACTUAL_VR_INT", "2", "0"}, {"ACTUAL_CTRL_MODE", "1", "0"},
        {"NULL", "-", "-"},
    };
    generate(CM1E_MAPPING_DYNAMIC, "1.2.0", CM1E_PDO_ORDER_UG_4_4);
    TEST_ASSERT_EQUAL_INT(1, count("RxPdos/RxPdo"));
    TEST_ASSERT_EQUAL_INT(1, count("TxPdos/TxPdo"));
    TEST_ASSERT_EQUAL_STRING("0", cell("RxPdos/RxPdo/Index"));
    TEST_ASSERT_EQUAL_STRING("0", cell("TxPdos/TxPdo/Index"));
    TEST_ASSERT_EQUAL_STRING("RXPDO_PROFILE", cell("RxPdos/RxPdo/Name"));
    TEST_ASSERT_EQUAL_STRING("TXPDO_PROFILE", cell("TxPdos/TxPdo/Name"));
    TEST_ASSERT_EQUAL_INT(6, count("RxPdos/RxPdo/Entry"));
    TEST_ASSERT_EQUAL_INT(10, count("TxPdos/TxPdo/Entry"));
    for (int i = 0; i < 6; i++)
        expect_row("RxPdos/RxPdo/Entry", i + 1, columns, rx[i]);
    for (int i = 0; i < 10; i++)
        expect_row("TxPdos/TxPdo/Entry", i + 1, columns, tx[i]);
}

/* ---- every mapping, firmware and order: UG 4.4, 7.2, 10.1 ------------------------------------------------------- */

#define TX_LONG_4_4                                                                                                 \
    "STATUS_WORD2 ERR_STATUS2 ACTUAL_POS4 ACTUAL_SPEED4 ACTUAL_TORQUE2 DIN2 ACTUAL_VR_INT2 ACTUAL_VR_INT2 "
#define TX_LONG_7_2                                                                                                 \
    "STATUS_WORD2 ACTUAL_POS4 ACTUAL_SPEED4 ACTUAL_TORQUE2 DIN2 ERR_STATUS2 ACTUAL_VR_INT2 ACTUAL_VR_INT2 "
#define TX_SHORT_4_4 "STATUS_WORD2 ERR_STATUS2 ACTUAL_POS4 ACTUAL_TORQUE2 ACTUAL_SPEED4 DIN2 NULL0 "
#define TX_SHORT_7_2 "STATUS_WORD2 ACTUAL_POS4 ACTUAL_SPEED4 ACTUAL_TORQUE2 DIN2 ERR_STATUS2 NULL0 "
#define RX_PROFILE "CTRL_WORD2 DOUT2 TARGET_POS4 TARGET_SPEED4 TARGET_VR_UINT4 TARGET_VR_UINT4 "

static const struct {
    cm1e_mapping_t mapping;
    cm1e_pdo_order_t order;
    const char *rx, *tx;
    const char *assigned_rx, *assigned_tx, *mode, *control;
} layouts[] = {
    {CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, "CTRL_WORD2 DOUT2 TARGET_POS4 TARGET_SPEED4 TARGET_CTRL_MODE1 NULL0 ",
     TX_LONG_4_4 "ACTUAL_CTRL_MODE1 NULL0 ", "0x1600", "0x1A00", "8", "CSP"},
    {CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_7_2, "CTRL_WORD2 TARGET_POS4 TARGET_SPEED4 DOUT2 TARGET_CTRL_MODE1 NULL0 ",
     TX_LONG_7_2 "ACTUAL_CTRL_MODE1 NULL0 ", "0x1600", "0x1A00", "8", "CSP"},
    {CM1E_MAPPING_CSP, CM1E_PDO_ORDER_UG_4_4, "CTRL_WORD2 DOUT2 TARGET_POS4 NULL0 ", TX_SHORT_4_4, "0x1601", "0x1A01",
     "8", "CSP"},
    {CM1E_MAPPING_CSP, CM1E_PDO_ORDER_UG_7_2, "CTRL_WORD2 TARGET_POS4 DOUT2 NULL0 ", TX_SHORT_7_2, "0x1601", "0x1A01",
     "8", "CSP"},
    {CM1E_MAPPING_CSV, CM1E_PDO_ORDER_UG_4_4, "CTRL_WORD2 DOUT2 TARGET_SPEED4 NULL0 ", TX_SHORT_4_4, "0x1602", "0x1A02",
     "9", "CSV"},
    {CM1E_MAPPING_CSV, CM1E_PDO_ORDER_UG_7_2, "CTRL_WORD2 TARGET_SPEED4 DOUT2 NULL0 ", TX_SHORT_7_2, "0x1602", "0x1A02",
     "9", "CSV"},
    {CM1E_MAPPING_PROFILE, CM1E_PDO_ORDER_UG_4_4, RX_PROFILE "TARGET_CTRL_MODE1 NULL0 ",
     TX_LONG_4_4 "ACTUAL_CTRL_MODE1 NULL0 ", "0x1603", "0x1A03", "1", "NONE"},
    {CM1E_MAPPING_PROFILE, CM1E_PDO_ORDER_UG_7_2, RX_PROFILE "TARGET_CTRL_MODE1 NULL0 ",
     TX_LONG_7_2 "ACTUAL_CTRL_MODE1 NULL0 ", "0x1603", "0x1A03", "1", "NONE"},
};
enum { LAYOUTS = sizeof layouts / sizeof layouts[0] };
static const struct {
    const char *version, *revision;
    bool mode_in_profile_pdo;
} firmwares[] = {
    {"1.2.0", "537001985", false}, {"1.3.0", "537002243", true}, {"1.3.2", "537002243", true},
    {"1.3.3", "537002243", true},  {"1.3.4", "537002243", true}, {"1.3.5", "537002243", true},
    {"", "537002243", true},
};
enum { FIRMWARES = sizeof firmwares / sizeof firmwares[0] };

/* "CTRL_WORD2 DOUT2 ": names and lengths of a list. */
static void list_of(char *text, size_t room, const char *path)
{
    char at[128];
    text[0] = '\0';
    snprintf(at, sizeof at, "%s/Entry", path);
    const int entries = count(at);
    for (int i = 1; i <= entries; i++)
        for (int part = 0; part < 2; part++) {
            snprintf(at, sizeof at, "%s/Entry[%d]/%s", path, i, part == 0 ? "Name" : "Length");
            snprintf(text + strlen(text), room - strlen(text), "%s%s", cell(at), part == 0 ? "" : " ");
        }
}

/* As `expected`, but without the mode where the firmware has none in the profile mapping. */
static void expect_list(const char *path, const char *expected, bool without_mode)
{
    char list[512], wanted[512];
    snprintf(wanted, sizeof wanted, "%s", expected);
    char *mode = strstr(wanted, strstr(path, "Rx") ? "TARGET_CTRL_MODE1 " : "ACTUAL_CTRL_MODE1 ");
    if (without_mode && mode)
        memmove(mode, strchr(mode, ' ') + 1, strlen(strchr(mode, ' ')));
    list_of(list, sizeof list, path);
    TEST_ASSERT_EQUAL_STRING(wanted, list);
}

static void expect_clean(void)
{
    cm1e_findings_t *findings;
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_check_file(&findings, file.bytes, file.size, &diag), diag.text);
    if (cm1e_findings_count(findings) > 0)
        TEST_FAIL_MESSAGE(cm1e_findings_at(findings, 0)->text);
    cm1e_findings_free(findings);
}

static void expect_round_trip(const void *bytes, size_t size)
{
    cm1e_file_t again;
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_generate_from(&again, bytes, size, CM1E_FILE_EC_EXTEND, 0, &diag),
                              diag.text);
    TEST_ASSERT_EQUAL(size, again.size);
    TEST_ASSERT_EQUAL_MEMORY(bytes, again.bytes, size);
    cm1e_file_free(&again);
}

static void test_every_mapping_firmware_and_order(void)
{
    for (int l = 0; l < LAYOUTS; l++)
        for (int f = 0; f < FIRMWARES; f++) {
            const bool without_mode = layouts[l].mapping == CM1E_MAPPING_PROFILE && !firmwares[f].mode_in_profile_pdo;
            generate(layouts[l].mapping, firmwares[f].version, layouts[l].order);
            expect_list("RxPdos/RxPdo", layouts[l].rx, without_mode);
            expect_list("TxPdos/TxPdo", layouts[l].tx, without_mode);
            TEST_ASSERT_EQUAL_STRING(firmwares[f].revision, cell("Profiles/Profile/Rev"));
            TEST_ASSERT_EQUAL_STRING(layouts[l].assigned_rx, cell("SdoInitCmds/SdoInitCmd/Entry[3]/Data"));
            TEST_ASSERT_EQUAL_STRING(layouts[l].assigned_tx, cell("SdoInitCmds/SdoInitCmd/Entry[5]/Data"));
            TEST_ASSERT_EQUAL_STRING(layouts[l].mode, cell("SdoInitCmds/SdoInitCmd/Entry[7]/Data"));
            TEST_ASSERT_EQUAL_STRING(layouts[l].control, cell("SlvCfgs/SlvCfg/CycData/CtrlMode"));
            TEST_ASSERT_EQUAL_INT(layouts[l].mapping == CM1E_MAPPING_PROFILE, count("SlvCfgs/SlvCfg/Vr"));
            TEST_ASSERT_EQUAL_STRING(cell("RxPdos/RxPdo/Name"), cell("SlvCfgs/SlvCfg/RxPdoIndex"));
            TEST_ASSERT_EQUAL(layouts[l].mapping == CM1E_MAPPING_PROFILE || layouts[l].mapping == CM1E_MAPPING_CSV,
                              file.warning[0] != '\0');
            expect_clean();
            expect_round_trip(file.bytes, file.size);
        }
}

/* ---- what the manual does not show ------------------------------------------------------------------------------ */

static void test_what_the_manual_does_not_show_has_defaults_and_options(void)
{
    generate(CM1E_MAPPING_DYNAMIC, "", CM1E_PDO_ORDER_UG_4_4);
    TEST_ASSERT_EQUAL_STRING("1.0.0", cell("Version"));
    TEST_ASSERT_EQUAL_STRING("0x0300", cell("SlvCfgs/SlvCfg/Dc/Mode"));
    TEST_ASSERT_EQUAL_STRING("100", cell("SlvCfgs/SlvCfg/MbxRate"));
    TEST_ASSERT_EQUAL_STRING("COE", cell("SlvCfgs/SlvCfg/MbxProtocols[1]"));
    TEST_ASSERT_EQUAL_STRING("FOE", cell("SlvCfgs/SlvCfg/MbxProtocols[2]"));
    TEST_ASSERT_EQUAL_INT(2, count("SlvCfgs/SlvCfg/MbxProtocols"));
    TEST_ASSERT_EQUAL_STRING("COE", cell("SlvCfgs/SlvCfg/MbxStartupProtocol"));
    TEST_ASSERT_EQUAL_STRING("POSITION", cell("SlvCfgs/SlvCfg/CycData/Atype"));
    TEST_ASSERT_EQUAL_STRING("FALSE", cell("SlvCfgs/SlvCfg/CycData/UseLrdLwr"));
    TEST_ASSERT_EQUAL_STRING("LRW", cell("SlvCfgs/SlvCfg/CycData/Cmd"));
    TEST_ASSERT_EQUAL_STRING("DEVICE_STATE_SAFEOP,DEVICE_STATE_OP", cell("SlvCfgs/SlvCfg/CycData/State"));
    TEST_ASSERT_EQUAL_INT(0, count("SlvCfgs/SlvCfg/SlotPdoIncrement"));

    const cm1e_generate_options_t options = {.format = CM1E_FILE_EC_EXTEND, .dc_mode = 0x0700, .mailbox_rate = 250};
    tearDown();
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_generate(&file, &options, &diag));
    doc = xmlReadMemory((const char *)file.bytes, (int)file.size, NULL, NULL, XML_PARSE_NONET);
    TEST_ASSERT_EQUAL_STRING("0x0700", cell("SlvCfgs/SlvCfg/Dc/Mode"));
    TEST_ASSERT_EQUAL_STRING("250", cell("SlvCfgs/SlvCfg/MbxRate"));
}

/* ---- several devices -------------------------------------------------------------------------------------------- */

static void test_two_firmwares_share_what_they_have_in_common(void)
{
    const cm1e_device_options_t devices[] = {{.firmware = "1.2.0"}, {.firmware = "1.3.5"}};
    generate_all(devices, 2);
    TEST_ASSERT_EQUAL_INT(1, count("RxPdos/RxPdo"));
    TEST_ASSERT_EQUAL_INT(1, count("TxPdos/TxPdo"));
    TEST_ASSERT_EQUAL_INT(1, count("SdoInitCmds/SdoInitCmd"));
    TEST_ASSERT_EQUAL_INT(1, count("EscCfgs/EscCfg"));
    TEST_ASSERT_EQUAL_INT(1, count("Vendors/Vendor"));
    TEST_ASSERT_EQUAL_INT(2, count("SlvCfgs/SlvCfg"));
    TEST_ASSERT_EQUAL_STRING("537001985", cell("Profiles/Profile[1]/Rev"));
    TEST_ASSERT_EQUAL_STRING("537002243", cell("Profiles/Profile[2]/Rev"));
    TEST_ASSERT_EQUAL_STRING("1", cell("Profiles/Profile[2]/SlvCfgIndex"));
    expect_clean();
    expect_round_trip(file.bytes, file.size);
}

static void test_lists_that_differ_get_names_of_their_own(void)
{
    const cm1e_device_options_t devices[] = {{.firmware = "1.2.0", .mapping = CM1E_MAPPING_CSP},
                                             {.order = CM1E_PDO_ORDER_UG_7_2}};
    generate_all(devices, 2);
    TEST_ASSERT_EQUAL_STRING("SDO_APP_CSP", cell("SdoInitCmds/SdoInitCmd[1]/Name"));
    TEST_ASSERT_EQUAL_STRING("SDO_APP_CSP_1", cell("SdoInitCmds/SdoInitCmd[2]/Name"));
    TEST_ASSERT_EQUAL_STRING("SDO_APP_CSP_1", cell("SlvCfgs/SlvCfg[2]/SdoInitCmdIndex"));
    TEST_ASSERT_EQUAL_STRING("RXPDO_PROFILE_CSP", cell("SlvCfgs/SlvCfg[1]/RxPdoIndex"));
    TEST_ASSERT_EQUAL_STRING("RXPDO_PROFILE", cell("SlvCfgs/SlvCfg[2]/RxPdoIndex"));
    expect_clean();
    golden_compare("ec_extend_two_firmwares.txt", file.bytes, file.size);
}

/* 0x1601 and 0x1602 have the same lengths, 0x1600 in its two orders the same names. */
static void test_lists_are_shared_only_where_names_and_lengths_are_the_same(void)
{
    const cm1e_device_options_t names[] = {{.firmware = "1.2.0", .mapping = CM1E_MAPPING_CSP},
                                           {.mapping = CM1E_MAPPING_CSV}};
    generate_all(names, 2);
    expect_list("RxPdos/RxPdo[1]", "CTRL_WORD2 DOUT2 TARGET_POS4 NULL0 ", false);
    expect_list("RxPdos/RxPdo[2]", "CTRL_WORD2 DOUT2 TARGET_SPEED4 NULL0 ", false);
    TEST_ASSERT_EQUAL_INT(1, count("TxPdos/TxPdo"));
    TEST_ASSERT_EQUAL_STRING("TXPDO_PROFILE_CSP", cell("SlvCfgs/SlvCfg[2]/TxPdoIndex"));
    expect_clean();

    const cm1e_device_options_t orders[] = {{.firmware = "1.2.0"}, {.order = CM1E_PDO_ORDER_UG_7_2}};
    generate_all(orders, 2);
    TEST_ASSERT_EQUAL_INT(2, count("RxPdos/RxPdo"));
    TEST_ASSERT_EQUAL_STRING("RXPDO_PROFILE_1", cell("RxPdos/RxPdo[2]/Name"));
    TEST_ASSERT_EQUAL_STRING("RXPDO_PROFILE_1", cell("SlvCfgs/SlvCfg[2]/RxPdoIndex"));
    TEST_ASSERT_EQUAL_STRING("TXPDO_PROFILE_1", cell("SlvCfgs/SlvCfg[2]/TxPdoIndex"));
    TEST_ASSERT_EQUAL_INT(1, count("SdoInitCmds/SdoInitCmd"));
    expect_clean();
}

/* One slave of several axes, as the two-axis device in Trio's file: lists of one axis, and the way to the next. */
static void test_a_bridge_has_the_lists_of_one_axis(void)
{
    static const char *const modes[] = {"0x6060", "0x6860", "0x7060", "0x7860"};
    for (uint32_t axes = 1; axes <= 4; axes++) {
        const cm1e_device_options_t devices[] = {
            {0}, {.model = CM1E_DEVICE_EB12, .axes = axes, .vendor_id = 0xAA77, .product_code = 0x1234, .revision = 7}};
        char text[16];
        generate_all(devices, 2);
        snprintf(text, sizeof text, "%u", (unsigned)axes);
        TEST_ASSERT_EQUAL_STRING("EB12", cell("Profiles/Profile[2]/Name"));
        TEST_ASSERT_EQUAL_STRING("0x0000AA77", cell("Profiles/Profile[2]/Vid"));
        TEST_ASSERT_EQUAL_STRING("0x00001234", cell("Profiles/Profile[2]/Pid"));
        TEST_ASSERT_EQUAL_STRING("7", cell("Profiles/Profile[2]/Rev"));
        TEST_ASSERT_EQUAL_INT(2, count("Vendors/Vendor"));
        TEST_ASSERT_EQUAL_STRING(text, cell("SlvCfgs/SlvCfg[2]/Axes"));
        TEST_ASSERT_EQUAL_STRING(axes > 1 ? "0x10" : "", cell("SlvCfgs/SlvCfg[2]/SlotPdoIncrement"));
        TEST_ASSERT_EQUAL_INT(1, count("SlvCfgs/SlvCfg[2]/MbxProtocols"));
        expect_list("RxPdos/RxPdo[2]", "CTRL_WORD2 TARGET_POS4 NULL0 ", false);
        expect_list("TxPdos/TxPdo[2]", "STATUS_WORD2 ACTUAL_POS4 NULL0 ", false);
        TEST_ASSERT_EQUAL_INT(6 + (int)axes, count("SdoInitCmds/SdoInitCmd[2]/Entry"));
        TEST_ASSERT_EQUAL_STRING("0x1601", cell("SdoInitCmds/SdoInitCmd[2]/Entry[3]/Data"));
        TEST_ASSERT_EQUAL_STRING("1", cell("SdoInitCmds/SdoInitCmd[2]/Entry[4]/Data"));
        TEST_ASSERT_EQUAL_STRING("0x1A01", cell("SdoInitCmds/SdoInitCmd[2]/Entry[5]/Data"));
        for (int axis = 0; axis < (int)axes; axis++) {
            snprintf(text, sizeof text, "Entry[%d]", 7 + axis);
            char path[64];
            snprintf(path, sizeof path, "SdoInitCmds/SdoInitCmd[2]/%s/Index", text);
            TEST_ASSERT_EQUAL_STRING(modes[axis], cell(path));
        }
        TEST_ASSERT_NOT_NULL(strstr(file.warning, "sync managers"));
        expect_clean();
        expect_round_trip(file.bytes, file.size);
    }
    golden_compare("ec_extend_with_bridge.txt", file.bytes, file.size);
}

static void expect_refused(const cm1e_device_options_t *devices, size_t number, const char *part)
{
    const cm1e_generate_options_t options = {.format = CM1E_FILE_EC_EXTEND, .devices = devices, .device_count = number};
    tearDown();
    memset(&diag, 0, sizeof diag);
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_generate(&file, &options, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, part), diag.text);
    TEST_ASSERT_NULL(file.bytes);
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_generate(&file, &options, NULL));
}

static void test_devices_that_the_controller_cannot_tell_apart_are_refused(void)
{
    const cm1e_device_options_t mappings[] = {{.mapping = CM1E_MAPPING_CSP}, {.mapping = CM1E_MAPPING_CSV}};
    const cm1e_device_options_t firmwares_of_one_revision[] = {{.firmware = "1.3.0"}, {.firmware = "1.2.0"},
                                                               {.firmware = "1.3.5"}};
    expect_refused(mappings, 2, "devices 1 and 2 have the same vendor 0x00004441, product 0x44412002");
    expect_refused(firmwares_of_one_revision, 3, "devices 1 and 3");
}

static void test_options_that_do_not_fit_are_refused(void)
{
    const cm1e_device_options_t firmware = {.firmware = "0.9"}, vendor = {.vendor_id = 1}, none = {0};
    expect_refused(&firmware, 1, "no firmware \"0.9\"");
    expect_refused(&vendor, 1, "follow from its tables");
    expect_refused(&none, 0, "no device");
}

/* ---- golden files ----------------------------------------------------------------------------------------------- */

static void test_golden_files(void)
{
    static const struct {
        const char *name, *firmware;
        cm1e_mapping_t mapping;
    } goldens[] = {
        {"ec_extend_dynamic_1.2.0.txt", "1.2.0", CM1E_MAPPING_DYNAMIC},
        {"ec_extend_dynamic.txt", "", CM1E_MAPPING_DYNAMIC},
        {"ec_extend_csp.txt", "", CM1E_MAPPING_CSP},
        {"ec_extend_csv.txt", "", CM1E_MAPPING_CSV},
        {"ec_extend_profile.txt", "", CM1E_MAPPING_PROFILE},
    };
    for (size_t i = 0; i < sizeof goldens / sizeof goldens[0]; i++) {
        generate(goldens[i].mapping, goldens[i].firmware, CM1E_PDO_ORDER_UG_4_4);
        golden_compare(goldens[i].name, file.bytes, file.size);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_view_1_vendors_and_profiles);
    RUN_TEST(test_view_2_slave_configurations);
    RUN_TEST(test_view_3_esc_configurations);
    RUN_TEST(test_view_4_initialization_commands);
    RUN_TEST(test_view_5_pdo_definitions);
    RUN_TEST(test_every_mapping_firmware_and_order);
    RUN_TEST(test_what_the_manual_does_not_show_has_defaults_and_options);
    RUN_TEST(test_two_firmwares_share_what_they_have_in_common);
    RUN_TEST(test_lists_that_differ_get_names_of_their_own);
    RUN_TEST(test_lists_are_shared_only_where_names_and_lengths_are_the_same);
    RUN_TEST(test_a_bridge_has_the_lists_of_one_axis);
    RUN_TEST(test_devices_that_the_controller_cannot_tell_apart_are_refused);
    RUN_TEST(test_options_that_do_not_fit_are_refused);
    RUN_TEST(test_golden_files);
    return UNITY_END();
}
