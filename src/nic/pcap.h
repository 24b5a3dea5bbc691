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

cm1e_error_t pcap_open(pcap_file_t **pcap, const char *path, cm1e_diag_t *diag);
/** After the first failed write (disk full) nothing more is written: the file stays readable up to there. */
void pcap_write(pcap_file_t *pcap, int64_t time_ns, const uint8_t *frame, size_t length);
/** NULL is allowed. */
void pcap_close(pcap_file_t *pcap);

#endif
