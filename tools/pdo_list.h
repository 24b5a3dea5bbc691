/**
 * @file pdo_list.h
 * The process data of a live slave after its scan: the PDOs that it has assigned, asked of it where it has CoE, else as
 * its SII says; with names and types as far as the SII has them.
 */
#ifndef CM1E_TOOLS_PDO_LIST_H
#define CM1E_TOOLS_PDO_LIST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/bus.h"

typedef struct listed_entry {
    bool output;
    uint16_t pdo, index;      /**< index 0: a gap */
    uint8_t subindex;
    unsigned bits, bit;       /**< bit: from the beginning of the process data of this direction */
    char pdo_name[64], name[64], type[16];
} listed_entry_t;

typedef struct pdo_list {
    bool by_coe;              /**< asked of the slave; false: of its SII */
    bool unknown;             /**< neither of them could be read */
    size_t count, room;
    listed_entry_t *entries;  /**< outputs, then inputs */
} pdo_list_t;

/** false: no memory. The caller frees the list. */
bool pdo_list_read(cm1e_bus_t *bus, uint16_t position, pdo_list_t *list);
void pdo_list_free(pdo_list_t *list);

#endif
