#include "eni_networks.h"

cm1e_error_t eni_describe(cm1e_description_file_t *described, eni_kind_t kind, cm1e_diag_t *diag)
{
    static const cm1e_device_options_t motor = {0};
    static const cm1e_device_options_t bridge = {.model = CM1E_DEVICE_EB01, .vendor_id = 0xAA77, .product_code = 1,
                                                 .revision = 1};
    if (kind == ENI_IO) {
        cm1e_describe_io_module(described);
        return CM1E_OK;
    }
    return cm1e_describe(described, kind == ENI_BRIDGE ? &bridge : &motor, CM1E_ESI_FLAT, diag);
}

cm1e_error_t eni_network_make(cm1e_eni_t *document, cm1e_description_file_t *described,
                              const eni_network_t *network, cm1e_diag_t *diag)
{
    static const char *const letters[] = {"X", "Y", "Z"};
    cm1e_eni_slave_t slaves[CM1E_MAX_SLAVES];
    cm1e_error_t error = CM1E_OK;
    for (size_t i = 0; i < network->count && error == CM1E_OK; i++)
        error = eni_describe(described, i < 8 ? network->slaves[i] : ENI_CM1E, diag);
    for (size_t i = 0; i < network->count && error == CM1E_OK; i++)
        slaves[i] = (cm1e_eni_slave_t){
            .device = &described->devices.at[i], .alias = i == 0 ? network->alias : 0,
            .name = i < 3 ? letters[i] : cm1e_arena_format(&described->arena, "axis %zu", i + 1)};
    return error == CM1E_OK ? cm1e_eni_make(document, slaves, network->count, 1000000, diag) : error;
}
