/**
 * @file foe_client.h
 * One transfer of a file over the mailbox of a slave (FoE, ETG.1000.6 section 5.8). It waits: for code that owns a bus
 * whose cycle does not run.
 */
#ifndef CM1E_BUS_FOE_CLIENT_H
#define CM1E_BUS_FOE_CLIENT_H

#include "bus/bus_internal.h"
#include "cm1e/foe.h"

typedef struct cm1e_foe {
    cm1e_bus_t *bus;
    uint16_t position;
    cm1e_mailbox_t *mailbox;     /**< with its addresses */
    cm1e_bus_slave_t *slave;     /**< takes emergencies that come meanwhile; NULL: it sends none in this state */
    cm1e_foe_options_t options;  /**< `answer_ns` is given */
    cm1e_diag_t *diag;

    bool writing;
    bool partly;                 /**< of a file that is written, the slave may have taken a part */
    size_t done, size;           /**< bytes; size 0: not known */
    cm1e_datagram_t datagram;
} cm1e_foe_t;

cm1e_error_t cm1e_foe_send(cm1e_foe_t *foe, const char *name, const uint8_t *bytes, size_t size);
cm1e_error_t cm1e_foe_receive(cm1e_foe_t *foe, const char *name, uint8_t *bytes, size_t *size);

#endif
