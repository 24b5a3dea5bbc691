/* The public functions of cm1e/generate.h: which format a file has, what can be generated, written anew, refused. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "cm1e/generate.h"

static cm1e_diag_t diag;
static cm1e_file_t file, again;
static cm1e_bus_config_t network;

void setUp(void)
{
    diag = (cm1e_diag_t){0};
    cm1e_bus_config_free(&network);
    cm1e_bus_config_init(&network, NULL, 3);
}

void tearDown(void)
{
    cm1e_file_free(&file);
    cm1e_file_free(&again);
}

static cm1e_file_format_t recognise(const char *text)
{
    return cm1e_file_recognise(text, strlen(text));
}

static void test_format_is_seen_in_the_root_element(void)
{
    static const struct {
        const char *text;
        cm1e_file_format_t format;
    } cases[] = {
        {"<EtherCATInfo Version=\"1.6\"/>", CM1E_FILE_ESI},
        {"<?xml version=\"1.0\"?>\r\n<EtherCATInfo>", CM1E_FILE_ESI},
        {"\xEF\xBB\xBF<?xml version=\"1.0\"?><EtherCATInfo\n>", CM1E_FILE_ESI},
        {"<!-- EtherCATInfo <EtherCATConfig> -->\n<?xml version=\"1.0\"?><EtherCAT>", CM1E_FILE_EC_EXTEND},
        {"  <EtherCAT/>", CM1E_FILE_EC_EXTEND},
        {"<EtherCATConfig Version=\"1.3\">", CM1E_FILE_ENI},
        {"<EtherCATConfiguration>", CM1E_FILE_UNKNOWN},
        {"<EtherCATInf", CM1E_FILE_UNKNOWN},
        {"<EtherCATInfo", CM1E_FILE_UNKNOWN},
        {"<html><EtherCATInfo></html>", CM1E_FILE_UNKNOWN},
        {"<!-- never closed <EtherCATInfo>", CM1E_FILE_UNKNOWN},
        {"<?xml", CM1E_FILE_UNKNOWN},
        {"<", CM1E_FILE_UNKNOWN},
        {"", CM1E_FILE_UNKNOWN},
        {"plain text", CM1E_FILE_UNKNOWN},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        TEST_ASSERT_EQUAL_INT_MESSAGE(cases[i].format, recognise(cases[i].text), cases[i].text);
    TEST_ASSERT_EQUAL_INT(CM1E_FILE_UNKNOWN, cm1e_file_recognise(NULL, 0));
}

static void test_format_is_seen_in_utf16_too(void)
{
    static const char text[] = "<?xml version=\"1.0\" encoding=\"UTF-16\"?><EtherCATInfo/>";
    uint8_t wide[2 + 2 * sizeof text] = {0xFF, 0xFE};
    for (size_t i = 0; i + 1 < sizeof text; i++)
        wide[2 + 2 * i] = (uint8_t)text[i];
    TEST_ASSERT_EQUAL_INT(CM1E_FILE_ESI, cm1e_file_recognise(wide, 2 * sizeof text));
    TEST_ASSERT_EQUAL_INT(CM1E_FILE_UNKNOWN, cm1e_file_recognise(wide, 10));
}

static void test_format_of_any_beginning_is_found_without_reading_beyond_it(void)
{
    static const char text[] = "<!-- a --><?xml version=\"1.0\"?><!-- b --><EtherCATConfig a=\"1\">";
    for (size_t size = 0; size < sizeof text; size++) {
        char *exact = malloc(size + 1); /* the sanitizer watches its end */
        memcpy(exact, text, size);
        char *shrunk = realloc(exact, size > 0 ? size : 1);
        const bool whole = size > strlen("<!-- a --><?xml version=\"1.0\"?><!-- b --><EtherCATConfig");
        TEST_ASSERT_EQUAL_INT(whole ? CM1E_FILE_ENI : CM1E_FILE_UNKNOWN, cm1e_file_recognise(shrunk, size));
        free(shrunk);
    }
}

static void test_image_of_an_sii_is_seen_by_its_words(void)
{
    const cm1e_generate_options_t options = {.format = CM1E_FILE_SII};
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_generate(&file, &options, &diag), diag.text);
    TEST_ASSERT_EQUAL_INT(CM1E_FILE_SII, cm1e_file_recognise(file.bytes, file.size));
    file.bytes[14] ^= 1; /* checksum: version and size still say what it is */
    TEST_ASSERT_EQUAL_INT(CM1E_FILE_SII, cm1e_file_recognise(file.bytes, file.size));
    TEST_ASSERT_EQUAL_INT(CM1E_FILE_UNKNOWN, cm1e_file_recognise(file.bytes, 127));
    for (int first = 0; first < 256; first++) /* but for the two marks of UTF-16 */
        for (int second = 0; second < 256; second++) {
            const bool mark = (first == 0xFF && second == 0xFE) || (first == 0xFE && second == 0xFF);
            file.bytes[0] = (uint8_t)first;
            file.bytes[1] = (uint8_t)second;
            TEST_ASSERT_EQUAL_INT(mark ? CM1E_FILE_UNKNOWN : CM1E_FILE_SII, cm1e_file_recognise(file.bytes, file.size));
        }
    memset(file.bytes, 0xFF, file.size); /* an erased EEPROM */
    TEST_ASSERT_EQUAL_INT(CM1E_FILE_UNKNOWN, cm1e_file_recognise(file.bytes, file.size));
}

static void test_every_format_has_a_name(void)
{
    TEST_ASSERT_EQUAL_STRING("unknown", cm1e_file_format_name(CM1E_FILE_UNKNOWN));
    TEST_ASSERT_EQUAL_STRING("ESI", cm1e_file_format_name(CM1E_FILE_ESI));
    TEST_ASSERT_EQUAL_STRING("EC_EXTEND", cm1e_file_format_name(CM1E_FILE_EC_EXTEND));
    TEST_ASSERT_EQUAL_STRING("SII", cm1e_file_format_name(CM1E_FILE_SII));
    TEST_ASSERT_EQUAL_STRING("ENI", cm1e_file_format_name(CM1E_FILE_ENI));
    TEST_ASSERT_EQUAL_STRING("unknown", cm1e_file_format_name((cm1e_file_format_t)99));
    TEST_ASSERT_EQUAL_STRING("unknown", cm1e_file_format_name((cm1e_file_format_t)-1));
}

/* ---- generating ------------------------------------------------------------------------------------------------- */

static const cm1e_file_format_t all_formats[] = {CM1E_FILE_ESI, CM1E_FILE_EC_EXTEND, CM1E_FILE_SII, CM1E_FILE_ENI};
enum { FORMATS = sizeof all_formats / sizeof all_formats[0] };

static void generate(cm1e_file_t *into, const cm1e_generate_options_t *options)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_generate(into, options, &diag), diag.text);
    TEST_ASSERT_EQUAL_UINT8(0, into->bytes[into->size]);
}

static void assert_same_bytes(void)
{
    TEST_ASSERT_EQUAL_UINT(file.size, again.size);
    TEST_ASSERT_EQUAL_INT(0, memcmp(file.bytes, again.bytes, file.size));
}

static void assert_no_error_in(const cm1e_file_t *checked)
{
    cm1e_findings_t *findings = NULL;
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_check_file(&findings, checked->bytes, checked->size, &diag), diag.text);
    for (size_t i = 0; i < cm1e_findings_count(findings); i++)
        TEST_FAIL_MESSAGE(cm1e_findings_at(findings, i)->text);
    TEST_ASSERT_NULL(cm1e_findings_at(findings, 0));
    cm1e_findings_free(findings);
}

/* Every format, layout, mapping, order and firmware: the same bytes twice, recognised, without a finding, and the same
 * after reading and writing. */
static void test_what_is_generated_comes_back_from_its_reader_byte_for_byte(void)
{
    static const char *const firmwares[] = {"1.2.0", "1.3.0", "1.3.2", "1.3.3", "1.3.4", "1.3.5"};
    for (unsigned n = 0; n < FORMATS * 2 * 4 * 2 * 6; n++) {
        const unsigned format = n % FORMATS, layout = n / FORMATS % 2, mapping = n / FORMATS / 2 % 4;
        const unsigned order = n / FORMATS / 8 % 2, firmware = n / FORMATS / 16;
        cm1e_device_options_t device = {.mapping = (cm1e_mapping_t)mapping, .order = (cm1e_pdo_order_t)order};
        snprintf(device.firmware, sizeof device.firmware, "%s", firmwares[firmware]);
        network.sim_pdo_order = device.order;
        for (unsigned axis = 0; axis < network.axis_count; axis++) {
            network.axes[axis].mapping = device.mapping;
            snprintf(network.axes[axis].firmware, sizeof network.axes[axis].firmware, "%s", firmwares[firmware]);
        }
        const cm1e_generate_options_t options = {
            .format = all_formats[format], .layout = (cm1e_esi_layout_t)layout, .devices = &device, .device_count = 1,
            .network = &network};
        generate(&file, &options);
        generate(&again, &options);
        assert_same_bytes();
        TEST_ASSERT_EQUAL_INT(options.format, cm1e_file_recognise(file.bytes, file.size));
        assert_no_error_in(&file);
        cm1e_file_free(&again);
        const cm1e_error_t error = cm1e_generate_from(&again, file.bytes, file.size, options.format, 0, &diag);
        TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, error, diag.text);
        assert_same_bytes();
        tearDown();
    }
}

static void test_default_is_one_motor_of_the_newest_firmware(void)
{
    static const cm1e_device_options_t device = {.firmware = "1.3.5"};
    for (unsigned n = 0; n < 3; n++) {
        generate(&file, &(cm1e_generate_options_t){.format = all_formats[n]});
        generate(&again,
                 &(cm1e_generate_options_t){.format = all_formats[n], .devices = &device, .device_count = 1});
        assert_same_bytes();
        tearDown();
    }
}

static void test_sii_out_of_an_esi_is_the_generated_one(void)
{
    generate(&file, &(cm1e_generate_options_t){.format = CM1E_FILE_SII});
    cm1e_file_t esi;
    generate(&esi, &(cm1e_generate_options_t){.format = CM1E_FILE_ESI});
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_generate_from(&again, esi.bytes, esi.size, CM1E_FILE_SII, 0, &diag),
                                  diag.text);
    assert_no_error_in(&again);
    TEST_ASSERT_EQUAL_UINT(file.size, again.size);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(file.bytes + 0x10, again.bytes + 0x10, 16); /* identity */
    cm1e_file_free(&again);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_NOT_FOUND,
                          cm1e_generate_from(&again, esi.bytes, esi.size, CM1E_FILE_SII, 1, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "device 2"));
    cm1e_file_free(&esi);
}

static void test_file_without_known_configuration_words_warns(void)
{
    generate(&file, &(cm1e_generate_options_t){.format = CM1E_FILE_SII});
    TEST_ASSERT_NOT_NULL(strstr(file.warning, "do not write an EEPROM"));
    cm1e_device_options_t device = {.config_data = {0x05, 0x0E}, .config_data_size = 14};
    generate(&again, &(cm1e_generate_options_t){.format = CM1E_FILE_SII, .devices = &device, .device_count = 1});
    TEST_ASSERT_EQUAL_STRING("", again.warning);
}

/* Neither by way of an image of ours nor by way of an ESI do guessed words become those of a real device. */
static void test_guessed_configuration_words_stay_guessed(void)
{
    static const uint8_t guesses[][14] = {
        {0}, {0x05}, {[0] = 0x05, [8] = 0x34, [9] = 0x12},
        {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF}};
    for (size_t i = 0; i < sizeof guesses / sizeof guesses[0]; i++) {
        cm1e_device_options_t device = {.config_data_size = 14};
        memcpy(device.config_data, guesses[i], sizeof guesses[i]);
        generate(&file, &(cm1e_generate_options_t){.format = CM1E_FILE_ESI, .devices = &device, .device_count = 1});
        TEST_ASSERT_NOT_NULL(strstr(file.warning, "do not write an EEPROM"));
        TEST_ASSERT_NULL(strstr((char *)file.bytes, "<ConfigData>"));
        cm1e_file_free(&file);
    }
    generate(&file, &(cm1e_generate_options_t){.format = CM1E_FILE_SII});
    const cm1e_file_format_t into[] = {CM1E_FILE_ESI, CM1E_FILE_SII};
    for (size_t i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_generate_from(&again, file.bytes, file.size, into[i], 0, &diag),
                                      diag.text);
        TEST_ASSERT_NOT_NULL(strstr(again.warning, "do not write an EEPROM"));
        TEST_ASSERT_NULL(i == 0 ? strstr((char *)again.bytes, "<ConfigData>") : NULL);
        cm1e_file_free(&again);
    }
}

/* ---- refusals --------------------------------------------------------------------------------------------------- */

static void refuse(cm1e_error_t error, const char *word, const cm1e_generate_options_t *options)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(error, cm1e_generate(&file, options, &diag), diag.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, word), diag.text);
    TEST_ASSERT_NULL(file.bytes);
}

#define ONE(...) .devices = &(cm1e_device_options_t){__VA_ARGS__}, .device_count = 1

static void test_options_that_do_not_fit_are_refused_with_the_reason(void)
{
    const cm1e_device_options_t two[2] = {{0}};
    refuse(CM1E_ERROR_INVALID_ARGUMENT, "format", &(cm1e_generate_options_t){0});
    refuse(CM1E_ERROR_CONFIG, "no device", &(cm1e_generate_options_t){.format = CM1E_FILE_ESI, .devices = two});
    refuse(CM1E_ERROR_CONFIG, "flat and modular",
           &(cm1e_generate_options_t){.format = CM1E_FILE_ESI, .layout = (cm1e_esi_layout_t)7});
    refuse(CM1E_ERROR_CONFIG, "one device",
           &(cm1e_generate_options_t){.format = CM1E_FILE_SII, .devices = two, .device_count = 2});
    for (unsigned n = 0; n < 3; n++) {
        const cm1e_file_format_t format = all_formats[n];
        refuse(CM1E_ERROR_CONFIG, "1.3.5", &(cm1e_generate_options_t){.format = format, ONE(.firmware = "1.3.1")});
        refuse(CM1E_ERROR_CONFIG, "vendor", &(cm1e_generate_options_t){.format = format, ONE(.vendor_id = 1)});
        refuse(CM1E_ERROR_CONFIG, "mapping", &(cm1e_generate_options_t){.format = format, ONE(.mapping = 4)});
        refuse(CM1E_ERROR_CONFIG, "model", &(cm1e_generate_options_t){.format = format, ONE(.model = 5)});
        refuse(CM1E_ERROR_CONFIG, "its maker",
               &(cm1e_generate_options_t){.format = format, ONE(.model = CM1E_DEVICE_CIA402)});
        refuse(CM1E_ERROR_CONFIG, "14 bytes", &(cm1e_generate_options_t){.format = format, ONE(.config_data_size = 7)});
        refuse(CM1E_ERROR_CONFIG, "vendor",
               &(cm1e_generate_options_t){.format = format, ONE(.model = CM1E_DEVICE_EB01)});
    }
}

static void test_alias_and_serial_number_belong_to_an_sii(void)
{
    for (unsigned n = 0; n < 2; n++) {
        refuse(CM1E_ERROR_CONFIG, "SII", &(cm1e_generate_options_t){.format = all_formats[n], ONE(.alias = 1)});
        refuse(CM1E_ERROR_CONFIG, "SII", &(cm1e_generate_options_t){.format = all_formats[n], ONE(.serial_number = 1)});
    }
    cm1e_device_options_t device = {.config_data = {8, 12, 0x81, 0x66, 0, 0, 0, 0, 0x34, 0x12}, .config_data_size = 14};
    generate(&file, &(cm1e_generate_options_t){.format = CM1E_FILE_SII, .devices = &device, .device_count = 1});
    TEST_ASSERT_EQUAL_HEX8_ARRAY(device.config_data, file.bytes, 14);
    cm1e_file_free(&file);
    generate(&file, &(cm1e_generate_options_t){.format = CM1E_FILE_ESI, .devices = &device, .device_count = 1});
    TEST_ASSERT_NOT_NULL(strstr((const char *)file.bytes, "<ConfigData>080C8166000000000000"));
}

static void test_eni_needs_a_network_whose_places_are_known(void)
{
    refuse(CM1E_ERROR_CONFIG, "network", &(cm1e_generate_options_t){.format = CM1E_FILE_ENI});
    network.axes[1].address = 5;
    refuse(CM1E_ERROR_CONFIG, "scan", &(cm1e_generate_options_t){.format = CM1E_FILE_ENI, .network = &network});
    network.axes[1].address_kind = CM1E_ADDRESS_EXPLICIT_ID;
    refuse(CM1E_ERROR_CONFIG, "scan", &(cm1e_generate_options_t){.format = CM1E_FILE_ENI, .network = &network});
    network.axes[1].address_kind = CM1E_ADDRESS_ALIAS;
    generate(&file, &(cm1e_generate_options_t){.format = CM1E_FILE_ENI, .network = &network});
}

static void test_axes_in_any_order_stand_in_the_eni_in_the_order_of_the_wire(void)
{
    for (int i = 0; i < 3; i++)
        network.axes[i].address = (uint16_t)(i + 1);
    generate(&file, &(cm1e_generate_options_t){.format = CM1E_FILE_ENI, .network = &network});
    const cm1e_axis_config_t first = network.axes[0];
    network.axes[0] = network.axes[2];
    network.axes[2] = first;
    generate(&again, &(cm1e_generate_options_t){.format = CM1E_FILE_ENI, .network = &network});
    assert_same_bytes();
}

/* What only its maker knows of, and pictures, are not taken over. The names stand behind the other warning. */
static void test_what_a_file_loses_is_named(void)
{
    static const char own[] = "<Own Foo=\"1\"><Part>1</Part></Own><ImageData16x14>424D</ImageData16x14>", end[] = "</Device>";
    static char text[1 << 20];
    generate(&file, &(cm1e_generate_options_t){.format = CM1E_FILE_ESI});
    const char *place = strstr((const char *)file.bytes, end);
    const int before = (int)(place - (const char *)file.bytes);
    const int size = snprintf(text, sizeof text, "%.*s%s%s", before, (const char *)file.bytes, own, place);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_generate_from(&again, file.bytes, file.size, CM1E_FILE_ESI, 0, &diag));
    TEST_ASSERT_NULL(strstr(again.warning, "does not have"));
    cm1e_file_free(&again);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_generate_from(&again, text, (size_t)size, CM1E_FILE_ESI, 0, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(again.warning, "the new file does not have Device/Own, Device/ImageData16x14"),
                                 again.warning);
    cm1e_file_free(&again);
    char *at = text + before;
    for (int n = 0; n < 700; n++)
        at += sprintf(at, "<LongNameOfAnElementWithNumber%d/>", n);
    strcpy(at, place);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_generate_from(&again, text, strlen(text), CM1E_FILE_ESI, 0, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(again.warning, " and 5"), again.warning);
}

static void test_unknown_files_are_refused(void)
{
    cm1e_findings_t *findings = NULL;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FILE, cm1e_check_file(&findings, "nothing", 7, &diag));
    TEST_ASSERT_NULL(findings);
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "EtherCATInfo"));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FILE, cm1e_generate_from(&file, "nothing", 7, CM1E_FILE_ESI, 0, &diag));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FILE, cm1e_generate_from(&file, NULL, 0, CM1E_FILE_ESI, 0, &diag));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_generate_from(&file, NULL, 7, CM1E_FILE_ESI, 0, &diag));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_generate_from(NULL, "nothing", 7, CM1E_FILE_ESI, 0, &diag));
    generate(&file, &(cm1e_generate_options_t){.format = CM1E_FILE_ESI});
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED,
                          cm1e_generate_from(&again, file.bytes, file.size, CM1E_FILE_ENI, 0, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "ENI"));
    cm1e_findings_free(NULL);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_format_is_seen_in_the_root_element);
    RUN_TEST(test_format_is_seen_in_utf16_too);
    RUN_TEST(test_format_of_any_beginning_is_found_without_reading_beyond_it);
    RUN_TEST(test_image_of_an_sii_is_seen_by_its_words);
    RUN_TEST(test_every_format_has_a_name);
    RUN_TEST(test_what_is_generated_comes_back_from_its_reader_byte_for_byte);
    RUN_TEST(test_default_is_one_motor_of_the_newest_firmware);
    RUN_TEST(test_sii_out_of_an_esi_is_the_generated_one);
    RUN_TEST(test_file_without_known_configuration_words_warns);
    RUN_TEST(test_guessed_configuration_words_stay_guessed);
    RUN_TEST(test_options_that_do_not_fit_are_refused_with_the_reason);
    RUN_TEST(test_alias_and_serial_number_belong_to_an_sii);
    RUN_TEST(test_eni_needs_a_network_whose_places_are_known);
    RUN_TEST(test_axes_in_any_order_stand_in_the_eni_in_the_order_of_the_wire);
    RUN_TEST(test_what_a_file_loses_is_named);
    RUN_TEST(test_unknown_files_are_refused);
    return UNITY_END();
}
