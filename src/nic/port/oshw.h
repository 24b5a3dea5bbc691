/**
 * @file oshw.h
 * SOEM's header of the hardware layer, replaced: byte order of the Ethernet header and the list of adapters.
 */
#ifndef _oshw_
#define _oshw_

#include "ethercattype.h"
#include "nicdrv.h"
#include "ethercatmain.h"

#ifdef __cplusplus
extern "C" {
#endif

uint16 oshw_htons(uint16 hostshort);
uint16 oshw_ntohs(uint16 networkshort);
ec_adaptert *oshw_find_adapters(void);
void oshw_free_adapters(ec_adaptert *adapter);

#ifdef __cplusplus
}
#endif
#endif
