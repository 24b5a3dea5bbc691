/**
 * @file pcap.h
 * Writer of pcap files with nanosecond time stamps (magic 0xA1B23C4D, link type Ethernet), which Wireshark opens.
 * Written through a large buffer, so that most frames cost a copy only.
 */
#ifndef CM1E_NIC_PCAP_H
#define CM1E_NIC_PCAP_H

#include <stddef.h>
#include <stdint.h>

#include "cm1e/error.h"

typedef struct pcap_file pcap_file_t;

/** CM1E_ERROR_IO: the file cannot be made, or somebody else writes it. */
cm1e_error_t cm1e_pcap_open(pcap_file_t **pcap, const char *path, cm1e_diag_t *diag);
/** CM1E_ERROR_IO: what was written so far does not arrive. Not in the cycle. */
cm1e_error_t cm1e_pcap_check(pcap_file_t *pcap, const char *path, cm1e_diag_t *diag);
/** After the first failed write (disk full) nothing more is written: the file stays readable up to there. */
void cm1e_pcap_write(pcap_file_t *pcap, int64_t time_ns, const uint8_t *frame, size_t length);
/** CM1E_ERROR_IO: not every frame is in the file. NULL is allowed. */
cm1e_error_t cm1e_pcap_close(pcap_file_t *pcap);

#endif
