/* The slaves that the configuration names beside the axes: what is written into them at the start, and which process
 * data they have then. */
#include <inttypes.h>
#include <string.h>

#include "bus/bus_internal.h"

/** Some hundred transfers, of all slaves at once; in practice some milliseconds. */
#define SETUP_TIMEOUT_NS INT64_C(60000000000)

static cm1e_error_t diagnose_setup(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    const cm1e_setup_job_t *job = &slave->setup;
    char label[CM1E_LABEL_LENGTH];
    if (job->excluded)
        return cm1e_diag_set(diag, job->error, 0, "The PDOs 0x%04X and 0x%04X of %s exclude each other (object "
                             "0x%04X:%02X), and the configuration assigns both: leave one of them out of %s.",
                             job->pdo, job->excluded, cm1e_bus_label(bus, slave, label), job->sdo.index,
                             job->sdo.subindex, job->pdo < 0x1A00 ? "outputs_pdos" : "inputs_pdos");
    if (job->differs && job->sdo.index == DETECTED_MODULES && job->sdo.subindex == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_IDENTITY, 0, "%s has %" PRIu64 " modules (0xF050:00), and the "
                             "configuration names %" PRIu64 ".", cm1e_bus_label_first(bus, slave, label), job->shown,
                             job->expected);
    if (job->differs && job->sdo.index == DETECTED_MODULES)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_IDENTITY, 0, "%s has the module 0x%08" PRIX64 " in slot %u "
                             "(0xF050:%02X), and the configuration names 0x%08" PRIX64 " there.",
                             cm1e_bus_label_first(bus, slave, label), job->shown, job->sdo.subindex, job->sdo.subindex,
                             job->expected);
    if (!job->differs)
        return cm1e_bus_diagnose_sdo(bus, slave, &job->sdo, "Start-up as the configuration states it", diag);
    return cm1e_diag_set(diag, job->error, 0, "%s did not keep what the configuration writes: object 0x%04X:%02X is "
                         "0x%" PRIX64 " after 0x%" PRIX64 " was written.", cm1e_bus_label_first(bus, slave, label),
                         job->sdo.index, job->sdo.subindex, job->shown, job->expected);
}

cm1e_error_t cm1e_bus_set_up_slaves(cm1e_bus_t *bus, bool before_op, cm1e_diag_t *diag)
{
    const int64_t deadline_ns = cm1e_clock_now(bus->clock) + SETUP_TIMEOUT_NS;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        slave->setup = (cm1e_setup_job_t){0};
        const cm1e_slave_config_t *config = cm1e_bus_setup_of(slave);
        const cm1e_setup_pulses_t pulses = cm1e_bus_setup_pulses(slave);
        if (cm1e_bus_was_there(slave) && cm1e_setup_is_needed(config, pulses, before_op))
            cm1e_setup_begin(&slave->setup, slave->info.position, config, pulses, before_op,
                             slave->facts.swapped);
    }
    const bool ended = cm1e_bus_pump_until_idle(bus, deadline_ns);
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        char label[CM1E_LABEL_LENGTH];
        if (slave->setup.error != CM1E_OK)
            return diagnose_setup(bus, slave, diag);
        if (ended || cm1e_setup_idle(&slave->setup))
            continue;
        cm1e_acyclic_cancel(bus);
        cm1e_setup_cancel(&slave->setup);
        return cm1e_diag_set(diag, CM1E_ERROR_TIMEOUT, 0, "%s takes too long to be written.",
                             cm1e_bus_label_first(bus, slave, label));
    }
    return CM1E_OK;
}

/** Its PDOs are asked of the slave: what it has assigned may differ from its SII. */
static bool is_asked(const cm1e_bus_slave_t *slave)
{
    return slave->config && slave->facts.coe && !cm1e_bus_has_motors(slave) && cm1e_bus_was_there(slave);
}

cm1e_error_t cm1e_bus_take_mapping(const cm1e_bus_t *bus, cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    const cm1e_mapping_job_t *job = &slave->mapping;
    char label[CM1E_LABEL_LENGTH];
    if (job->error == CM1E_ERROR_PDO_MAPPING)
        return cm1e_diag_set(diag, job->error, 0, "The PDO mapping of %s cannot be used: %s (object 0x%04X:%02X).",
                             cm1e_bus_label(bus, slave, label), job->reason, job->sdo.index, job->sdo.subindex);
    if (job->error != CM1E_OK)
        return cm1e_bus_diagnose_sdo(bus, slave, &job->sdo, "PDO mapping", diag);
    memcpy(slave->mapped, job->mapped, sizeof slave->mapped);
    return CM1E_OK;
}

static cm1e_error_t take_pdos(const cm1e_bus_t *bus, cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    const cm1e_error_t error = cm1e_bus_take_mapping(bus, slave, diag);
    if (error == CM1E_OK)
        slave->by_pdos = slave->mapping.unknown < 2; /* without any object for it, as its SII says */
    return error;
}

cm1e_error_t cm1e_bus_read_pdos(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    const int64_t deadline_ns = cm1e_clock_now(bus->clock) + SETUP_TIMEOUT_NS;
    cm1e_error_t error = CM1E_OK;
    for (uint32_t i = 0; i < bus->slave_count; i++)
        if (is_asked(&bus->slaves[i]))
            cm1e_mapping_begin_any(&bus->slaves[i].mapping, bus->slaves[i].info.position,
                                   bus->slaves[i].facts.swapped);
    if (!cm1e_bus_pump_until_idle(bus, deadline_ns)) {
        cm1e_acyclic_cancel(bus);
        return cm1e_diag_set(diag, CM1E_ERROR_TIMEOUT, 0, "A slave takes too long to report its PDO mapping.");
    }
    for (uint32_t i = 0; i < bus->slave_count && error == CM1E_OK; i++)
        if (is_asked(&bus->slaves[i]))
            error = take_pdos(bus, &bus->slaves[i], diag);
    return error;
}
