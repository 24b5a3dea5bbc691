#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/generate.h"
#include "config/clock_pulses.h"
#include "config/copy.h"
#include "config/interface.h"
#include "description/describe.h"
#include "description/expand.h"
#include "description/sii_image.h"
#include "device/devices.h"
#include "device/place.h"
#include "generate/ec_extend.h"
#include "generate/eni.h"
#include "generate/eni_slave.h"
#include "generate/esi.h"
#include "generate/file.h"
#include "generate/generate_options.h"

static const cm1e_device_options_t one_cm1e = {0};

void cm1e_file_free(cm1e_file_t *file)
{
    if (!file)
        return;
    free(file->bytes);
    *file = (cm1e_file_t){0};
}

void cm1e_file_warn_of_eeprom(cm1e_file_t *file, const cm1e_description_t *device)
{
    if (!device->eeprom.config_known)
        snprintf(file->warning, sizeof file->warning,
                 "the configuration words of the %s's EEPROM are not public: do not write an EEPROM from this "
                 "file. With the words of a real device (cm1e sii read, then --config-data) it can be",
                 device->type);
}

static cm1e_error_t write_sii(cm1e_file_t *file, const cm1e_description_t *device, cm1e_diag_t *diag)
{
    const size_t stated = device->eeprom.byte_size > 0 ? device->eeprom.byte_size : CM1E_SII_SIZE;
    const size_t room = stated < CM1E_SII_SIZE_MAX ? stated : CM1E_SII_SIZE_MAX;
    uint8_t *image = calloc(1, room + 1); /* with the 0 that stands behind every cm1e_file_t */
    cm1e_diag_t reason = {0};
    if (!image)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    const size_t size = cm1e_sii_write(image, room, device, &reason);
    if (size == 0) {
        free(image);
        return cm1e_diag_set(diag, reason.error, 0, "%s", reason.text);
    }
    file->bytes = image;
    file->size = size;
    return CM1E_OK;
}

cm1e_error_t cm1e_file_of_sii(cm1e_file_t *file, const cm1e_description_file_t *described, size_t device,
                              cm1e_diag_t *diag)
{
    const cm1e_description_t *as_described = &described->devices.at[device];
    if (as_described->slots.count == 0)
        return write_sii(file, as_described, diag);
    cm1e_arena_t arena = {0};
    cm1e_description_t expanded;
    uint32_t idents[CM1E_PLACES_MAX];
    const size_t places = cm1e_description_places(as_described);
    cm1e_description_default_modules(as_described, idents, places);
    cm1e_description_expand(&arena, &expanded, described, as_described, idents, places);
    const cm1e_error_t error = arena.failed ? cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory")
                                            : write_sii(file, &expanded, diag);
    cm1e_arena_free(&arena);
    return error;
}

static cm1e_error_t describe_all(cm1e_description_file_t *described, const cm1e_generate_options_t *options,
                                 cm1e_diag_t *diag)
{
    const cm1e_device_options_t *devices = options->devices ? options->devices : &one_cm1e;
    const size_t count = options->devices ? options->device_count : 1;
    cm1e_error_t error = CM1E_OK;
    const bool is_esi = options->format == CM1E_FILE_ESI;
    for (size_t i = 0; i < count && error == CM1E_OK; i++) {
        cm1e_device_options_t device = devices[i];
        if (is_esi) /* the file describes all devices of a kind, so the alias of one device is not used */
            memset(device.config_data + CM1E_SII_ALIAS, 0, 2);
        error = cm1e_describe(described, &device, is_esi ? options->layout : CM1E_ESI_FLAT, diag);
    }
    return error;
}

/* Masters find a description by vendor, product and revision (ETG.2000). */
static cm1e_error_t check_identities(const cm1e_description_file_t *described, cm1e_diag_t *diag)
{
    const cm1e_description_t *devices = described->devices.at;
    for (size_t i = 0; i < described->devices.count; i++)
        for (size_t j = 0; j < i; j++)
            if (devices[i].product_code == devices[j].product_code && devices[i].revision == devices[j].revision)
                return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                                     "devices %zu and %zu have the same product 0x%08X and revision 0x%08X: it is "
                                     "undefined which of them a master uses. One device has all mappings to choose "
                                     "from; make a separate file for another default", j + 1, i + 1,
                                     (unsigned)devices[i].product_code, (unsigned)devices[i].revision);
    return CM1E_OK;
}

static cm1e_error_t generate_described(cm1e_file_t *file, const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    cm1e_description_file_t described = {0};
    cm1e_error_t error = describe_all(&described, options, diag);
    if (error == CM1E_OK)
        error = check_identities(&described, diag);
    if (error == CM1E_OK)
        error = options->format == CM1E_FILE_ESI ? cm1e_esi_write(file, &described, diag)
                                                 : cm1e_file_of_sii(file, &described, 0, diag);
    for (size_t i = 0; error == CM1E_OK && i < described.devices.count; i++)
        cm1e_file_warn_of_eeprom(file, &described.devices.at[i]);
    cm1e_description_file_free(&described);
    return error;
}

static cm1e_error_t generate_ec_extend(cm1e_file_t *file, const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    cm1e_ec_extend_t document = {0};
    cm1e_error_t error = cm1e_ec_extend_make(&document, options, diag);
    if (error == CM1E_OK)
        error = cm1e_ec_extend_write(file, &document, diag);
    cm1e_ec_extend_free(&document);
    return error;
}

/* ---- ENI of a configuration ------------------------------------------------------------------------------------- */

/* A slave of the network: an axis, a bridge with up to four axes, or a slave without an axis. */
typedef struct node {
    const cm1e_axis_config_t *axis;       /* its first axis; NULL: no axis is known there */
    const cm1e_slave_config_t *slave;     /* NULL: it has an axis, or nothing is known there */
    const char *motors[CM1E_BRIDGE_AXES]; /* as configured, "": any */
    char name[CM1E_SLAVE_NAME];
} node_t;

/* Another axis of the same bridge; the check of the configuration ensures that the channels differ. */
static bool is_behind(const node_t *node, const cm1e_axis_config_t *axis)
{
    return node->axis && cm1e_device_is_shared(axis) && axis->address &&
           node->axis->address_kind == axis->address_kind && node->axis->address == axis->address;
}

static uint32_t places_of(const cm1e_bus_config_t *network) { return network->axis_count + network->slave_count; }

/* Place on the wire (0 = first) of the slave of an axis, if `count` slaves are known before it. If the configuration
 * does not state it, the result is an invalid place. */
static uint32_t place_of(const cm1e_bus_config_t *network, uint32_t axis, const node_t *nodes, uint32_t count)
{
    const cm1e_axis_config_t *config = &network->axes[axis];
    for (uint32_t place = 0; place < places_of(network); place++)
        if (is_behind(&nodes[place], config))
            return place;
    switch (config->address_kind) {
    case CM1E_ADDRESS_POSITION: return cm1e_axis_address(network, axis) - 1u;
    case CM1E_ADDRESS_ALIAS: return count;
    default: return UINT32_MAX;
    }
}

static cm1e_error_t place_unknown(const cm1e_bus_config_t *network, const cm1e_axis_config_t *axis, cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                         "axis %td (%s): its place on the wire does not follow from the configuration, or a device "
                         "is before it that the file does not list; make the ENI from a scan of the network",
                         axis - network->axes + 1, axis->name);
}

static bool is_known(const node_t *node) { return node->axis || node->slave; }

static cm1e_error_t slave_unknown(const cm1e_slave_config_t *slave, cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "slave %s: its place on the wire does not follow from the "
                         "configuration, is that of another one, or a device is before it that the file does not "
                         "list; make the ENI from a scan of the network", slave->name);
}

static cm1e_error_t find_slaves(node_t *nodes, uint32_t *count, const cm1e_bus_config_t *network, cm1e_diag_t *diag)
{
    for (uint32_t i = 0; i < network->slave_count; i++) {
        const cm1e_slave_config_t *slave = &network->slaves[i];
        const uint32_t place = slave->address - 1u;
        if (slave->address_kind != CM1E_ADDRESS_POSITION || place >= places_of(network) || is_known(&nodes[place]))
            return slave_unknown(slave, diag);
        nodes[place].slave = slave;
        snprintf(nodes[place].name, sizeof nodes[place].name, "%s", slave->name);
        ++*count;
    }
    return CM1E_OK;
}

/* The slaves in the order of the wire, in room for as many as there are axes and other slaves. */
static cm1e_error_t find_nodes(node_t *nodes, uint32_t *count, const cm1e_bus_config_t *network, cm1e_diag_t *diag)
{
    const cm1e_error_t error = find_slaves(nodes, count, network, diag);
    for (uint32_t axis = 0; axis < network->axis_count && error == CM1E_OK; axis++) {
        const cm1e_axis_config_t *config = &network->axes[axis];
        if (!cm1e_axis_has_motor(config))
            continue;
        const uint32_t place = place_of(network, axis, nodes, *count);
        node_t *node = place < places_of(network) ? &nodes[place] : NULL;
        if (!node || node->slave || (node->axis && !is_behind(node, config)))
            return place_unknown(network, config, diag);
        *count += !node->axis;
        node->axis = node->axis ? node->axis : config;
        cm1e_slave_name_add(node->name, config);
        if (cm1e_device_is_shared(config))
            node->motors[config->channel - 1] = config->motor;
    }
    for (uint32_t place = *count; place < places_of(network) && error == CM1E_OK; place++)
        if (is_known(&nodes[place]))
            return nodes[place].axis ? place_unknown(network, nodes[place].axis, diag)
                                     : slave_unknown(nodes[place].slave, diag);
    return error;
}

/* An axis behind a connector for which the device has no process data would be a name and nothing else. */
static cm1e_error_t check_axes(const node_t *node, const cm1e_device_options_t *device, cm1e_diag_t *diag)
{
    const unsigned axes = device->axes ? device->axes : CM1E_BRIDGE_AXES;
    for (unsigned channel = CM1E_BRIDGE_AXES; channel > axes; channel--)
        if (node->motors[channel - 1])
            return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                                 "%s: one of its axes has channel %u, but the given %s has %u axes; expected at least "
                                 "%u, or no number (4)", node->name, channel, cm1e_device_of_model(device->model)->name,
                                 axes, channel);
    return CM1E_OK;
}

/* The guide of the bridge states no identity, so the user must state it. */
static cm1e_error_t describe_bridge(cm1e_description_file_t *described, const node_t *node,
                                    const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    const cm1e_device_t *expected = cm1e_device_configured(node->axis);
    const cm1e_device_options_t *found = NULL;
    for (size_t i = 0; options->devices && i < options->device_count; i++) {
        const cm1e_device_options_t *device = &options->devices[i];
        const cm1e_device_t *model = cm1e_device_of_model(device->model);
        if (!cm1e_device_same_kind(model, expected) || !cm1e_device_has_motors(model, node->motors))
            continue;
        if (found)
            return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                                 "%s: an %s and an %s can both be the bridge there; state the motor of each of "
                                 "its axes", node->name, cm1e_device_of_model(found->model)->name,
                                 model->name);
        found = device;
    }
    if (!found)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "%s: it is behind a bridge, whose guide states no identity, and no given device has these "
                             "motors: state model (eb01, eb02, eb12), vendor, product code and revision, as `cm1e "
                             "scan` shows them; or make the ENI from a scan of the network", node->name);
    const cm1e_error_t error = check_axes(node, found, diag);
    return error == CM1E_OK ? cm1e_describe(described, found, CM1E_ESI_FLAT, diag) : error;
}

static cm1e_error_t describe_slave(cm1e_description_file_t *described, const cm1e_slave_config_t *slave,
                                   const cm1e_bus_config_t *network, cm1e_diag_t *diag)
{
    const bool simulated = cm1e_interface_is_simulated(network->interface_name);
    const cm1e_error_t error = cm1e_eni_describe_slave(described, slave, simulated, diag);
    if (error != CM1E_OK || described->arena.failed)
        return error;
    return cm1e_eni_configure_slave(described, slave, diag);
}

static cm1e_error_t describe_node(cm1e_description_file_t *described, const node_t *node,
                                  const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    const cm1e_axis_config_t *config = node->axis;
    if (node->slave)
        return describe_slave(described, node->slave, options->network, diag);
    const cm1e_device_t *expected = cm1e_device_configured(config);
    if (expected->channels)
        return describe_bridge(described, node, options, diag);
    if (!expected->described)
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0,
                             "%s: of a %s no description is made from tables; make the ENI from a scan of the network",
                             node->name, expected->label);
    cm1e_device_options_t device = {.mapping = config->mapping, .order = options->network->sim_pdo_order};
    snprintf(device.firmware, sizeof device.firmware, "%s", config->firmware);
    return cm1e_describe(described, &device, CM1E_ESI_FLAT, diag);
}

cm1e_error_t cm1e_file_of_eni(cm1e_file_t *file, const cm1e_eni_slave_t *slaves, size_t count, int64_t cycle_time_ns,
                              cm1e_diag_t *diag)
{
    cm1e_eni_t document = {0};
    cm1e_error_t error = cm1e_eni_make(&document, slaves, count, cycle_time_ns, diag);
    if (error == CM1E_OK)
        error = cm1e_eni_write(file, &document, diag);
    cm1e_eni_free(&document);
    return error;
}

static cm1e_error_t describe_nodes(cm1e_eni_slave_t *slaves, cm1e_description_file_t *described, const node_t *nodes,
                                   uint32_t count, const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    for (uint32_t i = 0; i < count && error == CM1E_OK; i++)
        error = describe_node(described, &nodes[i], options, diag);
    for (uint32_t i = 0; i < count && error == CM1E_OK; i++) { /* set at the end, because the list of devices moves
                                                                * while it grows */
        const cm1e_axis_config_t *config = nodes[i].axis;
        slaves[i] = (cm1e_eni_slave_t){.device = &described->devices.at[i], .name = nodes[i].name};
        if (config && config->address_kind == CM1E_ADDRESS_ALIAS)
            slaves[i].alias = config->address;
    }
    return error;
}

/* A file is a script for one network, and what is there is known from the bus file alone. */
static void warn_of_bus_file(cm1e_file_t *file, const cm1e_bus_config_t *network)
{
    const cm1e_axis_config_t *optional = NULL;
    for (uint32_t i = 0; i < network->axis_count && !optional; i++)
        if (network->axes[i].optional && cm1e_axis_has_motor(&network->axes[i]))
            optional = &network->axes[i];
    const bool clocks = cm1e_config_uses_clocks(network);
    if (optional)
        snprintf(file->warning, sizeof file->warning,
                 "%s may be absent by the bus file, but a master that runs this file needs all of its slaves. ",
                 optional->name);
    const size_t used = strlen(file->warning);
    if (clocks)
        snprintf(file->warning + used, sizeof file->warning - used,
                 "The distributed clocks that the bus file asks for are not in this file, because only a scan shows "
                 "who has one. ");
    if (optional || clocks)
        snprintf(file->warning + strlen(file->warning), sizeof file->warning - strlen(file->warning),
                 "Make the ENI from a scan of the network");
}

static cm1e_error_t eni_of_network(cm1e_file_t *file, const cm1e_bus_config_t *network,
                                   const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    cm1e_error_t error = cm1e_bus_config_check(network, diag);
    cm1e_eni_slave_t *slaves = calloc(places_of(network), sizeof *slaves);
    node_t *nodes = calloc(places_of(network), sizeof *nodes);
    cm1e_description_file_t described = {0};
    uint32_t count = 0;
    if (!slaves || !nodes)
        error = cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    if (error == CM1E_OK)
        error = find_nodes(nodes, &count, network, diag);
    if (error == CM1E_OK)
        error = describe_nodes(slaves, &described, nodes, count, options, diag);
    if (error == CM1E_OK)
        error = cm1e_file_of_eni(file, slaves, count, network->cycle_time_ns > 0 ? network->cycle_time_ns : 1000000,
                                 diag);
    if (error == CM1E_OK)
        warn_of_bus_file(file, network);
    cm1e_description_file_free(&described);
    free(slaves);
    free(nodes);
    return error;
}

static cm1e_error_t generate_eni(cm1e_file_t *file, const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    cm1e_bus_config_t network = {0};
    cm1e_error_t error = options->network ? cm1e_config_copy(&network, options->network) : CM1E_OK;
    if (error == CM1E_ERROR_NO_MEMORY)
        return cm1e_diag_set(diag, error, 0, "out of memory");
    if (error != CM1E_OK)
        return cm1e_bus_config_check(options->network, diag);
    if (cm1e_motors_before(&network, network.axis_count) + network.slave_count == 0)
        error = cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                              "an ENI describes a network, but no axis with a motor and no slave is configured");
    else
        error = eni_of_network(file, &network, options, diag);
    cm1e_bus_config_free(&network);
    return error;
}

static cm1e_error_t check_described(const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    for (size_t i = 0; options->devices && i < options->device_count; i++) {
        const cm1e_device_t *device = cm1e_device_of_model(options->devices[i].model);
        if (device && !device->described)
            return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "a %s is described by its maker: no file of it is made "
                                 "from the tables", device->label);
    }
    return CM1E_OK;
}

static cm1e_error_t generate(cm1e_file_t *file, const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    if (options->devices && options->device_count == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "no device is given");
    const cm1e_error_t error = check_described(options, diag);
    if (error != CM1E_OK)
        return error;
    if (options->format == CM1E_FILE_ESI && options->layout != CM1E_ESI_FLAT && options->layout != CM1E_ESI_MDP)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "there is no such layout; there are flat and modular");
    for (size_t i = 0; options->devices && i < options->device_count && options->format != CM1E_FILE_SII; i++)
        if (options->devices[i].alias != 0 || options->devices[i].serial_number != 0)
            return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                                 "alias and serial number belong to one device and its SII; %s describes all devices "
                                 "of a kind",
                                 cm1e_file_format_name(options->format));
    switch (options->format) {
    case CM1E_FILE_SII:
        if (options->devices && options->device_count > 1)
            return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "an SII image describes one device, not %zu",
                                 options->device_count);
        return generate_described(file, options, diag);
    case CM1E_FILE_ESI: return generate_described(file, options, diag);
    case CM1E_FILE_EC_EXTEND: return generate_ec_extend(file, options, diag);
    case CM1E_FILE_ENI: return generate_eni(file, options, diag);
    default: return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "there is no such file format");
    }
}

cm1e_error_t cm1e_generate_sized(cm1e_file_t *file, const cm1e_generate_options_t *options, size_t size,
                                 size_t device_size, cm1e_diag_t *diag)
{
    return cm1e_generate_with(generate, file, options, size, device_size, diag);
}
