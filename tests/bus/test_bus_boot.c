/* Slaves that booted from images of the generator instead of the tables: to a master they are the same, for every
 * firmware, order and mapping. */
#include "bus/bus_internal.h"
#include "bus/eeprom.h"
#include "bus/soem_private.h"
#include "bus_support.h"
#include "description/describe.h"
#include "description/sii_image.h"
#include "sim/cm1e_app.h"

static const char *const firmwares[] = {"1.2.0", "1.3.0", "1.3.2", "1.3.3", "1.3.4", "1.3.5"};
enum { FIRMWARES = 6, MAPPINGS = 4, ORDERS = 2, SLAVES = 2, SERIAL_NUMBER = 4711 };

typedef struct choice {
    const char *firmware;
    cm1e_mapping_t mapping;
    cm1e_pdo_order_t order;
} choice_t;

static choice_t choice_of(int n)
{
    return (choice_t){firmwares[n / MAPPINGS % FIRMWARES], (cm1e_mapping_t)(n % MAPPINGS),
                      (cm1e_pdo_order_t)(n / MAPPINGS / FIRMWARES)};
}

static cm1e_bus_t *bus_of(const choice_t *choice)
{
    sim_config(SLAVES);
    config.sim_pdo_order = choice->order;
    for (int i = 0; i < SLAVES; i++) {
        strcpy(config.axes[i].firmware, choice->firmware);
        config.axes[i].mapping = choice->mapping;
    }
    return open_bus();
}

/** Slave `position` starts again from an image made for the choice; its number tells that it did. */
static void boot(cm1e_bus_t *bus, const choice_t *choice, uint32_t position)
{
    cm1e_device_options_t options = {
        .mapping = choice->mapping, .order = choice->order, .serial_number = SERIAL_NUMBER + position};
    cm1e_description_file_t file = {0};
    uint8_t image[CM1E_SII_SIZE];
    strcpy(options.firmware, choice->firmware);
    ck_assert_msg(cm1e_describe(&file, &options, CM1E_ESI_FLAT, &diag) == CM1E_OK, "%s", diag.text);
    const size_t size = cm1e_sii_write(image, sizeof image, &file.devices.at[0], &diag);
    ck_assert_msg(size == sizeof image, "%s", diag.text);
    ck_assert_msg(cm1e_sim_segment_boot(segment_of(bus), position, image, size, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_description_file_free(&file);
}

/** What a master learns of a slave. */
typedef struct learned {
    char name[48];
    char string_1[EC_MAXNAME + 1];             /* what SOEM takes for the name */
    uint32_t revision, sii_bits[2], soem_bits[2]; /* outputs, inputs */
    int soem_pdos[2];
    uint16_t soem_indexes[2][8], bytes[2];
} learned_t;

static bool from_eeprom(void *context, uint16_t word, uint16_t count, uint8_t *bytes)
{
    for (unsigned i = 0; i < count; i += 2)
        if (!cm1e_eeprom_read(context, word + i, bytes + 2 * i))
            return false;
    return true;
}

/** All of it: of a motor the scan reads less. */
static void read_sii(cm1e_soem_t *soem, uint16_t position, cm1e_sii_t *sii)
{
    cm1e_eeprom_t eeprom = {.soem = soem, .station = soem->slaves[position].configadr};
    ck_assert(cm1e_eeprom_take(&eeprom));
    ck_assert_int_eq(cm1e_sii_read_header(sii, from_eeprom, &eeprom), SII_OK);
    ck_assert_int_eq(cm1e_sii_read_categories(sii, false, from_eeprom, &eeprom), SII_OK);
    cm1e_eeprom_give_back(&eeprom);
    ck_assert_str_eq(sii->name, soem->siis[position].name);
    ck_assert_mem_eq(sii->sync_managers, soem->siis[position].sync_managers, sizeof sii->sync_managers);
    cm1e_sii_free(sii);
}

static void learn_by_sii(cm1e_bus_t *bus, uint16_t position, learned_t *learned)
{
    cm1e_soem_t *soem = bus->soem;
    cm1e_sii_t sii;
    cm1e_bus_enter(bus);
    read_sii(soem, position, &sii);
    ecx_siistring(&soem->context, learned->string_1, position, 1);
    for (int transmit = 0; transmit < 2; transmit++) {
        static ec_eepromPDOt pdos;
        const int sync_manager = 2 + transmit;
        ecx_siiPDO(&soem->context, position, &pdos, (uint8)!transmit);
        learned->soem_pdos[transmit] = pdos.nPDO;
        learned->soem_bits[transmit] = pdos.SMbitsize[sync_manager];
        for (int i = 0; i < pdos.nPDO && i < 8; i++)
            learned->soem_indexes[transmit][i] = pdos.Index[i + 1];
        learned->sii_bits[transmit] = sii.bits[transmit][sync_manager];
    }
}

static void learn(cm1e_bus_t *bus, learned_t learned[SLAVES], uint32_t serial_number)
{
    memset(learned, 0, SLAVES * sizeof *learned);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    for (uint16_t position = 1; position <= SLAVES; position++)
        learn_by_sii(bus, position, &learned[position - 1]);
    ck_assert_msg(cm1e_bus_identify(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_configure(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_operate(bus, &diag) == CM1E_OK, "%s", diag.text);
    cycles(bus, 20);
    for (uint16_t position = 1; position <= SLAVES; position++) {
        const cm1e_slave_info_t *info = cm1e_bus_slave(bus, position);
        learned_t *into = &learned[position - 1];
        memcpy(into->name, info->name, sizeof into->name);
        into->revision = info->revision;
        into->bytes[0] = info->output_bytes;
        into->bytes[1] = info->input_bytes;
        ck_assert_uint_eq(info->serial_number, serial_number ? serial_number + position : 0);
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, position).al_state, CM1E_AL_OP);
    }
    cm1e_bus_close(bus);
}

/** The image says which mapping is the default; the device's own default stays 0x1600 and 0x1A00. What a master runs
 *  it with is what it assigned: here the same that the image says, so that SII and process image can be compared. */
START_TEST(slaves_from_images_are_those_from_the_tables)
{
    const choice_t choice = choice_of(_i);
    learned_t by_image[SLAVES], by_tables[SLAVES];
    cm1e_bus_t *bus = bus_of(&choice);
    for (uint32_t position = 1; position <= SLAVES; position++)
        boot(bus, &choice, position);
    learn(bus, by_image, SERIAL_NUMBER);
    learn(bus_of(&choice), by_tables, 0);
    for (int i = 0; i < SLAVES; i++) {
        for (int transmit = 0; transmit < 2; transmit++) {
            ck_assert_uint_eq(by_image[i].bytes[transmit], by_tables[i].bytes[transmit]);
            ck_assert_uint_eq(by_image[i].sii_bits[transmit], 8u * by_image[i].bytes[transmit]);
            ck_assert_uint_eq(by_image[i].soem_bits[transmit], 8u * by_image[i].bytes[transmit]);
            ck_assert_int_eq(by_image[i].soem_pdos[transmit], MAPPINGS);
            for (unsigned n = 0; n < MAPPINGS; n++)
                ck_assert_uint_eq(by_image[i].soem_indexes[transmit][n], (transmit ? 0x1A00 : 0x1600) + n);
        }
        ck_assert_str_eq(by_image[i].name, by_tables[i].name);
        ck_assert_str_eq(by_image[i].string_1, "CM1-E");
        ck_assert_str_eq(by_image[i].string_1, by_tables[i].string_1);
        ck_assert_uint_eq(by_image[i].revision, by_tables[i].revision);
    }
}
END_TEST

/** What an EEPROM says is assigned by default is not what the device's program assigns: a master reads 0x1C12, or
 *  writes it. */
START_TEST(default_of_the_image_is_not_the_default_of_the_device)
{
    const choice_t csp = {tested_firmware(), CM1E_MAPPING_CSP, tested_order()};
    cm1e_bus_t *bus = bus_of(&csp);
    boot(bus, &csp, 1);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    uint8_t assigned[2];
    size_t size = sizeof assigned;
    ck_assert_int_eq(cm1e_sdo_read(bus, 1, 0x1C12, 1, assigned, &size, &diag), CM1E_OK);
    ck_assert_uint_eq(cm1e_get_u16(assigned), 0x1600);
    cm1e_sii_t sii;
    read_sii(bus->soem, 1, &sii);
    ck_assert_uint_eq(sii.bits[0][2], 64);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- who comes back ---------------------------------------------------------------------------------------------- */

/** Two motors from images, which have serial numbers in their EEPROMs, in Operational. */
static cm1e_bus_t *start_numbered(void)
{
    const choice_t choice = {tested_firmware(), CM1E_MAPPING_DYNAMIC, tested_order()};
    cm1e_bus_t *bus = bus_of(&choice);
    for (uint32_t position = 1; position <= SLAVES; position++)
        boot(bus, &choice, position);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

/** Object 0x1018:4 of the second motor; a device that starts again has its default. */
static bool comes_back_with(cm1e_bus_t *bus, int64_t serial_number)
{
    cm1e_sim_cm1e_t *drive = cm1e_sim_cm1e_of(cm1e_sim_segment_slave(segment_of(bus), 2));
    for (int n = 0; n < 1500; n++) {
        cm1e_sim_store_set(&drive->store, OBJ_1018_IDENTITY, 4, serial_number);
        cycle(bus);
        const cm1e_slave_watch_t watch = cm1e_bus_slave_watch(bus, 2);
        if (n > 100 && !watch.lost && watch.al_state == CM1E_AL_OP && cm1e_bus_health(bus) == CM1E_OK)
            return true;
        cm1e_bus_request_recovery(bus, 2);
    }
    return false;
}

START_TEST(a_motor_whose_object_does_not_have_its_serial_number_comes_back)
{
    cm1e_bus_t *bus = start_numbered();
    simulate(bus, "power-cycle 2 20");
    ck_assert(comes_back_with(bus, 0));
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_motor_with_another_serial_number_does_not)
{
    cm1e_bus_t *bus = start_numbered();
    simulate(bus, "power-cycle 2 20");
    ck_assert(!comes_back_with(bus, SERIAL_NUMBER + 1)); /* that of the other one */
    ck_assert_uint_le(cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(bus), 2)), CM1E_AL_PRE_OP);
    ck_assert(comes_back_with(bus, SERIAL_NUMBER + 2));
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_boot");
    TCase *tests = tcase_create("boot");
    tcase_add_loop_test(tests, slaves_from_images_are_those_from_the_tables, 0, FIRMWARES * MAPPINGS * ORDERS);
    tcase_add_test(tests, default_of_the_image_is_not_the_default_of_the_device);
    tcase_add_test(tests, a_motor_whose_object_does_not_have_its_serial_number_comes_back);
    tcase_add_test(tests, a_motor_with_another_serial_number_does_not);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
