/**
 * @file esi_reader.h
 * Who reads ESI files for the bus file. The reader needs an XML library, which a program that moves motors does not, so
 * it is a guest (cm1e::generate) that registers itself before main().
 */
#ifndef CM1E_CONFIG_ESI_READER_H
#define CM1E_CONFIG_ESI_READER_H

#include "cm1e/config.h"

/** Adds what an ESI file says of a slave to its configuration; what that states already stays. `mode`: the name of an
 *  OpMode whose pulses are taken, "": none. @rt init */
typedef cm1e_error_t (*cm1e_esi_reader_t)(cm1e_slave_config_t *slave, const char *path, const char *mode,
                                          int64_t cycle_time_ns, cm1e_diag_t *diag);

void cm1e_esi_register_reader(cm1e_esi_reader_t reader);
/** NULL: there is none in this program. */
cm1e_esi_reader_t cm1e_esi_reader(void);

#endif
