#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "busfile/busfile.h"
#include "config/copy.h"
#include "config/interface.h"
#include "core/c_locale.h"
#include "core/in_task.h"
#include "device/place.h"

bool cm1e_busfile_no_memory(cm1e_config_problem_t *problem)
{
    snprintf(problem->text, sizeof problem->text, "out of memory");
    problem->no_memory = true;
    return false;
}

/* ---- conversion -------------------------------------------------------------------------------------------------- */

bool cm1e_busfile_convert_address(const uint16_t stated[3], cm1e_address_kind_t *kind, uint16_t *address,
                                  const char *list, uint32_t index, cm1e_config_problem_t *problem)
{
    static const char *const keys[] = {"position", "alias", "explicit_id"}; /* by cm1e_address_kind_t */
    unsigned count = 0, last = 0;
    for (unsigned i = 0; i < 3; i++)
        if (stated[i]) {
            count++;
            last = i;
        }
    *kind = (cm1e_address_kind_t)last;
    *address = stated[last];
    if (count <= 1)
        return true;
    snprintf(problem->path, sizeof problem->path, "%s[%u].%s", list, index, keys[last]);
    snprintf(problem->text, sizeof problem->text,
             "entry %u of the list is addressed twice; expected one of position, alias and explicit_id", index + 1);
    return false;
}

static void convert_software_limits(cm1e_axis_config_t *axis, const cm1e_busfile_axis_t *from)
{
    const double *negative = from->software_limit_negative, *positive = from->software_limit_positive;
    if (!negative && !positive)
        return;
    axis->software_limit_negative = negative ? *negative : -INFINITY;
    axis->software_limit_positive = positive ? *positive : INFINITY;
}

/* Hexadecimal, as manuals have it. */
static bool convert_pdo(uint16_t *pdo, const char *text, const char *key, unsigned first, uint32_t index,
                        cm1e_config_problem_t *problem)
{
    enum { PDOS = 0x200 };
    char *end;
    const unsigned long value = strtoul(text, &end, 16);
    const bool good = strncmp(text, "0x", 2) == 0 && *end == '\0' && value >= first && value < first + PDOS;
    *pdo = (uint16_t)value;
    if (good || text[0] == '\0')
        return true;
    snprintf(problem->path, sizeof problem->path, "axes[%u].drive.%s", index, key);
    snprintf(problem->text, sizeof problem->text, "%s is '%s'; expected 0x%04X ... 0x%04X", key, text, first,
             first + PDOS - 1);
    return false;
}

static bool convert_axis(cm1e_axis_config_t *axis, const cm1e_busfile_axis_t *from, uint32_t index,
                         cm1e_config_problem_t *problem)
{
    *axis = from->axis;
    axis->velocity_unit_stated = from->velocity_unit != 0;
    axis->velocity_in_counts_per_ms = from->velocity_unit == CM1E_BUSFILE_VELOCITY_COUNTS_PER_MS;
    axis->acceleration_in_kpulses = from->acceleration_unit != 0;
    axis->k37_stated = from->k37 != NULL;
    axis->k37 = from->k37 ? *from->k37 : 0;
    convert_software_limits(axis, from);
    if (!convert_pdo(&axis->outputs_pdo, from->outputs_pdo, "outputs_pdo", 0x1600, index, problem) ||
        !convert_pdo(&axis->inputs_pdo, from->inputs_pdo, "inputs_pdo", 0x1A00, index, problem) ||
        !cm1e_busfile_convert_wiring(axis, from, index, problem))
        return false;
    const uint16_t stated[] = {from->position, from->alias, from->explicit_id}; /* 0: its place in the list */
    return cm1e_busfile_convert_address(stated, &axis->address_kind, &axis->address, "axes", index, problem);
}

static void name_axis(cm1e_axis_config_t *axis, uint32_t number)
{
    if (axis->name[0] == '\0')
        snprintf(axis->name, sizeof axis->name, "axis%u", number);
}

bool cm1e_busfile_convert(cm1e_bus_config_t *config, const cm1e_busfile_t *from, uint32_t first_axis,
                          const char *path, cm1e_config_problem_t *problem)
{
    *config = from->config;
    if (config->interface_name[0] == '\0')
        snprintf(config->interface_name, sizeof config->interface_name, CM1E_SIM_INTERFACE);
    config->cycle_time_ns = (int64_t)from->cycle_time_us * 1000;
    config->frame_timeout_ns = (int64_t)from->frame_timeout_us * 1000;
    if (from->axis_count + from->slave_count == 0) {
        snprintf(problem->text, sizeof problem->text,
                 "key 'axes' is missing in the file; expected axes, slaves or both");
        return false;
    }
    for (uint32_t i = 0; i < from->axis_count; i++)
        if (!cm1e_bus_config_add_axis(config, NULL))
            return cm1e_busfile_no_memory(problem);
    for (uint32_t i = 0; i < from->axis_count; i++)
        if (!convert_axis(&config->axes[i], &from->axes[i], i, problem))
            return false;
    for (uint32_t i = 0; i < from->axis_count; i++) {
        config->axes[i].address = cm1e_axis_address(config, i);
        name_axis(&config->axes[i], first_axis + i + 1);
    }
    return cm1e_busfile_convert_slaves(config, from, path, problem);
}

/* ---- loading ----------------------------------------------------------------------------------------------------- */

static cm1e_error_t fill(cm1e_busfile_loaded_t *loaded, const uint8_t *bytes, size_t size,
                         const cyaml_schema_value_t *schema, cm1e_config_problem_t *problem)
{
    /* No log: what libcyaml could tell has been told, with its place, by cm1e_busfile_compare(). */
    const cyaml_config_t settings = {.mem_fn = cyaml_mem, .flags = CYAML_CFG_NO_ALIAS};
    cyaml_data_t *file = NULL;
    const cyaml_err_t load_error = cyaml_load_data(bytes, size, &settings, schema, &file, NULL);
    if (load_error == CYAML_ERR_OOM) {
        (void)cm1e_busfile_no_memory(problem);
        return CM1E_ERROR_NO_MEMORY;
    }
    if (load_error != CYAML_OK) {
        snprintf(problem->text, sizeof problem->text, "%s", cyaml_strerror(load_error));
        return CM1E_ERROR_CONFIG;
    }
    loaded->count = 1;
    const bool good = schema == &cm1e_busfile_several_schema
                          ? cm1e_busfile_convert_several(loaded, file, problem)
                          : cm1e_busfile_convert(&loaded->buses[0], file, 0, loaded->path, problem) &&
                                cm1e_config_find_problem(&loaded->buses[0], problem);
    cyaml_free(&settings, schema, file, 0);
    return good ? CM1E_OK : problem->no_memory ? CM1E_ERROR_NO_MEMORY : CM1E_ERROR_CONFIG;
}

static cm1e_error_t load_bytes(cm1e_busfile_loaded_t *loaded, const uint8_t *bytes, size_t size,
                               cm1e_config_problem_t *problem)
{
    yaml_document_t document;
    cm1e_error_t error = cm1e_busfile_parse(bytes, size, &document, problem);
    if (error != CM1E_OK)
        return error;
    const cyaml_schema_value_t *schema = cm1e_busfile_has_several(&document) ? &cm1e_busfile_several_schema
                                                                             : &cm1e_busfile_schema;
    error = cm1e_busfile_compare(&document, schema, problem) ? fill(loaded, bytes, size, schema, problem)
                                                             : CM1E_ERROR_CONFIG;
    if (error == CM1E_ERROR_CONFIG && problem->line == 0)
        cm1e_busfile_locate(&document, problem);
    yaml_document_delete(&document);
    return error;
}

/* libcyaml reads numbers by strtod(), too. */
static cm1e_error_t load_in_c_locale(cm1e_busfile_loaded_t *loaded, const uint8_t *bytes, size_t size,
                                     cm1e_config_problem_t *problem)
{
    c_locale_t locale;
    if (!cm1e_c_locale_begin(&locale)) {
        (void)cm1e_busfile_no_memory(problem);
        return CM1E_ERROR_NO_MEMORY;
    }
    const cm1e_error_t error = load_bytes(loaded, bytes, size, problem);
    cm1e_c_locale_end(&locale);
    return error;
}

/* "path:line:column: text"; a long path is cut at its beginning. */
static cm1e_error_t report(cm1e_diag_t *diag, cm1e_error_t error, const char *path,
                           const cm1e_config_problem_t *problem)
{
    enum { SHOWN = 160 };
    const size_t length = strlen(path);
    const char *dots = length > SHOWN ? "..." : "";
    const char *shown = length > SHOWN ? path + length - SHOWN : path;
    if (problem->line == 0)
        return cm1e_diag_set(diag, error, 0, "%s%s: %s", dots, shown, problem->text);
    return cm1e_diag_set(diag, error, 0, "%s%s:%zu:%zu: %s", dots, shown, problem->line, problem->column,
                         problem->text);
}

/* Reads and converts the file. What is loaded, also before an error, is freed by the caller. */
static cm1e_error_t load_file(cm1e_busfile_loaded_t *loaded, const char *path, cm1e_config_problem_t *problem)
{
    uint8_t *bytes = NULL;
    size_t length = 0;
    cm1e_error_t error = cm1e_busfile_read(path, &bytes, &length, problem);
    if (error == CM1E_OK)
        error = load_in_c_locale(loaded, bytes, length, problem);
    free(bytes);
    return error;
}

static void free_loaded(cm1e_busfile_loaded_t *loaded)
{
    for (uint32_t i = 0; i < CM1E_MAX_BUSES; i++)
        cm1e_bus_config_free(&loaded->buses[i]);
}

/* A configuration with the sizes of the program. */
static cm1e_error_t give(void *config, size_t size, size_t axis_size, const cm1e_bus_config_t *loaded,
                         cm1e_config_problem_t *problem)
{
    const cm1e_error_t error = cm1e_config_copy_sized(config, size, axis_size, loaded);
    if (error != CM1E_OK)
        snprintf(problem->text, sizeof problem->text, "%s",
                 error == CM1E_ERROR_CONFIG ? "the file has slaves, which the program does not know: it was "
                                              "compiled with an older version of the library; compile it again"
                                            : "out of memory");
    return error;
}

static cm1e_error_t give_all(void *configs, size_t size, size_t axis_size, const cm1e_busfile_loaded_t *loaded,
                             cm1e_config_problem_t *problem)
{
    for (uint32_t i = 0; i < loaded->count; i++) {
        const cm1e_error_t error = give((char *)configs + i * size, size, axis_size, &loaded->buses[i], problem);
        while (error != CM1E_OK && i-- > 0)
            cm1e_bus_config_free((void *)((char *)configs + i * size));
        if (error != CM1E_OK)
            return error;
    }
    return CM1E_OK;
}

cm1e_error_t cm1e_bus_config_load_all_sized(cm1e_bus_config_t *configs, size_t size, size_t axis_size, uint32_t room,
                                            uint32_t *count, const char *path, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_bus_config_load()", "", diag);
    if (!configs || !path || !count)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "no configuration or no path given");
    *count = 0;
    cm1e_config_problem_t problem = {0};
    cm1e_busfile_loaded_t loaded = {.path = path};
    cm1e_error_t error = load_file(&loaded, path, &problem);
    if (error == CM1E_OK && loaded.count > room) {
        error = CM1E_ERROR_CONFIG;
        snprintf(problem.text, sizeof problem.text, "the file has %u buses; expected at most %u here", loaded.count,
                 room);
    }
    if (error == CM1E_OK)
        error = give_all(configs, size, axis_size, &loaded, &problem);
    if (error == CM1E_OK)
        *count = loaded.count;
    free_loaded(&loaded);
    return error != CM1E_OK ? report(diag, error, path, &problem) : cm1e_diag_set(diag, CM1E_OK, 0, "%s", "");
}

cm1e_error_t cm1e_bus_config_load_sized(cm1e_bus_config_t *config, size_t size, size_t axis_size, const char *path,
                                        cm1e_diag_t *diag)
{
    uint32_t count;
    return cm1e_bus_config_load_all_sized(config, size, axis_size, 1, &count, path, diag);
}
