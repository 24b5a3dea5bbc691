/**
 * @file soem_adapter.h
 * The interface of the bus to SOEM: find slaves, map and exchange process data, send and receive single datagrams. No
 * other header of this room uses SOEM, and SOEM's mailbox client is never used.
 */
#ifndef CM1E_BUS_SOEM_ADAPTER_H
#define CM1E_BUS_SOEM_ADAPTER_H

#include <stddef.h>

#include "bus/datagram.h"
#include "cm1e/config.h"
#include "nic/nic.h"

typedef struct cm1e_soem cm1e_soem_t;

/** Maximum number of frames with acyclic datagrams on their way at one time, in addition to the process data: SOEM has
 *  16 frame buffers for all, one of supervision and one for the reference clock included. */
enum { CM1E_FRAMES_IN_FLIGHT = 7, CM1E_PROCESS_FRAMES_MAX = 7 };
enum { CM1E_BUNDLE_DATAGRAMS = 64 };

/** Datagrams in one frame. All zero: empty. */
typedef struct cm1e_bundle {
    uint8_t frame_index;                             /**< SOEM's, from the first datagram on */
    unsigned count;
    int64_t sent_ns;
    cm1e_datagram_t *datagrams[CM1E_BUNDLE_DATAGRAMS];
    uint16_t at[CM1E_BUNDLE_DATAGRAMS];              /**< of their data in the answer */
} cm1e_bundle_t;

/** Data of the SII and the registers of a slave; all of it is unchecked input. */
typedef struct cm1e_slave_facts {
    uint16_t station, alias;
    uint32_t vendor_id, product_code, revision, serial_number;
    uint16_t mailbox_out_start, mailbox_out_length, mailbox_in_start, mailbox_in_length;
    bool coe, foe, complete_access;
    bool swapped;            /**< inputs on sync manager 2, outputs on 3: 0x1C12 assigns TxPDOs */
    char name[48];
} cm1e_slave_facts_t;

/** Place of the process data of a slave after mapping, and the registers that define it (for its recovery). */
typedef struct cm1e_slave_placement {
    uint32_t output_offset, input_offset; /**< from the beginning of the outputs and of the inputs */
    uint32_t wire_output, wire_input;     /**< in the image of the frames */
    uint16_t output_bytes, input_bytes;
    uint8_t last_input_bits; /**< of the last byte of the inputs: those that the slave is mapped to */
    uint8_t sync_managers[4][SYNC_MANAGER_BYTES];
    unsigned fmmu_count;
    uint8_t fmmus[4][FMMU_BYTES];
} cm1e_slave_placement_t;

/** Makes an adapter; NULL: no memory, or the port cannot be set up. Sends nothing. The caller keeps owning the nic. */
cm1e_soem_t *cm1e_soem_create(cm1e_nic_t *nic, const cm1e_bus_config_t *config);
void cm1e_soem_destroy(cm1e_soem_t *soem);

/** Finds the slaves, brings them to Init with default settings, gives them station addresses and reads their SII.
 *  SOEM's own scan is not used, because a bad SII or a silent slave can block it. Returns the number of slaves; 0:
 *  none; SCAN_TOO_MANY: more than CM1E_MAX_SLAVES. With the slave in `*position`: SCAN_LOST: it stopped answering,
 *  SCAN_NO_ADDRESS: it answers, but not at the station address that it was given, SCAN_SII_UNREADABLE: its EEPROM does
 *  not answer, SCAN_SII_DAMAGED: its categories are invalid, SCAN_NO_MEMORY: no memory to read it. */
enum {
    SCAN_TOO_MANY = -1, SCAN_LOST = -2, SCAN_SII_UNREADABLE = -3, SCAN_SII_DAMAGED = -4, SCAN_NO_MEMORY = -5,
    SCAN_NO_ADDRESS = -6,
};
int cm1e_soem_scan(cm1e_soem_t *soem, uint16_t *position);
/** Gives one slave its station address without a scan, and removes those of all others. 0: no slave answers there. */
uint16_t cm1e_soem_address(cm1e_soem_t *soem, uint16_t position);
/** Prepares Init -> Pre-Operational: programs the mailboxes of the slaves and gives the SII to them. */
void cm1e_soem_set_up_mailboxes(cm1e_soem_t *soem);
/** What the process data mean by the SII; NULL: nothing is known. Valid until the next scan. */
const struct cm1e_sii_signals *cm1e_soem_signals(const cm1e_soem_t *soem, uint16_t position);
/** The operation modes of its distributed clock, by its SII. Returns how many there are. */
struct cm1e_sii_dc_mode;
unsigned cm1e_soem_dc_modes(const cm1e_soem_t *soem, uint16_t position, const struct cm1e_sii_dc_mode **modes);
void cm1e_soem_facts(const cm1e_soem_t *soem, uint16_t position, cm1e_slave_facts_t *facts);

/** Changes the number of slaves. Those beyond the present ones are absent, with the station address of their place. */
void cm1e_soem_set_count(cm1e_soem_t *soem, uint16_t count);
/** Sets the process data of a slave; zero bits: none. False: its sync managers cannot carry it. */
bool cm1e_soem_set_process_data(cm1e_soem_t *soem, uint16_t position, uint16_t output_bits, uint16_t input_bits);
/** Sets the process data of a slave as its SII states it. Returns false if the SII is contradictory. */
bool cm1e_soem_set_process_data_by_sii(cm1e_soem_t *soem, uint16_t position);
/** Sets the process data of a slave with a mailbox: SM2 and SM3 as its SII has them, with the length that its PDOs
 *  have. Returns false if they cannot carry it. */
bool cm1e_soem_set_process_data_by_pdos(cm1e_soem_t *soem, uint16_t position, uint16_t output_bits,
                                        uint16_t input_bits);
/** Upper bound of the image size in bytes, for all slaves set so far. */
size_t cm1e_soem_image_bytes(const cm1e_soem_t *soem);
/** Bytes of process data that every frame has room for. */
size_t cm1e_soem_frame_room(void);
/** Maps into `image`, programs sync managers and FMMUs: first all outputs, then all inputs. `present`: the slaves
 *  behind so many are absent. False: it does not fit into so many frames. */
bool cm1e_soem_map(cm1e_soem_t *soem, uint16_t present, uint8_t *image, unsigned most_frames, size_t *output_bytes,
                   size_t *input_bytes);
/** The SII of a slave says that it does not know LRW. */
bool cm1e_soem_refuses_lrw(const cm1e_soem_t *soem, uint16_t position);
/** After cm1e_soem_map(): the image is sent in frames of these sizes, and comes back in its place. So many slaves take
 *  outputs and give inputs. */
void cm1e_soem_set_frames(cm1e_soem_t *soem, const uint32_t *sizes, unsigned count, unsigned takers, unsigned givers);
void cm1e_soem_placement(const cm1e_soem_t *soem, uint16_t position, cm1e_slave_placement_t *placement);
/** Frames that one exchange takes. */
unsigned cm1e_soem_process_frames(const cm1e_soem_t *soem);
/** Working counter of a good exchange. */
int cm1e_soem_expected_working_counter(const cm1e_soem_t *soem);

/** Sends and receives the process data of the image. Receiving waits at most `timeout_ns` in total; DATAGRAM_LOST: no
 *  frame came back. */
void cm1e_soem_send_process_data(cm1e_soem_t *soem);
int cm1e_soem_receive_process_data(cm1e_soem_t *soem, int64_t timeout_ns);
/** From now on the process data goes with the time of this slave, which all others get (FRMW); position 0: without. */
void cm1e_soem_use_clocks(cm1e_soem_t *soem, uint16_t position);
/** What that datagram carries when it is sent, and the time that the last one to come back has brought. */
void cm1e_soem_set_clock_time(cm1e_soem_t *soem, int64_t time_ns);
int64_t cm1e_soem_clock_time(const cm1e_soem_t *soem);
/** Number of frames that came back too late; only grows. */
uint64_t cm1e_soem_late_frames(const cm1e_soem_t *soem);
/** Number of frames of another master that were seen; only grows. */
uint64_t cm1e_soem_foreign_frames(const cm1e_soem_t *soem);
/** Number of frames that the network interface did not take; only grows. */
uint64_t cm1e_soem_unsent_frames(const cm1e_soem_t *soem);

/** The ring with a second interface is broken, as far as frames have shown it. */
bool cm1e_soem_ring_is_broken(const cm1e_soem_t *soem);
/** How many slaves either interface reaches, by the broadcast read that was answered last; false: it does not tell. */
bool cm1e_soem_ring_reach(const cm1e_soem_t *soem, uint32_t reach[2]);

/** Lets a read of one slave (FPRD) ride in the frame of the next process data; two may. cm1e_soem_rides() follows. */
void cm1e_soem_offer(cm1e_soem_t *soem, cm1e_datagram_t *datagram);
/** After the process data were sent: whether the datagram rides in their frame. If not, it was not sent. It is
 *  answered or lost as soon as the process data are received. */
bool cm1e_soem_rides(cm1e_soem_t *soem, cm1e_datagram_t *datagram, int64_t now_ns);
/** Sends a datagram in a frame of its own. */
void cm1e_soem_post(cm1e_soem_t *soem, cm1e_datagram_t *datagram, int64_t now_ns);
/** Whether a datagram is back; its working counter and data are then filled in. One that rode in a frame of process
 *  data that is lost is back with DATAGRAM_LOST. */
bool cm1e_soem_take(cm1e_soem_t *soem, cm1e_datagram_t *datagram, int64_t timeout_ns);
/** Stops waiting for a datagram. */
void cm1e_soem_drop(cm1e_soem_t *soem, cm1e_datagram_t *datagram);
/** Puts a datagram into a frame; false: the frame is full. */
bool cm1e_soem_add(cm1e_soem_t *soem, cm1e_bundle_t *bundle, cm1e_datagram_t *datagram);
/** As cm1e_soem_post(), _take() and _drop(), for a frame with at least one datagram. */
void cm1e_soem_post_bundle(cm1e_soem_t *soem, cm1e_bundle_t *bundle, int64_t now_ns);
bool cm1e_soem_take_bundle(cm1e_soem_t *soem, const cm1e_bundle_t *bundle, int64_t timeout_ns);
void cm1e_soem_drop_bundle(cm1e_soem_t *soem, const cm1e_bundle_t *bundle);
/** A datagram for each slave, as many as fit into each frame: sends `count` and waits for all. One that its slave does
 *  not answer is sent `tries` times in all. Before the cycle runs. */
void cm1e_soem_transfer_all(cm1e_soem_t *soem, cm1e_datagram_t *datagrams, unsigned count, unsigned tries);
/** Room for a datagram for each slave, for cm1e_soem_transfer_all(). */
cm1e_datagram_t *cm1e_soem_batch(cm1e_soem_t *soem);
/** Sends a datagram and waits for it, with repetitions. Returns its working counter or DATAGRAM_LOST. */
int cm1e_soem_transfer(cm1e_soem_t *soem, cm1e_command_t command, uint16_t address, uint16_t offset, void *data,
                       uint16_t length);

#endif
