#include "sim/esc_chip.h"

#include <string.h>

#include "core/bytes.h"

/* Registers of an FMMU (0x0600 + 16 n). */
enum {
    FMMU_BYTES = 16, AT_LOGICAL = 0, AT_LENGTH = 4, AT_START_BIT = 6, AT_END_BIT = 7, AT_PHYSICAL = 8,
    AT_PHYSICAL_BIT = 10, AT_TYPE = 11, AT_ACTIVATE = 12,
};
enum { TYPE_READ = 0x01, TYPE_WRITE = 0x02 };

static void list_add(esc_fmmu_list_t *list, const esc_fmmu_t *fmmu)
{
    if (list->count == 0 || fmmu->start < list->start)
        list->start = fmmu->start;
    if (list->count == 0 || fmmu->end > list->end)
        list->end = fmmu->end;
    list->entries[list->count++] = *fmmu;
}

void cm1e_sim_esc_fmmu_decode(cm1e_sim_slave_t *slave)
{
    slave->reads.count = slave->writes.count = 0;
    const unsigned count = cm1e_sim_quirk_fmmus(slave);
    memset(slave->memory + ESC_FMMU + count * FMMU_BYTES, 0, (ESC_FMMUS - count) * FMMU_BYTES);
    for (unsigned i = 0; i < count; i++) {
        const uint8_t *registers = slave->memory + ESC_FMMU + i * FMMU_BYTES;
        const uint32_t start = cm1e_get_u32(registers + AT_LOGICAL);
        const uint16_t length = cm1e_get_u16(registers + AT_LENGTH);
        /* Logical addresses do not wrap: an FMMU that extends beyond the end is not mapped. */
        if (!(registers[AT_ACTIVATE] & 0x01) || length == 0 || start > UINT32_MAX - length)
            continue;
        const esc_fmmu_t fmmu = {
            .start = start,
            .end = start + length,
            .physical = cm1e_get_u16(registers + AT_PHYSICAL),
            .start_bit = registers[AT_START_BIT] & 7,
            .end_bit = registers[AT_END_BIT] & 7,
            .physical_bit = registers[AT_PHYSICAL_BIT] & 7,
            .bytewise = (registers[AT_START_BIT] & 7) == 0 && (registers[AT_END_BIT] & 7) == 7 &&
                        (registers[AT_PHYSICAL_BIT] & 7) == 0,
        };
        if (registers[AT_TYPE] & TYPE_READ)
            list_add(&slave->reads, &fmmu);
        if (registers[AT_TYPE] & TYPE_WRITE)
            list_add(&slave->writes, &fmmu);
    }
}
