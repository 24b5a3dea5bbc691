/**
 * @file sim/file_store.h
 * A place for one file that a master writes and reads by FoE, for applications of simulated slaves. Private to this
 * room.
 */
#ifndef CM1E_SIM_FILE_STORE_H
#define CM1E_SIM_FILE_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CM1E_SIM_FILE_BYTES = 1 << 16, CM1E_SIM_FILE_NAME = 64 };

typedef struct cm1e_sim_files {
    char name[CM1E_SIM_FILE_NAME];   /**< "": there is no file */
    char coming[CM1E_SIM_FILE_NAME]; /**< of the one that is being written */
    size_t size;
    unsigned busy;                   /**< so many requests are answered by "busy" first */
    uint8_t bytes[CM1E_SIM_FILE_BYTES];
} cm1e_sim_files_t;

/** As file_begin(), file_data() and file_read() of cm1e_sim_app_ops_t. */
uint32_t cm1e_sim_files_begin(cm1e_sim_files_t *files, const char *name);
uint32_t cm1e_sim_files_data(cm1e_sim_files_t *files, size_t offset, const uint8_t *data, size_t size, bool last);
uint32_t cm1e_sim_files_read(cm1e_sim_files_t *files, const char *name, size_t offset, uint8_t *data, size_t *size);

#endif
