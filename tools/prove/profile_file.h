/**
 * @file profile_file.h
 * Reads device profiles (JSON, docs/PROVE.md).
 */
#ifndef CM1E_TOOLS_PROFILE_FILE_H
#define CM1E_TOOLS_PROFILE_FILE_H

#include "cm1e/sim.h"

typedef struct profile_file profile_file_t;

/** NULL, after a complaint that names `path` and what is wrong: it is no profile. The caller frees it. */
profile_file_t *profile_file_read(const char *path, const void *bytes, size_t size);
/** It lives as long as the file. */
const cm1e_sim_profile_t *profile_file_content(const profile_file_t *file);
/** NULL is allowed. */
void profile_file_free(profile_file_t *file);

#endif
