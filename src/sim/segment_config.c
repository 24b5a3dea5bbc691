#include <string.h>

#include <strings.h>

#include "device/devices.h"
#include "device/place.h"
#include "sim/io_device.h"
#include "sim/segment.h"
#include "sim/slave.h"

enum { EXPLICIT_ID_MAX = 254 };

/* One place: a CM1-E, which is one axis, or a bridge with up to four; or a slave without an axis. Empty: a gap. */
typedef struct place {
    const cm1e_slave_config_t *slave;
    const cm1e_axis_config_t *axis;                        /* the first of the list */
    const cm1e_axis_config_t *channels[CM1E_BRIDGE_AXES];  /* behind a bridge */
} place_t;

static bool is_free(const place_t *place) { return !place->axis && !place->slave; }

/* Returns false if the place is taken, or if there is no such connector. */
static bool take_place(place_t *place, const cm1e_axis_config_t *axis)
{
    const bool shares = cm1e_device_is_shared(axis);
    if (place->axis && !(shares && cm1e_device_is_shared(place->axis)))
        return false;
    if (shares && (axis->channel == 0 || axis->channel > cm1e_device_configured(axis)->channels))
        return false;
    if (!place->axis)
        place->axis = axis;
    if (!shares)
        return true;
    const bool unused = !place->channels[axis->channel - 1];
    place->channels[axis->channel - 1] = axis;
    return unused;
}

/* The place of the bridge of which the list has named another axis before; NULL: none. */
static place_t *place_of_bridge(place_t *places, const cm1e_axis_config_t *axis)
{
    for (uint32_t i = 0; cm1e_device_is_shared(axis) && i < CM1E_MAX_SLAVES; i++) {
        const cm1e_axis_config_t *other = places[i].axis;
        if (other && cm1e_device_is_shared(other) && other->address_kind == axis->address_kind &&
            other->address == axis->address)
            return &places[i];
    }
    return NULL;
}

/* Axes and slaves with a position take that place; other axes, then other slaves fill the remaining places, in the
 * order of their lists. */
static bool place_axes(const cm1e_bus_config_t *config, place_t *places, cm1e_diag_t *diag)
{
    for (uint32_t i = 0; i < config->axis_count; i++) {
        const cm1e_axis_config_t *axis = &config->axes[i];
        if (!cm1e_axis_has_motor(axis) || axis->address_kind != CM1E_ADDRESS_POSITION)
            continue;
        const uint32_t position = cm1e_axis_address(config, i);
        if (position > CM1E_MAX_SLAVES || !take_place(&places[position - 1], axis)) {
            cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                          "the simulated segment has no place for axis %u at position %u: it is %s", i + 1, position,
                          position > CM1E_MAX_SLAVES ? "too far away" : "taken by another axis");
            return false;
        }
    }
    return true;
}

static bool place_other_axes(const cm1e_bus_config_t *config, place_t *places, cm1e_diag_t *diag)
{
    uint32_t free_place = 0;
    for (uint32_t i = 0; i < config->axis_count; i++) {
        if (!cm1e_axis_has_motor(&config->axes[i]) || config->axes[i].address_kind == CM1E_ADDRESS_POSITION)
            continue;
        while (free_place < CM1E_MAX_SLAVES && !is_free(&places[free_place]))
            free_place++;
        place_t *bridge = place_of_bridge(places, &config->axes[i]);
        if (!bridge && free_place == CM1E_MAX_SLAVES) {
            cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "the simulated segment has no place for axis %u: %d are taken",
                          i + 1, CM1E_MAX_SLAVES);
            return false;
        }
        if (!take_place(bridge ? bridge : &places[free_place], &config->axes[i])) {
            cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "the simulated segment has no place for axis %u at channel %u: "
                          "it is taken by another axis", i + 1, config->axes[i].channel);
            return false;
        }
    }
    return true;
}

static bool place_slave(const cm1e_slave_config_t *slave, place_t *place, cm1e_diag_t *diag)
{
    if (place && is_free(place)) {
        place->slave = slave;
        return true;
    }
    cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "the simulated segment has no place for slave %s at %u: it is %s",
                  slave->name, slave->address, place ? "taken by another" : "too far away");
    return false;
}

static bool place_slaves(const cm1e_bus_config_t *config, place_t *places, bool by_position, cm1e_diag_t *diag)
{
    uint32_t next = 0;
    for (uint32_t i = 0; i < config->slave_count; i++) {
        const cm1e_slave_config_t *slave = &config->slaves[i];
        const bool has_position = slave->address_kind == CM1E_ADDRESS_POSITION && !cm1e_slave_is_member(slave);
        if (has_position != by_position)
            continue;
        while (!by_position && next < CM1E_MAX_SLAVES && !is_free(&places[next]))
            next++;
        const uint32_t place = by_position ? slave->address - 1u : next;
        if (!place_slave(slave, place < CM1E_MAX_SLAVES ? &places[place] : NULL, diag))
            return false;
    }
    return true;
}

static void wire_device(cm1e_sim_slave_t *inputs, cm1e_sim_slave_t *outputs)
{
    cm1e_sim_io_device_t *device = cm1e_sim_io_device_of(inputs);
    if (device)
        device->source = cm1e_sim_io_device_of(outputs);
}

/* A wire goes from an input to the output of its number. */
static void wire_inputs(cm1e_sim_segment_t *segment, const place_t *places, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const char *source = places[i].slave ? places[i].slave->sim.wired_to : "";
        for (uint32_t k = 0; k < count && source[0]; k++)
            if (places[k].slave && strcasecmp(places[k].slave->name, source) == 0)
                wire_device(cm1e_sim_segment_slave(segment, i + 1), cm1e_sim_segment_slave(segment, k + 1));
    }
}

/* An axis at position 3 means that two slaves are before it: places of nobody get the device of `sim_gaps`. */
static uint32_t last_place(const place_t *places)
{
    uint32_t count = CM1E_MAX_SLAVES;
    while (count && is_free(&places[count - 1]))
        count--;
    return count;
}

static cm1e_error_t check_cm1e(const cm1e_axis_config_t *axis, cm1e_diag_t *diag)
{
    if (axis->address_kind == CM1E_ADDRESS_EXPLICIT_ID && axis->address > EXPLICIT_ID_MAX)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "explicit ID %u: the rotary switches give 1 to %d",
                             axis->address, EXPLICIT_ID_MAX);
    if (!cm1e_device_motor(axis->motor))
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "motor '%s' is not known", axis->motor);
    if (axis->firmware[0] && !cm1e_firmware_from_version(axis->firmware))
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "firmware '%s' is not a version", axis->firmware);
    return CM1E_OK;
}

static const cm1e_device_t *find_model(const place_t *place, cm1e_diag_t *diag)
{
    const char *motors[CM1E_BRIDGE_AXES];
    for (int i = 0; i < CM1E_BRIDGE_AXES; i++)
        motors[i] = place->channels[i] ? place->channels[i]->motor : "";
    const cm1e_device_t *device = cm1e_device_configured(place->axis)->with_motors(motors);
    if (!device)
        cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "no bridge has the motors '%s', '%s', '%s' and '%s'", motors[0],
                      motors[1], motors[2], motors[3]);
    return device;
}

/* The slave at a place, made from its axes. */
typedef struct made {
    const cm1e_bus_config_t *config;
    const place_t *place;
    uint16_t alias, id;
    cm1e_diag_t *diag;
    cm1e_error_t error; /* why there is no slave; CM1E_OK: no memory */
} made_t;

static cm1e_sim_slave_t *make_cm1e(made_t *made)
{
    made->error = check_cm1e(made->place->axis, made->diag);
    if (made->error != CM1E_OK)
        return NULL;
    return cm1e_sim_cm1e_create(made->place->axis, made->config->sim_pdo_order, made->alias, (uint8_t)made->id);
}

static cm1e_sim_slave_t *make_bridge(made_t *made)
{
    const cm1e_device_t *device = find_model(made->place, made->diag);
    made->error = device ? CM1E_OK : CM1E_ERROR_CONFIG;
    return device ? cm1e_sim_bridge_create(device->model, made->place->channels, made->alias) : NULL;
}

static cm1e_sim_slave_t *make_cia402(made_t *made) { return cm1e_sim_cia402_create(made->place->axis, made->alias); }

/* By the kind of the device. */
static const struct {
    const char *device;
    cm1e_sim_slave_t *(*make)(made_t *made);
} makers[] = {{"cm1-e", make_cm1e}, {"bridge", make_bridge}, {"cia402", make_cia402}};

static cm1e_sim_slave_t *make(made_t *made)
{
    const cm1e_slave_config_t *slave = made->place->slave;
    if (slave && slave->sim.kind != CM1E_SIM_SLAVE_GAP)
        return cm1e_sim_io_device_create(slave);
    if (!made->place->axis)
        return cm1e_sim_io_create_as(made->config->sim_gaps, slave);
    const cm1e_device_t *device = cm1e_device_configured(made->place->axis);
    for (size_t i = 0; device && i < sizeof makers / sizeof makers[0]; i++)
        if (strcmp(makers[i].device, device->kind) == 0)
            return makers[i].make(made);
    made->error = cm1e_diag_set(made->diag, CM1E_ERROR_CONFIG, 0, "device '%s' is not known",
                                made->place->axis->device);
    return NULL;
}

static cm1e_error_t add_made(cm1e_sim_segment_t *segment, cm1e_sim_slave_t *slave)
{
    const cm1e_error_t error = segment ? cm1e_sim_segment_add(segment, slave) : CM1E_ERROR_INVALID_ARGUMENT;
    if (error != CM1E_OK)
        cm1e_sim_slave_destroy(slave);
    return error;
}

static cm1e_error_t add_place(cm1e_sim_segment_t *segment, const cm1e_bus_config_t *config, const place_t *place,
                              cm1e_diag_t *diag)
{
    const cm1e_axis_config_t *axis = place->axis;
    made_t made = {.config = config, .place = place, .diag = diag,
                   .alias = axis && axis->address_kind == CM1E_ADDRESS_ALIAS ? axis->address : 0,
                   .id = axis && axis->address_kind == CM1E_ADDRESS_EXPLICIT_ID ? axis->address : 0};
    cm1e_sim_slave_t *slave = make(&made);
    if (made.error != CM1E_OK)
        return made.error;
    const cm1e_error_t error = add_made(segment, slave);
    if (error != CM1E_OK)
        return cm1e_diag_set(diag, error, 0, "the simulated slave %u cannot be made: out of memory",
                             cm1e_sim_segment_slave_count(segment) + 1);
    if ((axis && axis->sim_absent) || (place->slave && place->slave->sim_absent))
        cm1e_sim_segment_detach(segment, cm1e_sim_segment_slave_count(segment), false);
    return CM1E_OK;
}

cm1e_sim_segment_t *cm1e_sim_segment_create(const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    place_t places[CM1E_MAX_SLAVES] = {{0}};
    if (!config) {
        cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A configuration is missing.");
        return NULL;
    }
    if (config->axis_count > CM1E_MAX_AXES) {
        cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%u axes: a bus has %d at most", config->axis_count, CM1E_MAX_AXES);
        return NULL;
    }
    if (!place_axes(config, places, diag) || !place_slaves(config, places, true, diag) ||
        !place_other_axes(config, places, diag) || !place_slaves(config, places, false, diag))
        return NULL;
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create_empty();
    if (!segment) {
        cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "no memory for the simulated segment");
        return NULL;
    }
    uint32_t count = last_place(places);
    if (count == 0 && config->axis_count > 0) /* virtual axes only: frames need a slave to pass */
        count = 1;
    for (uint32_t i = 0; i < count; i++)
        if (add_place(segment, config, &places[i], diag) != CM1E_OK) {
            cm1e_sim_segment_destroy(segment);
            return NULL;
        }
    wire_inputs(segment, places, count);
    return segment;
}

cm1e_error_t cm1e_sim_segment_add_bridge(cm1e_sim_segment_t *segment, cm1e_device_model_t model)
{
    return add_made(segment, cm1e_sim_bridge_create(model, NULL, 0));
}

cm1e_error_t cm1e_sim_segment_add_io(cm1e_sim_segment_t *segment, cm1e_sim_io_t kind)
{
    return add_made(segment, cm1e_sim_io_create(kind));
}
