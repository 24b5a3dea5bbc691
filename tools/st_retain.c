/* The file: a line "cm1e retain <layout> <bytes> <checksum>", then the bytes of all variables in the order of the table. */
#include "st_retain.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "core/output.h"
#include "core/regular_file.h"

enum { MOST_BYTES = 65536, POLL_NS = 50000000 };
#define PERIOD_NS INT64_C(1000000000)
#define HEAD "cm1e retain %016" PRIx64 " %zu %016" PRIx64 "\n"

static uint64_t checksum(const unsigned char *bytes, size_t size)
{
    uint64_t hash = UINT64_C(14695981039346656037); /* FNV-1a */
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * UINT64_C(1099511628211);
    return hash;
}

static void copy_out(st_retain_t *retain)
{
    unsigned char *at = retain->copy;
    for (uint32_t i = 0; i < retain->program->retained.count; i++) {
        const st_variable_t *variable = &retain->program->retained.first[i];
        memcpy(at, variable->data, variable->size);
        at += variable->size;
    }
}

/** The lock goes over to the file that takes the place of the present one. */
static void move_lock(st_retain_t *retain, int file)
{
    if (retain->file >= 0)
        close(retain->file);
    retain->file = file;
}

static cm1e_error_t write_file(st_retain_t *retain, cm1e_diag_t *diag)
{
    cm1e_output_t output;
    if (memcmp(retain->copy, retain->written, retain->size) == 0)
        return CM1E_OK;
    const cm1e_error_t error = cm1e_output_open(&output, retain->path, diag);
    if (error != CM1E_OK)
        return error;
    fprintf(output.file, HEAD, retain->program->layout, retain->size, checksum(retain->copy, retain->size));
    fwrite(retain->copy, 1, retain->size, output.file);
    const int file = fcntl(fileno(output.file), F_DUPFD_CLOEXEC, 0);
    if (file >= 0)
        flock(file, LOCK_EX | LOCK_NB);
    const cm1e_error_t closed = cm1e_output_close(&output, diag);
    if (closed == CM1E_OK) {
        memcpy(retain->written, retain->copy, retain->size);
        move_lock(retain, file);
    } else if (file >= 0) {
        close(file);
    }
    return closed;
}

static void *write_copies(void *context)
{
    st_retain_t *retain = context;
    const struct timespec pause = {.tv_nsec = POLL_NS};
    while (!retain->end) {
        cm1e_diag_t diag = {0};
        nanosleep(&pause, NULL);
        if (atomic_load_explicit(&retain->state, memory_order_acquire) == 0)
            continue;
        if (write_file(retain, &diag) != CM1E_OK)
            retain->failed = true; /* told at the end, when it is tried once more */
        atomic_store_explicit(&retain->state, 0, memory_order_release);
    }
    return NULL;
}

/* ---- the beginning ----------------------------------------------------------------------------------------------- */

static cm1e_error_t refuse(const st_retain_t *retain, cm1e_error_t error, const char *why, cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, error, 0, "%s %s. Nothing was started. --cold-start begins with the initial values of the "
                         "program, and replaces the file", retain->path, why);
}

/** The file, if there is one, is that of this program until the end: two that keep their values in it, as that of the
 *  machine and one that is tried on the simulated segment, would replace those of the other. */
static cm1e_error_t take_file(st_retain_t *retain, cm1e_diag_t *diag)
{
    char why[160];
    struct stat mine, present;
    const cm1e_error_t error = cm1e_regular_file_open(retain->path, &retain->file, why, sizeof why);
    if (error == CM1E_ERROR_NOT_FOUND)
        return CM1E_OK; /* the first run */
    if (error != CM1E_OK)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "%s %s", retain->path, why);
    const bool locked = flock(retain->file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    const bool replaced = fstat(retain->file, &mine) != 0 || stat(retain->path, &present) != 0 ||
                          mine.st_ino != present.st_ino;
    if (locked || replaced)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "a program that runs keeps its RETAIN variables in %s. End it, or "
                             "name another file with --retain", retain->path);
    return CM1E_OK;
}

static cm1e_error_t read_file(st_retain_t *retain, cm1e_diag_t *diag)
{
    uint64_t layout = 0, sum = 0;
    size_t size = 0;
    char head[80] = "";
    if (retain->file < 0)
        return CM1E_OK; /* the first run */
    FILE *file = fdopen(fcntl(retain->file, F_DUPFD_CLOEXEC, 0), "rb");
    if (!file)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, (uint32_t)errno, "%s cannot be read: %s", retain->path,
                             strerror(errno));
    const bool headed = fgets(head, sizeof head, file) &&
        sscanf(head, "cm1e retain %" SCNx64 " %zu %" SCNx64, &layout, &size, &sum) == 3;
    const bool fits = headed && layout == retain->program->layout && size == retain->size;
    const bool whole = fits && fread(retain->copy, 1, size, file) == size && fgetc(file) == EOF &&
        checksum(retain->copy, size) == sum;
    fclose(file);
    if (headed && !fits)
        return refuse(retain, CM1E_ERROR_CONFIG, "has the values of other RETAIN variables: names, types or order have "
                      "changed since", diag);
    if (!whole)
        return refuse(retain, CM1E_ERROR_IO, "is damaged, or no file of RETAIN variables", diag);
    const unsigned char *at = retain->copy;
    for (uint32_t i = 0; i < retain->program->retained.count; i++) {
        const st_variable_t *variable = &retain->program->retained.first[i];
        memcpy(variable->data, at, variable->size);
        at += variable->size;
    }
    return CM1E_OK;
}

cm1e_error_t st_retain_begin(st_retain_t *retain, const st_program_t *program, const char *path, bool cold,
                             cm1e_diag_t *diag)
{
    *retain = (st_retain_t){.program = program, .file = -1};
    for (uint32_t i = 0; i < program->retained.count; i++)
        retain->size += program->retained.first[i].size;
    if (retain->size == 0)
        return CM1E_OK;
    if (retain->size > MOST_BYTES)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "the RETAIN variables have %zu bytes; %d are the most, because the "
                             "cycle copies them", retain->size, MOST_BYTES);
    if ((size_t)snprintf(retain->path, sizeof retain->path, "%s", path) >= sizeof retain->path)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "the name of the file of RETAIN variables is too long");
    retain->copy = calloc(2, retain->size);
    if (!retain->copy)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "%s", cm1e_strerror(CM1E_ERROR_NO_MEMORY));
    retain->written = retain->copy + retain->size;
    cm1e_error_t error = take_file(retain, diag);
    if (error == CM1E_OK && !cold)
        error = read_file(retain, diag);
    if (error == CM1E_OK)
        error = cm1e_output_check(path, diag);
    if (error != CM1E_OK)
        return error;
    copy_out(retain);
    memcpy(retain->written, retain->copy, retain->size);
    retain->written[0] = (unsigned char)~retain->copy[0]; /* what the file has is not known to be this */
    if (retain->file < 0) /* a file of a first run is this program's from here on too */
        error = write_file(retain, diag);
    if (error != CM1E_OK)
        return error;
    retain->started = pthread_create(&retain->thread, NULL, write_copies, retain) == 0;
    return CM1E_OK;
}

/* ---- the run ----------------------------------------------------------------------------------------------------- */

void st_retain_cycle(st_retain_t *retain, int64_t now_ns)
{
    if (retain->size == 0 || now_ns - retain->copied_ns < PERIOD_NS ||
        atomic_load_explicit(&retain->state, memory_order_acquire) != 0)
        return;
    retain->copied_ns = now_ns;
    copy_out(retain);
    atomic_store_explicit(&retain->state, 1, memory_order_release);
}

cm1e_error_t st_retain_end(st_retain_t *retain, cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    retain->end = true;
    if (retain->started) {
        pthread_join(retain->thread, NULL);
        copy_out(retain);
        error = write_file(retain, diag);
    }
    free(retain->copy);
    if (retain->program) /* it has begun */
        move_lock(retain, -1);
    *retain = (st_retain_t){.file = -1};
    return error;
}
