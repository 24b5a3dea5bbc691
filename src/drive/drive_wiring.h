/**
 * @file drive_wiring.h
 * Signals of other slaves that the configuration gives to an axis (`wiring`): digital inputs and outputs, and the
 * counts of an encoder. They are found when the drive is made. Inputs are sampled where the drive reads its own, so
 * both are of the same exchange of the process data.
 */
#ifndef CM1E_DRIVE_DRIVE_WIRING_H
#define CM1E_DRIVE_DRIVE_WIRING_H

#include "cm1e/io.h"
#include "drive/drive.h"

/** What an axis with such signals has; others have none. */
typedef struct cm1e_drive_wiring {
    cm1e_io_t inputs[CM1E_WIRED_SIGNALS], outputs[CM1E_WIRED_SIGNALS], encoder;
    uint8_t input_count, output_count;
    bool has_encoder;
    int64_t counted;    /**< the last value of the encoder that was believed */
    uint32_t missed;    /**< cycles in a row without such a value */
    uint8_t values;     /**< bit 0: input CM1E_WIRED_FIRST; where the slave is away the last value that came */
    uint8_t fresh;      /**< the value is of this exchange */
    uint8_t known;      /**< fresh, or missing for no longer than lost_cycles_limit */
    uint8_t held;       /**< outputs that go off by themselves */
    int64_t until_ns[CM1E_WIRED_SIGNALS]; /**< when they do */
} cm1e_drive_wiring_t;

/** Finds the signals that the configuration names; `drive->wiring` is NULL if there are none. */
cm1e_error_t cm1e_drive_wire(cm1e_drive_t *drive, cm1e_diag_t *diag);
/** Samples the inputs. @rt cycle */
void cm1e_drive_wiring_read(cm1e_drive_t *drive);

/** The place of signal `number` among `count`, which have the numbers from CM1E_WIRED_FIRST on; -1: it is none of
 *  them. */
static inline int cm1e_drive_wired_place(int number, int count)
{
    return number >= CM1E_WIRED_FIRST && number - CM1E_WIRED_FIRST < count ? number - CM1E_WIRED_FIRST : -1;
}
/** Place in the wiring of the input or output `number`; -1: it is none of these. @rt cycle */
static inline int cm1e_drive_wired_input(const cm1e_drive_t *drive, int number)
{
    return drive->wiring ? cm1e_drive_wired_place(number, drive->wiring->input_count) : -1;
}
static inline int cm1e_drive_wired_output(const cm1e_drive_t *drive, int number)
{
    return drive->wiring ? cm1e_drive_wired_place(number, drive->wiring->output_count) : -1;
}

/** Writes output number `n` of the wiring; it goes off at `until_ns`, unless it is written again. INT64_MAX: it stays.
 *  False: its slave is away, and nothing was written. @rt cycle */
bool cm1e_drive_wired_write(cm1e_drive_t *drive, int n, bool value, int64_t until_ns);
/** Whether the slave of output number `n` takes part in the cycle. @rt cycle */
bool cm1e_drive_wired_reached(const cm1e_drive_t *drive, int n);
/** The value that is sent to output number `n`. @rt cycle */
bool cm1e_drive_wired_output_value(const cm1e_drive_t *drive, int n);
/** Switches off what has not been written again in time. @rt cycle */
void cm1e_drive_wired_expire(cm1e_drive_t *drive);

#endif
