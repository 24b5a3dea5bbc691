/* The check of signals on other slaves that belong to an axis. */
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "config/io_types.h"
#include "config/ranges.h"

/* The slave of the list that "SLAVE.SIGNAL" means, and the name of its signal; NULL: none. Without a name of its own a
 * slave is "slave<n>". */
static const cm1e_slave_config_t *slave_of(const cm1e_bus_config_t *config, const char *name, const char **signal)
{
    char own[CM1E_NAME_LENGTH];
    for (uint32_t i = 0; i < config->slave_count; i++) {
        snprintf(own, sizeof own, "slave%u", i + 1);
        const char *slave = config->slaves[i].name[0] ? config->slaves[i].name : own;
        const size_t length = strlen(slave);
        *signal = name + length + 1;
        if (strncasecmp(name, slave, length) == 0 && name[length] == '.' && **signal != '\0')
            return &config->slaves[i];
    }
    return NULL;
}

/* NULL: a name that only the slave itself knows, whose signal is looked at when the bus is there. */
static const cm1e_signal_config_t *listed(const cm1e_slave_config_t *slave, const char *name)
{
    for (unsigned i = 0; i < slave->signal_count && i < CM1E_SLAVE_SIGNALS; i++)
        if (strncasecmp(slave->signals[i].name, name, sizeof slave->signals[i].name) == 0)
            return &slave->signals[i];
    return NULL;
}

/* NULL: the list does not say. */
static const cm1e_io_type_row_t *type_of(const cm1e_signal_config_t *signal)
{
    return signal->type_stated && (unsigned)signal->type < CM1E_IO_TYPE_COUNT ? &cm1e_io_types[signal->type] : NULL;
}

/* 0: only the slave knows. An object may have fewer bits than its type, but for BOOL, REAL and LREAL. */
static unsigned bits_of(const cm1e_signal_config_t *signal)
{
    const cm1e_io_type_row_t *type = type_of(signal);
    if (signal->index)
        return type && (type->bits == 1 || type->is_real) ? type->bits : 0;
    return signal->bits ? signal->bits : type ? type->bits : 1;
}

static bool is_counter(const cm1e_signal_config_t *signal)
{
    const cm1e_io_type_row_t *type = type_of(signal);
    const unsigned bits = bits_of(signal);
    return !(type && type->is_real) && (bits == 0 || (bits >= 2 && bits <= 64));
}

typedef enum use { USE_INPUT = 0, USE_OUTPUT, USE_ENCODER } use_t;

static bool check_signal(const check_t *check, const char *key, const char *name, use_t use)
{
    const char *own;
    if (!cm1e_config_is_text(name, CM1E_SIGNAL_LENGTH))
        return axis_wrong(check, key, NO_TEXT, (size_t)CM1E_SIGNAL_LENGTH);
    const cm1e_slave_config_t *slave = slave_of(check->config, name, &own);
    if (!slave)
        return axis_wrong(check, key, "has '%s'; expected the name of a slave of the list `slaves`, a point and its "
                          "signal, as in 'switches.home' or 'switches.input 3'", name);
    const cm1e_signal_config_t *signal = listed(slave, own);
    if (!signal)
        return true;
    if (signal->output != (use == USE_OUTPUT))
        return axis_wrong(check, key, "has '%s', which is an %s of its slave; expected an %s", name,
                          signal->output ? "output" : "input", signal->output ? "input" : "output");
    if (use == USE_ENCODER)
        return is_counter(signal) || axis_wrong(check, key, "has '%s', which is no counter; expected a whole number of "
                                                "2 ... 64 bits", name);
    return bits_of(signal) <= 1 || axis_wrong(check, key, "has '%s', which has %u bits; expected a signal of a single "
                                              "bit: name that one in the list", name, bits_of(signal));
}

static bool check_signals(const check_t *check, const char *key, const char names[][CM1E_SIGNAL_LENGTH], unsigned count,
                          use_t use)
{
    if (count > CM1E_WIRED_SIGNALS)
        return axis_wrong(check, key, "has %u; expected at most %d", count, CM1E_WIRED_SIGNALS);
    for (unsigned i = 0; i < count; i++) {
        if (!check_signal(check, key, names[i], use))
            return false;
        for (unsigned other = 0; other < i; other++)
            if (strcasecmp(names[i], names[other]) == 0)
                return axis_wrong(check, key, "has '%s' twice; expected each signal once", names[i]);
    }
    return true;
}

/* An output of two axes would have the value of the one that is written last. */
static bool check_owner(const check_t *check, const char *name)
{
    for (uint32_t i = 0; i < check->index; i++) {
        const cm1e_wiring_config_t *other = &check->config->axes[i].wiring;
        for (unsigned n = 0; n < other->output_count && n < CM1E_WIRED_SIGNALS; n++)
            if (strcasecmp(other->outputs[n], name) == 0)
                return axis_wrong(check, "outputs.signals", "has '%s', which axis %u of the list has too; expected an "
                                  "output of one axis", name, i + 1);
    }
    return true;
}

static bool check_encoder(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    if (!check_signal(check, "encoder_signal", axis->wiring.encoder, USE_ENCODER))
        return false;
    if (axis->type != CM1E_AXIS_ENCODER)
        return axis_wrong(check, "encoder_signal", "is given, and the axis is no encoder; expected `type: encoder`");
    return axis->max_velocity > 0 ||
           axis_wrong(check, "encoder_signal", "needs limits.velocity; expected the velocity in u/s above which a "
                      "change of the counts is no motion");
}

bool cm1e_config_check_wiring(const check_t *check)
{
    const cm1e_wiring_config_t *wiring = &check->axis->wiring;
    if (!check_signals(check, "inputs.signals", wiring->inputs, wiring->input_count, USE_INPUT) ||
        !check_signals(check, "outputs.signals", wiring->outputs, wiring->output_count, USE_OUTPUT))
        return false;
    for (unsigned i = 0; i < wiring->output_count; i++)
        if (!check_owner(check, wiring->outputs[i]))
            return false;
    return wiring->encoder[0] == '\0' || check_encoder(check);
}
