/* EC_EXTEND read: what was there comes back to the letter, what real files do is tolerated, damage has a line. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "chance.h"
#include "generate/ec_extend.h"
#include "unity.h"

static cm1e_file_t file;
static cm1e_diag_t diag;
static unsigned seed; /* of a random test that runs; 0: none does */

void setUp(void) {}

void tearDown(void)
{
    if (seed != 0)
        printf("CM1E_TEST_SEED=%u repeats this\n", seed);
    seed = 0;
    cm1e_file_free(&file);
}

static void generate(cm1e_mapping_t mapping)
{
    const cm1e_device_options_t device = {.mapping = mapping};
    const cm1e_generate_options_t options = {.format = CM1E_FILE_EC_EXTEND, .devices = &device, .device_count = 1};
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_generate(&file, &options, &diag), diag.text);
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

/* ---- reading what others wrote ---------------------------------------------------------------------------------- */

static void expect_rewritten(const char *from, const char *expected)
{
    cm1e_file_t again;
    const cm1e_error_t error = cm1e_generate_from(&again, from, strlen(from), CM1E_FILE_EC_EXTEND, 0, &diag);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, error, diag.text);
    TEST_ASSERT_EQUAL_STRING(expected, (const char *)again.bytes);
    expect_round_trip(again.bytes, again.size);
    cm1e_file_free(&again);
}

#define HEAD "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"

static void test_nothing_of_a_file_is_lost(void)
{
    /* Elements and attributes nobody knows, their order, spelling of numbers, empty elements, comments everywhere. */
    static const char text[] =
        HEAD "<!-- before -->\n<EtherCAT>\n  <Version>9.9</Version>\n  <!-- in -->\n  <Strange kind=\"a &lt; b\">\n"
             "    <Deep>1 &amp; 2</Deep>\n    <Deep/>\n  </Strange>\n  <Profiles>\n    <Profile>\n"
             "      <Rev>000000001</Rev>\n      <Pid>0x0000016f</Pid>\n      <Vid>734</Vid>\n      <Index>0</Index>\n"
             "      <SlvCfgIndex>0</SlvCfgIndex>\n      <Extra/>\n    </Profile>\n  </Profiles>\n</EtherCAT>\n"
             "<!-- after -->\n";
    expect_rewritten(text, text);
}

static void test_what_real_files_do_is_tolerated(void)
{
    static const char wanted[] = HEAD "<!-- AIN -->\n<EtherCAT>\n  <Version>1.0.0</Version>\n</EtherCAT>\n";
    expect_rewritten("<!--  AIN  -->\n<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<EtherCAT><Version> 1.0.0 "
                     "</Version></EtherCAT>", wanted);
    expect_rewritten("\xEF\xBB\xBF<!--AIN--><?xml version=\"1.0\"?><EtherCAT>\r\n\t<Version>1.0.0</Version>\r\n"
                     "</EtherCAT>\r\n", wanted);
    expect_rewritten("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><EtherCAT><N>M\xFCller</N></EtherCAT>",
                     HEAD "<EtherCAT>\n  <N>M\xC3\xBCller</N>\n</EtherCAT>\n");
    expect_rewritten("<!----> <!--\xFC--b--><?xml version=\"1.0\"?><EtherCAT/>",
                     HEAD "<!--  -->\n<!-- \xC3\xBC- -b -->\n<EtherCAT/>\n");
    expect_rewritten("<EtherCAT><N><![CDATA[a<b]]></N></EtherCAT>",
                     HEAD "<EtherCAT>\n  <N>a&lt;b</N>\n</EtherCAT>\n");
}

static void test_line_numbers_are_those_of_the_file(void)
{
    cm1e_ec_extend_t document = {0};
    generate(CM1E_MAPPING_DYNAMIC);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_ec_extend_read(&document, file.bytes, file.size, &diag));
    TEST_ASSERT_EQUAL_UINT(5, document.rx_pdos.at[0].place);
    TEST_ASSERT_EQUAL_UINT(8, document.rx_pdos.at[0].entries.at[0].place);
    TEST_ASSERT_EQUAL_UINT(1, document.profiles.count);
    TEST_ASSERT_EQUAL_HEX32(0x20020103, document.profiles.at[0].revision);
    TEST_ASSERT_EQUAL_UINT(13, cm1e_ec_pdo_bytes(&document.rx_pdos.at[0]));
    TEST_ASSERT_EQUAL_UINT(21, cm1e_ec_pdo_bytes(&document.tx_pdos.at[0]));
    cm1e_ec_extend_free(&document);
}

/* What cannot be read, and the line that the text has to name. */
static const struct {
    const char *text, *line, *part;
} damaged[] = {
    {"", "", "0 bytes"},
    {"<EtherCAT>\n<Version>1</Version>\n", "line 3", ""},
    {"<EtherCAT>\n<Version>1</Versoin>\n</EtherCAT>", "line 2", "Versoin"},
    {"<EtherCATInfo/>", "line 1", "<EtherCATInfo>"},
    {"<!DOCTYPE a [<!ENTITY x \"y\">]>\n<EtherCAT/>", "line 1", "DTD"},
    {"<EtherCAT>\n&x;</EtherCAT>", "line 2", ""},
    {"<EtherCAT>\n<a xmlns=\"urn:x\"/></EtherCAT>", "line 2", "namespace"},
    {"<EtherCAT>\n<a xml:space=\"preserve\"/></EtherCAT>", "line 2", "namespace"},
    {"<EtherCAT>\n<a>text<b/></a></EtherCAT>", "line 2", "beside"},
    {"<EtherCAT>\n<a>te<!-- c -->xt</a></EtherCAT>", "line 2", "beside"},
    {"<EtherCAT>\n<a><?php x ?></a></EtherCAT>", "line 2", "nothing else"},
    {"<?xml version=\"1.0\"?>\n<?php x ?>\n<EtherCAT/>", "line 3", "nothing else"},
    {"<EtherCAT>\n<RxPdos>\n<RxPdo>\n<Name>A</Name></RxPdo></RxPdos></EtherCAT>", "line 3", "no <Index>"},
    {"<EtherCAT><TxPdos>\n<TxPdo><Index>0</Index></TxPdo></TxPdos></EtherCAT>", "line 2", "no <Name>"},
    {"<EtherCAT><TxPdos><TxPdo>\n<Index>-1</Index><Name>A</Name></TxPdo></TxPdos></EtherCAT>", "line 2", "-1"},
    {"<EtherCAT><TxPdos><TxPdo>\n<Index>0z</Index><Name>A</Name></TxPdo></TxPdos></EtherCAT>", "line 2", "0z"},
    {"<EtherCAT><RxPdos><RxPdo><Index>0</Index><Name>A</Name>\n<Name>B</Name></RxPdo></RxPdos></EtherCAT>", "line 2",
     "twice"},
    {"<EtherCAT>\n<Vendors/>\n<Vendors/></EtherCAT>", "line 3", "twice"},
    {"<EtherCAT><RxPdos><RxPdo><Index>0</Index><Name>A</Name><Entry><Name>B</Name>\n<Length>5000</Length></Entry>"
     "</RxPdo></RxPdos></EtherCAT>", "line 2", "5000"},
    {"<EtherCAT><Profiles><Profile><Index>0</Index>\n<Vid>0x100000000</Vid></Profile></Profiles></EtherCAT>", "line 2",
     "0x100000000"},
    {"<EtherCAT><EscCfgs><EscCfg><Index>0</Index><Sm>\n<Index>16</Index></Sm></EscCfg></EscCfgs></EtherCAT>", "line 2",
     "16"},
    {"<EtherCAT><SdoInitCmds><SdoInitCmd><Index>0</Index><Name>A</Name><Entry><Index>0x1C12</Index>"
     "<SubIndex>0</SubIndex><Length>1</Length>\n<Data>one</Data><Transition>2</Transition></Entry></SdoInitCmd>"
     "</SdoInitCmds></EtherCAT>",
     "line 2", "one"},
};

static void test_damaged_files_are_refused_with_their_line(void)
{
    for (size_t i = 0; i < sizeof damaged / sizeof damaged[0]; i++) {
        cm1e_ec_extend_t document = {0};
        memset(&diag, 0, sizeof diag);
        const cm1e_error_t error = cm1e_ec_extend_read(&document, damaged[i].text, strlen(damaged[i].text), &diag);
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_FILE, error, damaged[i].text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, damaged[i].line), diag.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, damaged[i].part), diag.text);
        cm1e_ec_extend_free(&document);
        TEST_ASSERT_EQUAL(CM1E_ERROR_FILE,
                          cm1e_ec_extend_read(&document, damaged[i].text, strlen(damaged[i].text), NULL));
        cm1e_ec_extend_free(&document);
    }
}

static void test_a_list_without_end_is_refused(void)
{
    char *text = malloc(1 << 20), *at = text;
    at += sprintf(at, "<EtherCAT><Vendors>");
    for (int i = 0; i < 500; i++)
        at += sprintf(at, "<Vendor>\n<Vid>%d</Vid></Vendor>", i);
    cm1e_ec_extend_t document = {0};
    strcpy(at, "</Vendors></EtherCAT>");
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_ec_extend_read(&document, text, strlen(text), &diag));
    TEST_ASSERT_EQUAL_UINT(500, document.vendors.count);
    cm1e_ec_extend_free(&document);
    strcpy(at, "<Vendor><Vid>500</Vid></Vendor></Vendors></EtherCAT>");
    TEST_ASSERT_EQUAL(CM1E_ERROR_FILE, cm1e_ec_extend_read(&document, text, strlen(text), &diag));
    TEST_ASSERT_EQUAL_STRING("line 501: more than 500 <Vendor> in one list", diag.text);
    cm1e_ec_extend_free(&document);
    free(text);
}

/* No prefix of a file is a file, and none does harm. */
static void test_truncated_files_are_refused(void)
{
    generate(CM1E_MAPPING_DYNAMIC);
    const size_t whole = file.size - strlen("</EtherCAT>\n");
    for (size_t size = 0; size <= whole; size += 7) {
        cm1e_ec_extend_t document = {0};
        char *copy = malloc(size + 1);
        memcpy(copy, file.bytes, size);
        TEST_ASSERT_NOT_EQUAL(CM1E_OK, cm1e_ec_extend_read(&document, copy, size, &diag));
        cm1e_ec_extend_free(&document);
        free(copy);
    }
}

static void damage_and_read(const cm1e_file_t *good)
{
    char *copy = malloc(good->size);
    memcpy(copy, good->bytes, good->size);
    for (int hits = 1 + pick(4); hits > 0; hits--)
        copy[pick((int)good->size)] = (char)pick(256);
    cm1e_file_t first = {0};
    cm1e_findings_t *findings = NULL;
    memset(&diag, 0, sizeof diag);
    if (cm1e_generate_from(&first, copy, good->size, CM1E_FILE_EC_EXTEND, 0, &diag) == CM1E_OK) {
        expect_round_trip(first.bytes, first.size);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_check_file(&findings, copy, good->size, &diag));
        cm1e_findings_free(findings);
    } else {
        TEST_ASSERT_NOT_EQUAL(0, strlen(diag.text));
    }
    cm1e_file_free(&first);
    free(copy);
}

/* Whatever happens to bytes: an error with a text, or a document that comes back as it was read. */
static void test_random_damage_does_no_harm(void)
{
    generate(CM1E_MAPPING_PROFILE);
    for (int run = 0; run < seed_count(3000); run++) {
        seed = seed_of(run);
        chance_seed(seed);
        damage_and_read(&file);
    }
    seed = 0;
}

/* ---- a file of the world ---------------------------------------------------------------------------------------- */

/* The lines from the root element on, where spelling counts. */
static const char *from_root(const char *text)
{
    const char *root = strstr(text, "<EtherCAT>");
    TEST_ASSERT_NOT_NULL(root);
    return root;
}

/* CM1E_TRIO_SAMPLE: the path of an EC_EXTEND that Trio wrote (docs/TRIO.md); it may not be in this repository. */
static void test_a_file_of_trio_comes_back_from_its_first_element_on(void)
{
    const char *path = getenv("CM1E_TRIO_SAMPLE");
    FILE *sample = path ? fopen(path, "rb") : NULL;
    if (!sample)
        TEST_IGNORE_MESSAGE("CM1E_TRIO_SAMPLE names no file");
    static char text[1 << 20];
    const size_t size = fread(text, 1, sizeof text - 1, sample);
    fclose(sample);
    cm1e_findings_t *findings;
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_generate_from(&file, text, size, CM1E_FILE_EC_EXTEND, 0, &diag), diag.text);
    TEST_ASSERT_EQUAL_STRING(from_root(text), from_root((const char *)file.bytes));
    expect_round_trip(file.bytes, file.size);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_check_file(&findings, text, size, &diag));
    TEST_ASSERT_EQUAL_UINT(0, cm1e_findings_count(findings));
    cm1e_findings_free(findings);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nothing_of_a_file_is_lost);
    RUN_TEST(test_what_real_files_do_is_tolerated);
    RUN_TEST(test_line_numbers_are_those_of_the_file);
    RUN_TEST(test_damaged_files_are_refused_with_their_line);
    RUN_TEST(test_a_list_without_end_is_refused);
    RUN_TEST(test_truncated_files_are_refused);
    RUN_TEST(test_random_damage_does_no_harm);
    RUN_TEST(test_a_file_of_trio_comes_back_from_its_first_element_on);
    return UNITY_END();
}
