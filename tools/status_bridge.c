#include "status_bridge.h"

#include <inttypes.h>
#include <stdio.h>

#include "cia402/cia402.h"
#include "core/bytes.h"
#include "core/json_text.h"
#include "device/bridge_facts.h"
#include "device/bridge_status.h"
#include "which_slave.h"

/* ---- reading ---------------------------------------------------------------------------------------------------- */

static cm1e_error_t read_value(cm1e_bus_t *bus, uint16_t position, unsigned channel, uint16_t index, unsigned bytes,
                               cm1e_bridge_value_t *value, cm1e_diag_t *diag)
{
    uint8_t data[8] = {0};
    size_t size = sizeof data;
    index = (uint16_t)(index + channel * CM1E_BRIDGE_INDEX_INCREMENT);
    value->error = cm1e_sdo_read(bus, position, index, 0, data, &size, diag);
    if (value->error == CM1E_OK && size != bytes)
        value->error = cm1e_diag_set(diag, CM1E_ERROR_BUS_MAILBOX, 0,
                                     "Slave %u: object 0x%04X has %zu bytes; %u are right.", position, index, size,
                                     bytes);
    value->abort_code = value->error == CM1E_ERROR_SDO_ABORT ? diag->foreign_code : 0;
    value->known = value->error == CM1E_OK;
    value->value = value->known ? cm1e_get_u32(data) : 0;
    return value->error;
}

bool read_bridge(cm1e_bus_t *bus, uint16_t position, bridge_status_t *status, cm1e_diag_t *diag)
{
    cm1e_diag_t other;
    bool readable = true;
    if (cm1e_bridge_read(bus, position, &status->info, diag) != CM1E_OK)
        return false; /* the bridge is silent: each further read would fail too */
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++) {
        bridge_motor_reading_t *motor = &status->motors[i];
        if (read_value(bus, position, i, OBJ_6041_STATUSWORD, 2, &motor->statusword, diag) != CM1E_OK)
            readable = false;
        read_value(bus, position, i, OBJ_6061_MODES_OF_OPERATION_DISPLAY, 1, &motor->mode, &other);
        read_value(bus, position, i, OBJ_6064_POSITION_ACTUAL_VALUE, 4, &motor->position, &other);
    }
    return readable;
}

/* ---- what both outputs say -------------------------------------------------------------------------------------- */

static const char *model_name(const cm1e_bridge_info_t *info)
{
    return info->model_known ? cm1e_bridge_name(info->model) : "of an unknown model";
}

/* For an unknown motor the table of the CM2 is used: it has all bits of the CM1 and one more. */
static cm1e_bridge_motor_t motor_of(const cm1e_bridge_channel_t *channel)
{
    return channel->type.known && channel->type.value == CM1E_BRIDGE_CM1 ? CM1E_BRIDGE_CM1 : CM1E_BRIDGE_CM2;
}

static const char *motor_name(const cm1e_bridge_channel_t *channel)
{
    const bool known = channel->type.known && (channel->type.value == CM1E_BRIDGE_CM1
                                               || channel->type.value == CM1E_BRIDGE_CM2);
    return known ? cm1e_bridge_motor_name(motor_of(channel)) : "unknown motor";
}

static bool is_in_mode(const bridge_motor_reading_t *motor, cm1e_bridge_mode_t mode)
{
    return motor->mode.known && (int8_t)motor->mode.value == (int8_t)mode;
}

/* In CMD the statusword answers commands and has no state in it (BR 7.1.3). */
static const char *state_name(const bridge_motor_reading_t *motor)
{
    if (is_in_mode(motor, CM1E_BRIDGE_MODE_CMD))
        return "none in CMD mode";
    const bool cpio = is_in_mode(motor, CM1E_BRIDGE_MODE_CPIO);
    return cm1e_fsa_name(cm1e_fsa_decode_by(cpio ? cm1e_fsa_cpio_table : cm1e_fsa_bridge_table,
                                            (uint16_t)motor->statusword.value));
}

/* Bits 14 and 15 in the modes that have them (BR 6.1.3). */
static const char *flags_of(const bridge_motor_reading_t *motor)
{
    static const char *const flags[] = {"", ", motor error", ", motor free", ", motor error, motor free"};
    const bool other = is_in_mode(motor, CM1E_BRIDGE_MODE_CMD) || is_in_mode(motor, CM1E_BRIDGE_MODE_CPIO);
    return flags[other ? 0 : motor->statusword.value >> 14 & 3];
}

static const char *mode_name(const bridge_motor_reading_t *motor)
{
    const char *name = cm1e_bridge_mode_name((int8_t)motor->mode.value);
    return name ? name : "not a mode of the guide";
}

/* What the user should do; "": nothing. */
static const char *cure_of(const cm1e_bridge_channel_t *channel)
{
    if (channel->status.known && cm1e_bridge_status_is_error(motor_of(channel), channel->status.value))
        return cm1e_bridge_status_cure(motor_of(channel), channel->status.value);
    if (channel->receive_errors.known && channel->receive_errors.value > 0) /* BR 7.4 */
        return "the line to the motor is not stable: look for a bad contact at a connector, or too long a cable";
    return "";
}

static const char *axis_name(const cm1e_bus_t *bus, const cm1e_bus_config_t *config, const cm1e_slave_info_t *slave,
                             unsigned channel)
{
    const int axis = find_axis_at(bus, config, slave, (uint8_t)channel);
    return axis >= 0 ? config->axes[axis].name : "";
}

/** The values of the device, in the order of the printed lines. */
static const struct {
    size_t offset;
    const char *key, *label, *unit;
} numbers[] = {
    {offsetof(cm1e_bridge_info_t, pdo_longest_us), "longest_cycle_us", "longest cycle", "us"},
    {offsetof(cm1e_bridge_info_t, pdo_shortest_us), "shortest_cycle_us", "shortest cycle", "us"},
    {offsetof(cm1e_bridge_info_t, pdo_late), "late_cycles", "above 1300 us", "times"},
    {offsetof(cm1e_bridge_info_t, pdo_early), "early_cycles", "below 700 us", "times"},
    {offsetof(cm1e_bridge_info_t, serial_cycle_ms), "serial_cycle_ms", "serial cycle", "ms"},
    {offsetof(cm1e_bridge_info_t, serial_number), "serial_number", "serial number", ""},
    {offsetof(cm1e_bridge_info_t, config_code), "config_code", "configuration code", ""},
    {offsetof(cm1e_bridge_info_t, maker_mode), "maker_mode", "Musclecorp mode", ""},
    {offsetof(cm1e_bridge_info_t, master_mode), "master_mode", "master mode", ""},
    {offsetof(cm1e_bridge_info_t, test[0]), "test_1", "test value 1", ""},
    {offsetof(cm1e_bridge_info_t, test[1]), "test_2", "test value 2", ""},
    {offsetof(cm1e_bridge_info_t, test[2]), "test_3", "test value 3", ""},
    {offsetof(cm1e_bridge_info_t, test[3]), "test_4", "test value 4", ""},
};
enum { NUMBERS = sizeof numbers / sizeof *numbers };

static const cm1e_bridge_value_t *number(const cm1e_bridge_info_t *info, int n)
{
    return (const cm1e_bridge_value_t *)(const void *)((const char *)info + numbers[n].offset);
}

/* ---- as text ---------------------------------------------------------------------------------------------------- */

/* "12", or the reason why the value is missing. */
static const char *text_of_value(const cm1e_bridge_value_t *value, char *text, size_t size)
{
    if (value->known)
        snprintf(text, size, "%" PRIu32, value->value);
    else if (value->error == CM1E_ERROR_SDO_ABORT)
        snprintf(text, size, "refused (0x%08X, %s)", (unsigned)value->abort_code,
                 cm1e_sdo_abort_text(value->abort_code));
    else
        snprintf(text, size, "not readable (%s)",
                 value->error != CM1E_OK ? cm1e_strerror(value->error) : "not asked for");
    return text;
}

static void print_line(const cm1e_bridge_channel_t *channel)
{
    char baud_rate[140], cycle[120], sent[120], received[120], errors[120];
    const uint32_t bits = channel->baud_rate.known ? cm1e_bridge_bits_per_second(channel->baud_rate.value) : 0;
    if (bits)
        snprintf(baud_rate, sizeof baud_rate, "%" PRIu32 " bit/s", bits);
    else
        snprintf(baud_rate, sizeof baud_rate, "baud rate %s", text_of_value(&channel->baud_rate, cycle, sizeof cycle));
    printf("    %-16s %s, every %s ms; sent %s, received %s, receive errors %s\n", "serial line", baud_rate,
           text_of_value(&channel->cycle_time_ms, cycle, sizeof cycle), text_of_value(&channel->sent, sent, sizeof sent),
           text_of_value(&channel->received, received, sizeof received),
           text_of_value(&channel->receive_errors, errors, sizeof errors));
}

static void print_status(const cm1e_bridge_channel_t *channel)
{
    char text[CM1E_BRIDGE_STATUS_TEXT];
    const char *cure = cure_of(channel);
    if (channel->status.known)
        printf("    %-16s 0x%02X %s\n", "status", (unsigned)channel->status.value,
               cm1e_bridge_status_text(motor_of(channel), channel->status.value, text, sizeof text));
    else
        printf("    %-16s %s\n", "status", text_of_value(&channel->status, text, sizeof text));
    if (cure[0])
        printf("    %-16s %s\n", "what to do", cure);
}

static void print_motor(unsigned id, const char *axis, const cm1e_bridge_channel_t *channel,
                        const bridge_motor_reading_t *motor)
{
    char text[120];
    printf("  motor %u: %s%s%s%s\n", id, motor_name(channel), axis[0] ? ", axis \"" : "", axis, axis[0] ? "\"" : "");
    if (motor->statusword.known)
        printf("    %-16s %s (0x%04X)%s\n", "state", state_name(motor), (unsigned)motor->statusword.value,
               flags_of(motor));
    else
        printf("    %-16s %s\n", "state", text_of_value(&motor->statusword, text, sizeof text));
    print_status(channel);
    const bool dead_end = is_in_mode(motor, CM1E_BRIDGE_MODE_CMD) || is_in_mode(motor, CM1E_BRIDGE_MODE_CPIO);
    printf("    %-16s %s%s\n", "mode",
           motor->mode.known ? mode_name(motor) : text_of_value(&motor->mode, text, sizeof text),
           dead_end ? ": only power-off leads back to csp" : "");
    if (motor->position.known)
        printf("    %-16s %" PRId32 " counts\n", "position", (int32_t)motor->position.value);
    else
        printf("    %-16s %s\n", "position", text_of_value(&motor->position, text, sizeof text));
    print_line(channel);
    if (channel->configured_module.value != channel->detected_module.value)
        printf("    %-16s configured 0x%08X, detected 0x%08X: not the same\n", "module",
               (unsigned)channel->configured_module.value, (unsigned)channel->detected_module.value);
}

void print_bridge(const cm1e_bus_t *bus, const cm1e_bus_config_t *config, const cm1e_slave_info_t *slave,
                  const bridge_status_t *status)
{
    char state[48], text[120];
    printf("slave %u: %s, bridge %s, firmware %s, %s\n", slave->position, slave->name, model_name(&status->info),
           slave->software_version[0] ? slave->software_version : "unknown",
           al_state_name(slave->al_state, state, sizeof state));
    for (int i = 0; i < NUMBERS; i++) {
        const cm1e_bridge_value_t *value = number(&status->info, i);
        printf("  %-18s %s%s%s\n", numbers[i].label, text_of_value(value, text, sizeof text),
               value->known && numbers[i].unit[0] ? " " : "", value->known ? numbers[i].unit : "");
    }
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
        print_motor(i + 1, axis_name(bus, config, slave, i + 1), &status->info.channels[i], &status->motors[i]);
}

/* ---- as JSON ---------------------------------------------------------------------------------------------------- */

static json_t *as_json(const cm1e_bridge_value_t *value)
{
    return value->known ? json_integer(value->value) : json_null();
}

static json_t *motor_as_json(unsigned id, const char *axis, const cm1e_bridge_channel_t *channel,
                             const bridge_motor_reading_t *motor)
{
    char text[CM1E_BRIDGE_STATUS_TEXT];
    json_t *object = json_pack("{s:i, s:s, s:o}", "id", (int)id, "motor", motor_name(channel), "axis",
                               axis[0] ? cm1e_json_text(axis) : json_null());
    json_object_set_new(object, "state", motor->statusword.known ? json_string(state_name(motor)) : json_null());
    json_object_set_new(object, "statusword", as_json(&motor->statusword));
    json_object_set_new(object, "status", as_json(&channel->status));
    json_object_set_new(object, "status_text",
                        channel->status.known
                            ? json_string(cm1e_bridge_status_text(motor_of(channel), channel->status.value, text,
                                                                  sizeof text))
                            : json_null());
    json_object_set_new(object, "what_to_do", json_string(cure_of(channel)));
    json_object_set_new(object, "mode", motor->mode.known ? json_integer((int8_t)motor->mode.value) : json_null());
    json_object_set_new(object, "mode_name", motor->mode.known ? json_string(mode_name(motor)) : json_null());
    json_object_set_new(object, "position_counts",
                        motor->position.known ? json_integer((int32_t)motor->position.value) : json_null());
    json_object_set_new(object, "bits_per_second",
                        channel->baud_rate.known ? json_integer(cm1e_bridge_bits_per_second(channel->baud_rate.value))
                                                 : json_null());
    json_object_set_new(object, "serial_cycle_ms", as_json(&channel->cycle_time_ms));
    json_object_set_new(object, "sent", as_json(&channel->sent));
    json_object_set_new(object, "received", as_json(&channel->received));
    json_object_set_new(object, "receive_errors", as_json(&channel->receive_errors));
    json_object_set_new(object, "profile", as_json(&channel->profile));
    json_object_set_new(object, "configured_module", as_json(&channel->configured_module));
    json_object_set_new(object, "detected_module", as_json(&channel->detected_module));
    return object;
}

json_t *bridge_status_as_json(const cm1e_bus_t *bus, const cm1e_bus_config_t *config, const cm1e_slave_info_t *slave,
                              const bridge_status_t *status)
{
    json_t *object = json_pack("{s:i, s:s, s:s, s:s}", "position", slave->position, "name", slave->name, "firmware",
                               slave->software_version, "bridge", model_name(&status->info));
    for (int i = 0; i < NUMBERS; i++)
        json_object_set_new(object, numbers[i].key, as_json(number(&status->info, i)));
    json_t *motors = json_array();
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
        json_array_append_new(motors, motor_as_json(i + 1, axis_name(bus, config, slave, i + 1), &status->info.channels[i],
                                                    &status->motors[i]));
    json_object_set_new(object, "motors", motors);
    return object;
}
