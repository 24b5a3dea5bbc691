#include "bus/emergency_ring.h"

#include <stdio.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "core/bytes.h"
#include "device/emergency_codes.h"

/* ---- the ring --------------------------------------------------------------------------------------------------- */

void cm1e_emergency_add(cm1e_emergency_ring_t *ring, cm1e_emergency_t emergency)
{
    const uint64_t number = __atomic_load_n(&ring->last, __ATOMIC_RELAXED) + 1;
    cm1e_emergency_place_t *place = &ring->places[number % CM1E_EMERGENCIES];
    uint8_t bytes[8];
    uint64_t words[2] = {(uint64_t)emergency.time_ns, 0};
    cm1e_put_u16(bytes, emergency.code);
    bytes[2] = emergency.error_register;
    memcpy(bytes + 3, emergency.data, sizeof emergency.data);
    memcpy(&words[1], bytes, sizeof bytes);
    /* Release and acquire at every word keep them between the two writes of the sequence, without fences. */
    __atomic_store_n(&place->sequence, 0, __ATOMIC_RELAXED);
    for (int i = 0; i < 2; i++)
        __atomic_store_n(&place->words[i], words[i], __ATOMIC_RELEASE);
    __atomic_store_n(&place->sequence, number, __ATOMIC_RELEASE);
    __atomic_store_n(&ring->last, number, __ATOMIC_RELEASE);
}

/** false: the emergency has been overwritten meanwhile. */
static bool take(const cm1e_emergency_place_t *place, uint64_t number, cm1e_emergency_t *emergency)
{
    uint8_t bytes[8];
    if (__atomic_load_n(&place->sequence, __ATOMIC_ACQUIRE) != number)
        return false;
    const uint64_t time = __atomic_load_n(&place->words[0], __ATOMIC_ACQUIRE);
    const uint64_t message = __atomic_load_n(&place->words[1], __ATOMIC_ACQUIRE);
    if (__atomic_load_n(&place->sequence, __ATOMIC_RELAXED) != number)
        return false;
    memcpy(bytes, &message, sizeof bytes);
    *emergency = (cm1e_emergency_t){.number = number, .time_ns = (int64_t)time, .code = cm1e_get_u16(bytes),
                                    .error_register = bytes[2]};
    memcpy(emergency->data, bytes + 3, sizeof emergency->data);
    return true;
}

size_t cm1e_emergency_copy(const cm1e_emergency_ring_t *ring, uint64_t after, cm1e_emergency_t *emergencies,
                           size_t room, uint64_t *lost)
{
    const uint64_t last = __atomic_load_n(&ring->last, __ATOMIC_ACQUIRE);
    const uint64_t oldest = last > CM1E_EMERGENCIES ? last - CM1E_EMERGENCIES : 0;
    uint64_t missing = after < oldest ? oldest - after : 0;
    size_t count = 0;
    for (uint64_t number = after < last ? after + missing + 1 : last + 1; number <= last && count < room; number++) {
        if (take(&ring->places[number % CM1E_EMERGENCIES], number, &emergencies[count])) {
            count++;
        } else {
            missing += 1 + count; /* only the oldest are overwritten: what was copied before them is not in a row */
            count = 0;
        }
    }
    if (lost)
        *lost = missing;
    return count;
}

size_t cm1e_bus_emergency(const cm1e_bus_t *bus, uint16_t position, uint64_t after, cm1e_emergency_t *emergencies,
                          size_t room, uint64_t *lost)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (slave)
        return cm1e_emergency_copy(&slave->emergencies, after, emergencies, room, lost);
    if (lost)
        *lost = 0;
    return 0;
}

void cm1e_bus_keep_emergency(cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    cm1e_emergency_t emergency = slave->coe.emergency;
    if (emergency.number == slave->emergencies.last)
        return;
    emergency.time_ns = cm1e_clock_wall(bus->clock);
    cm1e_emergency_add(&slave->emergencies, emergency);
    bus->listening.emergencies++;
}

uint64_t cm1e_bus_emergencies(const cm1e_bus_t *bus) { return bus->listening.emergencies; }

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
    const cm1e_device_error_t *error = known(cm1e_bus_at(bus, position), emergency->code);
    if (!text || size == 0)
        return;
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
