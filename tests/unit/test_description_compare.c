/* A file beside a device: nothing where both say the same, and exactly one finding for each thing that differs. */
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unity.h>

#include "description/compare.h"
#include "description/describe.h"

static cm1e_description_file_t left, right; /* the file, the device; each has an arena of its own */
static cm1e_description_t *file, *device;
static cm1e_findings_t *findings;

static cm1e_description_t *described(cm1e_description_file_t *into)
{
    const cm1e_device_options_t options = {.firmware = "1.3.5"};
    cm1e_diag_t diag = {0};
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_describe(into, &options, CM1E_ESI_FLAT, &diag), diag.text);
    return &into->devices.at[0];
}

void setUp(void)
{
    file = described(&left);
    device = described(&right);
    file->place = file->identity_place = 17;
    findings = cm1e_findings_create();
}

void tearDown(void)
{
    cm1e_description_file_free(&left);
    cm1e_description_file_free(&right);
    cm1e_findings_free(findings);
}

static cm1e_described_object_t *object_of(cm1e_description_t *description, uint16_t index)
{
    for (size_t i = 0; i < description->objects.count; i++)
        if (description->objects.at[i].index == index)
            return &description->objects.at[i];
    return NULL;
}

static cm1e_described_pdo_t *pdo_of(cm1e_description_t *description, uint16_t index)
{
    for (size_t i = 0; i < description->pdos.count; i++)
        if (description->pdos.at[i].index == index)
            return &description->pdos.at[i];
    return NULL;
}

static void remove_object(cm1e_description_t *description, uint16_t index)
{
    cm1e_described_object_t *object = object_of(description, index), *last;
    last = &description->objects.at[--description->objects.count];
    *object = *last;
}

static void remove_pdo(cm1e_description_t *description, uint16_t index)
{
    cm1e_described_pdo_t *pdo = pdo_of(description, index);
    *pdo = description->pdos.at[--description->pdos.count];
}

/* ---- what can differ -------------------------------------------------------------------------------------------- */

static void other_vendor(void) { device->vendor_id ^= 1; }
static void other_product(void) { device->product_code ^= 1; }
static void other_revision(void) { device->revision ^= 1; }
static void other_configuration(void)
{
    static const uint8_t of_file[14] = {5, 0, 3}, of_device[14] = {5, 0, 4};
    file->eeprom.config_known = true;
    file->eeprom.config_data = (cm1e_bytes_t){of_file, 14};
    device->eeprom.config_data = (cm1e_bytes_t){of_device, 14};
}
static void other_bootstrap(void)
{
    static const uint8_t of_file[8] = {0, 0x10}, of_device[8] = {0, 0x20};
    file->eeprom.bootstrap = (cm1e_bytes_t){of_file, 8};
    device->eeprom.bootstrap = (cm1e_bytes_t){of_device, 8};
}
static void other_eeprom_size(void)
{
    file->eeprom.byte_size = 2048;
    device->eeprom.byte_size = 4096;
}
static void no_mailbox(void) { device->mailbox.present = false; }
static void no_foe(void) { device->mailbox.foe = !device->mailbox.foe; }
static void complete_access(void) { device->mailbox.complete_access = true; }
static void other_use(void) { device->sync_managers.at[3].use = CM1E_SM_UNUSED; }
static void other_start(void) { device->sync_managers.at[2].start = 0x1180; }
static void other_control(void) { device->sync_managers.at[2].control = 0x24; }
static void other_enable(void) { device->sync_managers.at[3].enable = 0; }
static void other_mailbox_size(void) { device->sync_managers.at[0].length = 256; }
static void fewer_sync_managers(void) { device->sync_managers.count = 3; }
static void pdo_missing_in_device(void) { remove_pdo(device, 0x1603); }
static void pdo_missing_in_file(void) { remove_pdo(file, 0x1603); }
static void other_direction(void) { pdo_of(device, 0x1603)->transmit = true; }
static void other_mapped_object(void) { pdo_of(device, 0x1600)->entries.at[1].index = 0x60FF; }
static void other_mapped_bits(void) { pdo_of(device, 0x1A00)->entries.at[4].bits = 32; }
static void fewer_entries(void) { pdo_of(device, 0x1A00)->entries.count--; }
static void other_assignment(void)
{
    pdo_of(device, 0x1600)->sync_manager = CM1E_NO_SYNC_MANAGER;
    pdo_of(device, 0x1601)->sync_manager = 2;
}
static void other_sync_manager(void) { pdo_of(device, 0x1600)->sync_manager = 1; }
static void object_missing_in_device(void) { remove_object(device, 0x607C); }
static void object_missing_in_file(void) { remove_object(file, 0x607C); }
static void subindex_missing_in_device(void) { object_of(device, 0x1018)->entries.count--; }
static void subindex_missing_in_file(void) { object_of(file, 0x1018)->entries.count--; }
static void other_type(void) { object_of(device, 0x6064)->entries.at[0].type = "UDINT"; }
static void other_bits(void) { object_of(device, 0x6064)->entries.at[0].bits = 16; }
static void other_access(void) { object_of(device, 0x6064)->entries.at[0].access |= CM1E_ACCESS_WRITE; }
static void other_mapping(void) { object_of(device, 0x6064)->entries.at[0].access &= (uint8_t)~CM1E_ACCESS_TXPDO; }
static void other_code(void) { object_of(device, 0x1018)->code = CM1E_OBJECT_VAR; }
static void other_object_name(void) { object_of(device, 0x6064)->name = "Where it is"; }
static void other_entry_name(void) { object_of(device, 0x1018)->entries.at[1].name = "Maker"; }

static const struct {
    const char *name;
    void (*make)(void);
    const char *rule, *words;
    unsigned count;
} differences[] = {
    {"vendor", other_vendor, "differs-identity", "vendor is 0x00004441 in the file, 0x00004440 in the device", 1},
    {"product", other_product, "differs-identity", "product code is 0x44412002", 1},
    {"revision", other_revision, "differs-identity", "revision is 0x20020103", 1},
    {"configuration", other_configuration, "differs-eeprom", "never write", 1},
    {"bootstrap", other_bootstrap, "differs-eeprom", "bootstrap", 1},
    {"EEPROM size", other_eeprom_size, "differs-eeprom", "2048 bytes in the file, 4096", 1},
    {"no mailbox", no_mailbox, "differs-mailbox", "The file has a mailbox, the device has none", 1},
    {"FoE", no_foe, "differs-mailbox", "FoE", 1},
    {"complete access", complete_access, "differs-mailbox", "The device's SII announces SDO complete access", 1},
    {"sync manager use", other_use, "differs-sync-manager", "Sync manager 3 is for inputs", 1},
    {"sync manager start", other_start, "differs-sync-manager", "begins at 0x1100 in the file, at 0x1180", 1},
    {"sync manager control", other_control, "differs-sync-manager", "0x64 in the file, 0x24", 1},
    {"sync manager enable", other_enable, "differs-sync-manager", "is enabled in the file, not enabled", 1},
    {"mailbox size", other_mailbox_size, "differs-sync-manager", "128 bytes in the file, 256", 1},
    {"sync managers", fewer_sync_managers, "differs-sync-manager", "4 sync managers, the device 3", 1},
    {"PDO not in device", pdo_missing_in_device, "differs-pdo", "The device has no RxPDO 0x1603", 1},
    {"PDO not in file", pdo_missing_in_file, "differs-pdo", "does not offer RxPDO 0x1603", 1},
    {"PDO direction", other_direction, "differs-pdo", "among the RxPDOs in the file, the TxPDOs", 1},
    {"mapped object", other_mapped_object, "differs-pdo", "Entry 2 of RxPDO 0x1600 is 0x60FE:00", 1},
    {"mapped bits", other_mapped_bits, "differs-pdo", "16 bits in the file, 0x6077:00 with 32 bits", 1},
    {"entries", fewer_entries, "differs-pdo", "9 entries (168 bits) in the file, 8 (160 bits)", 1},
    {"assignment", other_assignment, "differs-assignment", "assigned by default", 2},
    {"sync manager of a PDO", other_sync_manager, "differs-pdo", "sync manager 2 in the file, to sync manager 1", 1},
    {"object not in device", object_missing_in_device, "differs-object", "The device has no object 0x607C", 1},
    {"object not in file", object_missing_in_file, "differs-object", "The file lacks object 0x607C", 1},
    {"entry not in device", subindex_missing_in_device, "differs-object", "The device has no sub-index 0x1018:04", 1},
    {"entry not in file", subindex_missing_in_file, "differs-object", "The file lacks sub-index 0x1018:04", 1},
    {"type", other_type, "differs-object", "DINT in the file, UDINT", 1},
    {"bits", other_bits, "differs-object", "32 bits in the file, 16", 1},
    {"access", other_access, "differs-object", "allows read in the file, read and write", 1},
    {"mapping", other_mapping, "differs-object", "into TxPDOs in the file, into no PDO", 1},
    {"code", other_code, "differs-object", "is a variable in the device, and has sub-indexes in the file", 1},
    {"object name", other_object_name, "differs-name", "\"Where it is\"", 1},
    {"entry name", other_entry_name, "differs-name", "\"Maker\"", 1},
};

static void test_every_difference_is_that_finding_and_no_other(void)
{
    for (size_t i = 0; i < sizeof differences / sizeof differences[0]; i++) {
        tearDown();
        setUp();
        differences[i].make();
        cm1e_compare(findings, file, device);
        TEST_ASSERT_EQUAL_size_t_MESSAGE(differences[i].count, cm1e_findings_count(findings), differences[i].name);
        const cm1e_finding_t *finding = cm1e_findings_at(findings, 0);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(differences[i].rule, finding->rule, differences[i].name);
        char text[1024];
        snprintf(text, sizeof text, "%s: %s", differences[i].name, finding->text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(finding->text, differences[i].words), text);
        const bool warning = !strcmp(finding->rule, "differs-name") || !strcmp(finding->rule, "differs-assignment");
        TEST_ASSERT_EQUAL_MESSAGE(!warning, finding->is_error, differences[i].name);
    }
}

static void test_the_same_says_nothing(void)
{
    cm1e_compare(findings, file, device);
    TEST_ASSERT_EQUAL_size_t(0, cm1e_findings_count(findings));
}

static void test_findings_have_the_place_in_the_file(void)
{
    pdo_of(file, 0x1600)->entries.at[1].place = 99;
    other_mapped_object();
    other_vendor();
    cm1e_compare(findings, file, device);
    cm1e_findings_sort(findings);
    TEST_ASSERT_EQUAL_UINT(17, cm1e_findings_at(findings, 0)->line);
    TEST_ASSERT_EQUAL_UINT(99, cm1e_findings_at(findings, 1)->line);
}

/* ---- what one side does not state -------------------------------------------------------------------------------- */

static void test_what_is_not_stated_is_no_difference(void)
{
    /* A device that tells no dictionary; a file that has none and offers one mapping alone; sizes of one side. */
    device->objects.count = 0;
    file->product_given = file->revision_given = false;
    file->product_code = file->revision = 0;
    cm1e_compare(findings, file, device);
    TEST_ASSERT_EQUAL_size_t(0, cm1e_findings_count(findings));
    tearDown();
    setUp();
    file->objects.count = 0;
    file->pdos.count = 1;
    file->sync_managers.count = 0;
    device->eeprom.byte_size = 4096;
    file->eeprom.byte_size = 0;
    cm1e_compare(findings, file, device);
    TEST_ASSERT_EQUAL_size_t(0, cm1e_findings_count(findings));
}

static void test_a_guessed_configuration_and_the_alias_do_not_count(void)
{
    static const uint8_t of_file[14] = {5, 0, 3, 0, 0, 0, 0, 0, 1}, of_device[14] = {5, 0, 3, 0, 0, 0, 0, 0, 2};
    other_configuration();
    file->eeprom.config_known = false;
    cm1e_compare(findings, file, device);
    file->eeprom.config_known = true;
    file->eeprom.config_data.data = of_file;
    device->eeprom.config_data.data = of_device;
    cm1e_compare(findings, file, device);
    TEST_ASSERT_EQUAL_size_t(0, cm1e_findings_count(findings));
}

static void test_names_that_a_device_leaves_out_or_cuts_do_not_count(void)
{
    object_of(device, 0x6064)->name = "";
    object_of(device, 0x6041)->name = "Status";
    object_of(device, 0x1018)->entries.at[1].name = "Vend";
    object_of(device, 0x1600)->entries.at[1].name = "SubIndex 001";
    object_of(device, 0x1018)->code = CM1E_OBJECT_ARRAY; /* nor whether what has sub-indexes is an array */
    cm1e_compare(findings, file, device);
    TEST_ASSERT_EQUAL_size_t(0, cm1e_findings_count(findings));
}

static void test_an_eni_names_protocols_alone(void)
{
    file->mailbox.sdo_info = file->mailbox.pdo_assign = file->mailbox.pdo_config = false;
    cm1e_compare(findings, file, device);
    TEST_ASSERT_EQUAL_size_t(0, cm1e_findings_count(findings));
}

/* ---- modules ---------------------------------------------------------------------------------------------------- */

static void test_objects_and_pdos_of_any_module_that_can_stand_in_a_slot_are_in_the_file(void)
{
    cm1e_description_t variants[2] = {*file, *file};
    cm1e_description_file_t third = {0};
    variants[1] = *described(&third);
    remove_pdo(&variants[0], 0x1603);
    remove_object(&variants[0], 0x1603);
    remove_pdo(&variants[1], 0x1600);
    remove_object(&variants[1], 0x1600);
    cm1e_compare_variants(findings, variants, 2, 2, device);
    TEST_ASSERT_EQUAL_size_t(0, cm1e_findings_count(findings));
    remove_pdo(&variants[1], 0x1603);
    pdo_of(&variants[1], 0x1A03)->entries.at[0].bits = 8; /* the second variant is compared, too */
    cm1e_compare_variants(findings, variants, 1, 2, device); /* unless it is only there to be asked */
    TEST_ASSERT_EQUAL_size_t(1, cm1e_findings_count(findings));
    cm1e_compare_variants(findings, variants, 2, 2, device);
    TEST_ASSERT_EQUAL_size_t(2, cm1e_findings_count(findings));
    cm1e_description_file_free(&third);
}

/* A file can have as many as it likes; the work must not grow with their square. */
static void test_very_many_pdos_are_compared_in_no_time(void)
{
    enum { MANY = 300000, SECONDS = 10 };
    const cm1e_described_pdo_t pdo = *pdo_of(file, 0x1600);
    for (int i = 0; i < MANY; i++)
        *(cm1e_described_pdo_t *)CM1E_APPEND(&left.arena, &file->pdos) = pdo;
    TEST_ASSERT_FALSE(left.arena.failed);
    const clock_t begin = clock();
    cm1e_compare(findings, file, device);
    TEST_ASSERT_EQUAL_size_t(0, cm1e_findings_count(findings));
    TEST_ASSERT_LESS_THAN_INT64(SECONDS * (int64_t)CLOCKS_PER_SEC, clock() - begin);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_same_says_nothing);
    RUN_TEST(test_every_difference_is_that_finding_and_no_other);
    RUN_TEST(test_findings_have_the_place_in_the_file);
    RUN_TEST(test_what_is_not_stated_is_no_difference);
    RUN_TEST(test_a_guessed_configuration_and_the_alias_do_not_count);
    RUN_TEST(test_names_that_a_device_leaves_out_or_cuts_do_not_count);
    RUN_TEST(test_an_eni_names_protocols_alone);
    RUN_TEST(test_objects_and_pdos_of_any_module_that_can_stand_in_a_slot_are_in_the_file);
    RUN_TEST(test_very_many_pdos_are_compared_in_no_time);
    return UNITY_END();
}
