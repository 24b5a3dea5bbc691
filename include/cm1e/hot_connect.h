/**
 * @file hot_connect.h
 * Slaves that come and go while the others run: which are there, which wait, what was refused. The bus file says which
 * slaves may be absent (`optional`), which come together (`hot_connect`), and who brings them back (`recover`).
 */
#ifndef CM1E_HOT_CONNECT_H
#define CM1E_HOT_CONNECT_H

#include "cm1e/bus.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Whether a slave takes part in the cycle, and if not, why. */
typedef enum cm1e_presence {
    CM1E_PRESENCE_THERE = 0,  /**< it takes part */
    CM1E_PRESENCE_ABSENT,     /**< it does not answer, or nothing with its address was found */
    CM1E_PRESENCE_WAITS,      /**< it answers, and waits until somebody asks for it: by MC_Reset of one of its axes, or
                                   by cm1e_bus_recover() */
    CM1E_PRESENCE_COMING,     /**< it is identified, configured and brought to Operational */
    CM1E_PRESENCE_REFUSED,    /**< a device with its address is there, which is not the expected one, or which cannot
                                   be configured */
    CM1E_PRESENCE_STAYS_OUT,  /**< it answers, and nobody brings it back (`recover: never`) */
    CM1E_PRESENCE_COUNT,
} cm1e_presence_t;

/** A device on the wire that is none of the configured slaves. It got no configuration, and has no station address. */
typedef struct cm1e_stranger {
    uint16_t place;           /**< on the wire, 1 = first */
    uint16_t alias;
    uint16_t explicit_id;     /**< 0: none, or not asked for */
    uint16_t reserved;        /**< 0 */
    uint32_t vendor_id, product_code, revision, serial_number; /**< by its SII; all 0: it cannot be read */
} cm1e_stranger_t;

#define CM1E_STRANGERS 8 /**< so many are kept */

/** Buffer size that is large enough for every text of cm1e_bus_presence_text(). */
enum { CM1E_PRESENCE_TEXT = 512 };

/** Whether a slave takes part in the cycle, and if not, why. @rt any */
CM1E_API cm1e_presence_t cm1e_bus_presence(const cm1e_bus_t *bus, uint32_t position);
/** "there", "absent", "waits" ... Never NULL. @rt any */
CM1E_API const char *cm1e_presence_name(cm1e_presence_t presence);
/** Writes why a slave does not take part, as a sentence that says what to do; "" if it takes part. @rt block */
CM1E_API void cm1e_bus_presence_text(const cm1e_bus_t *bus, uint32_t position, char *text, size_t size);
/** Allows the bus to bring back a slave that waits. Motors stay disabled. CM1E_ERROR_INVALID_ARGUMENT: there is no such
 *  slave; CM1E_ERROR_STATE: it does not wait, `diag` says what it does. @rt any */
CM1E_API cm1e_error_t cm1e_bus_recover(cm1e_bus_t *bus, uint32_t position, cm1e_diag_t *diag);
/** Copies the strangers that are on the wire now, at most `room`; returns their number. A bus looks for them only if it
 *  has optional slaves. @rt any */
CM1E_API size_t cm1e_bus_strangers(const cm1e_bus_t *bus, cm1e_stranger_t *strangers, size_t room);
/** "A device at place 4 of the wire was refused: ...". @rt block */
CM1E_API void cm1e_stranger_text(const cm1e_stranger_t *stranger, char *text, size_t size);
/** Number of changes so far: slaves that came, went or wait, strangers. @rt any */
CM1E_API uint64_t cm1e_bus_presence_news(const cm1e_bus_t *bus);

#ifdef __cplusplus
}
#endif
#endif
