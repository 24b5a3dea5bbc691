#include "description/check.h"

enum { MODE_MASK = 0x03, MODE_MAILBOX = 0x02, BUFFERS = 3 };

/* Bytes of the chip's memory: process data has three buffers behind each other, a mailbox one (ETG.1000.4 6.7). */
static uint32_t memory_of(const cm1e_described_sync_manager_t *manager)
{
    return (uint32_t)manager->length * ((manager->control & MODE_MASK) == MODE_MAILBOX ? 1 : BUFFERS);
}

void cm1e_check_overlap(cm1e_findings_t *findings, const cm1e_described_sync_manager_t *managers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < i; j++) {
            const cm1e_described_sync_manager_t *a = &managers[j], *b = &managers[i];
            const uint32_t end_a = a->start + memory_of(a), end_b = b->start + memory_of(b);
            if (!(a->enable & 1) || !(b->enable & 1) || a->length == 0 || b->length == 0 || a->start >= end_b ||
                b->start >= end_a)
                continue;
            cm1e_findings_add(findings, CM1E_RULE_SYNC_MANAGERS_OVERLAP, b->place,
                              "sync managers %zu (0x%04X ... 0x%04X) and %zu (0x%04X ... 0x%04X) overlap; process data "
                              "takes its length three times",
                              j, a->start, (unsigned)end_a - 1, i, b->start, (unsigned)end_b - 1);
        }
}
