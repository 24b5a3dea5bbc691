/* SOEM's oshw functions: byte order of the Ethernet header, list of adapters. */
#include "oshw.h"

#include <arpa/inet.h>
#include <net/if.h>
#include <stdio.h>
#include <stdlib.h>

uint16 oshw_htons(uint16 hostshort) { return htons(hostshort); }

uint16 oshw_ntohs(uint16 networkshort) { return ntohs(networkshort); }

ec_adaptert *oshw_find_adapters(void)
{
    ec_adaptert *first = NULL, **end = &first;
    struct if_nameindex *all = if_nameindex();
    for (struct if_nameindex *i = all; i && i->if_index != 0; i++) {
        ec_adaptert *adapter = calloc(1, sizeof *adapter);
        if (!adapter)
            break;
        snprintf(adapter->name, sizeof adapter->name, "%s", i->if_name);
        snprintf(adapter->desc, sizeof adapter->desc, "%s", i->if_name);
        *end = adapter;
        end = &adapter->next;
    }
    if (all)
        if_freenameindex(all);
    return first;
}

void oshw_free_adapters(ec_adaptert *adapter)
{
    while (adapter) {
        ec_adaptert *next = adapter->next;
        free(adapter);
        adapter = next;
    }
}
