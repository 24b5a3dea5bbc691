/**
 * @file datagram.h
 * One EtherCAT datagram outside the process data, and the registers that the bus reads and writes with it. Datagrams
 * are plain data: the state machines of the bus fill a datagram and judge its answer, without SOEM.
 */
#ifndef CM1E_BUS_DATAGRAM_H
#define CM1E_BUS_DATAGRAM_H

#include <stdbool.h>
#include <stdint.h>

/** Largest mailbox (and datagram) that fits into one Ethernet frame. */
enum { CM1E_DATAGRAM_MAX = 1486 };

/** Datagram commands (ETG.1000.4 table 14). */
typedef enum cm1e_command {
    COMMAND_APRD = 1,
    COMMAND_APWR = 2,
    COMMAND_APRW = 3,  /**< what was there before comes back; the working counter is 3 */
    COMMAND_FPRD = 4,
    COMMAND_FPWR = 5,
    COMMAND_BRD = 7,
    COMMAND_BWR = 8,
    COMMAND_FRMW = 14, /**< the addressed slave is read, all others are written */
} cm1e_command_t;

/** Registers of a slave controller (ETG.1000.4, section 6). */
enum {
    REG_STATION_ADDRESS = 0x0010,
    REG_STATION_ALIAS = 0x0012,
    REG_AL_CONTROL = 0x0120,
    REG_AL_STATUS = 0x0130, /**< 0x0134: AL status code */
    REG_WATCHDOG_DIVIDER = 0x0400,
    REG_WATCHDOG_PROCESS_DATA = 0x0420,
    REG_EEPROM_CONFIG = 0x0500,
    REG_FMMU0 = 0x0600,
    REG_SM0 = 0x0800,
    REG_SM1 = 0x0808,
    REG_SM2 = 0x0810,
    REG_SM3 = 0x0818,
};

enum {
    AL_STATE_MASK = 0x0F,
    AL_ERROR_FLAG = 0x10,      /**< AL status: error; AL control: acknowledge */
    AL_ID_REQUEST = 0x20,      /**< AL control and status: explicit device ID (ETG.1020) */
    SM_STATUS_FULL = 0x08,     /**< sync manager status: mailbox is full */
    SM_ACTIVATE_ENABLE = 0x01,
    SM_ACTIVATE_REPEAT = 0x02, /**< sync manager activate / PDI control: repeat request and its acknowledge */
    SYNC_MANAGER_BYTES = 8,
    FMMU_BYTES = 16,
};

/** Working counter of a datagram whose frame did not come back. */
enum { DATAGRAM_LOST = -1 };

/** A datagram. The sender fills it; `working_counter` and, for a read, `data` are filled when it is back. */
typedef struct cm1e_datagram {
    uint8_t command;     /**< cm1e_command_t */
    uint8_t frame_index; /**< SOEM's, while it is on its way */
    bool rides;          /**< in a frame of process data, or it waits for one */
    uint8_t seat;        /**< if it rides: which of those who may */
    uint16_t address, offset, length;
    int working_counter;
    int64_t sent_ns;
    uint8_t data[CM1E_DATAGRAM_MAX];
} cm1e_datagram_t;

static inline void cm1e_datagram_set(cm1e_datagram_t *d, cm1e_command_t command, uint16_t address, uint16_t offset,
                                     uint16_t length)
{
    d->command = (uint8_t)command;
    d->address = address;
    d->offset = offset;
    d->length = length;
}

#endif
