/**
 * @file check.h
 * The cross-checker: rules that a schema cannot express. A rule has a name, a row in CM1E_RULES and, by test_check_*, a
 * file that is broken in exactly that way. docs/CHECK-RULES.md explains them to users.
 */
#ifndef CM1E_DESCRIPTION_CHECK_H
#define CM1E_DESCRIPTION_CHECK_H

#include "cm1e/generate.h"
#include "description/description.h"

/** The one list of rules: X(enumerator, name, is an error). */
#define CM1E_RULES(X)                                                                                               \
    /* ESI, SII, ENI: a device */                                                                                   \
    X(PDO_ENTRY_NOT_IN_DICTIONARY, "pdo-entry-not-in-dictionary", true)                                             \
    X(PDO_ENTRY_SIZE, "pdo-entry-size", true)                                                                       \
    X(PDO_ENTRY_TYPE, "pdo-entry-type", true)                                                                       \
    X(PDO_ENTRY_NOT_MAPPABLE, "pdo-entry-not-mappable", false)                                                      \
    X(PDO_TWICE, "pdo-twice", true)                                                                                 \
    X(PDO_INDEX, "pdo-index", false)                                                                                \
    X(PDO_SYNC_MANAGER, "pdo-sync-manager", true)                                                                   \
    X(PDO_MANDATORY_UNASSIGNED, "pdo-mandatory-unassigned", false)                                                  \
    X(NO_PDO_ASSIGNED, "no-pdo-assigned", false)                                                                    \
    X(EXCLUDE_ONE_SIDED, "exclude-one-sided", false)                                                                \
    X(EXCLUDE_MISSING, "exclude-missing", false)                                                                    \
    X(EXCLUDE_TWICE, "exclude-twice", false)                                                                        \
    X(EXCLUDE_ITSELF, "exclude-itself", true)                                                                       \
    X(EXCLUDED_ASSIGNED, "excluded-assigned", true)                                                                 \
    X(MAPPING_OBJECT, "mapping-object", true)                                                                       \
    X(MAPPING_COMMAND, "mapping-command", true)                                                                     \
    X(ASSIGNMENT_OBJECT, "assignment-object", false)                                                                \
    X(ASSIGNMENT_COMMAND, "assignment-command", true)                                                               \
    X(INIT_COMMAND_OBJECT, "init-command-object", true)                                                             \
    X(INIT_COMMAND_READ_ONLY, "init-command-read-only", true)                                                       \
    X(INIT_COMMAND_SIZE, "init-command-size", true)                                                                 \
    X(INIT_COMMAND_RANGE, "init-command-range", true)                                                               \
    X(INIT_COMMAND_COMPLETE_ACCESS, "init-command-complete-access", true)                                           \
    X(SYNC_MANAGERS_OVERLAP, "sync-managers-overlap", true)                                                         \
    X(SYNC_MANAGER_BEYOND_MEMORY, "sync-manager-beyond-memory", true)                                               \
    X(SYNC_MANAGER_CONTROL, "sync-manager-control", true)                                                           \
    X(SYNC_MANAGER_WATCHDOG, "sync-manager-watchdog", false)                                                        \
    X(SYNC_MANAGER_ORDER, "sync-manager-order", true)                                                               \
    X(SYNC_MANAGER_SIZE, "sync-manager-size", false)                                                                \
    X(SYNC_MANAGER_RANGE, "sync-manager-range", true)                                                               \
    X(SYNC_MANAGER_TYPES, "sync-manager-types", true)                                                               \
    X(SYNC_MANAGERS_TOO_MANY, "sync-managers-too-many", true)                                                       \
    X(FMMU_MISSING, "fmmu-missing", true)                                                                           \
    X(FMMU_MAILBOX_MISSING, "fmmu-mailbox-missing", false)                                                          \
    X(FMMUS_TOO_MANY, "fmmus-too-many", true)                                                                       \
    X(MAILBOX_SIZE, "mailbox-size", true)                                                                           \
    X(MAILBOX_WITHOUT_SYNC_MANAGER, "mailbox-without-sync-manager", true)                                           \
    X(MAILBOX_WITHOUT_PROTOCOL, "mailbox-without-protocol", false)                                                  \
    X(BOOTSTRAP_SIZE, "bootstrap-size", true)                                                                       \
    X(BOOTSTRAP_WITHOUT_FOE, "bootstrap-without-foe", false)                                                        \
    X(OBJECT_TWICE, "object-twice", true)                                                                           \
    X(SUBINDEX_TWICE, "subindex-twice", true)                                                                       \
    X(OBJECT_SIZE, "object-size", true)                                                                             \
    X(DATA_SIZE, "data-size", true)                                                                                 \
    X(RANGE_EMPTY, "range-empty", true)                                                                             \
    X(DEFAULT_OUT_OF_RANGE, "default-out-of-range", true)                                                           \
    X(TYPE_SIZE, "type-size", true)                                                                                 \
    X(TYPE_ITEM_SIZE, "type-item-size", true)                                                                       \
    X(TYPE_ITEM_OFFSET, "type-item-offset", true)                                                                   \
    X(TYPE_UNKNOWN, "type-unknown", true)                                                                           \
    X(TYPE_TWICE, "type-twice", true)                                                                               \
    X(TYPE_LOOP, "type-loop", true)                                                                                 \
    X(IDENTITY_OBJECT, "identity-object", true)                                                                     \
    X(IDENTITY_REVISION, "identity-revision", false)                                                                \
    X(DEVICE_TWICE, "device-twice", true)                                                                           \
    X(DEVICE_TYPE, "device-type", true)                                                                             \
    X(SLOT_MODULE_MISSING, "slot-module-missing", true)                                                             \
    X(SLOT_DEFAULTS, "slot-defaults", true)                                                                         \
    X(SLOT_NO_DEFAULT, "slot-no-default", false)                                                                    \
    X(SLOT_INSTANCES, "slot-instances", true)                                                                       \
    X(SLOT_DEPENDENCE, "slot-dependence", true)                                                                     \
    X(MODULE_TWICE, "module-twice", true)                                                                           \
    /* an SII image */                                                                                              \
    X(SII_CHECKSUM, "sii-checksum", true)                                                                           \
    X(SII_CATEGORY_LENGTH, "sii-category-length", true)                                                             \
    X(SII_NO_END, "sii-no-end", true)                                                                               \
    X(SII_SIZE, "sii-size", true)                                                                                   \
    X(SII_INCOMPLETE, "sii-incomplete", true)                                                                       \
    X(SII_CATEGORY_TWICE, "sii-category-twice", false)                                                              \
    X(SII_STRING_MISSING, "sii-string-missing", true)                                                               \
    X(SII_STRING_TEXT, "sii-string-text", false)                                                                    \
    X(SII_DATA_TYPE, "sii-data-type", false)                                                                        \
    X(SII_MAILBOX, "sii-mailbox", true)                                                                             \
    X(SII_PROTOCOLS, "sii-protocols", false)                                                                        \
    /* EC_EXTEND */                                                                                                 \
    X(TRIO_INDEX, "trio-index", true)                                                                               \
    X(TRIO_NAME, "trio-name", true)                                                                                 \
    X(TRIO_REFERENCE, "trio-reference", true)                                                                       \
    X(TRIO_VENDOR, "trio-vendor", true)                                                                             \
    X(TRIO_PROFILE, "trio-profile", true)                                                                           \
    X(TRIO_PDO_ENTRY, "trio-pdo-entry", true)                                                                       \
    X(TRIO_PDO_SIZE, "trio-pdo-size", true)                                                                         \
    X(TRIO_SYNC_MANAGER, "trio-sync-manager", true)                                                                 \
    X(TRIO_INIT_COMMAND, "trio-init-command", true)                                                                 \
    X(TRIO_ASSIGNMENT, "trio-assignment", true)                                                                     \
    X(TRIO_MAILBOX, "trio-mailbox", true)                                                                           \
    X(TRIO_AXES, "trio-axes", true)                                                                                 \
    X(TRIO_DEVICE, "trio-device", true)                                                                             \
    X(TRIO_REVISION, "trio-revision", false)                                                                        \
    X(TRIO_UNKNOWN, "trio-unknown", false)                                                                          \
    /* ENI: a network */                                                                                            \
    X(ENI_STATION, "eni-station", true)                                                                             \
    X(ENI_POSITION, "eni-position", true)                                                                           \
    X(ENI_PREVIOUS_PORT, "eni-previous-port", true)                                                                 \
    X(ENI_COMMAND_ADDRESS, "eni-command-address", true)                                                             \
    X(ENI_VALIDATE, "eni-validate", true)                                                                           \
    X(ENI_START, "eni-start", false)                                                                                \
    X(ENI_SYNC_MANAGER, "eni-sync-manager", true)                                                                   \
    X(ENI_PROCESS_DATA, "eni-process-data", true)                                                                   \
    X(ENI_FMMU, "eni-fmmu", true)                                                                                   \
    X(ENI_MAILBOX, "eni-mailbox", true)                                                                             \
    X(ENI_IMAGE_PLACE, "eni-image-place", true)                                                                     \
    X(ENI_IMAGE_RANGE, "eni-image-range", true)                                                                     \
    X(ENI_IMAGE_OVERLAP, "eni-image-overlap", true)                                                                 \
    X(ENI_VARIABLE_TWICE, "eni-variable-twice", false)                                                              \
    X(ENI_WORKING_COUNTER, "eni-working-counter", true)                                                             \
    X(ENI_FRAME, "eni-frame", true)                                                                                 \
    X(ENI_CYCLE_TIME, "eni-cycle-time", true)                                                                       \
    X(ENI_CM1E_REVISION, "eni-cm1e-revision", false)                                                                \
    X(ENI_CM1E_PDO, "eni-cm1e-pdo", true)                                                                           \
    /* a live device beside a file */                                                                               \
    X(DIFFERS, "differs", true)                                                                                     \
    X(DIFFERS_IDENTITY, "differs-identity", true)                                                                   \
    X(DIFFERS_EEPROM, "differs-eeprom", true)                                                                       \
    X(DIFFERS_MAILBOX, "differs-mailbox", true)                                                                     \
    X(DIFFERS_SYNC_MANAGER, "differs-sync-manager", true)                                                           \
    X(DIFFERS_PDO, "differs-pdo", true)                                                                             \
    X(DIFFERS_ASSIGNMENT, "differs-assignment", false)                                                              \
    X(DIFFERS_OBJECT, "differs-object", true)                                                                       \
    X(DIFFERS_NAME, "differs-name", false)                                                                          \
    X(NOT_COMPARED, "not-compared", false)

typedef enum cm1e_rule {
#define CM1E_RULE_ENUMERATOR(enumerator, name, is_error) CM1E_RULE_##enumerator,
    CM1E_RULES(CM1E_RULE_ENUMERATOR)
#undef CM1E_RULE_ENUMERATOR
    CM1E_RULE_COUNT,
} cm1e_rule_t;

/** Maximum number of findings; the last one then says that there are more. */
#define CM1E_FINDINGS_MAX 1000

struct cm1e_findings {
    cm1e_arena_t arena; /**< `failed`: a part was not checked, so an empty list does not mean that there is no fault */
    CM1E_LIST(cm1e_finding_t) list;
};

/** Makes an empty list; NULL: no memory. Free it with cm1e_findings_free(). */
cm1e_findings_t *cm1e_findings_create(void);
/** Adds a finding. An equal rule, place and text count once. Names out of a file are cleaned of characters that could
 *  act on a terminal (cm1e_text_clean()). */
void cm1e_findings_add(cm1e_findings_t *findings, cm1e_rule_t rule, cm1e_place_t place, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/** Whether there is a finding of that rule at that place; always false for place 0. */
bool cm1e_findings_has(const cm1e_findings_t *findings, cm1e_rule_t rule, cm1e_place_t place);
/** Sorts by line; call it after the last finding. */
void cm1e_findings_sort(cm1e_findings_t *findings);
/** Ends a check with the result `error`: gives the sorted findings to `*given`, or frees them after an error. No memory
 *  for some of the findings is an error too. */
cm1e_error_t cm1e_findings_give(cm1e_findings_t *findings, cm1e_error_t error, cm1e_findings_t **given,
                                cm1e_diag_t *diag);

/** First address behind the memory of a sync manager: process data has three buffers behind each other, a mailbox, or
 *  what has its mode, one (ETG.1000.4 6.7). */
uint32_t cm1e_sync_manager_end(const cm1e_described_sync_manager_t *manager);
/** Finds sync managers of one device that overlap; those without a length or not enabled are ignored. */
void cm1e_check_overlap(cm1e_findings_t *findings, const cm1e_described_sync_manager_t *managers, size_t count);

/** Every rule about devices, for every device of a file; MDP devices also with their slots expanded. */
void cm1e_check_description(cm1e_findings_t *findings, const cm1e_description_file_t *file);

#endif
