/**
 * @file eeprom.h
 * The EEPROM (SII) behind one slave controller, through the controller's interface (ETG.1000.4 section 6.4): a group of
 * words read, a word written and read back. Blocking, every wait bounded; before the cycle runs.
 */
#ifndef CM1E_BUS_EEPROM_H
#define CM1E_BUS_EEPROM_H

#include "bus/soem_adapter.h"

typedef struct cm1e_eeprom {
    cm1e_soem_t *soem;
    uint16_t station;
    bool lost;              /**< the slave controller does not answer */
    bool was_offered;       /**< the slave's processor had the interface before */
    bool ready;             /**< the interface is idle, without errors */
    uint32_t group_word;    /**< address of the words in `group` */
    unsigned group_bytes;   /**< 0: nothing */
    uint8_t group[8];
} cm1e_eeprom_t;

/** Takes the interface from the slave's processor; false: lost. */
bool cm1e_eeprom_take(cm1e_eeprom_t *eeprom);
/** Returns the interface to the processor, if that had it. */
void cm1e_eeprom_give_back(cm1e_eeprom_t *eeprom);
/** Two words from word address `word` on. False: `lost`, or the EEPROM does not answer. */
bool cm1e_eeprom_read(cm1e_eeprom_t *eeprom, uint32_t word, uint8_t bytes[4]);
/** Writes a word until it reads back as written. False: `lost`, or the EEPROM does not keep it. */
bool cm1e_eeprom_write(cm1e_eeprom_t *eeprom, uint32_t word, uint16_t value);

#endif
