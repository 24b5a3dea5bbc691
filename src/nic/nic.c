#include "nic/nic.h"

#include <stdio.h>
#include <stdlib.h>

#include "nic/nic_private.h"

/** The first that matches the interface name wins; the raw socket takes every name. */
static const cm1e_nic_backend_t *const backends[] = {&cm1e_backend_sim, &cm1e_backend_raw};

static const char *first_interface(const cm1e_bus_config_t *config)
{
    return config->interface_name[0] ? config->interface_name : "sim";
}

cm1e_error_t cm1e_nic_open_backend(cm1e_nic_t **nic, const cm1e_nic_backend_t *backend, const cm1e_bus_config_t *config,
                                   cm1e_diag_t *diag)
{
    *nic = NULL;
    cm1e_nic_t *n = calloc(1, sizeof *n);
    if (!n)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the network interface.");
    n->backend = backend;
    n->clock = cm1e_clock_monotonic();
    n->ports = config->second_interface[0] ? 2 : 1;
    snprintf(n->interface_name, sizeof n->interface_name, "%s", first_interface(config));
    cm1e_error_t error = backend->open(n, config, diag);
    if (error) {
        free(n);
        return error;
    }
    if (config->pcap_file[0])
        error = cm1e_nic_pcap(n, config->pcap_file, diag);
    if (!error && n->pcap) /* its header: a full disk is told before anything moves */
        error = cm1e_pcap_check(n->pcap, config->pcap_file, diag);
    if (error) {
        cm1e_nic_close(n);
        return error;
    }
    *nic = n;
    return CM1E_OK;
}

cm1e_error_t cm1e_nic_open(cm1e_nic_t **nic, const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    const char *name = first_interface(config);
    for (size_t i = 0; i < sizeof backends / sizeof backends[0]; i++)
        if (backends[i]->matches(name))
            return cm1e_nic_open_backend(nic, backends[i], config, diag);
    *nic = NULL;
    return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "No way to open interface \"%s\".", name);
}

cm1e_error_t cm1e_nic_close(cm1e_nic_t *nic)
{
    if (!nic)
        return CM1E_OK;
    nic->backend->close(nic);
    const cm1e_error_t error = cm1e_pcap_close(nic->pcap);
    /* The virtual clock dies with the nic: nobody may keep on using it. */
    if (cm1e_clock_current() == &nic->virtual_clock)
        cm1e_clock_make_current(NULL);
    free(nic);
    return error;
}

cm1e_clock_t *cm1e_nic_clock(cm1e_nic_t *nic) { return nic->clock; }

cm1e_sim_segment_t *cm1e_nic_segment(cm1e_nic_t *nic) { return nic->segment; }

void cm1e_nic_replace_segment(cm1e_nic_t *nic, cm1e_sim_segment_t *segment)
{
    cm1e_sim_segment_destroy(nic->segment);
    nic->segment = segment;
}
