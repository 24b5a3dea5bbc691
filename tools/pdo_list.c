#include "pdo_list.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_image.h"
#include "cm1e/io.h"
#include "core/bytes.h"
#include "description/sii_image.h"
#include "sii_device.h"

enum { FIRST_TXPDO = 0x1A00, ASSIGNED_MAX = 64, ENTRIES_MAX = 254 };

static listed_entry_t *append(pdo_list_t *list)
{
    if (list->count == list->room) {
        const size_t room = 2 * list->room + 32;
        listed_entry_t *entries = realloc(list->entries, room * sizeof *entries);
        if (!entries)
            return NULL;
        list->entries = entries;
        list->room = room;
    }
    list->entries[list->count] = (listed_entry_t){0};
    return &list->entries[list->count++];
}

void pdo_list_free(pdo_list_t *list)
{
    free(list->entries);
    *list = (pdo_list_t){0};
}

/* ---- what the SII says ------------------------------------------------------------------------------------------- */

/** NULL: the SII cannot be read, or has no device. */
static const cm1e_description_t *read_sii(cm1e_bus_t *bus, uint16_t position, cm1e_description_file_t *file)
{
    input_t image;
    cm1e_diag_t diag;
    if (!read_device(bus, position, &image, &diag))
        return NULL;
    const bool good = cm1e_sii_read(file, image.bytes, image.size, NULL, &diag) == CM1E_OK;
    free(image.bytes);
    return good && file->devices.count > 0 ? &file->devices.at[0] : NULL;
}

/** Name and type of an object that any PDO of the SII maps. */
static void name_entry(const cm1e_description_t *sii, listed_entry_t *entry)
{
    snprintf(entry->type, sizeof entry->type, "%s",
             entry->index ? cm1e_io_type_name(cm1e_io_type_of_bits(entry->bits)) : "");
    for (size_t i = 0; sii && i < sii->pdos.count; i++) {
        const cm1e_described_pdo_t *pdo = &sii->pdos.at[i];
        if (pdo->index == entry->pdo)
            snprintf(entry->pdo_name, sizeof entry->pdo_name, "%s", pdo->name ? pdo->name : "");
        for (size_t k = 0; entry->index && k < pdo->entries.count; k++) {
            const cm1e_described_pdo_entry_t *known = &pdo->entries.at[k];
            if (known->index != entry->index || known->subindex != entry->subindex)
                continue;
            snprintf(entry->name, sizeof entry->name, "%s", known->name ? known->name : "");
            if (known->bits == entry->bits && known->type && known->type[0])
                snprintf(entry->type, sizeof entry->type, "%s", known->type);
        }
    }
}

static bool list_sii(const cm1e_description_t *sii, pdo_list_t *list)
{
    for (int transmit = 0; transmit < 2; transmit++) {
        unsigned bit = 0;
        int manager = CM1E_NO_SYNC_MANAGER;
        for (size_t i = 0; sii && i < sii->pdos.count; i++) {
            const cm1e_described_pdo_t *pdo = &sii->pdos.at[i];
            if (pdo->transmit != transmit || pdo->sync_manager == CM1E_NO_SYNC_MANAGER)
                continue;
            bit = pdo->sync_manager == manager ? bit : (bit + 7) / 8 * 8; /* each begins with a whole byte */
            manager = pdo->sync_manager;
            for (size_t k = 0; k < pdo->entries.count; k++) {
                listed_entry_t *entry = append(list);
                if (!entry)
                    return false;
                *entry = (listed_entry_t){.output = !transmit, .pdo = pdo->index, .index = pdo->entries.at[k].index,
                                          .subindex = pdo->entries.at[k].subindex, .bits = pdo->entries.at[k].bits,
                                          .bit = bit};
                bit += entry->bits;
            }
        }
    }
    return true;
}

/* ---- what the slave says ----------------------------------------------------------------------------------------- */

static bool read_value(cm1e_bus_t *bus, uint16_t position, unsigned index, unsigned subindex, uint32_t *value)
{
    uint8_t data[4] = {0};
    size_t size = sizeof data;
    if (cm1e_sdo_read(bus, position, (uint16_t)index, (uint8_t)subindex, data, &size, NULL) != CM1E_OK)
        return false;
    *value = (uint32_t)cm1e_get_uint(data, (unsigned)size);
    return true;
}

/** false: no memory. A PDO whose objects cannot be read ends there. */
static bool list_pdo(cm1e_bus_t *bus, uint16_t position, bool output, unsigned pdo, unsigned *bit, pdo_list_t *list)
{
    uint32_t count = 0, mapped = 0;
    read_value(bus, position, pdo, 0, &count);
    for (unsigned i = 1; i <= count && i <= ENTRIES_MAX && read_value(bus, position, pdo, i, &mapped); i++) {
        listed_entry_t *entry = append(list);
        if (!entry)
            return false;
        *entry = (listed_entry_t){.output = output, .pdo = (uint16_t)pdo, .index = (uint16_t)(mapped >> 16),
                                  .subindex = (uint8_t)(mapped >> 8), .bits = mapped & 0xFF, .bit = *bit};
        *bit += entry->bits;
    }
    return true;
}

static bool list_assigned(cm1e_bus_t *bus, uint16_t position, pdo_list_t *list)
{
    for (unsigned manager = 0; manager < 2; manager++) { /* the first one may carry the inputs */
        const unsigned index = OBJ_1C12_RXPDO_ASSIGN + manager;
        uint32_t count = 0, pdo = 0;
        unsigned bit = 0;
        list->by_coe |= read_value(bus, position, index, 0, &count);
        for (unsigned i = 1; i <= count && i <= ASSIGNED_MAX && read_value(bus, position, index, i, &pdo); i++)
            if (!list_pdo(bus, position, (pdo & 0xFFFF) < FIRST_TXPDO, pdo & 0xFFFF, &bit, list))
                return false;
    }
    return true;
}

bool pdo_list_read(cm1e_bus_t *bus, uint16_t position, pdo_list_t *list)
{
    cm1e_description_file_t file = {0};
    const cm1e_description_t *sii = read_sii(bus, position, &file);
    *list = (pdo_list_t){0};
    bool good = !cm1e_bus_slave_has_coe(bus, position) || list_assigned(bus, position, list);
    if (good && !list->by_coe)
        good = list_sii(sii, list);
    list->unknown = !list->by_coe && !sii;
    for (size_t i = 0; good && i < list->count; i++)
        name_entry(sii, &list->entries[i]);
    cm1e_description_file_free(&file);
    if (!good)
        pdo_list_free(list);
    return good;
}
