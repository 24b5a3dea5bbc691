#include "nic/nic.h"

#include <stdio.h>
#include <stdlib.h>

#include "config/interface.h"
#include "nic/nic_private.h"

static const cm1e_nic_backend_t *guests[CM1E_NIC_GUESTS];

bool cm1e_nic_register(const cm1e_nic_backend_t *backend)
{
    for (size_t i = 0; i < CM1E_NIC_GUESTS; i++) {
        if (!guests[i])
            guests[i] = backend;
        if (guests[i] == backend)
            return true;
    }
    return false;
}

static const char *first_interface(const cm1e_bus_config_t *config)
{
    return config->interface_name[0] ? config->interface_name : CM1E_SIM_INTERFACE;
}

cm1e_error_t cm1e_nic_open_backend(cm1e_nic_t **nic, const cm1e_nic_backend_t *backend, const cm1e_bus_config_t *config,
                                   cm1e_diag_t *diag)
{
    *nic = NULL;
    cm1e_nic_t *n = calloc(1, sizeof *n);
    if (!n)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the network interface.");
    n->backend = backend;
    n->link.clock = cm1e_clock_monotonic();
    n->link.identity = CM1E_SOEM_IDENTITY;
    n->link.ports = config->second_interface[0] ? 2 : 1;
    snprintf(n->link.interface_name, sizeof n->link.interface_name, "%s", first_interface(config));
    cm1e_error_t error = backend->open(&n->link, config, diag);
    if (error != CM1E_OK) {
        free(n);
        return error;
    }
    if (config->pcap_file[0])
        error = cm1e_nic_pcap(n, config->pcap_file, diag);
    if (error == CM1E_OK && n->pcap) /* its header: a full disk is told before anything moves */
        error = cm1e_pcap_check(n->pcap, config->pcap_file, diag);
    if (error != CM1E_OK) {
        cm1e_nic_close(n);
        return error;
    }
    *nic = n;
    return CM1E_OK;
}

cm1e_error_t cm1e_nic_open(cm1e_nic_t **nic, const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    const char *name = first_interface(config);
    for (size_t i = 0; i < CM1E_NIC_GUESTS && guests[i]; i++)
        if (guests[i]->matches(name))
            return cm1e_nic_open_backend(nic, guests[i], config, diag);
    *nic = NULL;
    if (cm1e_interface_is_simulated(name))
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0,
                             "Interface \"%s\" is a simulated segment, and this program was built without the "
                             "simulator. Link the library cm1e::sim or call cm1e_sim_register(), or name a network "
                             "interface such as \"eth1\".", name);
    return cm1e_nic_open_backend(nic, &cm1e_backend_raw, config, diag);
}

cm1e_error_t cm1e_nic_close(cm1e_nic_t *nic)
{
    if (!nic)
        return CM1E_OK;
    /* The clock may be the backend's and die with it: this thread must not keep on using it. */
    if (cm1e_clock_current() == nic->link.clock)
        cm1e_clock_make_current(NULL);
    nic->backend->close(&nic->link);
    const cm1e_error_t error = cm1e_pcap_close(nic->pcap);
    free(nic);
    return error;
}

cm1e_clock_t *cm1e_nic_clock(cm1e_nic_t *nic) { return nic->link.clock; }

void *cm1e_nic_state_of(const cm1e_nic_t *nic, const cm1e_nic_backend_t *backend)
{
    return nic->backend == backend ? nic->link.state : NULL;
}
