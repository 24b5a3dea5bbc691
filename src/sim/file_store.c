#include "sim/file_store.h"

#include <stdio.h>
#include <string.h>

#include "sim/slave.h"

static bool is_busy(cm1e_sim_files_t *files)
{
    if (files->busy == 0)
        return false;
    files->busy--;
    return true;
}

uint32_t cm1e_sim_files_begin(cm1e_sim_files_t *files, const char *name)
{
    if (is_busy(files))
        return FOE_RESULT_BUSY;
    snprintf(files->coming, sizeof files->coming, "%s", name);
    files->name[0] = 0;
    files->size = 0;
    return 0;
}

uint32_t cm1e_sim_files_data(cm1e_sim_files_t *files, size_t offset, const uint8_t *data, size_t size, bool last)
{
    if (is_busy(files))
        return FOE_RESULT_BUSY;
    if (offset + size > sizeof files->bytes)
        return FOE_CODE_DISK_FULL;
    memcpy(files->bytes + offset, data, size);
    files->size = offset + size;
    if (last)
        memcpy(files->name, files->coming, sizeof files->name);
    return 0;
}

uint32_t cm1e_sim_files_read(cm1e_sim_files_t *files, const char *name, size_t offset, uint8_t *data, size_t *size)
{
    if (is_busy(files))
        return FOE_RESULT_BUSY;
    if (!files->name[0] || strcmp(files->name, name) != 0)
        return FOE_CODE_NOT_FOUND;
    const size_t left = files->size - offset;
    *size = left < *size ? left : *size;
    memcpy(data, files->bytes + offset, *size);
    return 0;
}
