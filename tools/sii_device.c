#include "sii_device.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command.h"
#include "end_signals.h"

bool read_device(cm1e_bus_t *bus, uint16_t position, input_t *image, cm1e_diag_t *diag)
{
    *image = (input_t){.bytes = malloc(CM1E_SII_IMAGE_MAX), .size = CM1E_SII_IMAGE_MAX};
    if (image->bytes && cm1e_sii_read_device(bus, position, image->bytes, &image->size, diag) == CM1E_OK)
        return true;
    if (!image->bytes)
        cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    free(image->bytes);
    image->bytes = NULL;
    return false;
}

/** The backup is on the disk before anything is changed, and never overwrites a file. */
static bool write_backup(const char *path, const input_t *image)
{
    const int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (file < 0) {
        complain("cannot write the backup %s: %s; nothing was written into the slave", path, strerror(errno));
        return false;
    }
    const bool whole = write(file, image->bytes, image->size) == (ssize_t)image->size && fsync(file) == 0;
    const int error = errno;
    if (close(file) == 0 && whole)
        return true;
    complain("cannot write the backup %s: %s; nothing was written into the slave", path, strerror(error));
    remove(path);
    return false;
}

/** Refused before the first word was written, so the backup is not needed. */
static bool nothing_written(cm1e_error_t error)
{
    return error == CM1E_ERROR_FILE || error == CM1E_ERROR_STATE || error == CM1E_ERROR_CONFIG ||
           error == CM1E_ERROR_BUS_IDENTITY || error == CM1E_ERROR_INVALID_ARGUMENT || error == CM1E_ERROR_NO_MEMORY;
}

int write_device(cm1e_bus_t *bus, uint16_t position, const input_t *image, const input_t *present, const char *backup,
                 const cm1e_sii_write_options_t *options)
{
    cm1e_diag_t diag = {0};
    catch_signals(); /* none of them breaks it off: half of an image is no SII */
    if (!write_backup(backup, present))
        return EXIT_FAILED;
    const cm1e_error_t error = cm1e_sii_write_device(bus, position, image->bytes, image->size, options, &diag);
    if (nothing_written(error))
        remove(backup);
    if (error == CM1E_OK)
        return EXIT_OK;
    fail(&diag);
    if (!nothing_written(error))
        complain("the backup is %s", backup);
    return EXIT_FAILED;
}
