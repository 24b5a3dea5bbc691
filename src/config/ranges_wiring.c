/* The check of signals on other slaves that belong to an axis. */
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "config/ranges.h"

/* Whether `name` is "SLAVE.SIGNAL" with a slave of the list. Without a name of its own a slave is "slave<n>". */
static bool is_of_listed_slave(const cm1e_bus_config_t *config, const char *name)
{
    char own[CM1E_NAME_LENGTH];
    for (uint32_t i = 0; i < config->slave_count; i++) {
        snprintf(own, sizeof own, "slave%u", i + 1);
        const char *slave = config->slaves[i].name[0] ? config->slaves[i].name : own;
        const size_t length = strlen(slave);
        if (strncasecmp(name, slave, length) == 0 && name[length] == '.' && name[length + 1] != '\0')
            return true;
    }
    return false;
}

static bool check_signal(const check_t *check, const char *key, const char *name)
{
    if (!cm1e_config_is_text(name, CM1E_SIGNAL_LENGTH))
        return axis_wrong(check, key, NO_TEXT, (size_t)CM1E_SIGNAL_LENGTH);
    return is_of_listed_slave(check->config, name) ||
           axis_wrong(check, key, "has '%s'; expected the name of a slave of the list `slaves`, a point and its "
                      "signal, as in 'switches.home' or 'switches.input 3'", name);
}

static bool check_signals(const check_t *check, const char *key, const char names[][CM1E_SIGNAL_LENGTH], unsigned count)
{
    if (count > CM1E_WIRED_SIGNALS)
        return axis_wrong(check, key, "has %u; expected at most %d", count, CM1E_WIRED_SIGNALS);
    for (unsigned i = 0; i < count; i++) {
        if (!check_signal(check, key, names[i]))
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
    if (!check_signal(check, "encoder_signal", axis->wiring.encoder))
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
    if (!check_signals(check, "inputs.signals", wiring->inputs, wiring->input_count) ||
        !check_signals(check, "outputs.signals", wiring->outputs, wiring->output_count))
        return false;
    for (unsigned i = 0; i < wiring->output_count; i++)
        if (!check_owner(check, wiring->outputs[i]))
            return false;
    return wiring->encoder[0] == '\0' || check_encoder(check);
}
