/**
 * @file check_private.h
 * Shared declarations of the cross-checker; private to this room.
 */
#ifndef CM1E_DESCRIPTION_CHECK_PRIVATE_H
#define CM1E_DESCRIPTION_CHECK_PRIVATE_H

#include "description/check.h"

/** First member of items that are searched by a number: they are sorted, because a file decides how many there are. */
typedef struct cm1e_check_key {
    uint32_t number;
    size_t order;   /**< place in the file: of two with equal numbers the first comes first */
} cm1e_check_key_t;
/** Sorts `count` items that begin with a key. */
void cm1e_check_sort(void *items, size_t count, size_t item_size);
/** Place of the first item, of sorted ones, whose number is not below `number`; `count`: there is none. */
size_t cm1e_check_first(const void *items, size_t count, size_t item_size, uint32_t number);

/** One sub-index of a dictionary. */
typedef struct cm1e_check_entry {
    cm1e_check_key_t key; /**< index << 8 | sub-index */
    const cm1e_described_object_t *object;
    const cm1e_described_entry_t *entry;
} cm1e_check_entry_t;

/** One device under check, its slots filled. */
typedef struct cm1e_check {
    cm1e_findings_t *findings;
    cm1e_arena_t *arena;                     /**< for what is needed while checking */
    const cm1e_description_t *device;
    bool by_default;                         /**< the modules are the default modules of the file */
    uint16_t slot_index_increment;
    bool is_modular;                         /**< findings so far, because one mistake in a module shows in every
                                                  slot and every choice */
    bool has_dictionary, states_mappability;
    /* By their number: whether a PDO, a start-up command is of a module that states no objects at all. */
    const bool *silent_pdos, *silent_commands;
    size_t entry_count;
    const cm1e_check_entry_t *entries;       /**< sorted */
    const cm1e_check_key_t *objects, *pdos;  /**< by index, sorted */
} cm1e_check_t;

/** As cm1e_findings_add(), but without a finding that another slot or choice of modules already has at that place. */
void cm1e_check_add(const cm1e_check_t *check, cm1e_rule_t rule, cm1e_place_t place, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/** NULL: there is none. */
const cm1e_check_entry_t *cm1e_check_find_entry(const cm1e_check_t *check, uint16_t index, uint8_t subindex);
const cm1e_described_object_t *cm1e_check_find_object(const cm1e_check_t *check, uint16_t index);
const cm1e_described_pdo_t *cm1e_check_find_pdo(const cm1e_check_t *check, uint16_t index);
/** NULL also where there are several of that index. */
const cm1e_described_pdo_t *cm1e_check_only_pdo(const cm1e_check_t *check, uint16_t index);
/** Default value of a sub-index; false: none is stated. */
bool cm1e_check_default(const cm1e_check_t *check, uint16_t index, uint8_t subindex, uint32_t *value,
                        cm1e_place_t *place);

/** The indexes that exist already. */
typedef struct cm1e_check_seen {
    uint8_t bits[0x10000 / 8];
} cm1e_check_seen_t;
static inline bool cm1e_check_has_seen(const cm1e_check_seen_t *seen, uint16_t index)
{
    return seen->bits[index / 8] >> index % 8 & 1;
}
static inline bool cm1e_check_seen(cm1e_check_seen_t *seen, uint16_t index)
{
    const bool before = cm1e_check_has_seen(seen, index);
    seen->bits[index / 8] |= (uint8_t)(1u << index % 8);
    return before;
}

/* ---- the groups of rules ----------------------------------------------------------------------------------------- */

/** Definitions sorted by name. */
typedef struct cm1e_check_sorted_types {
    const cm1e_type_definition_t **at;
    size_t count;
} cm1e_check_sorted_types_t;
/** Scope of a type name: its own dictionary, then that of the device. */
typedef struct cm1e_check_types {
    cm1e_check_sorted_types_t own, common;
} cm1e_check_types_t;
cm1e_check_sorted_types_t cm1e_check_sort_types(const cm1e_check_t *check, const cm1e_type_list_t *types);

/** Type definitions of the device or of a module, and the objects that use them. */
void cm1e_check_types(const cm1e_check_t *check, const cm1e_type_list_t *types, const cm1e_check_types_t *known);
void cm1e_check_objects(const cm1e_check_t *check, const cm1e_object_list_t *objects, const cm1e_check_types_t *known);
/** An object against the type it names. */
void cm1e_check_object_type(const cm1e_check_t *check, const cm1e_described_object_t *object,
                            const cm1e_check_types_t *known);
/** What the entries of PDOs name; for those that stand beside a dictionary. */
void cm1e_check_pdo_types(const cm1e_check_t *check, const cm1e_pdo_list_t *pdos, const cm1e_check_types_t *known);

/** A value as a number; and whether it lies in the range of the sub-index, or that cannot be said. */
const char *cm1e_check_value_text(char *text, size_t room, const cm1e_described_entry_t *entry, cm1e_bytes_t data);
bool cm1e_check_within_range(const cm1e_described_entry_t *entry, cm1e_bytes_t data);

/** Checks a device with its slots filled. */
void cm1e_check_dictionary(const cm1e_check_t *check);
void cm1e_check_identity(const cm1e_check_t *check);
void cm1e_check_devices(const cm1e_check_t *check, const cm1e_description_file_t *file);
void cm1e_check_sync_managers(const cm1e_check_t *check);
void cm1e_check_mailbox(const cm1e_check_t *check);
/** Checks the PDOs of the device, or of a module, by themselves. */
void cm1e_check_own_pdos(const cm1e_check_t *check, const cm1e_pdo_list_t *pdos);
void cm1e_check_pdos(const cm1e_check_t *check);
void cm1e_check_excludes(const cm1e_check_t *check);
void cm1e_check_mapping_objects(const cm1e_check_t *check);
void cm1e_check_assignment(const cm1e_check_t *check);
void cm1e_check_init_commands(const cm1e_check_t *check);
/** Of the file. */
void cm1e_check_slots(const cm1e_check_t *check, const cm1e_description_file_t *file);
void cm1e_check_modules(const cm1e_check_t *check, const cm1e_description_file_t *file);

#endif
