#include "description/check_private.h"

/* Compares the PDO entries with the dictionary, and checks which PDOs exclude each other. */

/* Indexes below are data types, which mappings use for unused bits (CiA 301, dummy mapping). */
enum { FIRST_OBJECT = 0x1000 };

/* ---- entries ----------------------------------------------------------------------------------------------------- */

/* The device's own mapping object says that it maps this part of an object. The guide of the CM1-E does so for 0x6079,
 * 16 of 32 bits (UG 7.2.5): odd, but no contradiction within the file. */
static bool device_maps_part(const cm1e_check_t *check, const cm1e_described_pdo_t *pdo, size_t row, uint32_t bits)
{
    const cm1e_described_pdo_entry_t *entry = &pdo->entries.at[row];
    uint32_t mapped;
    cm1e_place_t place;
    return entry->bits < bits && row < 254 &&
           cm1e_check_default(check, pdo->index, (uint8_t)(row + 1), &mapped, &place) &&
           mapped == ((uint32_t)entry->index << 16 | (uint32_t)entry->subindex << 8 | (entry->bits & 0xFF));
}

static void check_mapped(const cm1e_check_t *check, const cm1e_described_pdo_t *pdo, size_t row,
                         const cm1e_check_entry_t *found)
{
    const cm1e_described_pdo_entry_t *entry = &pdo->entries.at[row];
    const uint8_t access = found->entry->access, needed = pdo->transmit ? CM1E_ACCESS_TXPDO : CM1E_ACCESS_RXPDO;
    if (entry->bits != found->entry->bits && found->entry->bits > 0 &&
        !device_maps_part(check, pdo, row, found->entry->bits))
        cm1e_check_add(check, CM1E_RULE_PDO_ENTRY_SIZE, entry->place,
                       "%s 0x%04X maps 0x%04X:%02X with %u bits; the object has %u", cm1e_pdo_kind(pdo),
                       pdo->index, entry->index, entry->subindex, (unsigned)entry->bits,
                       (unsigned)found->entry->bits);
    if (check->states_mappability && !(access & needed))
        cm1e_check_add(check, CM1E_RULE_PDO_ENTRY_NOT_MAPPABLE, entry->place,
                       "%s 0x%04X maps 0x%04X:%02X, which the dictionary does not mark as mappable in a %s",
                       cm1e_pdo_kind(pdo), pdo->index, entry->index, entry->subindex, cm1e_pdo_kind(pdo));
}

static void check_entry(const cm1e_check_t *check, const cm1e_described_pdo_t *pdo, size_t row, bool silent)
{
    const cm1e_described_pdo_entry_t *entry = &pdo->entries.at[row];
    const uint32_t type_bits = entry->type ? cm1e_type_bits(entry->type) : 0;
    if (type_bits > 0 && entry->bits != type_bits)
        cm1e_check_add(check, CM1E_RULE_PDO_ENTRY_TYPE, entry->place,
                       "%s 0x%04X gives 0x%04X:%02X %u bits and the type %s, which has %u", cm1e_pdo_kind(pdo),
                       pdo->index, entry->index, entry->subindex, (unsigned)entry->bits, entry->type,
                       (unsigned)type_bits);
    if (entry->index < FIRST_OBJECT || !check->has_dictionary)
        return;
    const cm1e_check_entry_t *found = cm1e_check_find_entry(check, entry->index, entry->subindex);
    if (found)
        check_mapped(check, pdo, row, found);
    else if (!silent)
        cm1e_check_add(check, CM1E_RULE_PDO_ENTRY_NOT_IN_DICTIONARY, entry->place,
                       cm1e_check_find_object(check, entry->index)
                           ? "%s 0x%04X maps 0x%04X:%02X, a sub-index that the object does not have"
                           : "%s 0x%04X maps 0x%04X:%02X, an object that is not in the dictionary",
                       cm1e_pdo_kind(pdo), pdo->index, entry->index, entry->subindex);
}

#define TWICE "there are two PDOs 0x%04X"

/* ---- PDOs -------------------------------------------------------------------------------------------------------- */

static void check_sync_manager(const cm1e_check_t *check, const cm1e_described_pdo_t *pdo)
{
    const cm1e_description_t *device = check->device;
    const char *needed = pdo->transmit ? "inputs" : "outputs";
    if (pdo->sync_manager == CM1E_NO_SYNC_MANAGER) {
        if (pdo->mandatory)
            cm1e_check_add(check, CM1E_RULE_PDO_MANDATORY_UNASSIGNED, pdo->place,
                           "%s 0x%04X is mandatory, but no sync manager carries it", cm1e_pdo_kind(pdo),
                           pdo->index);
        return;
    }
    if (pdo->sync_manager < 0 || (size_t)pdo->sync_manager >= device->sync_managers.count)
        cm1e_check_add(check, CM1E_RULE_PDO_SYNC_MANAGER, pdo->place,
                       "%s 0x%04X is assigned to sync manager %d; the device has %zu", cm1e_pdo_kind(pdo),
                       pdo->index, pdo->sync_manager, device->sync_managers.count);
    else if (device->sync_managers.at[pdo->sync_manager].use != CM1E_SM_UNUSED && /* which stands for unknown, too */
             device->sync_managers.at[pdo->sync_manager].use != (pdo->transmit ? CM1E_SM_INPUTS : CM1E_SM_OUTPUTS))
        cm1e_check_add(check, CM1E_RULE_PDO_SYNC_MANAGER, pdo->place,
                       "%s 0x%04X is assigned to sync manager %d, which is not for %s", cm1e_pdo_kind(pdo),
                       pdo->index, pdo->sync_manager, needed);
}

/* Objects 0x1600 ... 0x17FF and 0x1A00 ... 0x1BFF (ETG.1000.6 table 74); devices without CoE choose freely. */
static void check_index(const cm1e_check_t *check, const cm1e_described_pdo_t *pdo)
{
    const uint16_t first = pdo->transmit ? 0x1A00 : 0x1600, last = pdo->transmit ? 0x1BFF : 0x17FF;
    if (check->device->mailbox.coe && (pdo->index < first || pdo->index > last))
        cm1e_check_add(check, CM1E_RULE_PDO_INDEX, pdo->place, "%s 0x%04X: %ss have the indexes 0x%04X to 0x%04X",
                       cm1e_pdo_kind(pdo), pdo->index, cm1e_pdo_kind(pdo), first, last);
}

void cm1e_check_pdos(const cm1e_check_t *check)
{
    const cm1e_description_t *device = check->device;
    for (size_t i = 0; i < device->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        check_sync_manager(check, pdo);
        check_index(check, pdo);
        for (size_t row = 0; !pdo->is_virtual && row < pdo->entries.count; row++)
            check_entry(check, pdo, row, check->silent_pdos[i]);
    }
    /* Those that the increments of the slots moved onto others. */
    for (size_t i = 1; check->by_default && i < device->pdos.count; i++) {
        const cm1e_described_pdo_t *before = &device->pdos.at[check->pdos[i - 1].order];
        const cm1e_described_pdo_t *pdo = &device->pdos.at[check->pdos[i].order];
        if (pdo->index == before->index && (pdo->depends_on_slot || before->depends_on_slot))
            cm1e_check_add(check, CM1E_RULE_PDO_TWICE, pdo->place, TWICE, pdo->index);
    }
}

void cm1e_check_own_pdos(const cm1e_check_t *check, const cm1e_pdo_list_t *pdos)
{
    cm1e_check_seen_t seen = {0};
    for (size_t i = 0; i < pdos->count; i++)
        if (cm1e_check_seen(&seen, pdos->at[i].index))
            cm1e_check_add(check, CM1E_RULE_PDO_TWICE, pdos->at[i].place, TWICE, pdos->at[i].index);
}

/* ---- PDOs that exclude each other -------------------------------------------------------------------------------- */

typedef struct exclusion {
    cm1e_check_key_t key; /* the PDO that excludes in the upper half, the other one in the lower */
    uint16_t from, to;
    const cm1e_described_pdo_t *pdo;
    cm1e_place_t place;
} exclusion_t;

static uint32_t pair(uint16_t from, uint16_t to) { return (uint32_t)from << 16 | to; }

static bool is_excluded(const exclusion_t *exclusions, size_t count, uint16_t from, uint16_t to)
{
    const size_t found = cm1e_check_first(exclusions, count, sizeof *exclusions, pair(from, to));
    return found < count && exclusions[found].key.number == pair(from, to);
}

static void check_exclusion(const cm1e_check_t *check, const exclusion_t *all, size_t count, size_t i)
{
    const exclusion_t *e = &all[i];
    const char *kind = cm1e_pdo_kind(e->pdo);
    const cm1e_described_pdo_t *other = cm1e_check_find_pdo(check, e->to);
    if (i > 0 && all[i - 1].key.number == e->key.number) {
        cm1e_check_add(check, CM1E_RULE_EXCLUDE_TWICE, e->place, "%s 0x%04X excludes 0x%04X twice", kind, e->from,
                       e->to);
        return;
    }
    if (e->from == e->to)
        cm1e_check_add(check, CM1E_RULE_EXCLUDE_ITSELF, e->place, "%s 0x%04X excludes itself", kind, e->from);
    else if (!other)
        cm1e_check_add(check, CM1E_RULE_EXCLUDE_MISSING, e->place,
                       "%s 0x%04X excludes 0x%04X, which is not there", kind, e->from, e->to);
    else if (!is_excluded(all, count, e->to, e->from))
        cm1e_check_add(check, CM1E_RULE_EXCLUDE_ONE_SIDED, e->place,
                       "%s 0x%04X excludes 0x%04X, but 0x%04X does not exclude 0x%04X", kind, e->from, e->to, e->to,
                       e->from);
    if (other && e->from != e->to && e->pdo->sync_manager != CM1E_NO_SYNC_MANAGER &&
        e->pdo->sync_manager == other->sync_manager && (e->from < e->to || !is_excluded(all, count, e->to, e->from)))
        cm1e_check_add(check, CM1E_RULE_EXCLUDED_ASSIGNED, e->place,
                       "0x%04X and 0x%04X exclude each other, but sync manager %d carries both", e->from, e->to,
                       e->pdo->sync_manager);
}

void cm1e_check_excludes(const cm1e_check_t *check)
{
    const cm1e_description_t *device = check->device;
    size_t count = 0;
    for (size_t i = 0; i < device->pdos.count; i++)
        count += device->pdos.at[i].excludes.count;
    if (count == 0 || count > CM1E_ARENA_LIMIT / sizeof(exclusion_t))
        return;
    exclusion_t *all = cm1e_arena_take(check->arena, count * sizeof *all);
    if (check->arena->failed)
        return;
    size_t n = 0;
    for (size_t i = 0; i < device->pdos.count; i++)
        for (size_t j = 0; j < device->pdos.at[i].excludes.count; j++, n++) {
            const cm1e_exclude_t *exclude = &device->pdos.at[i].excludes.at[j];
            const uint16_t from = device->pdos.at[i].index;
            all[n] = (exclusion_t){{pair(from, exclude->index), n}, from, exclude->index, &device->pdos.at[i],
                                   exclude->place};
        }
    cm1e_check_sort(all, count, sizeof *all);
    for (size_t i = 0; i < count; i++)
        check_exclusion(check, all, count, i);
}
