/* What the ports of a slave controller have counted since its power-on (ETG.1000.4, 6.2). */
#include "bus/bus_internal.h"
#include "bus/kept.h"
#include "core/bytes.h"
#include "core/in_task.h"

enum {
    REG_DL_STATUS = 0x0110,
    LINK_BIT = 4,                /**< of port 0 in DL status */
    REG_RECEIVE_ERRORS = 0x0300, /**< per port a byte of invalid frames and a byte of receive errors; from 0x0308 on
                                      forwarded errors, 0x030C malformed frames */
    RECEIVE_ERROR_BYTES = 13,
    FORWARDED_AT = 8,
    MALFORMED_AT = 12,
    REG_LOST_LINKS = 0x0310,
};

cm1e_error_t cm1e_bus_read_ports(cm1e_bus_t *bus, uint16_t position, cm1e_slave_port_t ports[CM1E_PORTS],
                                 cm1e_diag_t *diag)
{
    uint8_t status[2], errors[RECEIVE_ERROR_BYTES], lost[CM1E_PORTS];
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_bus_read_ports()", "", diag);
    if (!bus)
        return cm1e_bus_missing("cm1e_bus_read_ports()", diag);
    const cm1e_error_t driven = cm1e_bus_refuse_driven(bus, "cm1e_bus_read_ports()", "cm1e_bus_port_faults() has what "
                                                       "the ports have counted since Operational.", diag);
    if (driven != CM1E_OK)
        return driven;
    if (!cm1e_bus_slave(bus, position))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "There is no slave %u.", position);
    if (!ports)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "cm1e_bus_read_ports() needs a place for the ports.");
    if (!cm1e_bus_read_registers(bus, position, REG_DL_STATUS, status, sizeof status) ||
        !cm1e_bus_read_registers(bus, position, REG_RECEIVE_ERRORS, errors, sizeof errors) ||
        !cm1e_bus_read_registers(bus, position, REG_LOST_LINKS, lost, sizeof lost))
        return cm1e_diag_set(diag, CM1E_ERROR_TIMEOUT, 0, "Slave %u does not answer when its ports are read.",
                             position);
    for (int port = 0; port < CM1E_PORTS; port++)
        ports[port] = (cm1e_slave_port_t){
            .link = cm1e_get_u16(status) >> (LINK_BIT + port) & 1,
            .invalid_frames = errors[2 * port],
            .receive_errors = errors[2 * port + 1],
            .forwarded_errors = errors[FORWARDED_AT + port],
            .lost_links = lost[port],
        };
    return CM1E_OK;
}
