/**
 * @file eni_networks.h
 * Networks for tests of the ENI: made of devices of ours.
 */
#ifndef CM1E_TEST_ENI_NETWORKS_H
#define CM1E_TEST_ENI_NETWORKS_H

#include <stdio.h>

#include "description/describe.h"
#include "generate/eni.h"

typedef enum eni_kind { ENI_CM1E = 0, ENI_IO, ENI_BRIDGE } eni_kind_t;

typedef struct eni_network {
    const char *file;       /* golden file */
    eni_kind_t slaves[8];   /* beyond them: CM1-E */
    size_t count;
    uint16_t alias;         /* of the first */
} eni_network_t;

enum { ENI_ONE, ENI_THREE, ENI_MIXED, ENI_BRIDGED, ENI_NETWORKS };
static const eni_network_t eni_networks[ENI_NETWORKS] = {
    {.file = "eni_one_axis.xml", .slaves = {ENI_CM1E}, .count = 1},
    {.file = "eni_three_axes.xml", .slaves = {ENI_CM1E, ENI_CM1E, ENI_CM1E}, .count = 3},
    {.file = "eni_mixed.xml", .slaves = {ENI_CM1E, ENI_IO, ENI_CM1E}, .count = 3},
    {.file = "eni_bridge.xml", .slaves = {ENI_CM1E, ENI_IO, ENI_BRIDGE}, .count = 3},
};

/* Appends one device. */
cm1e_error_t eni_describe(cm1e_description_file_t *described, eni_kind_t kind, cm1e_diag_t *diag);

/* The document of a network; it lives as long as `described`. */
cm1e_error_t eni_network_make(cm1e_eni_t *document, cm1e_description_file_t *described,
                              const eni_network_t *network, cm1e_diag_t *diag);

#endif
