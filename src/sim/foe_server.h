/**
 * @file foe_server.h
 * The slave's side of FoE (ETG.1000.6 section 5.8), for files that a master writes or reads: packet numbers, errors,
 * busy. What a file is for is the application's business. Private to this room.
 */
#ifndef CM1E_SIM_FOE_SERVER_H
#define CM1E_SIM_FOE_SERVER_H

#include "sim/mailbox.h"

typedef struct foe_server {
    bool open;         /**< a file is being written */
    uint32_t packet;   /**< number of the packet that was taken last */
    size_t received;   /**< bytes of the file */
    bool reading;      /**< a file is being read */
    bool ended;        /**< its last packet has been sent */
    char name[64];
    uint32_t password;
} foe_server_t;

void cm1e_sim_foe_reset(cm1e_sim_slave_t *slave);
/** Fills in the answer to a request; length 0: none. `room` is that of the mailbox to the slave, `answer_room` that of
 *  the other one. */
void cm1e_sim_foe_request(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer,
                          size_t room, size_t answer_room);
/** Outside Bootstrap no file is taken. */
void cm1e_sim_foe_refuse(mailbox_message_t *answer);

#endif
