#include <stdlib.h>

#include "description/check.h"

enum { MODE_MASK = 0x03, MODE_MAILBOX = 0x02, BUFFERS = 3 };

typedef struct area {
    uint32_t start, end; /* behind the last byte */
    size_t n;
    bool buffered;
} area_t;

uint32_t cm1e_sync_manager_end(const cm1e_described_sync_manager_t *manager)
{
    const bool buffered = (manager->control & MODE_MASK) != MODE_MAILBOX;
    return manager->start + (uint32_t)manager->length * (buffered ? BUFFERS : 1);
}

static int by_start(const void *left, const void *right)
{
    const area_t *a = left, *b = right;
    return a->start != b->start ? (a->start < b->start ? -1 : 1) : (a->n > b->n) - (a->n < b->n);
}

static size_t collect(area_t *areas, const cm1e_described_sync_manager_t *managers, size_t count)
{
    size_t used = 0;
    for (size_t n = 0; n < count; n++)
        if ((managers[n].enable & 1) && managers[n].length > 0)
            areas[used++] = (area_t){managers[n].start, cm1e_sync_manager_end(&managers[n]), n,
                                     (managers[n].control & MODE_MASK) != MODE_MAILBOX};
    return used;
}

void cm1e_check_overlap(cm1e_findings_t *findings, const cm1e_described_sync_manager_t *managers, size_t count)
{
    if (count == 0 || count > CM1E_ARENA_LIMIT / sizeof(area_t))
        return;
    area_t *areas = cm1e_arena_take(&findings->arena, count * sizeof *areas);
    if (findings->arena.failed)
        return;
    const size_t used = collect(areas, managers, count);
    qsort(areas, used, sizeof *areas, by_start);
    for (size_t i = 1, farthest = 0; i < used; i++) {
        const area_t *before = &areas[farthest];
        if (areas[i].start < before->end)
            cm1e_findings_add(findings, CM1E_RULE_SYNC_MANAGERS_OVERLAP, managers[areas[i].n].place,
                              "sync manager %zu begins at 0x%04X, within sync manager %zu, which takes 0x%04X to "
                              "0x%04X%s",
                              areas[i].n, (unsigned)areas[i].start, before->n, (unsigned)before->start,
                              (unsigned)before->end - 1, before->buffered ? ", its length three times" : "");
        if (areas[i].end > before->end)
            farthest = i;
    }
}
