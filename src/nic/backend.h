/**
 * @file backend.h
 * What stands behind an interface, as a table of functions: the packet socket of this room, or a guest such as the
 * simulator, which registers itself (cm1e_nic_register()).
 */
#ifndef CM1E_NIC_BACKEND_H
#define CM1E_NIC_BACKEND_H

#include "nic/nic.h"

/** What SOEM's source address has in these bytes. */
enum { CM1E_SOEM_IDENTITY = 0x0101 };

/** What a backend and the nic share. The nic fills it in before open(). */
typedef struct cm1e_nic_link {
    void *state;             /**< the backend's own; set by open() */
    cm1e_clock_t *clock;     /**< monotonic; open() may set a clock of the backend, which lives until close() */
    int ports;               /**< 1, or 2 for a ring */
    char interface_name[64]; /**< of the first port */
    uint16_t identity;       /**< in the source address of every frame: what came back of another master is told from
                                  our own by it. CM1E_SOEM_IDENTITY unless open() sets another */
} cm1e_nic_link_t;

struct cm1e_nic_backend {
    const char *name;
    bool (*matches)(const char *interface_name);
    cm1e_error_t (*open)(cm1e_nic_link_t *link, const cm1e_bus_config_t *config, cm1e_diag_t *diag);
    /** Sends one frame on a port; false: not sent. Never blocks. */
    bool (*send)(cm1e_nic_link_t *link, int port, const uint8_t *frame, size_t length);
    /** Next frame received on any port, until `deadline_ns` (clock of the link) has passed; 0: none. `*port` says where
     *  it came in. A deadline in the past means: only what is here already. Waits exactly, to the deadline and not
     *  beyond. `frame` has room for CM1E_FRAME_MAX. */
    size_t (*receive)(cm1e_nic_link_t *link, int *port, uint8_t *frame, int64_t deadline_ns);
    void (*close)(cm1e_nic_link_t *link);
};

enum { CM1E_NIC_GUESTS = 4 };

/** Makes a backend known. A registered backend is asked for a name before the packet socket is; the first that matches
 *  wins. Registering it again changes nothing. false: CM1E_NIC_GUESTS are registered already. Not to be called while
 *  another thread opens a nic. @rt init */
CM1E_GUEST_API bool cm1e_nic_register(const cm1e_nic_backend_t *backend);
/** The state that `backend` keeps for this nic; NULL: another backend serves it. @rt any */
CM1E_GUEST_API void *cm1e_nic_state_of(const cm1e_nic_t *nic, const cm1e_nic_backend_t *backend);

#endif
