/**
 * @file mapping.h
 * The PDO mapping of one slave: assigns the chosen PDOs, then reads back what the slave made of it. The layout is
 * always what the device says (the manual gives two orders, UG 4.4 and UG 7.2); gaps (entries of index 0) only take
 * up bits. A device that refuses to have its assignment written is right as long as the assignment is the chosen one:
 * in the bridge's list of objects part of it is read-only (BR appendix 6). A list of SDO transfers, one after the
 * other; who runs it owns the CoE client.
 */
#ifndef CM1E_BUS_MAPPING_H
#define CM1E_BUS_MAPPING_H

#include "cm1e/bus.h"
#include "device/devices.h"

enum { CM1E_MAPPED_ENTRIES = 128 };

typedef struct cm1e_mapped_entry {
    uint16_t index, bit_offset; /**< index 0: a gap */
    uint8_t subindex, bits;
} cm1e_mapped_entry_t;

/** One direction of the process data of a slave. */
typedef struct cm1e_mapped_direction {
    uint16_t bits;
    uint8_t entry_count;
    cm1e_mapped_entry_t entries[CM1E_MAPPED_ENTRIES];
} cm1e_mapped_direction_t;

typedef enum cm1e_mapping_step {
    MAPPING_IDLE = 0,
    MAPPING_CLEAR,      /**< write 0 to the number of assigned PDOs */
    MAPPING_ASSIGN,     /**< write a PDO, one after the other */
    MAPPING_COUNT,      /**< write their number */
    MAPPING_READ_COUNT, /**< read the number of assigned PDOs: the one written */
    MAPPING_READ_PDO,   /**< read the assigned PDOs, one after the other: those written */
    MAPPING_READ_ENTRIES, /**< read the number of entries of a PDO */
    MAPPING_READ_ENTRY, /**< read the entries, one after the other, then go on with the next PDO */
} cm1e_mapping_step_t;

typedef struct cm1e_mapping_job {
    cm1e_mapping_step_t step;
    cm1e_pdo_choice_t choice;   /**< as asked for; none: the device's own assignment is read */
    cm1e_pdo_choice_t assigned; /**< the choice of the present direction */
    int direction;           /**< 0 outputs, 1 inputs */
    uint8_t place;           /**< number of the PDO in the choice, from 0 */
    uint8_t entry, entries;  /**< where the reading of its entries is, from 1 */
    bool started;            /**< `sdo` is in work or done */
    bool any;                /**< cm1e_mapping_begin_any() */
    bool swapped;            /**< inputs are on sync manager 2: 0x1C12 assigns them */
    uint8_t unknown;         /**< directions whose assignment cannot be read: it has none, or no object for it */
    cm1e_sdo_t sdo;
    cm1e_sdo_t refused;      /**< the first write that was refused, where `is_refused`; the result if it matters */
    bool is_refused;
    uint8_t data[4];
    cm1e_error_t error;      /**< result, valid when idle; foreign code in sdo.abort_code */
    const char *reason;      /**< with CM1E_ERROR_PDO_MAPPING: what is wrong */
    cm1e_mapped_direction_t mapped[2];
} cm1e_mapping_job_t;

void cm1e_mapping_begin(cm1e_mapping_job_t *job, uint16_t position, const cm1e_pdo_choice_t *choice);
/** Reads the assignment that a slave has, which may be empty in a direction, or missing. `swapped`: inputs are on sync
 *  manager 2, outputs on 3. */
void cm1e_mapping_begin_any(cm1e_mapping_job_t *job, uint16_t position, bool swapped);
static inline bool cm1e_mapping_idle(const cm1e_mapping_job_t *job) { return job->step == MAPPING_IDLE; }
/** The transfer to begin now; NULL: the job has ended, or is idle. The transfer that was returned before must have
 *  ended. */
cm1e_sdo_t *cm1e_mapping_next(cm1e_mapping_job_t *job);
/** Whether two layouts have equal entries at equal places. */
bool cm1e_mapping_equal(const cm1e_mapped_direction_t *a, const cm1e_mapped_direction_t *b);
/** NULL: not mapped at a whole byte with 1 ... 4 whole bytes. */
const cm1e_mapped_entry_t *cm1e_mapping_find(const cm1e_mapped_direction_t *direction, uint16_t index,
                                             uint8_t subindex);

#endif
