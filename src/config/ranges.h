/**
 * @file ranges.h
 * Shared declarations of the check; private to this room.
 */
#ifndef CM1E_CONFIG_RANGES_H
#define CM1E_CONFIG_RANGES_H

#include "config/clock_pulses.h"
#include "config/problem.h"
#include "device/devices.h"

/* Every check returns false with the problem filled. Paths and key names are those of a bus file; a configuration made
 * by hand has the same names in other places. */
typedef struct check {
    const cm1e_bus_config_t *config;
    cm1e_config_problem_t *problem;
    const cm1e_axis_config_t *axis; /* the axis being checked */
    uint32_t index;
    uint16_t addresses[CM1E_MAX_AXES]; /* of all axes: cm1e_axis_address() */
    double counts_per_unit;
    double most_velocity; /* counts/s of the axis */
    char name[CM1E_NAME_LENGTH + 8];
} check_t;

/** Returns false, with the fault in the problem, after the names of axis and key. */
__attribute__((format(printf, 3, 4)))
bool cm1e_config_axis_wrong(const check_t *check, const char *key, const char *format, ...);
#define axis_wrong cm1e_config_axis_wrong
/** Whether a text ends within its array and has no control characters. */
bool cm1e_config_is_text(const char *text, size_t size);
#define IS_TEXT(array) cm1e_config_is_text(array, sizeof(array))
#define NO_TEXT "is not a text of less than %zu bytes without control characters"

/** The ways to state an address, by cm1e_address_kind_t: the key of the bus file, and the largest value. */
typedef struct cm1e_config_address {
    const char *key;
    uint16_t maximum;
} cm1e_config_address_t;
extern const cm1e_config_address_t cm1e_config_addresses[];

static inline const cm1e_device_t *device_of(const check_t *check) { return cm1e_device_configured(check->axis); }
static inline const cm1e_device_drive_t *drive_of(const check_t *check)
{
    return cm1e_device_drive_configured(check->axis);
}

/** Which device, where it is, its motor, and the keys that it has (ranges_device.c). */
bool cm1e_config_check_device(const check_t *check);
/** The unit, which the numbers need; then the numbers of an axis (ranges_numbers.c). */
bool cm1e_config_check_unit(check_t *check);
bool cm1e_config_check_numbers(check_t *check);
/** The slaves without an axis (ranges_slaves.c). */
bool cm1e_config_check_slaves(const cm1e_bus_config_t *config, cm1e_config_problem_t *problem);
/** Pulses of distributed clocks (ranges_clocks.c): the key that is wrong, and why; NULL: none. */
enum { CM1E_WRONG_PULSES = 160 };
const char *cm1e_config_wrong_pulses(const cm1e_bus_config_t *config, const cm1e_dc_config_t *dc,
                                     char text[CM1E_WRONG_PULSES]);
/** Slaves that may be absent (ranges_optional.c): an axis; a slave of the list, of which the key that is wrong, and
 *  why; NULL: none. */
bool cm1e_config_check_optional(const check_t *check);
enum { CM1E_WRONG_OPTIONAL = 224 };
const char *cm1e_config_wrong_optional(const cm1e_bus_config_t *config, uint32_t index,
                                       char text[CM1E_WRONG_OPTIONAL]);
/** Signals on other slaves (ranges_wiring.c). */
bool cm1e_config_check_wiring(const check_t *check);
/** Checks that a virtual axis or an encoder has no keys of a motor. */
bool cm1e_config_check_without_motor(const check_t *check);

#endif
