/**
 * @file drive_kind.h
 * What one kind of drive needs to be served, as const tables: its objects in the process data, how its words are read,
 * and its modes of operation with the ways between them. A new device is a new kind in drive_kind.c; the sources of
 * this room ask the tables and name no device, but for those whose names say so.
 */
#ifndef CM1E_DRIVE_DRIVE_KIND_H
#define CM1E_DRIVE_DRIVE_KIND_H

#include "drive/drive_bridge.h"

/** One object that the drive uses: where its slot is kept, which sizes are understood, which mappings must have it. */
typedef struct cm1e_drive_object {
    size_t slot;                    /**< a cm1e_image_slot_t of cm1e_drive_t */
    bool output;
    uint16_t index;                 /**< of the first axis */
    uint8_t least_bytes, most_bytes;
    uint8_t needed_in;              /**< 1 << cm1e_mapping_t */
    const char *name;
} cm1e_drive_object_t;

/** A choice of process data. `name` NULL: the device has no such mapping. */
typedef struct cm1e_drive_mapping {
    const char *name;
    cm1e_mode_t first_mode;
} cm1e_drive_mapping_t;

/** How controlword and statusword are coded; masks of 0: the words have no such bits. */
typedef struct cm1e_drive_words {
    const cm1e_fsa_row_t *states;   /**< of the statusword; NULL: it shows none */
    uint16_t voltage;               /**< motor power; 0: not shown, it counts as on */
    uint16_t fault;                 /**< any of these bits */
    uint16_t motor_free;            /**< no torque, whatever the state */
    uint16_t target_reached, bit12, bit13;
    uint16_t inputs, outputs;       /**< digital inputs in the statusword, outputs in the controlword: from bit 4 on */
    uint16_t mark;                  /**< always in the controlword */
    uint16_t no_torque, fault_reset; /**< controlwords; fault_reset as no_torque: there is no such command */
    bool commands;                  /**< the words are those of drive_command.h */
    bool own_coding;                /**< in other modes they would be something else */
} cm1e_drive_words_t;
enum { CM1E_DRIVE_SIGNALS_AT = 4 };

/** One mode of operation. */
typedef struct cm1e_drive_mode {
    int8_t mode;                    /**< 0x6060, 0x6061 */
    const char *abbreviation;
    const cm1e_drive_words_t *words;
    size_t target;                  /**< slot without which the mode is of no use; CM1E_DRIVE_NO_TARGET */
    bool torque;                    /**< Operation enabled is for this mode, too */
    bool holds_position;            /**< the target position acts */
    bool halts;                     /**< by bit 8 of the controlword */
    uint8_t ways;                   /**< rows of the table from which it can be reached: 1 << row; WAYS_ALL */
    bool rest;                      /**< reached at rest and without an error only (BR appendix 3) */
    bool leaves_abnormal;           /**< csp "will possibly result in operating abnormal" after it (BR 6 note 2) */
    const char *cure;               /**< of an error in this mode, where it is another one than a fault reset */
} cm1e_drive_mode_t;
#define CM1E_DRIVE_NO_TARGET ((size_t)-1)
#define CM1E_DRIVE_WAYS_ALL 0xFF

typedef struct cm1e_drive_kind {
    const char *name;
    const cm1e_drive_object_t *objects;
    size_t object_count;
    cm1e_drive_mapping_t mappings[CM1E_MAPPING_PROFILE + 1];
    const cm1e_drive_mode_t *modes;
    size_t mode_count;
    const char *no_way;             /**< a sentence: why a mode is not reached from the present one */
    const char *refusal;            /**< a sentence: why a switch of mode is not confirmed */
    bool asks_mode_first;           /**< 0x6061 is read before 0x6060 is written: not every way can be gone back */
    bool mode_supervised;           /**< an unconfirmed switch is a fault without torque, too */
    int64_t reset_settle_ns;        /**< an error that a reset has cleared may come back by itself until then */
    cm1e_error_t (*init)(cm1e_drive_t *drive, cm1e_diag_t *diag); /**< what the configuration has to state */
    void (*step)(cm1e_drive_t *drive); /**< in every cycle, after the inputs; NULL: nothing */
} cm1e_drive_kind_t;

extern const cm1e_drive_kind_t cm1e_drive_kind_cm1e, cm1e_drive_kind_bridge, cm1e_drive_kind_virtual;
/** Of a mode that is not known: no state, no torque, controlword 0000h. */
extern const cm1e_drive_words_t cm1e_drive_words_unknown;

/** NULL: not a mode of this kind. */
const cm1e_drive_mode_t *cm1e_drive_mode_row(const cm1e_drive_kind_t *kind, int8_t mode);

#endif
