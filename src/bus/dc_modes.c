/* The pulses that each slave gets: as the configuration states them, or by the name of a mode in its EEPROM. */
#include <stdio.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "bus/sii_reader.h"
#include "config/ranges.h"

static const cm1e_dc_config_t *stated_for(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave)
{
    static const cm1e_dc_config_t none;
    const cm1e_axis_config_t *axis = cm1e_bus_axis_of(bus, slave, 0);
    return axis ? &axis->dc : slave->config ? &slave->config->dc : &none;
}

/** Finds a mode by its name; "first" is the first mode, unless a mode has that name. NULL: there is none. */
static const cm1e_sii_dc_mode_t *find_mode(const cm1e_sii_dc_mode_t *modes, unsigned count, const char *name)
{
    for (unsigned i = 0; i < count; i++)
        if (strcmp(modes[i].name, name) == 0)
            return &modes[i];
    for (unsigned i = 0; i < count && strcmp(name, "first") == 0; i++)
        if (cm1e_config_mode_has_sync0(&modes[i].facts))
            return &modes[i];
    return NULL;
}

static cm1e_error_t no_mode(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, const char *name,
                            const cm1e_sii_dc_mode_t *modes, unsigned count, cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH], list[CM1E_SII_DC_MODES * (CM1E_SII_DC_MODE_NAME + 4)] = "none";
    size_t used = 0;
    for (unsigned i = 0; i < count && used < sizeof list; i++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s\"%s\"", i ? ", " : "", modes[i].name);
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%s has no mode \"%s\" for its distributed clock. Its EEPROM has "
                         "(category 60): %s.", cm1e_bus_label_first(bus, slave, label), name, list);
}

/** Takes the pulses of the mode that `stated` names. A mode without SYNC0 gives no pulses. */
static cm1e_error_t take_mode(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, const cm1e_dc_config_t *stated,
                              cm1e_diag_t *diag)
{
    const cm1e_sii_dc_mode_t *modes;
    const unsigned count = cm1e_soem_dc_modes(bus->soem, slave->info.position, &modes);
    const cm1e_sii_dc_mode_t *mode = find_mode(modes, count, stated->mode);
    char label[CM1E_LABEL_LENGTH], text[CM1E_WRONG_PULSES];
    if (!mode)
        return no_mode(bus, slave, stated->mode, modes, count, diag);
    slave->dc_control = (uint8_t)mode->facts.assign_activate;
    slave->pulses = cm1e_config_pulses_of_mode(&mode->facts, stated->shift_us, bus->config.cycle_time_ns);
    const char *key = cm1e_config_wrong_pulses(&bus->config, &slave->pulses, text);
    if (!key)
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "The mode \"%s\" of %s cannot be used: %s %s.", mode->name,
                         cm1e_bus_label(bus, slave, label), key, text);
}

cm1e_error_t cm1e_dc_find_pulses(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    for (uint32_t i = 0; i < bus->slave_count && error == CM1E_OK; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        const cm1e_dc_config_t *stated = stated_for(bus, slave);
        slave->pulses = *stated;
        slave->dc_control = 0;
        if (stated->mode[0] && !cm1e_bus_was_there(slave))
            slave->pulses = (cm1e_dc_config_t){0}; /* its EEPROM is not known */
        else if (stated->mode[0])
            error = take_mode(bus, slave, stated, diag);
    }
    return error;
}
