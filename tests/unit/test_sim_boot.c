/* A simulated slave that boots from a file: what it takes from an image, and what it refuses. */
#include <string.h>

#include "core/bytes.h"
#include "description/describe.h"
#include "description/sii_image.h"
#include "sim/cm1e_app.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"
#include "unity.h"

static cm1e_bus_config_t config;
static cm1e_sim_segment_t *segment;
static cm1e_description_file_t file;
static uint8_t image[4096];
static cm1e_diag_t diag;

/* A CM1-E of firmware 1.3.0, with an I/O module before it. */
void setUp(void)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", 1);
    config.axes[0].address = 2;
    strcpy(config.axes[0].firmware, "1.3.0");
    segment = cm1e_sim_segment_create(&config, &diag);
    TEST_ASSERT_NOT_NULL(segment);
    diag = (cm1e_diag_t){0};
}
void tearDown(void)
{
    cm1e_description_file_free(&file);
    cm1e_sim_segment_destroy(segment);
}

static cm1e_sim_slave_t *slave(void) { return cm1e_sim_segment_slave(segment, 2); }

static cm1e_description_t *describe(void)
{
    const cm1e_device_options_t options = {.firmware = "1.3.0", .mapping = CM1E_MAPPING_CSP, .serial_number = 4711};
    cm1e_description_file_free(&file);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_describe(&file, &options, CM1E_ESI_FLAT, &diag));
    return &file.devices.at[0];
}

static size_t write(const cm1e_description_t *device)
{
    const size_t size = cm1e_sii_write(image, sizeof image, device, &diag);
    TEST_ASSERT_GREATER_THAN_size_t_MESSAGE(0, size, diag.text);
    return size;
}

static void test_the_image_is_what_the_slave_has(void)
{
    cm1e_description_t *device = describe();
    device->eeprom.alias = 0x1234;
    device->eeprom.byte_size = 4096;
    device->sync_managers.at[2].start = 0x1800; /* where its buffers lie is its own affair */
    const size_t size = write(device);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_sim_segment_boot(segment, 2, image, size, &diag), diag.text);
    TEST_ASSERT_EQUAL_size_t(4096, slave()->sii_size);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(image, slave()->sii, 4096);
    TEST_ASSERT_TRUE(slave()->sii_valid);
    TEST_ASSERT_EQUAL_HEX16(0x1234, cm1e_get_u16(slave()->memory + ESC_STATION_ALIAS));
    TEST_ASSERT_EQUAL_HEX16(0x1234, cm1e_sim_cm1e_of(slave())->alias); /* with an ID set too it refuses Pre-Op */
    TEST_ASSERT_EQUAL_UINT8(0, slave()->role_manager[ESC_ROLE_MAILBOX_OUT]);
    TEST_ASSERT_EQUAL_UINT8(3, slave()->role_manager[ESC_ROLE_INPUTS]);
}

/* As `ethercat sii_read` of IgH writes them. */
static void test_an_image_may_end_behind_its_last_category(void)
{
    write(describe());
    size_t end = CM1E_SII_HEADER_BYTES;
    cm1e_sii_category_t category;
    while (cm1e_sii_category_at(&category, image, sizeof image, end) && category.type != CM1E_SII_CATEGORY_END)
        end = category.start + category.bytes;
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_sim_segment_boot(segment, 2, image, end + 2, &diag), diag.text);
    TEST_ASSERT_EQUAL_size_t(CM1E_SII_SIZE, slave()->sii_size);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(image, slave()->sii, CM1E_SII_SIZE);
}

static void test_a_module_of_another_kind_boots_too(void)
{
    cm1e_describe_io_module(&file);
    file.devices.at[0].name = "Another name";
    const size_t size = write(&file.devices.at[0]);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_sim_segment_boot(segment, 1, image, size, &diag), diag.text);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(image, cm1e_sim_segment_slave(segment, 1)->sii, size);
}

/* ---- what does not fit ------------------------------------------------------------------------------------------ */

static void other_vendor(cm1e_description_t *device) { device->vendor_id = 1; }
static void other_product(cm1e_description_t *device) { device->product_code++; }
static void other_firmware(cm1e_description_t *device) { device->revision = 0x20020001; }
static void fewer_sync_managers(cm1e_description_t *device) { device->sync_managers.count = 3; }
static void other_use(cm1e_description_t *device) { device->sync_managers.at[3].use = CM1E_SM_UNUSED; }
static void short_mailbox(cm1e_description_t *device)
{
    device->sync_managers.at[0].length = device->eeprom.mailbox_out_length = 33;
}
static void long_mailbox(cm1e_description_t *device)
{
    device->sync_managers.at[1].length = device->eeprom.mailbox_in_length = 1487;
}
static void other_pdo(cm1e_description_t *device) { device->pdos.at[0].index = 0x1604; }
static void other_direction(cm1e_description_t *device) { device->pdos.at[0].index = 0x1A00; }
static void fewer_entries(cm1e_description_t *device) { device->pdos.at[3].entries.count--; }
static void other_order(cm1e_description_t *device)
{
    const cm1e_described_pdo_entry_t first = device->pdos.at[0].entries.at[1];
    device->pdos.at[0].entries.at[1] = device->pdos.at[0].entries.at[2];
    device->pdos.at[0].entries.at[2] = first;
}
static void other_subindex(cm1e_description_t *device) { device->pdos.at[0].entries.at[0].subindex = 1; }
static void other_size(cm1e_description_t *device) { device->pdos.at[0].entries.at[0].bits = 8; }

static void test_an_image_of_another_device_is_refused_with_the_reason(void)
{
    static const struct {
        void (*spoil)(cm1e_description_t *device);
        const char *reason;
    } cases[] = {
        {other_vendor, "vendor 0x00000001"},
        {other_product, "product 0x44412003"},
        {other_firmware, "revision 0x20020001; with its firmware this slave has 0x20020103"},
        {fewer_sync_managers, "has 3 sync managers; this slave has 4"},
        {other_use, "sync manager 3 of type 0; on this slave it is of type 4"},
        {short_mailbox, "mailbox of 33 bytes; expected 34 to 1486"},
        {long_mailbox, "mailbox of 1487 bytes"},
        {other_pdo, "RxPDO 0x1604, which this slave has not"},
        {other_direction, "RxPDO 0x1A00, which this slave has not"},
        {fewer_entries, "has 6 entries in PDO 0x1603; on this slave it has 7"},
        {other_order, "0x607A:00 with 32 bits as entry 2 of PDO 0x1600; this slave has 0x60FE:00"},
        {other_subindex, "0x6040:01"},
        {other_size, "with 8 bits as entry 1"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        cm1e_description_t *device = describe();
        cases[i].spoil(device);
        const size_t size = write(device);
        const uint8_t *const before = slave()->sii;
        diag = (cm1e_diag_t){0};
        TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_ERROR_FILE, cm1e_sim_segment_boot(segment, 2, image, size, &diag),
                                      cases[i].reason);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FILE, diag.error);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, cases[i].reason), diag.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "simulated slave 2"), diag.text);
        TEST_ASSERT_EQUAL_PTR(before, slave()->sii);
    }
}

static void test_a_damaged_image_is_refused_with_the_place(void)
{
    const size_t size = write(describe());
    image[2] ^= 0xFF;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FILE, cm1e_sim_segment_boot(segment, 2, image, size, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "damaged at byte 0x000E: the checksum"), diag.text);
    image[2] ^= 0xFF;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FILE, cm1e_sim_segment_boot(segment, 2, image, 0x200, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "damaged"), diag.text);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FILE, cm1e_sim_segment_boot(segment, 2, image, 100, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "100 bytes are not an SII image"), diag.text);
    /* A warning is none of that. */
    image[0x38] = 0x04;
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_sim_segment_boot(segment, 2, image, size, &diag), diag.text);
}

static void test_there_is_no_slave_behind_the_last(void)
{
    const size_t size = write(describe());
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_NOT_FOUND, cm1e_sim_segment_boot(segment, 3, image, size, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "slave 3; the segment has 2"), diag.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_image_is_what_the_slave_has);
    RUN_TEST(test_an_image_may_end_behind_its_last_category);
    RUN_TEST(test_a_module_of_another_kind_boots_too);
    RUN_TEST(test_an_image_of_another_device_is_refused_with_the_reason);
    RUN_TEST(test_a_damaged_image_is_refused_with_the_place);
    RUN_TEST(test_there_is_no_slave_behind_the_last);
    return UNITY_END();
}
