/**
 * @file coe_server.h
 * CANopen over EtherCAT, the slave's side (ETG.1000.6 5.6): SDO upload and download (expedited, normal, segmented,
 * complete access), SDO information. Works on the application's dictionary. Private to this room.
 */
#ifndef CM1E_SIM_COE_SERVER_H
#define CM1E_SIM_COE_SERVER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "device/device.h"

typedef struct cm1e_sim_slave cm1e_sim_slave_t;
typedef struct mailbox_message mailbox_message_t;

enum { COE_SDO_MAX_BYTES = 2048 }; /**< the largest value, or object in complete access, that can be transferred */

enum coe_transfer { COE_TRANSFER_NONE = 0, COE_TRANSFER_UPLOAD, COE_TRANSFER_DOWNLOAD };

typedef struct coe_server {
    /* segmented transfer */
    enum coe_transfer transfer;
    uint16_t index;
    uint8_t subindex;
    bool complete_access;
    bool toggle;
    size_t size, done;
    uint8_t data[COE_SDO_MAX_BYTES];
    /* list of objects that goes out in fragments */
    uint16_t list_type;       /**< 0: none */
    size_t list_object;       /**< number of the next object of the dictionary */
    uint16_t fragments_left;
    unsigned fragments_sent;  /**< of the list, behind the first one */
} coe_server_t;

void cm1e_sim_coe_reset(cm1e_sim_slave_t *slave);
/** Handles a request of `length` bytes (CoE header first); fills `answer` with at most `room` bytes, or leaves its
 *  length 0 if there is no answer. Returns 0 or a mailbox error detail. */
uint16_t cm1e_sim_coe_request(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer,
                              size_t room);
/** The next fragment of a list under way; false: none. */
bool cm1e_sim_coe_next_fragment(cm1e_sim_slave_t *slave, mailbox_message_t *answer, size_t room);

/* coe_server_sdo.c */
void cm1e_sim_coe_sdo(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer,
                      size_t room);
/* coe_server_access.c: one entry or a whole object; 0 or an SDO abort code. `size`: room, then bytes. */
uint32_t cm1e_sim_coe_read(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex, bool complete_access,
                           uint8_t *data, size_t *size);
uint32_t cm1e_sim_coe_write(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex, bool complete_access,
                            const uint8_t *data, size_t size);
/** Whether a download of `size` bytes may begin. */
uint32_t cm1e_sim_coe_check_write(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex, bool complete_access,
                                  size_t size);
/** NULL: no such object. */
const cm1e_object_t *cm1e_sim_coe_object(cm1e_sim_slave_t *slave, uint16_t index);
const cm1e_entry_t *cm1e_sim_coe_entry(cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex);
/* coe_server_info.c */
void cm1e_sim_coe_info(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer,
                       size_t room);

#endif
