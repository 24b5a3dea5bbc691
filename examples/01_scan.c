/*
 * Lists the slaves of a network.
 *
 *     01_scan          the simulated segment
 *     01_scan eth1     that network interface (as root, or with cap_net_raw)
 */
#include <stdio.h>

#include <cm1e/bus.h>

static void print_slave(const cm1e_slave_info_t *slave)
{
    printf("%3u  %-16s %-12s vendor 0x%08X  product 0x%08X  revision 0x%08X  alias %u  switches 0x%02X\n",
           slave->position, slave->name, slave->software_version, slave->vendor_id, slave->product_code,
           slave->revision, slave->alias, slave->explicit_id);
}

int main(int argc, char **argv)
{
    cm1e_bus_config_t config;
    cm1e_diag_t why = {0};
    cm1e_bus_t *bus = NULL;

    cm1e_bus_config_init(&config, argc > 1 ? argv[1] : "sim", 3);
    cm1e_error_t error = cm1e_bus_open(&bus, &config, &why);
    cm1e_bus_config_free(&config); /* the bus has a copy */
    if (error == CM1E_OK)
        error = cm1e_bus_scan(bus, &why);
    if (error == CM1E_OK)
        for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++)
            print_slave(cm1e_bus_slave(bus, position));
    else
        fprintf(stderr, "%s\n", why.text);
    cm1e_bus_close(bus);
    return error == CM1E_OK ? 0 : 1;
}
