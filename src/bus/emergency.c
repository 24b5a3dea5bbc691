#include "bus/emergency_ring.h"

#include <stdio.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "core/bytes.h"
#include "device/emergency_codes.h"

/* ---- what is kept ------------------------------------------------------------------------------------------------ */

size_t cm1e_bus_emergencies(const cm1e_bus_t *bus, uint16_t position, uint64_t after, cm1e_emergency_t *emergencies,
                            size_t room, uint64_t *lost)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (slave)
        return cm1e_history_copy(slave->emergencies, CM1E_EMERGENCY_SHAPE, after, emergencies, room, lost);
    if (lost)
        *lost = 0;
    return 0;
}

void cm1e_bus_keep_emergency(cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    cm1e_emergency_t emergency = slave->coe.emergency;
    if (emergency.number == cm1e_history_last(slave->emergencies))
        return;
    emergency.time_ns = cm1e_clock_wall(bus->clock);
    cm1e_history_add(slave->emergencies, CM1E_EMERGENCY_SHAPE, &emergency);
    bus->listening.emergencies++;
}

uint64_t cm1e_bus_emergency_count(const cm1e_bus_t *bus) { return bus->listening.emergencies; }

/* ---- texts ------------------------------------------------------------------------------------------------------ */

static const cm1e_device_error_t *known(const cm1e_bus_slave_t *slave, uint16_t code)
{
    const cm1e_device_t *device = slave ? slave->info.device : NULL;
    const cm1e_device_drive_t *drive = device ? device->drives[0] : NULL;
    const cm1e_device_error_t *error = drive && drive->error ? drive->error(code) : NULL;
    return error ? error : cm1e_cia402_error(code);
}

/** Bytes, if there are any but zeros: " Data: 01 02 03 04 05." */
static void data_text(const cm1e_emergency_t *emergency, char text[40])
{
    static const uint8_t none[sizeof emergency->data];
    const uint8_t *d = emergency->data;
    text[0] = 0;
    if (memcmp(d, none, sizeof none) != 0)
        snprintf(text, 40, " Data: %02X %02X %02X %02X %02X.", d[0], d[1], d[2], d[3], d[4]);
}

void cm1e_emergency_text(const cm1e_bus_t *bus, uint16_t position, const cm1e_emergency_t *emergency, char *text,
                         size_t size)
{
    char bits[CM1E_ERROR_REGISTER_TEXT], data[40];
    if (!text || size == 0)
        return;
    text[0] = '\0';
    if (!emergency)
        return;
    const cm1e_device_error_t *error = known(cm1e_bus_at(bus, position), emergency->code);
    data_text(emergency, data);
    cm1e_error_register_text(emergency->error_register, bits, sizeof bits);
    if (emergency->code == 0)
        snprintf(text, size, "emergency 0x0000, no error any more%s%s.%s", bits[0] ? ", but register: " : "", bits,
                 data);
    else
        snprintf(text, size, "emergency 0x%04X, %s. Error register 0x%02X%s%s.%s%s%s%s", emergency->code,
                 error ? error->text : cm1e_emergency_class(emergency->code), emergency->error_register,
                 bits[0] ? ": " : "", bits, data, error ? " Cure: " : "", error ? error->cure : "", error ? "." : "");
}

void cm1e_emergency_sentence(const cm1e_bus_t *bus, uint16_t position, const cm1e_emergency_t *emergency, char *text,
                             size_t size)
{
    char label[CM1E_LABEL_LENGTH], words[CM1E_EMERGENCY_TEXT_BYTES];
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    cm1e_emergency_text(bus, position, emergency, words, sizeof words);
    if (slave)
        snprintf(text, size, "%s: %s", cm1e_bus_label_first(bus, slave, label), words);
    else
        snprintf(text, size, "A slave that is gone: %s", words);
}
