/**
 * @file soem_adapter.h
 * All that the bus asks of SOEM, in words of ours: slaves found, process data mapped and exchanged, single datagrams
 * sent and fetched. The one header of this room behind which SOEM lives; SOEM's own mailbox client is never used.
 */
#ifndef CM1E_BUS_SOEM_ADAPTER_H
#define CM1E_BUS_SOEM_ADAPTER_H

#include <stddef.h>

#include "bus/datagram.h"
#include "cm1e/config.h"
#include "nic/nic.h"

typedef struct cm1e_soem cm1e_soem_t;

/** Datagrams in flight at one time beside the process data: SOEM has 16 frame buffers for all. */
enum { CM1E_DATAGRAMS_IN_FLIGHT = 8, CM1E_PROCESS_FRAMES_MAX = 7 };

/** What the SII and the registers of a slave say; all of it is unchecked input. */
typedef struct cm1e_slave_facts {
    uint16_t station, alias;
    uint32_t vendor_id, product_code, revision, serial_number;
    uint16_t mailbox_out_start, mailbox_out_length, mailbox_in_start, mailbox_in_length;
    bool coe, complete_access;
    char name[48];
} cm1e_slave_facts_t;

/** Where the process data of a slave lies after mapping, and the registers that make it so (for its recovery). */
typedef struct cm1e_slave_placement {
    uint32_t output_offset, input_offset; /**< from the begin of the outputs and of the inputs */
    uint16_t output_bytes, input_bytes;
    uint8_t sync_managers[4][SYNC_MANAGER_BYTES];
    unsigned fmmu_count;
    uint8_t fmmus[4][FMMU_BYTES];
} cm1e_slave_placement_t;

/** NULL: no memory, or the port cannot be set up. Sends nothing. The nic stays the caller's. */
cm1e_soem_t *cm1e_soem_create(cm1e_nic_t *nic, const cm1e_bus_config_t *config);
void cm1e_soem_destroy(cm1e_soem_t *soem);

/** Finds the slaves, brings them to Init with default settings, gives them station addresses and reads their SII. Not
 *  SOEM's own scan: that can be kept for ever by a bad SII or a slave that falls silent. Returns how many; 0: none;
 *  SCAN_TOO_MANY: more than CM1E_MAX_SLAVES; with the slave in `*position`: SCAN_LOST: it stopped answering,
 *  SCAN_SII_UNREADABLE: its EEPROM does not answer, SCAN_SII_DAMAGED: its content cannot be walked through,
 *  SCAN_NO_MEMORY: none to read it. */
enum {
    SCAN_TOO_MANY = -1, SCAN_LOST = -2, SCAN_SII_UNREADABLE = -3, SCAN_SII_DAMAGED = -4, SCAN_NO_MEMORY = -5,
};
int cm1e_soem_scan(cm1e_soem_t *soem, uint16_t *position);
/** Gives one slave its station address without a scan, and takes all others theirs. 0: nobody answers there. */
uint16_t cm1e_soem_address(cm1e_soem_t *soem, uint16_t position);
/** Programs the mailboxes of the slaves and leaves the SII to them: what Init -> Pre-Operational needs. */
void cm1e_soem_set_up_mailboxes(cm1e_soem_t *soem);
void cm1e_soem_facts(const cm1e_soem_t *soem, uint16_t position, cm1e_slave_facts_t *facts);

/** Sets the process data of a slave; zero bits: none. False: its sync managers cannot carry it. */
bool cm1e_soem_set_process_data(cm1e_soem_t *soem, uint16_t position, uint16_t output_bits, uint16_t input_bits);
/** The same as its SII says. False: its SII is contradictory. */
bool cm1e_soem_set_process_data_by_sii(cm1e_soem_t *soem, uint16_t position);
/** Bytes that the image of everything set so far needs, at most. */
size_t cm1e_soem_image_bytes(const cm1e_soem_t *soem);
/** Maps into `image`, programs sync managers and FMMUs. False: it does not fit into CM1E_PROCESS_FRAMES_MAX frames. */
bool cm1e_soem_map(cm1e_soem_t *soem, uint8_t *image, size_t room, size_t *output_bytes, size_t *input_bytes);
void cm1e_soem_placement(const cm1e_soem_t *soem, uint16_t position, cm1e_slave_placement_t *placement);
/** Frames that one exchange takes. */
unsigned cm1e_soem_process_frames(const cm1e_soem_t *soem);
/** Working counter of a good exchange. */
int cm1e_soem_expected_working_counter(const cm1e_soem_t *soem);

/** The process data of the image. Receiving waits at most `timeout_ns` in all; DATAGRAM_LOST: no frame came back. */
void cm1e_soem_send_process_data(cm1e_soem_t *soem);
int cm1e_soem_receive_process_data(cm1e_soem_t *soem, int64_t timeout_ns);
/** Frames that came back when nobody waited for them any more; only grows. */
uint64_t cm1e_soem_late_frames(const cm1e_soem_t *soem);
/** Frames that the network interface did not take; only grows. */
uint64_t cm1e_soem_unsent_frames(const cm1e_soem_t *soem);

/** Sends a datagram in a frame of its own. */
void cm1e_soem_post(cm1e_soem_t *soem, cm1e_datagram_t *datagram, int64_t now_ns);
/** TRUE: it is back, its working counter and data are filled in. Otherwise it is still under way. */
bool cm1e_soem_take(cm1e_soem_t *soem, cm1e_datagram_t *datagram, int64_t timeout_ns);
/** Stops waiting for it. */
void cm1e_soem_drop(cm1e_soem_t *soem, cm1e_datagram_t *datagram);
/** Sends a datagram and waits for it, with repetitions. Returns its working counter or DATAGRAM_LOST. */
int cm1e_soem_transfer(cm1e_soem_t *soem, cm1e_command_t command, uint16_t address, uint16_t offset, void *data,
                       uint16_t length);

#endif
