/* The reader of SII images: what it takes from a good one, how it names what is wrong, that nothing in a bad one leads
 * it astray, and that writing and reading are each other's reverse. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "description/describe.h"
#include "description/sii_image.h"
#include "unity.h"

enum { BYTES = 0x4000 };
static uint8_t image[BYTES];
static size_t size;
static cm1e_description_file_t described, file;
static cm1e_findings_t *findings;
static cm1e_diag_t diag;

void setUp(void)
{
    findings = cm1e_findings_create();
    diag = (cm1e_diag_t){0};
}
void tearDown(void)
{
    cm1e_description_file_free(&described);
    cm1e_description_file_free(&file);
    cm1e_findings_free(findings);
}

/* ---- images ----------------------------------------------------------------------------------------------------- */

static const cm1e_description_t *describe(const cm1e_device_options_t *options)
{
    cm1e_description_file_free(&described);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_describe(&described, options, CM1E_ESI_FLAT, &diag), diag.text);
    return &described.devices.at[0];
}

static void write(const cm1e_description_t *device)
{
    size = cm1e_sii_write(image, sizeof image, device, &diag);
    TEST_ASSERT_EQUAL_size_t_MESSAGE(CM1E_SII_SIZE, size, diag.text);
}

static const cm1e_description_t *read(void)
{
    cm1e_description_file_free(&file);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_sii_read(&file, image, size, findings, &diag), diag.text);
    TEST_ASSERT_EQUAL_size_t(1, file.devices.count);
    return &file.devices.at[0];
}

static void expect_no_findings(void)
{
    for (size_t i = 0; i < cm1e_findings_count(findings); i++)
        TEST_FAIL_MESSAGE(cm1e_findings_at(findings, i)->text);
}

/* Byte address of the header of the nth category of a type, 0 = first. */
static size_t place_of(uint16_t type, unsigned n)
{
    cm1e_sii_category_t category;
    for (size_t at = CM1E_SII_HEADER_BYTES;; at = category.start + category.bytes) {
        TEST_ASSERT_TRUE(cm1e_sii_category_at(&category, image, size, at));
        if (category.type == type && n-- == 0)
            return at;
        TEST_ASSERT_NOT_EQUAL_UINT16(CM1E_SII_CATEGORY_END, category.type);
    }
}

/* An image made by hand: the fixed words of a device without mailbox, categories one by one, the end mark. */
static void begin_image(void)
{
    memset(image, 0, sizeof image);
    image[14] = cm1e_sii_crc8(image, 14);
    cm1e_put_u32(image + 0x10, 0x1234);
    cm1e_put_u16(image + 0x7C, BYTES / 128 - 1);
    cm1e_put_u16(image + 0x7E, 1);
    size = CM1E_SII_HEADER_BYTES;
}

static void put_category(uint16_t type, const void *bytes, size_t count)
{
    cm1e_put_u16(image + size, type);
    cm1e_put_u16(image + size + 2, (uint16_t)(count / 2));
    memcpy(image + size + 4, bytes, count);
    size += 4 + count;
}

static void end_image(void)
{
    cm1e_put_u16(image + size, CM1E_SII_CATEGORY_END);
    size += 2;
}

/* ---- there and back --------------------------------------------------------------------------------------------- */

static void expect_same_text(const char *expected, const char *actual)
{
    TEST_ASSERT_EQUAL_STRING(expected ? expected : "", actual ? actual : "");
}

static void expect_same_pdos(const cm1e_description_t *expected, const cm1e_description_t *actual, bool transmit)
{
    size_t at = 0;
    for (size_t i = 0; i < expected->pdos.count; i++) {
        const cm1e_described_pdo_t *left = &expected->pdos.at[i];
        if (left->transmit != transmit)
            continue;
        while (at < actual->pdos.count && actual->pdos.at[at].transmit != transmit)
            at++;
        TEST_ASSERT_LESS_THAN_size_t(actual->pdos.count, at);
        const cm1e_described_pdo_t *right = &actual->pdos.at[at++];
        TEST_ASSERT_EQUAL_HEX16(left->index, right->index);
        expect_same_text(left->name, right->name);
        TEST_ASSERT_EQUAL_INT(left->sync_manager, right->sync_manager);
        TEST_ASSERT_EQUAL(left->fixed, right->fixed);
        TEST_ASSERT_EQUAL(left->mandatory, right->mandatory);
        TEST_ASSERT_EQUAL(left->is_virtual, right->is_virtual);
        TEST_ASSERT_EQUAL(left->depends_on_slot, right->depends_on_slot);
        TEST_ASSERT_EQUAL_size_t(left->entries.count, right->entries.count);
        for (size_t e = 0; e < left->entries.count; e++) {
            TEST_ASSERT_EQUAL_HEX16(left->entries.at[e].index, right->entries.at[e].index);
            TEST_ASSERT_EQUAL_HEX8(left->entries.at[e].subindex, right->entries.at[e].subindex);
            TEST_ASSERT_EQUAL_UINT32(left->entries.at[e].bits, right->entries.at[e].bits);
            TEST_ASSERT_EQUAL_STRING(left->entries.at[e].type, right->entries.at[e].type);
            expect_same_text(left->entries.at[e].name, right->entries.at[e].name);
        }
    }
}

static void expect_same_channels(const cm1e_description_t *expected, const cm1e_description_t *actual)
{
    TEST_ASSERT_EQUAL_size_t(expected->fmmus.count, actual->fmmus.count);
    for (size_t i = 0; i < expected->fmmus.count; i++)
        TEST_ASSERT_EQUAL_INT(expected->fmmus.at[i].use, actual->fmmus.at[i].use);
    TEST_ASSERT_EQUAL_size_t(expected->sync_managers.count, actual->sync_managers.count);
    for (size_t i = 0; i < expected->sync_managers.count; i++) {
        const cm1e_described_sync_manager_t *left = &expected->sync_managers.at[i];
        const cm1e_described_sync_manager_t *right = &actual->sync_managers.at[i];
        TEST_ASSERT_EQUAL_INT(left->use, right->use);
        TEST_ASSERT_EQUAL_HEX16(left->start, right->start);
        TEST_ASSERT_EQUAL_UINT16(left->length, right->length);
        TEST_ASSERT_TRUE(right->length_given);
        TEST_ASSERT_EQUAL_HEX8(left->control, right->control);
        TEST_ASSERT_EQUAL_HEX8(left->enable, right->enable);
    }
    TEST_ASSERT_EQUAL_size_t(expected->channels.count, actual->channels.count);
    for (size_t i = 0; i < expected->channels.count; i++)
        TEST_ASSERT_EQUAL_INT32(expected->channels.at[i].profile_no, actual->channels.at[i].profile_no);
}

static void expect_same_dc_modes(const cm1e_description_t *expected, const cm1e_description_t *actual)
{
    TEST_ASSERT_EQUAL_size_t(expected->dc_modes.count, actual->dc_modes.count);
    for (size_t i = 0; i < expected->dc_modes.count; i++) {
        const cm1e_dc_mode_t *left = &expected->dc_modes.at[i], *right = &actual->dc_modes.at[i];
        expect_same_text(left->name, right->name);
        expect_same_text(left->text, right->text);
        TEST_ASSERT_EQUAL_HEX16(left->assign_activate, right->assign_activate);
        TEST_ASSERT_EQUAL(left->sync0_given, right->sync0_given);
        TEST_ASSERT_EQUAL(left->sync1_given, right->sync1_given);
        TEST_ASSERT_EQUAL_INT32(left->sync0_cycle_ns, right->sync0_cycle_ns);
        TEST_ASSERT_EQUAL_INT32(left->sync0_factor, right->sync0_factor);
        TEST_ASSERT_EQUAL_INT32(left->sync0_shift_ns, right->sync0_shift_ns);
        TEST_ASSERT_EQUAL_INT32(left->sync1_factor, right->sync1_factor);
        TEST_ASSERT_EQUAL_INT32(left->sync1_shift_ns, right->sync1_shift_ns);
    }
}

/* What an SII can hold. */
static void expect_same(const cm1e_description_t *expected, const cm1e_description_t *actual)
{
    TEST_ASSERT_EQUAL_HEX32(expected->vendor_id, actual->vendor_id);
    TEST_ASSERT_EQUAL_HEX32(expected->product_code, actual->product_code);
    TEST_ASSERT_EQUAL_HEX32(expected->revision, actual->revision);
    expect_same_text(expected->type, actual->type);
    expect_same_text(expected->name, actual->name);
    expect_same_text(expected->group, actual->group);
    expect_same_text(expected->physics, actual->physics);
    TEST_ASSERT_EQUAL(expected->no_lrw, actual->no_lrw);
    TEST_ASSERT_EQUAL(expected->identification_reg134, actual->identification_reg134);
    cm1e_mailbox_protocols_t left = expected->mailbox, right = actual->mailbox;
    left.place = right.place = 0;
    left.segmented_sdo = false; /* not in an SII */
    TEST_ASSERT_EQUAL_MEMORY(&left, &right, sizeof left);
    TEST_ASSERT_EQUAL_UINT32(expected->eeprom.byte_size, actual->eeprom.byte_size);
    TEST_ASSERT_EQUAL_MEMORY(expected->eeprom.config_data.data, actual->eeprom.config_data.data,
                             expected->eeprom.config_data.size);
    if (expected->eeprom.bootstrap.data)
        TEST_ASSERT_EQUAL_MEMORY(expected->eeprom.bootstrap.data, actual->eeprom.bootstrap.data, 8);
    TEST_ASSERT_EQUAL_HEX16(expected->eeprom.mailbox_out_start, actual->eeprom.mailbox_out_start);
    TEST_ASSERT_EQUAL_UINT16(expected->eeprom.mailbox_out_length, actual->eeprom.mailbox_out_length);
    TEST_ASSERT_EQUAL_HEX16(expected->eeprom.mailbox_in_start, actual->eeprom.mailbox_in_start);
    TEST_ASSERT_EQUAL_UINT16(expected->eeprom.mailbox_in_length, actual->eeprom.mailbox_in_length);
    TEST_ASSERT_EQUAL_UINT16(expected->eeprom.alias, actual->eeprom.alias);
    TEST_ASSERT_EQUAL_UINT32(expected->eeprom.serial_number, actual->eeprom.serial_number);
    TEST_ASSERT_EQUAL_UINT16(expected->eeprom.version, actual->eeprom.version);
    expect_same_channels(expected, actual);
    TEST_ASSERT_EQUAL_size_t(expected->pdos.count, actual->pdos.count);
    expect_same_pdos(expected, actual, false);
    expect_same_pdos(expected, actual, true);
}

static void expect_same_bytes(void)
{
    static uint8_t again[BYTES];
    memset(again, 0xAA, sizeof again);
    TEST_ASSERT_EQUAL_size_t_MESSAGE(size, cm1e_sii_write(again, sizeof again, &file.devices.at[0], &diag), diag.text);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(image, again, size);
}

static void test_every_device_comes_back_as_it_was_written(void)
{
    for (int f = 0; f < CM1E_FIRMWARE_COUNT; f++)
        for (int choice = 0; choice < 32; choice++) {
            cm1e_device_options_t options = {
                .order = (cm1e_pdo_order_t)(choice & 1), .mapping = (cm1e_mapping_t)(choice >> 1 & 3),
                .distributed_clocks = choice & 8, .complete_access = choice & 16,
                .alias = (uint16_t)(choice * 1000), .serial_number = 0x80000000u + (unsigned)choice,
                .config_data_size = choice & 16 ? 14 : 0, .config_data = {0x80, 0x0E, 0, 0xCC, 0x88, 0x13},
            };
            strcpy(options.firmware, cm1e_firmware_info((cm1e_firmware_t)f)->version);
            const cm1e_description_t *device = describe(&options);
            write(device);
            const cm1e_description_t *again = read();
            expect_no_findings();
            expect_same(device, again);
            if (options.distributed_clocks)
                expect_same_dc_modes(device, again);
            else /* "SM Synchronous" alone says nothing */
                TEST_ASSERT_EQUAL_size_t(0, again->dc_modes.count);
            expect_same_bytes();
        }
}

static void test_simple_devices_come_back_as_they_were_written(void)
{
    for (int kind = CM1E_SIM_IO_MODULE; kind <= CM1E_SIM_IO_COUPLER; kind++) {
        tearDown();
        setUp();
        cm1e_describe_io(&described, (cm1e_sim_io_t)kind);
        write(&described.devices.at[0]);
        const cm1e_description_t *again = read();
        expect_no_findings();
        expect_same(&described.devices.at[0], again);
        TEST_ASSERT_FALSE(again->mailbox.present);
        expect_same_bytes();
    }
}

/* All that our own devices do not make use of. */
static void test_what_other_devices_have_comes_back_too(void)
{
    cm1e_description_t device = *describe(&(cm1e_device_options_t){.distributed_clocks = true});
    device.mailbox = (cm1e_mailbox_protocols_t){.present = true, .coe = true, .eoe = true, .soe = true, .voe = true,
                                                .aoe = true, .pdo_config = true, .pdo_upload = true};
    device.no_lrw = true;
    device.identification_reg134 = false;
    device.physics = "Y HK";
    device.name = "\xC3\x84ndern um 5 \xC2\xB5m";
    device.channels.count = 0;
    device.pdos.at[1].mandatory = device.pdos.at[2].is_virtual = device.pdos.at[3].depends_on_slot = true;
    device.pdos.at[1].fixed = false;
    device.pdos.at[1].sync_manager = 7;
    device.pdos.at[2].entries.at[0] = (cm1e_described_pdo_entry_t){.bits = 255, .type = ""}; /* a gap */
    device.pdos.at[2].entries.at[1].type = "BIT3";
    device.pdos.at[2].entries.at[1].bits = 3;
    device.pdos.at[2].entries.at[2].type = "STRING(4)";
    device.fmmus.at[1].use = CM1E_FMMU_UNUSED;
    device.sync_managers.at[3].enable = 0;
    device.dc_modes.at[1] = (cm1e_dc_mode_t){
        .name = "DC", .text = NULL, .assign_activate = 0x0700, .sync0_given = true, .sync1_given = true,
        .sync0_cycle_ns = 500000, .sync0_shift_ns = -1000, .sync0_factor = -2, .sync1_factor = 3,
        .sync1_shift_ns = 2000};
    device.eeprom.byte_size = 4096;
    size = cm1e_sii_write(image, sizeof image, &device, &diag);
    TEST_ASSERT_EQUAL_size_t_MESSAGE(4096, size, diag.text);
    const cm1e_description_t *again = read();
    expect_no_findings();
    expect_same(&device, again);
    expect_same_dc_modes(&device, again);
    TEST_ASSERT_NULL(again->dc_modes.at[1].text);
    TEST_ASSERT_NULL(again->pdos.at[4 + 2].entries.at[0].name); /* the RxPDOs come second */
    expect_same_bytes();
}

/* ---- other people's images -------------------------------------------------------------------------------------- */

static const uint8_t general[32] = {1, 0, 2, 3, [11] = 0x02, [16] = 0x11};

/* Another order, one category for each PDO, some that nobody knows, strings last; it ends behind the end mark. */
static void test_categories_may_stand_in_any_order(void)
{
    static const uint8_t first[16] = {0x00, 0x1A, 1, 1, 0, 3, 0, 0, 0x00, 0x60, 1, 2, 5, 8, 0, 0};
    static const uint8_t second[16] = {0x01, 0x1A, 1, 0xFF, 0, 0, 0, 0, 0x00, 0x60, 2, 0, 0, 4, 0, 0};
    begin_image();
    put_category(0x8001, "of the maker", 12);
    put_category(50, first, sizeof first);
    put_category(0, "", 0);
    put_category(30, general, sizeof general);
    put_category(20, "types", 6);
    put_category(50, second, sizeof second);
    put_category(10, "\003\005group\002on\004na\0e", 16);
    end_image();
    const cm1e_description_t *device = read();
    TEST_ASSERT_EQUAL_STRING("group", device->group);
    TEST_ASSERT_EQUAL_STRING("on", device->type);
    TEST_ASSERT_EQUAL_STRING("na", device->name); /* a zero ends it */
    TEST_ASSERT_TRUE(device->no_lrw);
    TEST_ASSERT_EQUAL_STRING("YY", device->physics);
    TEST_ASSERT_EQUAL_size_t(2, device->pdos.count);
    TEST_ASSERT_EQUAL_HEX16(0x1A01, device->pdos.at[1].index);
    TEST_ASSERT_EQUAL_INT(CM1E_NO_SYNC_MANAGER, device->pdos.at[1].sync_manager);
    TEST_ASSERT_EQUAL_STRING("on", device->pdos.at[0].entries.at[0].name);
    TEST_ASSERT_EQUAL_STRING("USINT", device->pdos.at[0].entries.at[0].type);
    TEST_ASSERT_EQUAL_UINT32(1, cm1e_description_process_bytes(device, 1));
    TEST_ASSERT_EQUAL_size_t(1, cm1e_findings_count(findings)); /* the second category of TxPDOs */
    TEST_ASSERT_FALSE(device->mailbox.present);
    TEST_ASSERT_EQUAL_HEX32(0x1234, file.vendor_id);
}

/* The first one counts, as for most masters; process data adds up. */
static void test_a_second_category_of_a_kind_adds_process_data_only(void)
{
    static const uint8_t manager[8] = {0x00, 0x11, 1, 0, 0x64, 0, 1, 3}, pdo[8] = {0x00, 0x16, 0, 2};
    static const uint8_t mode[24] = {[14] = 0x00, 0x03}, fmmu[2] = {1, 2};
    begin_image();
    for (int n = 0; n < 2; n++) {
        put_category(10, n ? "\001\002no" : "\001\002on", 4);
        put_category(30, general, sizeof general);
        put_category(40, fmmu, sizeof fmmu);
        put_category(41, manager, sizeof manager);
        put_category(51, pdo, sizeof pdo);
        put_category(60, mode, sizeof mode);
    }
    end_image();
    const cm1e_description_t *device = read();
    TEST_ASSERT_EQUAL_STRING("on", device->group);
    TEST_ASSERT_EQUAL_size_t(2, device->fmmus.count);
    TEST_ASSERT_EQUAL_size_t(1, device->sync_managers.count);
    TEST_ASSERT_EQUAL_size_t(2, device->pdos.count);
    TEST_ASSERT_EQUAL_size_t(2, device->dc_modes.count);
}

static void test_protocols_that_nobody_knows_make_no_mailbox(void)
{
    begin_image();
    cm1e_put_u16(image + 0x38, 0x4800);
    end_image();
    TEST_ASSERT_FALSE(read()->mailbox.present);
    cm1e_put_u16(image + 0x38, 0x0001);
    TEST_ASSERT_TRUE(read()->mailbox.present);
}

static void test_without_general_string_1_is_the_name(void)
{
    begin_image();
    put_category(10, "\002\004name\005other", 12);
    end_image();
    TEST_ASSERT_EQUAL_STRING("name", read()->name);
    expect_no_findings();
    begin_image();
    end_image();
    TEST_ASSERT_EQUAL_STRING("", read()->name);
    expect_no_findings();
}

/* Further ones are those of other devices in the same list. */
static void test_devices_add_up_in_a_file(void)
{
    begin_image();
    end_image();
    read();
    cm1e_put_u32(image + 0x10, 0x5678);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_sii_read(&file, image, size, NULL, NULL));
    TEST_ASSERT_EQUAL_size_t(2, file.devices.count);
    TEST_ASSERT_EQUAL_HEX32(0x5678, file.devices.at[1].vendor_id);
    TEST_ASSERT_EQUAL_HEX32(0x1234, file.vendor_id);
}

static void test_sizes_that_no_image_has_are_refused(void)
{
    begin_image();
    static const size_t sizes[] = {0, 1, CM1E_SII_HEADER_BYTES - 1, CM1E_SII_SIZE_MAX + 1u, SIZE_MAX};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FILE, cm1e_sii_read(&file, image, sizes[i], findings, &diag));
        TEST_ASSERT_NOT_NULL(strstr(diag.text, "not an SII image"));
        TEST_ASSERT_EQUAL_size_t(0, file.devices.count);
    }
}

/* ---- rules ------------------------------------------------------------------------------------------------------ */

static void wrong_checksum(void) { image[1] ^= 0x80; }
static void cut_within_a_category(void) { size = place_of(51, 0) + 4 + 20; }
static void cut_before_the_end(void) { size = place_of(CM1E_SII_CATEGORY_END, 0); }
static void cut_within_a_header(void) { size = place_of(51, 0) + 2; }
static void small_eeprom(void) { cm1e_put_u16(image + 0x7C, 3); }
static void repeated_category(void)
{
    size = place_of(CM1E_SII_CATEGORY_END, 0);
    put_category(41, image + place_of(41, 0) + 4, 32);
    end_image();
}
static void missing_string(void) { image[place_of(30, 0) + 4 + 3] = 200; }
static void missing_string_of_an_entry(void) { image[place_of(50, 0) + 4 + 8 + 3] = 199; }
static void control_character(void) { image[place_of(10, 0) + 4 + 2] = 0x1B; }
static void unknown_type(void) { image[place_of(50, 0) + 4 + 8 + 4] = 0x7F; }
static void mailbox_elsewhere(void) { cm1e_put_u16(image + 0x30, 0x1800); }
static void mailbox_of_another_length(void) { cm1e_put_u16(image + place_of(41, 0) + 4 + 8 + 2, 64); }
static void foe_in_general_only(void) { cm1e_put_u16(image + 0x38, 0x04); }
static void eoe_in_the_header_only(void) { cm1e_put_u16(image + 0x38, 0x0E); }
static void coe_in_the_header_only(void) { image[place_of(30, 0) + 4 + 5] = 0; }
/* A category whose length is true but too short for what it announces. */
static void shorten(uint16_t type, size_t bytes)
{
    const size_t at = place_of(type, 0), length = 2u * cm1e_get_u16(image + at + 2);
    memmove(image + at + 4 + length - bytes, image + at + 4 + length, sizeof image - (at + 4 + length));
    cm1e_put_u16(image + at + 2, (uint16_t)((length - bytes) / 2));
}
static void short_strings(void) { image[place_of(10, 0) + 4] += 2; } /* one could be the padding */
static void short_last_string(void)
{
    begin_image();
    put_category(10, "\001\007abcdef", 8);
    end_image();
}
static void short_general(void) { shorten(30, 4); }
static void short_sync_managers(void) { shorten(41, 4); }
static void short_pdo_entry(void) { shorten(50, 4); }
static void short_pdos(void) { shorten(51, 8); }
static void long_pdos(void)
{
    begin_image();
    put_category(50, "\x00\x1A\x00\xFF\x00\x00\x00\x00\x01\x1A\x00\xFF", 12);
    end_image();
}
static void short_dc(void) { shorten(60, 2); }

/* Every rule about images, each broken in that way only. */
static void test_every_rule_finds_what_breaks_it_and_nothing_else(void)
{
    static const struct {
        void (*spoil)(void);
        const char *rule;
        bool is_error;
        const char *text;
    } cases[] = {
        {wrong_checksum, "sii-checksum", true, "0x"},
        {cut_within_a_category, "sii-category-length", true, "type 51 states"},
        {cut_before_the_end, "sii-no-end", true, "0xFFFF"},
        {cut_within_a_header, "sii-no-end", true, "0xFFFF"},
        {small_eeprom, "sii-size", true, "has 512 bytes"},
        {repeated_category, "sii-category-twice", false, "SyncM"},
        {missing_string, "sii-string-missing", true, "string 200"},
        {missing_string_of_an_entry, "sii-string-missing", true, "string 199"},
        {control_character, "sii-string-text", false, "\"?M1-E\""},
        {unknown_type, "sii-data-type", false, "0x7F"},
        {mailbox_elsewhere, "sii-mailbox", true, "0x1800"},
        {mailbox_of_another_length, "sii-mailbox", true, "mailbox in"},
        {foe_in_general_only, "sii-protocols", false, "FoE: not supported by word 0x1C, supported"},
        {eoe_in_the_header_only, "sii-protocols", false, "EoE: supported"},
        {coe_in_the_header_only, "sii-protocols", false, "CoE: supported"},
        {short_strings, "sii-incomplete", true, "Strings"},
        {short_last_string, "sii-incomplete", true, "Strings"},
        {short_general, "sii-incomplete", true, "General has 28 bytes"},
        {short_sync_managers, "sii-incomplete", true, "SyncM has 28 bytes"},
        {short_pdo_entry, "sii-incomplete", true, "TxPDO"},
        {short_pdos, "sii-incomplete", true, "RxPDO"},
        {long_pdos, "sii-incomplete", true, "TxPDO has 12 bytes"},
        {short_dc, "sii-incomplete", true, "DC has 46 bytes"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tearDown();
        setUp();
        write(describe(&(cm1e_device_options_t){.distributed_clocks = true}));
        cases[i].spoil();
        read();
        TEST_ASSERT_GREATER_OR_EQUAL_size_t_MESSAGE(1, cm1e_findings_count(findings), cases[i].rule);
        const cm1e_finding_t *finding = cm1e_findings_at(findings, 0);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(cases[i].rule, finding->rule, finding->text);
        TEST_ASSERT_EQUAL(cases[i].is_error, finding->is_error);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(finding->text, cases[i].text), finding->text);
        TEST_ASSERT_GREATER_THAN_UINT32(0, finding->line);
        TEST_ASSERT_LESS_OR_EQUAL_size_t(size, finding->line);
        if (cm1e_findings_count(findings) > 1)
            TEST_FAIL_MESSAGE(cm1e_findings_at(findings, 1)->text);
    }
    static const char *const names[] = {
#define RULE_NAME(enumerator, name, is_error) name,
        CM1E_RULES(RULE_NAME)};
    for (size_t n = 0; n < sizeof names / sizeof names[0]; n++) {
        bool broken = strncmp(names[n], "sii-", 4) != 0;
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
            broken = broken || strcmp(cases[i].rule, names[n]) == 0;
        TEST_ASSERT_TRUE_MESSAGE(broken, names[n]);
    }
}

/* ---- damage ----------------------------------------------------------------------------------------------------- */

/* What was read can be written, and from then on stays as it is. */
static void expect_stable(void)
{
    static uint8_t once[BYTES], twice[BYTES];
    const size_t written = cm1e_sii_write(once, sizeof once, &file.devices.at[0], NULL);
    if (written == 0)
        return;
    cm1e_description_file_t again = {0};
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_sii_read(&again, once, written, NULL, NULL));
    TEST_ASSERT_EQUAL_size_t(written, cm1e_sii_write(twice, sizeof twice, &again.devices.at[0], NULL));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(once, twice, written);
    cm1e_description_file_free(&again);
}

/* From the heap, so that a sanitizer sees what is read behind the end. */
static void read_copy(size_t bytes)
{
    uint8_t *copy = malloc(bytes);
    memcpy(copy, image, bytes);
    cm1e_description_file_free(&file);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_sii_read(&file, copy, bytes, findings, &diag));
    free(copy);
    expect_stable();
}

static void test_an_image_cut_anywhere_is_read_up_to_there(void)
{
    write(describe(&(cm1e_device_options_t){.distributed_clocks = true}));
    const size_t end = place_of(CM1E_SII_CATEGORY_END, 0) + 2;
    for (size_t bytes = CM1E_SII_HEADER_BYTES; bytes < end; bytes++) {
        tearDown();
        setUp();
        read_copy(bytes);
        TEST_ASSERT_EQUAL_size_t(1, cm1e_findings_count(findings));
    }
    tearDown();
    setUp();
    read_copy(end);
    expect_no_findings();
}

static void test_random_images_do_no_harm(void)
{
    const unsigned seed = 20250304;
    printf("seed %u\n", seed);
    srand(seed);
    for (int round = 0; round < 4000; round++) {
        tearDown();
        setUp();
        write(describe(&(cm1e_device_options_t){.distributed_clocks = round % 2}));
        for (int n = rand() % 40; n >= 0; n--)
            image[rand() % 4 ? 0x80 + (unsigned)rand() % 0x600 : (unsigned)rand() % size] = (uint8_t)rand();
        for (size_t i = 0x80; round % 3 == 0 && i < size; i++)
            image[i] = round % 2 ? (uint8_t)rand() : (uint8_t)(rand() % 64);
        read_copy(CM1E_SII_HEADER_BYTES + (size_t)rand() % (size - CM1E_SII_HEADER_BYTES));
        TEST_ASSERT_LESS_OR_EQUAL_size_t(CM1E_FINDINGS_MAX, cm1e_findings_count(findings));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_device_comes_back_as_it_was_written);
    RUN_TEST(test_simple_devices_come_back_as_they_were_written);
    RUN_TEST(test_what_other_devices_have_comes_back_too);
    RUN_TEST(test_categories_may_stand_in_any_order);
    RUN_TEST(test_a_second_category_of_a_kind_adds_process_data_only);
    RUN_TEST(test_protocols_that_nobody_knows_make_no_mailbox);
    RUN_TEST(test_without_general_string_1_is_the_name);
    RUN_TEST(test_devices_add_up_in_a_file);
    RUN_TEST(test_sizes_that_no_image_has_are_refused);
    RUN_TEST(test_every_rule_finds_what_breaks_it_and_nothing_else);
    RUN_TEST(test_an_image_cut_anywhere_is_read_up_to_there);
    RUN_TEST(test_random_images_do_no_harm);
    return UNITY_END();
}
