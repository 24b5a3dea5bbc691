/**
 * @file quirks.h
 * What real slaves do that the simulated ones do not do by themselves. A slave keeps its quirks without power. Private
 * to this room.
 */
#ifndef CM1E_SIM_QUIRKS_H
#define CM1E_SIM_QUIRKS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct cm1e_sim_quirks {
    uint8_t fmmus, sync_managers; /**< a small controller: it has so many; 0: all of the simulated one */
    int64_t sii_extra_ns;         /**< a slow EEPROM: each read takes so much longer */
    int64_t mailbox_extra_ns;     /**< a slow mailbox: each request is taken so much later */
    unsigned info_fragments;      /**< the list of objects is aborted after so many fragments; 0: never */
    bool fixed_assignment;        /**< 0x1C12 and 0x1C13 cannot be written */
    bool fixed_mapping;           /**< 0x1600 ... 0x1BFF cannot be written */
    bool loops;                   /**< port 1 sends frames back, though there is a link */
    bool late_id;                 /**< tells its explicit device ID from Pre-Operational on only */
    uint16_t branch_of;           /**< position of the slave whose port it is connected to; 0: the one before it */
    uint8_t branch_port;          /**< that port: 1, 2 or 3 */
} cm1e_sim_quirks_t;

typedef struct cm1e_sim_slave cm1e_sim_slave_t;

/** Gives a slave a quirk by its name, with a number where it needs one; "nothing" takes all away. false: there is no
 *  such quirk, or the number is none; `text` says what is expected, else what it has now. */
bool cm1e_sim_quirk(cm1e_sim_slave_t *slave, const char *name, const char *number, char *text, size_t size);
/** Whether an object is one of those that it does not let anybody write. */
bool cm1e_sim_quirk_is_fixed(const cm1e_sim_slave_t *slave, uint16_t index);
/** The numbers of its FMMUs and sync managers. */
unsigned cm1e_sim_quirk_fmmus(const cm1e_sim_slave_t *slave);
unsigned cm1e_sim_quirk_sync_managers(const cm1e_sim_slave_t *slave);

#endif
