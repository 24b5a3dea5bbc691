/**
 * @file sdo_info.h
 * Reads the object dictionary from a slave: SDO information (ETG.1000.6 5.6.3). The thread that owns the bus calls
 * these functions after a scan, before the cycle runs. All data come from the device: lengths are checked, contents are
 * not.
 */
#ifndef CM1E_SDO_INFO_H
#define CM1E_SDO_INFO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/bus.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Lists of objects that a slave has (ETG.1000.6 table 44). */
typedef enum cm1e_info_list {
    CM1E_OBJECTS_ALL = 1,
    CM1E_OBJECTS_RXPDO = 2,   /**< objects that can be mapped into an RxPDO */
    CM1E_OBJECTS_TXPDO = 3,
    CM1E_OBJECTS_BACKUP = 4,  /**< objects to store for the replacement of a device */
    CM1E_OBJECTS_SETTINGS = 5,
} cm1e_info_list_t;

/** Bytes of a name, the 0 at its end included. */
#define CM1E_INFO_NAME 64

/** An object as the slave describes it. */
typedef struct cm1e_object_info {
    uint16_t index;
    uint16_t data_type;       /**< CoE data type (ETG.1020); for records 0 or a type of their own */
    uint8_t highest_subindex;
    uint8_t code;             /**< 7 VAR, 8 ARRAY, 9 RECORD */
    char name[CM1E_INFO_NAME];/**< printable, cut if it is longer; "": none */
} cm1e_object_info_t;

/** Access rights of an entry by state (ETG.1000.6 table 46). */
enum cm1e_info_access {
    CM1E_INFO_READ_PREOP = 0x0001, CM1E_INFO_READ_SAFEOP = 0x0002, CM1E_INFO_READ_OP = 0x0004,
    CM1E_INFO_WRITE_PREOP = 0x0008, CM1E_INFO_WRITE_SAFEOP = 0x0010, CM1E_INFO_WRITE_OP = 0x0020,
    CM1E_INFO_RXPDO = 0x0040, CM1E_INFO_TXPDO = 0x0080, CM1E_INFO_BACKUP = 0x0100, CM1E_INFO_SETTING = 0x0200,
};

/** A value of an entry, little endian. `size` 0: the slave gives no value, or one of more than 8 bytes. */
typedef struct cm1e_info_value {
    uint8_t size;
    uint8_t bytes[8];
} cm1e_info_value_t;

/** A sub-index of an object as the slave describes it. */
typedef struct cm1e_entry_info {
    uint16_t index;
    uint8_t subindex;
    uint16_t data_type;       /**< CoE data type (ETG.1020) */
    uint16_t bits;
    uint16_t access;          /**< cm1e_info_access */
    bool unit_given;
    uint32_t unit;            /**< ETG.1004 */
    cm1e_info_value_t default_value, minimum, maximum;
    char name[CM1E_INFO_NAME];
} cm1e_entry_info_t;

/** Reads the indexes of the objects in a list, in the order of the slave. `*count` is the room in `indexes`, afterwards
 *  the number of objects. Returns CM1E_ERROR_INVALID_ARGUMENT if there is not enough room, CM1E_ERROR_SDO_ABORT if the
 *  slave refuses, CM1E_ERROR_TIMEOUT if it does not answer, like a slave without this service. @rt block */
CM1E_API cm1e_error_t cm1e_sdo_info_list(cm1e_bus_t *bus, uint16_t position, cm1e_info_list_t list, uint16_t *indexes,
                                         size_t *count, cm1e_diag_t *diag);
/** Reads the description of an object; errors as for cm1e_sdo_info_list(). @rt block */
CM1E_API cm1e_error_t cm1e_sdo_info_object(cm1e_bus_t *bus, uint16_t position, uint16_t index, cm1e_object_info_t *info,
                                           cm1e_diag_t *diag);
/** Reads the description of a sub-index, with unit, default and range if the slave gives them; errors as for
 *  cm1e_sdo_info_list(). @rt block */
CM1E_API cm1e_error_t cm1e_sdo_info_entry(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex,
                                          cm1e_entry_info_t *info, cm1e_diag_t *diag);

#ifdef __cplusplus
}
#endif
#endif
