#include "sim/esc_chip.h"

#include "core/bytes.h"

/* What the controller itself notes in its registers: event requests, error counters, links. */

void cm1e_sim_esc_event(cm1e_sim_slave_t *slave, uint16_t bits, bool on)
{
    uint8_t *request = slave->memory + ESC_EVENT_REQUEST;
    cm1e_put_u16(request, (uint16_t)(on ? cm1e_get_u16(request) | bits : cm1e_get_u16(request) & ~bits));
}

void cm1e_sim_esc_count(cm1e_sim_slave_t *slave, uint16_t address)
{
    if (slave->memory[address] < UINT8_MAX)
        slave->memory[address]++;
}

void cm1e_sim_esc_links(cm1e_sim_slave_t *slave, const bool link[4], const bool open[4])
{
    enum { LINK_SHIFT = 4, LOOP_SHIFT = 8, LOOP_CLOSED = 1, COMMUNICATION = 2, PORTS = 4 };
    const uint16_t before = cm1e_get_u16(slave->memory + ESC_DL_STATUS);
    /* Bit 0: the SII was loaded, bit 1: the PDI watchdog is served. */
    uint16_t status = slave->sii_valid ? 0x0003 : 0x0000;
    for (int port = 0; port < PORTS; port++) {
        if (link[port])
            status |= (uint16_t)(1u << (LINK_SHIFT + port));
        else if (before & 1u << (LINK_SHIFT + port))
            cm1e_sim_esc_count(slave, (uint16_t)(ESC_LOST_LINKS + port));
        status |= (uint16_t)((open[port] ? COMMUNICATION : LOOP_CLOSED) << (LOOP_SHIFT + 2 * port));
    }
    if (status == before)
        return;
    cm1e_put_u16(slave->memory + ESC_DL_STATUS, status);
    cm1e_sim_esc_event(slave, ESC_EVENT_DL_STATUS, true);
}
