/**
 * @file eeprom_interface.h
 * Registers, commands and status of a slave controller's interface to its EEPROM (ETG.1000.4 section 6.4).
 */
#ifndef CM1E_BUS_EEPROM_INTERFACE_H
#define CM1E_BUS_EEPROM_INTERFACE_H

enum {
    REG_EEPROM_CONTROL = 0x0502, REG_EEPROM_DATA = 0x0508,
    EEPROM_GROUP_AT = REG_EEPROM_DATA - REG_EEPROM_CONTROL, /**< of the data, behind command and address */
    EEPROM_NOP = 0x0000, EEPROM_READ = 0x0100, EEPROM_WRITE = 0x0201 /**< with write enable, in the same frame */,
    EEPROM_READS_8 = 0x0040, EEPROM_ERRORS = 0x7800, EEPROM_NACK = 0x2000, EEPROM_NOT_ENABLED = 0x4000,
    EEPROM_BUSY = 0x8000,
    CONFIG_MASTER = 0, CONFIG_OFFERED = 1, CONFIG_FORCE = 2,
};

#endif
