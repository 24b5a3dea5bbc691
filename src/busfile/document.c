#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "busfile/busfile.h"
#include "core/regular_file.h"

/* ---- reading ----------------------------------------------------------------------------------------------------- */

static cm1e_error_t read_all(int file, uint8_t *bytes, size_t *size, cm1e_config_problem_t *problem)
{
    *size = 0;
    while (*size <= CM1E_BUSFILE_MAX_SIZE) {
        const ssize_t n = read(file, bytes + *size, CM1E_BUSFILE_MAX_SIZE + 1 - *size);
        if (n == 0)
            return CM1E_OK;
        if (n > 0)
            *size += (size_t)n;
        else if (errno != EINTR)
            return cm1e_regular_file_error(errno, problem->text, sizeof problem->text);
    }
    snprintf(problem->text, sizeof problem->text, "is larger than %d bytes; expected a bus file",
             CM1E_BUSFILE_MAX_SIZE);
    return CM1E_ERROR_CONFIG;
}

cm1e_error_t cm1e_busfile_read(const char *path, uint8_t **bytes, size_t *size, cm1e_config_problem_t *problem)
{
    int file;
    cm1e_error_t error = cm1e_regular_file_open(path, &file, problem->text, sizeof problem->text);
    *bytes = NULL;
    if (error != CM1E_OK)
        return error;
    if ((*bytes = malloc(CM1E_BUSFILE_MAX_SIZE + 1)) == NULL) {
        snprintf(problem->text, sizeof problem->text, "cannot be read: out of memory");
        error = CM1E_ERROR_NO_MEMORY;
    } else {
        error = read_all(file, *bytes, size, problem);
    }
    close(file);
    if (error != CM1E_OK) {
        free(*bytes);
        *bytes = NULL;
    }
    return error;
}

/* ---- parsing ----------------------------------------------------------------------------------------------------- */

enum { MAX_DEPTH = 8 }; /* the schema needs 6 */

static void set_place(cm1e_config_problem_t *problem, yaml_mark_t mark)
{
    problem->line = mark.line + 1;
    problem->column = mark.column + 1;
}

/* libyaml tells only the offset of a byte that is no text. */
static void set_place_of_offset(cm1e_config_problem_t *problem, const uint8_t *bytes, size_t offset)
{
    problem->line = problem->column = 1;
    for (size_t i = 0; i < offset; i++) {
        problem->column++;
        if (bytes[i] == '\n') {
            problem->line++;
            problem->column = 1;
        }
    }
}

/** The character of the mark is a tab. YAML wants spaces there, and its parser does not say so. */
static bool is_tab(const uint8_t *bytes, size_t size, yaml_mark_t mark)
{
    size_t at = size >= 3 && memcmp(bytes, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    for (size_t left = mark.index; left > 0 && at < size; left--)
        do
            at++;
        while (at < size && (bytes[at] & 0xC0) == 0x80); /* the rest of a character */
    return at < size && bytes[at] == '\t';
}

static cm1e_error_t parser_error(const yaml_parser_t *parser, const uint8_t *bytes, size_t size,
                                 cm1e_config_problem_t *problem)
{
    if (parser->error == YAML_MEMORY_ERROR) {
        snprintf(problem->text, sizeof problem->text, "out of memory");
        return CM1E_ERROR_NO_MEMORY;
    }
    if (parser->error == YAML_READER_ERROR)
        set_place_of_offset(problem, bytes, parser->problem_offset < size ? parser->problem_offset : size);
    else
        set_place(problem, parser->problem_mark);
    const char *what = parser->problem ? parser->problem : "syntax error";
    if (parser->error != YAML_READER_ERROR && is_tab(bytes, size, parser->problem_mark))
        snprintf(problem->text, sizeof problem->text, "not YAML: a tab; expected spaces, by which lines are indented");
    else if (parser->context)
        snprintf(problem->text, sizeof problem->text, "not YAML: %s (%s)", what, parser->context);
    else
        snprintf(problem->text, sizeof problem->text, "not YAML: %s", what);
    return CM1E_ERROR_CONFIG;
}

typedef struct scan {
    int depth, documents;
} scan_t;

/* NULL: nothing wrong with this event. */
static const char *scan_event(scan_t *scan, const yaml_event_t *event)
{
    const yaml_char_t *anchor = NULL, *tag = NULL;
    switch (event->type) {
    case YAML_DOCUMENT_START_EVENT:
        if (++scan->documents > 1)
            return "a second document begins; expected one document in the file";
        break;
    case YAML_ALIAS_EVENT:
        return "an alias; expected the value itself (aliases and anchors are not supported)";
    case YAML_SCALAR_EVENT:
        anchor = event->data.scalar.anchor;
        tag = event->data.scalar.tag;
        break;
    case YAML_SEQUENCE_START_EVENT:
        anchor = event->data.sequence_start.anchor;
        tag = event->data.sequence_start.tag;
        scan->depth++;
        break;
    case YAML_MAPPING_START_EVENT:
        anchor = event->data.mapping_start.anchor;
        tag = event->data.mapping_start.tag;
        scan->depth++;
        break;
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
        scan->depth--;
        break;
    default:
        break;
    }
    if (anchor)
        return "an anchor; expected the value alone (aliases and anchors are not supported)";
    if (tag)
        return "a tag; expected the value alone (tags are not supported)";
    if (scan->depth > MAX_DEPTH)
        return "lists or groups nested too deeply; see docs/BUS-FILE.md for the keys";
    return NULL;
}

/* One pass over the events, which costs no memory, before anything is built from them. */
static cm1e_error_t scan_events(const uint8_t *bytes, size_t size, cm1e_config_problem_t *problem)
{
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser)) {
        snprintf(problem->text, sizeof problem->text, "out of memory");
        return CM1E_ERROR_NO_MEMORY;
    }
    yaml_parser_set_input_string(&parser, bytes, size);
    scan_t scan = {0};
    cm1e_error_t error = CM1E_OK;
    for (bool end = false; !end && error == CM1E_OK;) {
        yaml_event_t event;
        if (!yaml_parser_parse(&parser, &event)) {
            error = parser_error(&parser, bytes, size, problem);
            break;
        }
        const char *wrong = scan_event(&scan, &event);
        if (wrong) {
            set_place(problem, event.start_mark);
            snprintf(problem->text, sizeof problem->text, "%s", wrong);
            error = CM1E_ERROR_CONFIG;
        }
        end = event.type == YAML_STREAM_END_EVENT;
        yaml_event_delete(&event);
    }
    yaml_parser_delete(&parser);
    if (error == CM1E_OK && scan.documents == 0) {
        problem->line = problem->column = 1;
        snprintf(problem->text, sizeof problem->text, "the file is empty; expected the keys bus and axes");
        error = CM1E_ERROR_CONFIG;
    }
    return error;
}

cm1e_error_t cm1e_busfile_parse(const uint8_t *bytes, size_t size, yaml_document_t *document,
                                cm1e_config_problem_t *problem)
{
    const cm1e_error_t error = scan_events(bytes, size, problem);
    if (error != CM1E_OK)
        return error;
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser)) {
        snprintf(problem->text, sizeof problem->text, "out of memory");
        return CM1E_ERROR_NO_MEMORY;
    }
    yaml_parser_set_input_string(&parser, bytes, size);
    const bool loaded = yaml_parser_load(&parser, document);
    const cm1e_error_t load_error = loaded ? CM1E_OK : parser_error(&parser, bytes, size, problem);
    yaml_parser_delete(&parser);
    return load_error;
}

/* ---- finding a node ---------------------------------------------------------------------------------------------- */

static yaml_node_t *find_key(yaml_document_t *document, const yaml_node_t *node, const char *key, size_t length)
{
    if (node->type != YAML_MAPPING_NODE)
        return NULL;
    for (const yaml_node_pair_t *pair = node->data.mapping.pairs.start; pair < node->data.mapping.pairs.top; pair++) {
        const yaml_node_t *name = yaml_document_get_node(document, pair->key);
        if (name->type == YAML_SCALAR_NODE && name->data.scalar.length == length &&
            memcmp(name->data.scalar.value, key, length) == 0)
            return yaml_document_get_node(document, pair->value);
    }
    return NULL;
}

static yaml_node_t *find_item(yaml_document_t *document, const yaml_node_t *node, unsigned long number)
{
    if (node->type != YAML_SEQUENCE_NODE ||
        number >= (unsigned long)(node->data.sequence.items.top - node->data.sequence.items.start))
        return NULL;
    return yaml_document_get_node(document, node->data.sequence.items.start[number]);
}

bool cm1e_busfile_has_several(yaml_document_t *document)
{
    const yaml_node_t *root = yaml_document_get_root_node(document);
    return root && find_key(document, root, "buses", strlen("buses"));
}

void cm1e_busfile_locate(yaml_document_t *document, cm1e_config_problem_t *problem)
{
    yaml_node_t *node = yaml_document_get_root_node(document);
    const char *path = problem->path;
    while (node) {
        set_place(problem, node->start_mark);
        if (*path == '[') {
            char *end;
            node = find_item(document, node, strtoul(path + 1, &end, 10));
            path = *end == ']' ? end + 1 : end;
        } else {
            path += *path == '.';
            const size_t length = strcspn(path, ".[");
            node = find_key(document, node, path, length); /* at the end of the path no key has its name, "" */
            path += length;
        }
    }
}
