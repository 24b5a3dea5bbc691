/* A wrong, missing, doubled or extra slave is an error that names what was expected and what was found. */
#include "bus_support.h"
#include "sim/esc_chip.h"

typedef enum kind { END = 0, MOTOR, IO } kind_t;
/** What hangs on the wire ... */
typedef struct device {
    kind_t kind;
    uint16_t alias;
    uint8_t switches;
    const char *firmware;
} device_t;
/** The network that the configuration expects. */
typedef struct expected {
    cm1e_address_kind_t kind;
    uint16_t address;
    const char *firmware;
} expected_t;

typedef struct identity_case {
    const char *name;
    device_t devices[4];
    uint32_t axes;
    expected_t expected[4];
    cm1e_error_t error;
    uint16_t positions[4];  /* of the axes, where it is right */
    const char *words[3];   /* that the diagnosis must contain */
} identity_case_t;

#define POSITION CM1E_ADDRESS_POSITION
#define ALIAS CM1E_ADDRESS_ALIAS
#define ID CM1E_ADDRESS_EXPLICIT_ID
#define WRONG CM1E_ERROR_BUS_IDENTITY

/* What a case leaves out is 0. */
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
static const identity_case_t cases[] = {
    {"by position", {{MOTOR}, {MOTOR}}, 2, {{POSITION, 2}, {POSITION, 1}}, CM1E_OK, {2, 1}, {0}},
    {"by default position", {{MOTOR}, {MOTOR}}, 2, {{POSITION, 0}, {POSITION, 0}}, CM1E_OK, {1, 2}, {0}},
    {"by alias, in any order", {{MOTOR, 30}, {MOTOR, 10}, {MOTOR, 20}}, 3, {{ALIAS, 10}, {ALIAS, 20}, {ALIAS, 30}},
     CM1E_OK, {2, 3, 1}, {0}},
    {"by ID, in any order", {{MOTOR, 0, 0xFE}, {MOTOR, 0, 1}}, 2, {{ID, 1}, {ID, 0xFE}}, CM1E_OK, {2, 1}, {0}},
    {"aliases that are the stations of others", {{MOTOR, 0x1002}, {MOTOR, 0x1003}, {MOTOR, 0x1001}}, 3,
     {{ALIAS, 0x1001}, {ALIAS, 0x1002}, {ALIAS, 0x1003}}, CM1E_OK, {3, 1, 2}, {0}},
    {"mixed", {{MOTOR}, {MOTOR, 7}, {MOTOR, 0, 9}}, 3, {{ID, 9}, {ALIAS, 7}, {POSITION, 1}}, CM1E_OK, {3, 2, 1}, {0}},
    {"another device in between", {{MOTOR}, {IO}, {MOTOR}}, 2, {{POSITION, 1}, {POSITION, 3}}, CM1E_OK, {1, 3}, {0}},
    {"whatever is there", {{MOTOR}, {IO}, {MOTOR, 5}}, 0, {{0}}, CM1E_OK, {0}, {0}},
    {"missing at a position", {{MOTOR}}, 2, {{POSITION, 1}, {POSITION, 2}}, WRONG, {0},
     {"position 2", "missing", "Found 1 slave:"}},
    {"missing alias", {{MOTOR, 1}, {MOTOR, 2}}, 2, {{ALIAS, 1}, {ALIAS, 3}}, WRONG, {0},
     {"alias 3", "missing", "alias 2"}},
    {"missing ID", {{MOTOR, 0, 1}}, 1, {{ID, 2}}, WRONG, {0}, {"explicit device ID 2", "missing", "ID 1"}},
    {"no ID set", {{MOTOR}}, 1, {{ID, 1}}, WRONG, {0}, {"explicit device ID 1", "missing", "ID 0"}},
    {"of another kind", {{MOTOR}, {IO}}, 2, {{POSITION, 1}, {POSITION, 2}}, WRONG, {0},
     {"expected a CM1-E", "slave 2", "another kind"}},
    {"doubled alias", {{MOTOR, 4}, {MOTOR, 4}}, 2, {{ALIAS, 4}, {POSITION, 2}}, WRONG, {0},
     {"alias 4", "doubled", "slaves 1 and 2"}},
    {"doubled ID", {{MOTOR, 0, 6}, {MOTOR}, {MOTOR, 0, 6}}, 3, {{POSITION, 2}, {ID, 6}, {POSITION, 1}}, WRONG, {0},
     {"explicit device ID 6", "doubled", "slaves 1 and 3"}},
    {"two axes on one slave", {{MOTOR, 4}, {MOTOR}}, 2, {{ALIAS, 4}, {POSITION, 1}}, WRONG, {0},
     {"axis1", "axis2", "slave 1"}},
    {"an extra motor", {{MOTOR}, {MOTOR}, {MOTOR}}, 2, {{POSITION, 1}, {POSITION, 2}}, WRONG, {0},
     {"Slave 3", "extra", "Found 3 slaves"}},
    {"an extra motor at the beginning", {{MOTOR}, {MOTOR, 1}, {MOTOR, 2}}, 2, {{ALIAS, 1}, {ALIAS, 2}}, WRONG, {0},
     {"Slave 1", "extra", "Found 3 slaves"}},
    {"an extra motor in the middle", {{MOTOR, 1}, {MOTOR}, {MOTOR, 2}}, 2, {{ALIAS, 1}, {ALIAS, 2}}, WRONG, {0},
     {"Slave 2", "extra", "Found 3 slaves"}},
    {"firmware as expected", {{MOTOR, 0, 0, "1.3.4"}}, 1, {{POSITION, 1, "1.3.4"}}, CM1E_OK, {1}, {0}},
    {"another firmware", {{MOTOR, 0, 0, "1.2.0"}}, 1, {{POSITION, 1, "1.3.5"}}, WRONG, {0},
     {"1.2.0", "1.3.5", "0x100A"}},
};

static cm1e_bus_t *bus_of_case(const identity_case_t *c)
{
    sim_config(c->axes);
    for (uint32_t i = 0; i < c->axes; i++) {
        cm1e_axis_config_t *axis = &config.axes[i];
        axis->address_kind = c->expected[i].kind;
        axis->address = c->expected[i].address;
        if (c->expected[i].firmware)
            strcpy(axis->firmware, c->expected[i].firmware);
    }
    /* The segment that the nic makes of the configuration is replaced, so it must not depend on it. */
    static cm1e_bus_config_t kept;
    cm1e_bus_config_free(&kept);
    kept = config;
    config.axes = NULL; /* they are of the other one now */
    sim_config(1);
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create_empty();
    for (const device_t *device = c->devices; device->kind != END; device++) {
        static cm1e_axis_config_t motor;
        memset(&motor, 0, sizeof motor);
        strcpy(motor.firmware, device->firmware ? device->firmware : tested_firmware());
        cm1e_sim_slave_t *slave =
            device->kind == IO ? cm1e_sim_io_module_create()
                               : cm1e_sim_cm1e_create(&motor, tested_order(), device->alias, device->switches);
        slave->memory[ESC_DL_ALIAS] = 1; /* an earlier master let it answer at its alias */
        ck_assert_int_eq(cm1e_sim_segment_add(segment, slave), CM1E_OK);
    }
    cm1e_bus_config_free(&config);
    config = kept;
    kept.axes = NULL;
    cm1e_bus_t *bus = open_bus();
    cm1e_sim_replace_segment(cm1e_bus_nic(bus), segment);
    return bus;
}

START_TEST(identity)
{
    const identity_case_t *c = &cases[_i];
    cm1e_bus_t *bus = bus_of_case(c);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s: %s", c->name, diag.text);
    const cm1e_error_t error = cm1e_bus_identify(bus, &diag);
    ck_assert_msg(error == c->error, "%s: %s: %s", c->name, cm1e_strerror(error), diag.text);
    for (int i = 0; i < 3 && c->words[i]; i++)
        ck_assert_msg(strstr(diag.text, c->words[i]) != NULL, "%s: \"%s\" lacks \"%s\"", c->name, diag.text,
                      c->words[i]);
    for (uint32_t axis = 0; axis < c->axes && c->error == CM1E_OK; axis++)
        ck_assert_msg(cm1e_bus_axis_position(bus, axis) == c->positions[axis], "%s: axis %u", c->name, axis);
    ck_assert_uint_eq(cm1e_bus_axis_position(bus, c->axes), 0);
    if (c->error == CM1E_OK)
        ck_assert_msg(cm1e_bus_configure(bus, &diag) == CM1E_OK, "%s: %s", c->name, diag.text);
    else
        ck_assert_int_eq(cm1e_bus_configure(bus, &diag), CM1E_ERROR_STATE);
    cm1e_bus_close(bus);
}
END_TEST

/** Another text in place of the version that a slave tells. */
static cm1e_tap_verdict_t spoil_version(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    for (size_t at = 0; frame->direction == CM1E_TAP_RECEIVED && at + 5 <= frame->length; at++)
        if (memcmp(frame->bytes + at, "1.3.4", 5) == 0)
            memcpy(frame->bytes + at, " ~\x7F\x1F\x80", 5);
    return CM1E_TAP_PASS;
}

/** What could act on a terminal is shown as "?". */
START_TEST(software_version_has_plain_characters)
{
    static const identity_case_t c = {"a version", {{MOTOR, 0, 0, "1.3.4"}}, 0, {{0}}, CM1E_OK, {0}, {0}};
    cm1e_bus_t *bus = bus_of_case(&c);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), spoil_version, NULL);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    const char *version = cm1e_bus_slave(bus, 1)->software_version;
    ck_assert_msg(strstr(version, " ~???"), "%s", version);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- slaves beside the axes -------------------------------------------------------------------------------------- */

/** On the wire: a motor with alias 3, a device with alias 4, and a third one. The configuration names the motor, and slaves
 *  by these. */
static const struct {
    uint16_t third; /* its alias */
    cm1e_address_kind_t kinds[2];
    uint16_t addresses[2];
    const char *words;
} slave_cases[] = {
    {4, {ALIAS}, {4}, "Slave \"first\": alias 4 is doubled, slaves 2 and 3 both have it. Found 3 slaves"},
    {6, {ALIAS}, {5}, "Slave \"first\": expected a slave at alias 5, which is missing. Found 3 slaves"},
    {6, {POSITION, ALIAS}, {2, 4}, "\"first\" and \"second\" are both slave 2. Found 3 slaves"},
    {6, {ALIAS}, {3}, "Slave \"first\" is slave 1, which an axis of the configuration is already. Found 3 slaves"},
};

START_TEST(identity_of_slaves)
{
    sim_config(1);
    for (int i = 0; i < 2 && slave_cases[_i].addresses[i]; i++) {
        cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, i ? "second" : "first");
        slave->address_kind = slave_cases[_i].kinds[i];
        slave->address = slave_cases[_i].addresses[i];
    }
    cm1e_slave_config_t device = {.sim = {.kind = CM1E_SIM_SLAVE_DIGITAL, .inputs = 4}, .address_kind = ALIAS,
                                  .address = 4};
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create_empty();
    cm1e_sim_segment_add(segment, cm1e_sim_cm1e_create(&config.axes[0], tested_order(), 3, 0));
    cm1e_sim_segment_add(segment, cm1e_sim_io_create_as(CM1E_SIM_IO_MODULE, &device));
    device.address = slave_cases[_i].third;
    cm1e_sim_segment_add(segment, cm1e_sim_io_create_as(CM1E_SIM_IO_MODULE, &device));
    cm1e_bus_t *bus = open_bus();
    cm1e_sim_replace_segment(cm1e_bus_nic(bus), segment);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_bus_identify(bus, &diag), WRONG);
    ck_assert_msg(strncmp(diag.text, slave_cases[_i].words, strlen(slave_cases[_i].words)) == 0, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_identity");
    TCase *tests = tcase_create("identity");
    tcase_add_loop_test(tests, identity, 0, sizeof cases / sizeof cases[0]);
    tcase_add_test(tests, software_version_has_plain_characters);
    tcase_add_loop_test(tests, identity_of_slaves, 0, sizeof slave_cases / sizeof slave_cases[0]);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
