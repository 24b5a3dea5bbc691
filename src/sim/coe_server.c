#include "sim/coe_server.h"

#include <string.h>

#include "core/bytes.h"
#include "sim/esc_chip.h"

/* CoE header (ETG.1000.6 table 29): number in bits 0-8, service in bits 12-15. */
enum { HEADER_BYTES = 2, SERVICE_SHIFT = 12 };
enum {
    SERVICE_EMERGENCY = 1, SERVICE_SDO_REQUEST = 2, SERVICE_SDO_RESPONSE = 3, SERVICE_TXPDO = 4, SERVICE_RXPDO = 5,
    SERVICE_TXPDO_REQUEST = 6, SERVICE_RXPDO_REQUEST = 7, SERVICE_SDO_INFORMATION = 8,
};
enum { SDO_REQUEST_BYTES = 10, INFORMATION_HEADER_BYTES = 6 };

void cm1e_sim_coe_reset(cm1e_sim_slave_t *slave)
{
    slave->coe.transfer = COE_TRANSFER_NONE;
    slave->coe.list_type = 0;
}

uint16_t cm1e_sim_coe_request(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer,
                              size_t room)
{
    if (length < HEADER_BYTES)
        return MAILBOX_ERROR_SIZE_TOO_SHORT;
    if (room > sizeof answer->data)
        room = sizeof answer->data;
    answer->type = MAILBOX_TYPE_COE;
    /* Any request ends an unfinished list. */
    slave->coe.list_type = 0;
    switch (cm1e_get_u16(request) >> SERVICE_SHIFT) {
    case SERVICE_SDO_REQUEST:
        if (length < SDO_REQUEST_BYTES)
            return MAILBOX_ERROR_SIZE_TOO_SHORT;
        cm1e_sim_coe_sdo(slave, request, length, answer, room);
        return 0;
    case SERVICE_SDO_INFORMATION:
        if (length < INFORMATION_HEADER_BYTES)
            return MAILBOX_ERROR_SIZE_TOO_SHORT;
        cm1e_sim_coe_info(slave, request, length, answer, room);
        return 0;
    case SERVICE_EMERGENCY:
    case SERVICE_SDO_RESPONSE:
    case SERVICE_TXPDO:
    case SERVICE_RXPDO:
    case SERVICE_TXPDO_REQUEST:
    case SERVICE_RXPDO_REQUEST:
        return MAILBOX_ERROR_SERVICE_NOT_SUPPORTED;
    default:
        return MAILBOX_ERROR_INVALID_HEADER;
    }
}
