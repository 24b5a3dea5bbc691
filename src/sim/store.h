/**
 * @file store.h
 * The object dictionary of a simulated device with a present value for each of its entries, and the rules of SDO access
 * that apply to every device, with their abort codes (ETG.1000.6 table 41). Private to the simulator.
 */
#ifndef CM1E_SIM_STORE_H
#define CM1E_SIM_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "device/devices.h"

typedef struct cm1e_sim_store {
    const cm1e_object_t **objects; /**< those that the device has, in order of index */
    size_t object_count;
    cm1e_firmware_t firmware;      /**< entries that came later are not there */
    uint32_t *first_entry;         /**< per object: place of its first entry in `values` */
    int64_t *values;               /**< one per entry of the device tables, texts included */
    cm1e_object_t *own_objects;    /**< of a profile: what `objects` points to; NULL: the tables */
    cm1e_entry_t *own_entries;
    const struct cm1e_sim_profile *profile; /**< NULL: none; it outlives the store */
} cm1e_sim_store_t;

/** An entry and its value. */
typedef struct cm1e_sim_cell {
    const cm1e_entry_t *entry;
    int64_t *value;
} cm1e_sim_cell_t;

/** Initialises every value with the default of the device's tables. Returns false if there is no memory; destroy the
 *  store in that case too. */
bool cm1e_sim_store_create(cm1e_sim_store_t *store, const cm1e_device_t *device, cm1e_firmware_t firmware);
void cm1e_sim_store_destroy(cm1e_sim_store_t *store);
/** store_profile.c: amends the entries by a profile, and adds those that only it has. Values stay. Entries that it
 *  calls missing stay too: the slave hides them. Refuses a number that the type of its entry does not have. After an
 *  error nothing has changed. */
cm1e_error_t cm1e_sim_store_play(cm1e_sim_store_t *store, const struct cm1e_sim_profile *profile, cm1e_diag_t *diag);
/** Sets the values that the profile states; after a reset. Does nothing without one. */
void cm1e_sim_store_set_profile_values(cm1e_sim_store_t *store);
/** NULL: no more. */
const cm1e_object_t *cm1e_sim_store_object(const cm1e_sim_store_t *store, size_t n);
/** Finds an entry. Returns 0, or the abort code for what is missing; the cell then has two NULL pointers. */
uint32_t cm1e_sim_store_find(const cm1e_sim_store_t *store, uint16_t index, uint8_t subindex, cm1e_sim_cell_t *cell);
/** Finds an entry that can be read. */
uint32_t cm1e_sim_store_find_readable(const cm1e_sim_store_t *store, uint16_t index, uint8_t subindex,
                                      cm1e_sim_cell_t *cell);
/** Does nothing where there is no such entry. */
void cm1e_sim_store_set(cm1e_sim_store_t *store, uint16_t index, uint8_t subindex, int64_t value);

/* ---- values on the wire; all return 0 or an abort code ------------------------------------------------------- */
bool cm1e_sim_is_signed(cm1e_data_type_t type);
/** `size`: room, then bytes. */
uint32_t cm1e_sim_give_number(const cm1e_entry_t *entry, int64_t value, uint8_t *data, size_t *size);
uint32_t cm1e_sim_give_text(const char *text, uint8_t *data, size_t *size);
/** Whether a number of `size` bytes may be written now. */
uint32_t cm1e_sim_check_write(const cm1e_entry_t *entry, uint8_t al_state, size_t size);
/** The number in as many bytes as the entry has. */
int64_t cm1e_sim_take_number(const cm1e_entry_t *entry, const uint8_t *data);
uint32_t cm1e_sim_check_range(const cm1e_entry_t *entry, int64_t value);

#endif
