/**
 * @file eni_registers.h
 * Registers of the slave controller (ETG.1000.4 6) that the commands of an ENI write and read. Private to eni*.c.
 */
#ifndef CM1E_GENERATE_ENI_REGISTERS_H
#define CM1E_GENERATE_ENI_REGISTERS_H

enum {
    STATION_ADDRESS = 0x0010,   /**< configured station address, 6.1 */
    STATION_ALIAS = 0x0012,     /**< 6.1 */
    DL_CONTROL_ALIAS = 0x0103,  /**< bit 0: the alias is an address too; 6.1 */
    AL_CONTROL = 0x0120,        /**< 6.2 */
    AL_STATUS = 0x0130,         /**< 6.2, with the status code 4 bytes behind it */
    ECAT_EVENT_MASK = 0x0200,   /**< 6.2 */
    RX_ERRORS = 0x0300,         /**< 6.3 */
    WATCHDOG_DIVIDER = 0x0400,  /**< 6.3 */
    WATCHDOG_PDI = 0x0410,      /**< 6.3 */
    WATCHDOG_PROCESS_DATA = 0x0420, /**< 6.3 */
    SII_ACCESS = 0x0500,        /**< who has the EEPROM: 0 the master, 1 the slave's processor; 6.4 */
    SII_CONTROL = 0x0502,       /**< 6.4 */
    SII_DATA = 0x0508,          /**< 6.4 */
    FMMU = 0x0600,              /**< FMMU_BYTES each, 6.6 */
    SYNC_MANAGER = 0x0800,      /**< SYNC_MANAGER_BYTES each, 6.7 */
    DC_RECEIVE_TIMES = 0x0900,  /**< a write latches when this frame came in at every port; 6.8 */
    DC_SYSTEM_TIME = 0x0910,    /**< 6.8 */
    DC_OFFSET = 0x0920,         /**< 6.8 */
    DC_DELAY = 0x0928,          /**< 6.8 */
    DC_SPEED = 0x0930,          /**< 6.8 */
    DC_FILTER = 0x0934,         /**< 6.8 */
    DC_CONTROL = 0x0980,        /**< with the activation behind it; 6.8 */
    DC_ACTIVATION = 0x0981,     /**< 6.8 */
    DC_START = 0x0990,          /**< of SYNC0; 6.8 */
    DC_CYCLES = 0x09A0,         /**< of SYNC0 and SYNC1; 6.8 */
    REGISTERS_END = 0x1000,     /**< where the memory begins */
};
enum { FMMUS = 16, FMMU_BYTES = 16, FMMU_READ = 1, FMMU_WRITE = 2, SYNC_MANAGERS = 16, SYNC_MANAGER_BYTES = 8 };
/** Control byte of a mailbox, written or read by the master, with an event to the slave. */
enum { CONTROL_MAILBOX_OUT = 0x26, CONTROL_MAILBOX_IN = 0x22 };
/** What a slave with inputs, with outputs adds to the working counter of LRW (ETG.1000.4 5.4.3). */
enum { LRW_INPUTS = 1, LRW_OUTPUTS = 2 };

#endif
