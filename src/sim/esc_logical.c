/* Logical addresses: a datagram passes through the FMMUs to the memory. */
#include "sim/esc_chip.h"

/* Bits first ... last of the logical byte `address` belong to the FMMU. */
static void byte_bits(const esc_fmmu_t *fmmu, uint32_t address, unsigned *first, unsigned *last)
{
    *first = address == fmmu->start ? fmmu->start_bit : 0;
    *last = address == fmmu->end - 1 ? fmmu->end_bit : 7;
}

/* Where a logical bit lies in the slave's memory, counted in bits. */
static uint32_t physical_bit(const esc_fmmu_t *fmmu, uint32_t address, unsigned bit)
{
    return fmmu->physical * 8u + fmmu->physical_bit + (address - fmmu->start) * 8u + bit - fmmu->start_bit;
}

static bool read_bits(cm1e_sim_slave_t *slave, const esc_fmmu_t *fmmu, uint32_t from, uint32_t to, uint8_t *data)
{
    bool any = false;
    uint32_t cached = UINT32_MAX;
    bool cached_ok = false;
    uint8_t byte = 0;
    for (uint32_t address = from; address < to; address++, data++) {
        unsigned first, last;
        byte_bits(fmmu, address, &first, &last);
        for (unsigned bit = first; bit <= last; bit++) {
            const uint32_t place = physical_bit(fmmu, address, bit);
            if (place / 8 != cached) {
                cached = place / 8;
                cached_ok = cm1e_sim_esc_read(slave, cached, &byte, 1);
            }
            if (!cached_ok)
                continue;
            any = true;
            *data = (uint8_t)((*data & ~(1u << bit)) | ((byte >> place % 8 & 1u) << bit));
        }
    }
    return any;
}

/* Byte by byte, the other bits of each as they stand in the memory. */
static bool write_bits(cm1e_sim_slave_t *slave, const esc_fmmu_t *fmmu, uint32_t from, uint32_t to, const uint8_t *data)
{
    bool any = false;
    uint32_t cached = UINT32_MAX;
    uint8_t byte = 0;
    for (uint32_t address = from; address < to; address++, data++) {
        unsigned first, last;
        byte_bits(fmmu, address, &first, &last);
        for (unsigned bit = first; bit <= last; bit++) {
            const uint32_t place = physical_bit(fmmu, address, bit);
            if (place / 8 >= ESC_MEMORY_BYTES)
                return any;
            if (place / 8 != cached) {
                if (cached != UINT32_MAX)
                    any |= cm1e_sim_esc_write(slave, cached, &byte, 1);
                cached = place / 8;
                byte = slave->memory[cached];
            }
            byte = (uint8_t)((byte & ~(1u << place % 8)) | ((*data >> bit & 1u) << place % 8));
        }
    }
    if (cached != UINT32_MAX)
        any |= cm1e_sim_esc_write(slave, cached, &byte, 1);
    return any;
}

/* The part of the datagram that an FMMU maps; false: none. */
static bool overlap(const esc_fmmu_t *fmmu, uint32_t address, uint16_t length, uint32_t *from, uint32_t *to)
{
    const uint64_t end = (uint64_t)address + length;
    *from = address > fmmu->start ? address : fmmu->start;
    *to = end < fmmu->end ? (uint32_t)end : fmmu->end;
    return *from < *to;
}

static bool outside(const esc_fmmu_list_t *list, uint32_t address, uint16_t length)
{
    return list->count == 0 || address >= list->end || (uint64_t)address + length <= list->start;
}

bool cm1e_sim_esc_logical_read(cm1e_sim_slave_t *slave, uint32_t address, uint8_t *data, uint16_t length)
{
    bool any = false;
    if (outside(&slave->reads, address, length))
        return false;
    for (unsigned i = 0; i < slave->reads.count; i++) {
        const esc_fmmu_t *fmmu = &slave->reads.entries[i];
        uint32_t from, to;
        if (!overlap(fmmu, address, length, &from, &to))
            continue;
        uint8_t *place = data + (from - address);
        if (fmmu->bytewise)
            any |= cm1e_sim_esc_read(slave, fmmu->physical + (from - fmmu->start), place, to - from);
        else
            any |= read_bits(slave, fmmu, from, to, place);
    }
    return any;
}

bool cm1e_sim_esc_logical_write(cm1e_sim_slave_t *slave, uint32_t address, const uint8_t *data, uint16_t length)
{
    bool any = false;
    if (outside(&slave->writes, address, length))
        return false;
    for (unsigned i = 0; i < slave->writes.count; i++) {
        const esc_fmmu_t *fmmu = &slave->writes.entries[i];
        uint32_t from, to;
        if (!overlap(fmmu, address, length, &from, &to))
            continue;
        const uint8_t *place = data + (from - address);
        if (fmmu->bytewise)
            any |= cm1e_sim_esc_write(slave, fmmu->physical + (from - fmmu->start), place, to - from);
        else
            any |= write_bits(slave, fmmu, from, to, place);
    }
    return any;
}
