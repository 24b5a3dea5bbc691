/* A bus file with several buses: `buses`. Each is converted and checked as if it were alone, and then beside the
 * others, because one program runs all of them in one cycle. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "busfile/busfile.h"
#include "config/interface.h"

/* The problem lies in this bus, and its path has to begin there. */
static bool in_bus(uint32_t bus, cm1e_config_problem_t *problem)
{
    char path[sizeof problem->path];
    snprintf(path, sizeof path, "%s", problem->path);
    snprintf(problem->path, sizeof problem->path, "buses[%u]%s%.80s", bus, path[0] ? "." : "", path);
    return false;
}

__attribute__((format(printf, 4, 5)))
static bool wrong(cm1e_config_problem_t *problem, uint32_t bus, const char *path, const char *format, ...)
{
    va_list args;
    snprintf(problem->path, sizeof problem->path, "%s", path);
    va_start(args, format);
    vsnprintf(problem->text, sizeof problem->text, format, args);
    va_end(args);
    return in_bus(bus, problem);
}

static bool is_same_interface(const char *a, const char *b)
{
    /* Every simulated segment is one of its own. */
    return !cm1e_interface_is_simulated(a) && cm1e_interface_is_same(a, b);
}

/* An interface of `config` that the bus `other` has too; NULL: there is none. */
static const char *shared_interface(const cm1e_bus_config_t *config, const cm1e_bus_config_t *other)
{
    const char *const own[] = {config->interface_name, config->second_interface};
    for (int i = 0; i < 2; i++)
        if (is_same_interface(own[i], other->interface_name) || is_same_interface(own[i], other->second_interface))
            return own[i];
    return NULL;
}

static bool check_axes(const cm1e_bus_config_t *config, const cm1e_bus_config_t *other, uint32_t bus,
                       cm1e_config_problem_t *problem)
{
    for (uint32_t i = 0; i < config->axis_count; i++)
        for (uint32_t k = 0; k < other->axis_count; k++)
            if (strcmp(config->axes[i].name, other->axes[k].name) == 0) {
                char path[32];
                snprintf(path, sizeof path, "axes[%u].name", i);
                return wrong(problem, bus, path, "bus %s: axis %s: the bus %s has an axis of this name too; expected "
                             "names that differ over all buses", config->name, config->axes[i].name, other->name);
            }
    return true;
}

static int64_t cycle_us(const cm1e_bus_config_t *config)
{
    return (config->cycle_time_ns ? config->cycle_time_ns : 1000000) / 1000;
}

static bool check_beside(const cm1e_bus_config_t *config, const cm1e_bus_config_t *other, uint32_t bus,
                         cm1e_config_problem_t *problem)
{
    const char *interface = shared_interface(config, other);
    if (strcmp(config->name, other->name) == 0)
        return wrong(problem, bus, "name", "two buses have the name %s; expected names that differ", config->name);
    if (interface)
        return wrong(problem, bus, "bus.interface", "bus %s: the bus %s has the interface %s too; expected an "
                     "interface of its own for each bus", config->name, other->name, interface);
    if (cycle_us(config) != cycle_us(other))
        return wrong(problem, bus, "bus.cycle_time_us", "bus %s: cycle_time_us is %lld, and %lld on the bus %s; "
                     "expected one cycle for all buses", config->name, (long long)cycle_us(config),
                     (long long)cycle_us(other), other->name);
    if (config->virtual_time != other->virtual_time)
        return wrong(problem, bus, "bus.virtual_time", "bus %s: virtual_time differs from that of the bus %s; expected "
                     "one time for all buses", config->name, other->name);
    return check_axes(config, other, bus, problem);
}

/* The bus `number`, behind those before it, which have so many axes. */
static bool convert_one(cm1e_busfile_loaded_t *loaded, const cm1e_busfile_t *from, uint32_t number, uint32_t axes,
                        cm1e_config_problem_t *problem)
{
    cm1e_bus_config_t *config = &loaded->buses[number];
    if (!cm1e_busfile_convert(config, from, axes, loaded->path, problem) || !cm1e_config_find_problem(config, problem))
        return in_bus(number, problem);
    if (axes + config->axis_count > CM1E_MAX_AXES)
        return wrong(problem, number, "axes", "bus %s: there are more than %d axes on all buses together", config->name,
                     CM1E_MAX_AXES);
    for (uint32_t i = 0; i < number; i++)
        if (!check_beside(config, &loaded->buses[i], number, problem))
            return false;
    return true;
}

bool cm1e_busfile_convert_several(cm1e_busfile_loaded_t *loaded, const cm1e_busfile_several_t *from,
                                  cm1e_config_problem_t *problem)
{
    uint32_t axes = 0;
    loaded->count = from->count;
    for (uint32_t i = 0; i < from->count; i++) {
        if (!convert_one(loaded, &from->buses[i], i, axes, problem))
            return false;
        axes += loaded->buses[i].axis_count;
    }
    return true;
}
