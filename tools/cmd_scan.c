/** cm1e scan: lists the slaves of the network. */
#include <stdio.h>
#include <string.h>

#include "attach.h"
#include "command.h"
#include "core/text.h"
#include "device/devices.h"

static error_t parse(int key, char *arg, struct argp_state *state)
{
    (void)arg;
    if (key == ARGP_KEY_INIT) {
        state->child_inputs[0] = state->child_inputs[1] = state->input;
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

static const char *model_name(const cm1e_slave_info_t *slave)
{
    const char *model = cm1e_bridge_name(slave->model);
    return model ? model : "of an unknown model";
}

static const char *motor_name(uint8_t motor)
{
    return motor ? cm1e_bridge_motor_name((cm1e_bridge_motor_t)motor) : "unknown";
}

static json_t *bridge_as_json(const cm1e_slave_info_t *slave)
{
    json_t *motors = json_array();
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
        json_array_append_new(motors, json_string(motor_name(slave->motors[i])));
    return json_pack("{s:s, s:o}", "model", model_name(slave), "motors", motors);
}

static json_t *slave_as_json(const cm1e_slave_info_t *slave)
{
    char state[48];
    return json_pack("{s:i, s:s, s:I, s:I, s:I, s:I, s:i, s:i, s:s, s:b, s:o, s:s}", "position", slave->position,
                     "name", slave->name, "vendor_id", (json_int_t)slave->vendor_id, "product_code",
                     (json_int_t)slave->product_code, "revision", (json_int_t)slave->revision, "serial_number",
                     (json_int_t)slave->serial_number, "alias", slave->alias, "explicit_id", slave->explicit_id,
                     "al_state", al_state_name(slave->al_state, state, sizeof state), "is_cm1e",
                     slave->device == &cm1e_device_cm1e, "bridge",
                     slave->device && slave->device->channels ? bridge_as_json(slave) : json_null(), "software_version",
                     slave->software_version);
}

/** Width of a column: its widest text, but not below a minimum. */
static int wider(int width, const char *text)
{
    const int wanted = (int)cm1e_text_width(text);
    return wanted > width ? wanted : width;
}

/** printf() counts bytes; a letter may have several. */
static int in_bytes(int width, const char *text) { return width + (int)(strlen(text) - cm1e_text_width(text)); }

static void print_table(const cm1e_bus_t *bus)
{
    char state[48];
    int name_width = 20, state_width = 18;
    for (uint32_t i = 1; i <= cm1e_bus_slave_count(bus); i++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, i);
        name_width = wider(name_width, slave->name);
        state_width = wider(state_width, al_state_name(slave->al_state, state, sizeof state));
    }
    printf("%3s  %-*s %-10s %-10s %-10s %6s %4s  %-*s %s\n", "pos", name_width, "name", "vendor", "product", "revision",
           "alias", "ID", state_width, "state", "firmware");
    for (uint32_t i = 1; i <= cm1e_bus_slave_count(bus); i++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, i);
        printf("%3u  %-*s 0x%08X 0x%08X 0x%08X %6u %4u  %-*s %s\n", slave->position,
               in_bytes(name_width, slave->name), slave->name, slave->vendor_id, slave->product_code, slave->revision,
               slave->alias, slave->explicit_id, state_width, al_state_name(slave->al_state, state, sizeof state),
               slave->software_version[0] ? slave->software_version : "-");
        if (slave->device && slave->device->channels)
            printf("     bridge %s, motors %s, %s, %s, %s\n", model_name(slave), motor_name(slave->motors[0]),
                   motor_name(slave->motors[1]), motor_name(slave->motors[2]), motor_name(slave->motors[3]));
    }
}

static const struct argp_child children[] = {{&common_argp, 0, NULL, 0}, {&attach_argp, 0, NULL, 0}, {0}};
const struct argp argp_scan = {NULL, parse, NULL, "Lists the slaves of a network.", children, NULL, NULL};

int command_scan(int argc, char **argv)
{
    common_options_t options = {0};
    if (parse_options(&argp_scan, argc, argv, &options))
        return EXIT_WRONG_USE;

    static cm1e_bus_config_t config;
    if (!load_network(&options, &config))
        return EXIT_WRONG_USE;
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    if (open_network(&options, &config, &bus, &diag) != CM1E_OK)
        return fail(&diag);
    if (options.json) {
        json_t *slaves = json_array();
        for (uint32_t i = 1; i <= cm1e_bus_slave_count(bus); i++)
            json_array_append_new(slaves, slave_as_json(cm1e_bus_slave(bus, i)));
        print_json(slaves);
    } else {
        print_table(bus);
        tell_simulated(&config);
    }
    /* A bus file states the expected slaves: compare. */
    const bool as_expected = config.axis_count == 0 || cm1e_bus_identify(bus, &diag) == CM1E_OK;
    return close_bus(bus, &options, as_expected ? EXIT_OK : fail(&diag));
}
