#include <string.h>

#include "core/bytes.h"
#include "sim/coe_server.h"
#include "sim/esc_chip.h"

/* In complete access (ETG.1000.6 5.6.2.1) an object is the row of its entries, sub-index 0 as 16 bits. */
enum { SUBINDEX_0_BYTES = 2 };

const cm1e_object_t *cm1e_sim_coe_object(cm1e_sim_slave_t *slave, uint16_t index)
{
    const cm1e_object_t *object;
    for (size_t n = 0; slave->ops->object && (object = slave->ops->object(slave->app, n)) != NULL; n++)
        if (object->index == index)
            return cm1e_sim_profile_hides(slave, index, 0) ? NULL : object;
    return NULL;
}

const cm1e_entry_t *cm1e_sim_coe_entry(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex)
{
    return slave->ops->entry && !cm1e_sim_profile_hides(slave, index, subindex)
               ? slave->ops->entry(slave->app, index, subindex) : NULL;
}

/* The abort code for an entry that is not there. */
static uint32_t missing(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex)
{
    if (!cm1e_sim_profile_hides(slave, index, subindex))
        return 0;
    return cm1e_sim_profile_hides(slave, index, 0) ? SDO_ABORT_NO_OBJECT : SDO_ABORT_NO_SUBINDEX;
}

static size_t entry_bytes(const cm1e_entry_t *entry) { return (entry->bits + 7u) / 8u; }

static uint32_t read_entry(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex, uint8_t *data, size_t *size)
{
    if (!slave->ops->sdo_read)
        return SDO_ABORT_NO_OBJECT;
    const size_t room = *size;
    const uint32_t hidden = missing(slave, index, subindex);
    const uint32_t abort =
        hidden ? hidden : slave->ops->sdo_read(slave->app, index, subindex, slave->al_state, data, size);
    if (*size > room)
        *size = room;
    return abort;
}

static uint32_t write_entry(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex, const uint8_t *data, size_t size)
{
    const uint32_t hidden = missing(slave, index, subindex);
    if (hidden)
        return hidden;
    if (cm1e_sim_quirk_is_fixed(slave, index))
        return SDO_ABORT_READ_ONLY;
    return slave->ops->sdo_write ? slave->ops->sdo_write(slave->app, index, subindex, slave->al_state, data, size)
                                 : (uint32_t)SDO_ABORT_NO_OBJECT;
}

/* Whether an object can be accessed completely from that sub-index on. */
static uint32_t check_complete_access(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex)
{
    const cm1e_object_t *object = cm1e_sim_coe_object(slave, index);
    if (!object)
        return SDO_ABORT_NO_OBJECT;
    if (object->object_code == CM1E_OBJECT_VAR)
        return SDO_ABORT_COMPLETE_ACCESS;
    return subindex > 1 ? SDO_ABORT_NO_SUBINDEX : 0;
}

/* The highest sub-index as the device has it now; sub-index 0 of a mapping or an assignment changes. */
static uint32_t read_highest_subindex(cm1e_sim_slave_t *slave, uint16_t index, unsigned *highest)
{
    uint8_t value[8] = {0};
    size_t size = sizeof value;
    const uint32_t abort = read_entry(slave, index, 0, value, &size);
    *highest = value[0];
    return abort;
}

/* An entry that cannot be read, in an object that can, reads as zero. */
static bool reads_as_zero(uint32_t abort, unsigned subindex)
{
    return abort == SDO_ABORT_WRITE_ONLY ||
           (subindex > 0 && (abort == SDO_ABORT_UNSUPPORTED_ACCESS || abort == SDO_ABORT_NO_SUBINDEX));
}

static uint32_t read_complete(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex, uint8_t *data, size_t *size)
{
    const size_t room = *size;
    unsigned highest = 0;
    uint32_t refused = check_complete_access(slave, index, subindex);
    if (!refused)
        refused = read_highest_subindex(slave, index, &highest);
    if (refused)
        return refused;
    size_t at = 0;
    for (unsigned sub = subindex; sub <= highest; sub++) {
        const cm1e_entry_t *entry = cm1e_sim_coe_entry(slave, index, (uint8_t)sub);
        if (!entry)
            continue;
        const size_t bytes = sub == 0 ? SUBINDEX_0_BYTES : entry_bytes(entry);
        if (bytes > room - at)
            return SDO_ABORT_MEMORY;
        size_t got = bytes;
        memset(data + at, 0, bytes);
        const uint32_t abort = read_entry(slave, index, (uint8_t)sub, data + at, &got);
        if (abort && !reads_as_zero(abort, sub))
            return abort;
        at += bytes;
    }
    *size = at;
    return 0;
}

static bool same_as_present(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex, const uint8_t *data, size_t size)
{
    uint8_t present[8] = {0};
    size_t got = sizeof present;
    return size <= sizeof present && read_entry(slave, index, subindex, present, &got) == 0 &&
           memcmp(present, data, size) == 0;
}

static uint32_t write_entries(cm1e_sim_slave_t *slave, uint16_t index, unsigned last, const uint8_t *data, size_t size,
                              size_t *used)
{
    size_t at = 0;
    for (unsigned sub = 1; sub <= last && at < size; sub++) {
        const cm1e_entry_t *entry = cm1e_sim_coe_entry(slave, index, (uint8_t)sub);
        if (!entry)
            continue;
        const size_t bytes = entry_bytes(entry);
        if (bytes > size - at)
            return SDO_ABORT_TYPE_LENGTH;
        const uint32_t abort = write_entry(slave, index, (uint8_t)sub, data + at, bytes);
        /* Read-only entries in between may be written with their present values. */
        if (abort && (abort != SDO_ABORT_READ_ONLY || !same_as_present(slave, index, (uint8_t)sub, data + at, bytes)))
            return abort;
        at += bytes;
    }
    *used = at;
    return 0;
}

static uint32_t write_complete(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex, const uint8_t *data,
                               size_t size)
{
    unsigned last = 0;
    uint32_t refused = check_complete_access(slave, index, subindex);
    if (!refused)
        refused = read_highest_subindex(slave, index, &last);
    if (refused)
        return refused;
    const cm1e_entry_t *count_entry = cm1e_sim_coe_entry(slave, index, 0);
    const bool count_writable = subindex == 0 && count_entry && (count_entry->access & CM1E_ACCESS_WRITE);
    size_t used = 0;
    uint32_t abort = 0;
    if (subindex == 0) {
        if (size < SUBINDEX_0_BYTES)
            return SDO_ABORT_TYPE_LENGTH;
        /* The number of entries is set to 0 first and to its new value last, as for single access to an assignment. */
        const uint8_t none = 0;
        if (count_writable) {
            last = data[0];
            abort = write_entry(slave, index, 0, &none, 1);
        } else if (data[0] != last) {
            abort = SDO_ABORT_READ_ONLY;
        }
        if (abort)
            return abort;
    }
    const uint8_t *entries = subindex == 0 ? data + SUBINDEX_0_BYTES : data;
    const size_t entries_size = size - (size_t)(entries - data);
    abort = write_entries(slave, index, last, entries, entries_size, &used);
    if (abort == 0 && used != entries_size)
        abort = SDO_ABORT_TYPE_LENGTH;
    if (abort == 0 && count_writable)
        abort = write_entry(slave, index, 0, data, 1);
    return abort;
}

uint32_t cm1e_sim_coe_read(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex, bool complete_access,
                           uint8_t *data, size_t *size)
{
    return complete_access ? read_complete(slave, index, subindex, data, size)
                           : read_entry(slave, index, subindex, data, size);
}

uint32_t cm1e_sim_coe_write(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex, bool complete_access,
                            const uint8_t *data, size_t size)
{
    return complete_access ? write_complete(slave, index, subindex, data, size)
                           : write_entry(slave, index, subindex, data, size);
}

uint32_t cm1e_sim_coe_check_write(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex, bool complete_access,
                                  size_t size)
{
    if (size > COE_SDO_MAX_BYTES)
        return SDO_ABORT_MEMORY;
    if (complete_access)
        return check_complete_access(slave, index, subindex);
    if (!cm1e_sim_coe_object(slave, index))
        return SDO_ABORT_NO_OBJECT;
    const cm1e_entry_t *entry = cm1e_sim_coe_entry(slave, index, subindex);
    if (!entry)
        return SDO_ABORT_NO_SUBINDEX;
    if (!(entry->access & CM1E_ACCESS_WRITE))
        return SDO_ABORT_READ_ONLY;
    return entry->type != CM1E_TYPE_STRING && size > entry_bytes(entry) ? (uint32_t)SDO_ABORT_TOO_LONG : 0;
}
