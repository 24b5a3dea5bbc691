/* PDO mappings. The guide gives two orders of the same objects; a device has one of them for all (UG 4.4, 7.2). */
#include <stdio.h>
#include <string.h>

#include "core/bytes.h"
#include "prove/prove.h"

enum { MAPPING_TEXT = 200 };

static void append(char text[MAPPING_TEXT], unsigned index, unsigned subindex, unsigned bits)
{
    const size_t used = strlen(text);
    snprintf(text + used, MAPPING_TEXT - used, "%s%04X%s%.0u/%u", used ? " " : "", index, subindex ? ":" : "", subindex,
             bits);
}

/** The mapping as the device has it: "6040/16 60FE/16"; false: it cannot be read. */
static bool read_mapping(const prove_t *prove, uint16_t pdo, char text[MAPPING_TEXT])
{
    int64_t count, value;
    text[0] = '\0';
    if (!prove_value(prove, pdo, 0, &count))
        return false;
    for (int64_t i = 1; i <= count; i++) {
        if (!prove_value(prove, pdo, (uint8_t)i, &value))
            return false;
        append(text, (unsigned)(value >> 16) & 0xFFFF, (unsigned)(value >> 8) & 0xFF, (unsigned)value & 0xFF);
    }
    return true;
}

static void write_ours(const prove_t *prove, uint16_t index, cm1e_pdo_order_t order, char text[MAPPING_TEXT])
{
    cm1e_pdo_t pdo;
    text[0] = '\0';
    cm1e_device_pdo(&pdo, (cm1e_mapping_t)(index & 0xF), index >= 0x1A00, order, prove->firmware->firmware);
    for (unsigned i = 0; i < pdo.entry_count; i++)
        append(text, pdo.entries[i].index, pdo.entries[i].subindex, pdo.entries[i].bits);
}

static void look_at_pdo(prove_t *prove, uint16_t index)
{
    char found[MAPPING_TEXT], first[MAPPING_TEXT], second[MAPPING_TEXT], thing[16];
    snprintf(thing, sizeof thing, "0x%04X", index);
    if (!read_mapping(prove, index, found)) {
        prove_note(prove, "it cannot be read");
        return;
    }
    write_ours(prove, index, CM1E_PDO_ORDER_UG_4_4, first);
    write_ours(prove, index, CM1E_PDO_ORDER_UG_7_2, second);
    const bool is_second = strcmp(found, second) == 0;
    prove_compare(prove, thing, is_second ? second : first, found);
    if (strcmp(first, second) != 0 && (is_second || strcmp(found, first) == 0))
        prove_note(prove, "order of %s", is_second ? "UG 7.2" : "UG 4.4");
}

/** Every row of the mappings of the bridge is in its dictionary. */
static void look_at_bridge(prove_t *prove)
{
    for (size_t i = 0; i < prove->entry_count; i++) {
        const seen_entry_t *entry = &prove->entries[i];
        const uint16_t area = entry->index & 0xFE00;
        char thing[16];
        int64_t value;
        if (!entry->ours || (area != 0x1600 && area != 0x1A00) || entry->ours->availability != CM1E_AVAILABLE
            || !prove_value(prove, entry->index, entry->subindex, &value))
            continue;
        snprintf(thing, sizeof thing, "0x%04X:%02X", entry->index, entry->subindex);
        prove_compare_number(prove, thing, entry->ours->default_value, value, 8);
    }
}

void look_mapping(prove_t *prove, const point_t *point)
{
    if (point->row > 0)
        look_at_pdo(prove, (uint16_t)point->row);
    else
        look_at_bridge(prove);
}
