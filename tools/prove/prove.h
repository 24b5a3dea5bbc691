/**
 * @file prove.h
 * What `cm1e prove` looks at: a table of points, each with the clause of the guide that it settles, and a function that
 * compares the device with our tables. Results are JSON values, which become the report.
 *
 * Levels: reading, states and refused requests need no permission; settings are written and written back with
 * --allow-writes; the motor is enabled and moved with --allow-motion and limits. Behind a point with --allow-dead-ends
 * the device must be switched off and on.
 */
#ifndef CM1E_TOOLS_PROVE_H
#define CM1E_TOOLS_PROVE_H

#include <jansson.h>

#include "cm1e/bus.h"
#include "cm1e/sdo_info.h"
#include "command.h"
#include "device/devices.h"

typedef enum point_level { LEVEL_READ = 0, LEVEL_WRITE, LEVEL_MOTION, LEVEL_DEAD_END } point_level_t;

typedef struct prove prove_t;
typedef struct point point_t;
struct point {
    const char *id, *what, *clause, *how;
    const char *kind;          /**< kind of device that has it; NULL: every one */
    point_level_t level;
    void (*look)(prove_t *prove, const point_t *point);
    int row;                   /**< argument of `look`: the row of a table */
};
/** Point number n, in the order in which they are looked at; NULL: no more. */
const point_t *prove_point(size_t n);

enum { PROVE_PATTERNS = 16 };

typedef struct prove_options {
    common_options_t common;
    const char *output, *profile, *patterns[PROVE_PATTERNS];
    int pattern_count;
    const char *where;         /**< position or name; NULL: the only motor or bridge */
    bool list, allow_writes, allow_motion, allow_dead_ends;
    double max_velocity, max_travel; /**< revolutions of the motor and revolutions/s; 0: not given */
} prove_options_t;

/** One sub-index: what our tables say, what the device says of it, and what it reads. */
typedef struct seen_entry {
    uint16_t index;
    uint8_t subindex;
    const cm1e_entry_t *ours;  /**< NULL: not in our tables, or not of this firmware */
    bool told;                 /**< `info` is valid */
    cm1e_entry_info_t info;
    cm1e_error_t error;        /**< of reading it */
    uint32_t abort_code;
    uint8_t value[64];
    size_t size;
} seen_entry_t;

enum { SEEN_ENTRIES = 2048, SEEN_OBJECTS = 512, SEEN_SII = 8192 };

struct prove {
    const prove_options_t *options;
    cm1e_bus_config_t *config;
    cm1e_bus_t *bus;
    uint16_t position;
    const cm1e_slave_info_t *slave;
    const cm1e_device_t *device;
    const cm1e_firmware_info_t *firmware; /**< of a CM1-E: the one of its version, or the newest */

    bool has_information;      /**< it has SDO information */
    uint16_t objects[SEEN_OBJECTS];
    size_t object_count;
    cm1e_object_info_t object_infos[SEEN_OBJECTS];
    seen_entry_t entries[SEEN_ENTRIES];
    size_t entry_count;
    uint8_t sii[SEEN_SII];
    size_t sii_size;

    bool interrupted;          /**< nothing further is tried */
    bool cannot_move;          /**< no further motion */

    json_t *results;           /**< array */
    json_t *profile_codes;     /**< object: what the device answers in place of a code of ours */
    unsigned compared;         /**< of the point that is looked at */
    json_t *differences;
    char note[400];
};

/* ---- comparing, for the functions of the points ------------------------------------------------------------------ */

/** Two texts; "0x1018:02" as the thing. */
void prove_compare(prove_t *prove, const char *thing, const char *expected, const char *found);
/** Two numbers, as decimal or, with `digits` > 0, as 0x with so many digits. */
void prove_compare_number(prove_t *prove, const char *thing, int64_t expected, int64_t found, int digits);
void prove_compare_truth(prove_t *prove, const char *thing, bool found, const char *expected, const char *otherwise);
/** Why it is not known; also adds a word to what is compared. */
void prove_note(prove_t *prove, const char *format, ...) __attribute__((format(printf, 2, 3)));
/** An answer that differs by its code: kept for the profile. */
void prove_compare_code(prove_t *prove, const char *kind, const char *thing, uint32_t expected, uint32_t found);

/* ---- reading ----------------------------------------------------------------------------------------------------- */

void prove_read_all(prove_t *prove);
/** NULL: the device has none, or it was not looked for. */
const seen_entry_t *prove_entry(const prove_t *prove, uint16_t index, uint8_t subindex);
bool prove_is_missing(const prove_t *prove, const seen_entry_t *entry);
/** The number that was read; false: it was not. */
bool prove_value(const prove_t *prove, uint16_t index, uint8_t subindex, int64_t *value);
int64_t prove_number_of(const uint8_t *bytes, size_t size, bool is_signed);
bool prove_is_signed(unsigned data_type);
/** The device is neither enabled nor operated by somebody; false after a complaint. */
bool prove_is_at_rest(prove_t *prove);
/** Scans again, after requests that have left the device in another state. False after a complaint. */
bool prove_scan(prove_t *prove);
/** Opens and scans; a simulated segment plays the profile of the options. False after a complaint. */
bool prove_open(prove_t *prove);
/** Ctrl-C and the like end the run behind what is under way, so that nothing is left as it was only tried; so does a device
 *  that is gone. */
bool prove_is_told_to_end(prove_t *prove);
/** Makes a simulated segment play the profile of the options, if there is one. */
bool prove_play(const prove_options_t *options, cm1e_bus_t *bus);

/* ---- the functions of the points --------------------------------------------------------------------------------- */

void look_identity(prove_t *prove, const point_t *point);
void look_sii(prove_t *prove, const point_t *point);
void look_dictionary(prove_t *prove, const point_t *point);
void look_mapping(prove_t *prove, const point_t *point);
void look_controller(prove_t *prove, const point_t *point);
void look_state(prove_t *prove, const point_t *point);
void look_boot(prove_t *prove, const point_t *point);
void look_cml(prove_t *prove, const point_t *point);
void look_dead_ends(prove_t *prove, const point_t *point);
void look_abort(prove_t *prove, const point_t *point);
void look_write(prove_t *prove, const point_t *point);
void look_error(prove_t *prove, const point_t *point);
void look_cycle(prove_t *prove, const point_t *point);
void look_motion(prove_t *prove, const point_t *point);

/* ---- results ----------------------------------------------------------------------------------------------------- */

enum { ID_VENDOR, ID_PRODUCT, ID_REVISION, ID_FIRMWARE, ID_TYPE, ID_NAME, ID_HARDWARE };
enum { SII_CHECKSUM, SII_IDENTITY, SII_CONTENTS };
enum { DICT_OBJECTS, DICT_READABLE, DICT_SIZES, DICT_TYPES, DICT_ACCESS, DICT_DEFAULTS, DICT_RANGES, DICT_VALUES };
enum { ESC_UNITS, ESC_ALIAS, ESC_CONFIGURATION, ESC_WATCHDOG, ESC_CLOCK, ESC_ID };
enum { BOOT_ENTER, BOOT_PREOP };
enum { CML_MODE, CML_STATUS, CML_PARAMETER };
enum { WRITE_KEPT, WRITE_TOO_HIGH, WRITE_TOO_LOW, WRITE_ROUNDED };
enum { MOVE_ENABLE, MOVE_CSP, MOVE_CSV, MOVE_PP, MOVE_PV, MOVE_UNIT, MOVE_WATCHDOG, MOVE_HOME,
       MOVE_HOME_BRIDGE = MOVE_HOME + 6 };

/** The whole report as JSON; the caller releases it. */
json_t *prove_report(const prove_t *prove);
/** The report as Markdown; the caller frees it. NULL: no memory. */
char *prove_markdown(const json_t *report);
/** The device profile; the caller releases it. */
json_t *prove_profile(const prove_t *prove);
void prove_print(const json_t *report);

#endif
