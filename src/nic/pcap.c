#include "nic/pcap.h"
#include "core/clock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum { BUFFER_SIZE = 1 << 20, SNAP_LENGTH = 65535, LINK_ETHERNET = 1 };

struct pcap_file {
    FILE *file;
    bool failed;
    char buffer[BUFFER_SIZE];
};

/* Headers in the byte order of the machine: the reader tells it from the magic number. */
typedef struct file_header {
    uint32_t magic;
    uint16_t major, minor;
    int32_t zone;
    uint32_t accuracy, snap_length, link_type;
} file_header_t;

typedef struct record_header {
    uint32_t seconds, nanoseconds, stored_length, length;
} record_header_t;

static void put(pcap_file_t *pcap, const void *bytes, size_t size)
{
    if (!pcap->failed && fwrite(bytes, 1, size, pcap->file) != size)
        pcap->failed = true;
}

static cm1e_error_t cannot_write(const char *path, cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "The pcap file %s cannot be written: %s.", path, strerror(errno));
}

/** Opens a file that nobody else writes, and empties it: two that write one file damage the records of each other. A
 *  lock needs no file of its own and ends with the process. -1: errno is EWOULDBLOCK where somebody writes it. */
static int open_alone(const char *path)
{
    struct stat found;
    const int fd = open(path, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (fd < 0 || fstat(fd, &found) != 0 || !S_ISREG(found.st_mode))
        return fd;
    const bool taken = flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!taken && ftruncate(fd, 0) == 0)
        return fd;
    const int why = taken ? EWOULDBLOCK : errno;
    close(fd);
    errno = why;
    return -1;
}

cm1e_error_t cm1e_pcap_open(pcap_file_t **pcap, const char *path, cm1e_diag_t *diag)
{
    *pcap = NULL;
    pcap_file_t *p = calloc(1, sizeof *p);
    if (!p)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the buffer of the pcap file.");
    const int fd = open_alone(path);
    p->file = fd >= 0 ? fdopen(fd, "wb") : NULL;
    if (!p->file) {
        free(p);
        if (fd >= 0)
            close(fd);
        else if (errno == EWOULDBLOCK)
            return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "The pcap file %s is being written already, for another "
                                 "network or by another program: name another file.", path);
        return cannot_write(path, diag);
    }
    setvbuf(p->file, p->buffer, _IOFBF, sizeof p->buffer);
    const file_header_t header = {.magic = 0xA1B23C4D, .major = 2, .minor = 4, .snap_length = SNAP_LENGTH,
                                  .link_type = LINK_ETHERNET};
    put(p, &header, sizeof header);
    *pcap = p;
    return CM1E_OK;
}

cm1e_error_t cm1e_pcap_check(pcap_file_t *pcap, const char *path, cm1e_diag_t *diag)
{
    return fflush(pcap->file) == 0 ? CM1E_OK : cannot_write(path, diag);
}

void cm1e_pcap_write(pcap_file_t *pcap, int64_t time_ns, const uint8_t *frame, size_t length)
{
    const record_header_t header = {.seconds = (uint32_t)(time_ns / S_IN_NS),
                                    .nanoseconds = (uint32_t)(time_ns % S_IN_NS),
                                    .stored_length = (uint32_t)length, .length = (uint32_t)length};
    put(pcap, &header, sizeof header);
    put(pcap, frame, length);
}

cm1e_error_t cm1e_pcap_close(pcap_file_t *pcap)
{
    if (!pcap)
        return CM1E_OK;
    const bool arrived = fflush(pcap->file) == 0;
    /* A child that was forked meanwhile has the file open too, and the lock with it. */
    flock(fileno(pcap->file), LOCK_UN);
    const bool whole = fclose(pcap->file) == 0 && arrived && !pcap->failed;
    free(pcap);
    return whole ? CM1E_OK : CM1E_ERROR_IO;
}
