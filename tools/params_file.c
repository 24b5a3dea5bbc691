/* Parameters in a file: YAML with a comment for each, so that a person can read and change it. */
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

#include "files.h"
#include "params.h"

/* ---- writing ----------------------------------------------------------------------------------------------------- */

/* What a device says of itself, as every reader of YAML takes it. */
static void put_text(FILE *file, const char *key, const char *text)
{
    fprintf(file, "  %s: \"", key);
    for (; *text; text++)
        fputc(*text >= ' ' && *text <= '~' && *text != '"' && *text != '\\' ? *text : '?', file);
    fputs("\"\n", file);
}

char *params_as_yaml(const params_head_t *head, const params_t *params)
{
    char *text = NULL, number[16], range[80];
    size_t size;
    FILE *file = open_memstream(&text, &size);
    if (!file)
        return NULL;
    fputs("# Parameters of a motor, written by `cm1e params backup`; `cm1e params restore` writes them back.\n"
          "# A value may be changed, and a line removed. What is behind # is from the guide of the motor.\n"
          "device:\n", file);
    put_text(file, "kind", head->kind);
    put_text(file, "name", head->name);
    put_text(file, "firmware", head->firmware);
    fprintf(file, "  serial: 0x%08X\nparameters:\n", (unsigned)head->serial);
    for (size_t i = 0; i < params->count; i++) {
        const cm1e_entry_t *entry = params->at[i].entry;
        char line[PARAM_NAME + 40];
        snprintf(line, sizeof line, "%s: %" PRId64, entry->name, params->at[i].value);
        fprintf(file, "  %-24s # %s, %s: %s\n", line, param_number(entry, number),
                param_range(entry, range, sizeof range), entry->meaning ? entry->meaning : "");
    }
    const bool good = !ferror(file);
    if (fclose(file) != 0 || !good) {
        free(text);
        return NULL;
    }
    return text;
}

/* ---- reading ----------------------------------------------------------------------------------------------------- */

typedef struct reader {
    const char *path;
    yaml_document_t document;
    const params_t *known;
    params_head_t head;
    params_t *params;
    bool good;
} reader_t;

__attribute__((format(printf, 3, 4)))
static void wrong(reader_t *reader, const yaml_node_t *node, const char *format, ...)
{
    char text[300];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    complain("%s:%zu: %s", reader->path, node->start_mark.line + 1, text);
    reader->good = false;
}

static const char *scalar(const yaml_node_t *node)
{
    return node && node->type == YAML_SCALAR_NODE ? (const char *)node->data.scalar.value : NULL;
}

static void read_head(reader_t *reader, const yaml_node_t *key, const yaml_node_t *value)
{
    params_head_t *head = &reader->head;
    const struct {
        const char *key;
        char *to;
        size_t size;
    } texts[] = {{"kind", head->kind, sizeof head->kind}, {"name", head->name, sizeof head->name},
                 {"firmware", head->firmware, sizeof head->firmware}};
    const char *word = scalar(key), *text = scalar(value);
    if (!word || !text) {
        wrong(reader, key, "expected a key with one value");
        return;
    }
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        if (strcmp(word, texts[i].key) == 0) {
            snprintf(texts[i].to, texts[i].size, "%s", text);
            return;
        }
    if (strcmp(word, "serial") == 0)
        head->serial = (uint32_t)strtoul(text, NULL, 0);
    else
        wrong(reader, key, "unknown key \"%s\" in device; expected kind, name, firmware or serial", word);
}

static void read_parameter(reader_t *reader, const yaml_node_t *key, const yaml_node_t *value)
{
    const char *word = scalar(key), *text = scalar(value);
    if (!word || !text) {
        wrong(reader, key, "expected the name of a parameter with one value");
        return;
    }
    param_t param = {.entry = param_find(reader->known, word), .line = key->start_mark.line + 1};
    if (!param.entry || !param_parse(param.entry, text, &param.value)) {
        wrong(reader, key, "this line cannot be restored");
        return;
    }
    for (size_t i = 0; i < reader->params->count; i++)
        if (reader->params->at[i].entry == param.entry) {
            wrong(reader, key, "%s is already in line %zu", param.entry->name, reader->params->at[i].line);
            return;
        }
    if (reader->params->count < PARAMS_MAX)
        reader->params->at[reader->params->count++] = param;
}

static void read_mapping(reader_t *reader, const yaml_node_t *node, const char *what,
                         void (*take)(reader_t *, const yaml_node_t *, const yaml_node_t *))
{
    if (node->type != YAML_MAPPING_NODE) {
        wrong(reader, node, "%s: expected names, each with a value", what);
        return;
    }
    for (const yaml_node_pair_t *pair = node->data.mapping.pairs.start; pair < node->data.mapping.pairs.top; pair++)
        take(reader, yaml_document_get_node(&reader->document, pair->key),
             yaml_document_get_node(&reader->document, pair->value));
}

static bool is_parameters(const char *word) { return word && strcmp(word, "parameters") == 0; }

/** All but the parameters. */
static void read_device(reader_t *reader, const yaml_node_t *key, const yaml_node_t *value)
{
    const char *word = scalar(key);
    if (word && strcmp(word, "device") == 0)
        read_mapping(reader, value, word, read_head);
    else if (!is_parameters(word))
        wrong(reader, key, "unknown key \"%s\"; expected device and parameters", word ? word : "");
}

static void read_parameters(reader_t *reader, const yaml_node_t *key, const yaml_node_t *value)
{
    if (is_parameters(scalar(key)))
        read_mapping(reader, value, "parameters", read_parameter);
}

/** The head first: the parameters of another device are all unknown. */
static void read_document(reader_t *reader, params_judge_t judge, const void *context)
{
    const yaml_node_t *root = yaml_document_get_root_node(&reader->document);
    if (root)
        read_mapping(reader, root, "the file", read_device);
    reader->good = reader->good && (!root || judge(&reader->head, context));
    if (root && reader->good)
        read_mapping(reader, root, "the file", read_parameters);
    if (reader->good && reader->params->count == 0) {
        complain("%s: there are no parameters in it", reader->path);
        reader->good = false;
    }
}

bool params_read_file(const char *path, const params_t *known, params_judge_t judge, const void *context,
                      params_t *params)
{
    input_t input;
    if (!read_input(path, &input))
        return false;
    if (input.size > 0 && input.bytes[input.size - 1] != '\n') {
        complain("%s: its last line has no end, so the file may be cut off within a number. End the line with a newline if it "
                 "is complete", path);
        free(input.bytes);
        return false;
    }
    reader_t reader = {.path = path, .known = known, .params = params, .good = true};
    yaml_parser_t parser;
    params->count = 0;
    if (!yaml_parser_initialize(&parser)) {
        complain("out of memory");
        free(input.bytes);
        return false;
    }
    yaml_parser_set_input_string(&parser, input.bytes, input.size);
    if (yaml_parser_load(&parser, &reader.document)) {
        read_document(&reader, judge, context);
        yaml_document_delete(&reader.document);
    } else {
        complain("%s:%zu: not YAML: %s", path, parser.problem_mark.line + 1,
                 parser.problem ? parser.problem : "syntax error");
        reader.good = false;
    }
    yaml_parser_delete(&parser);
    free(input.bytes);
    return reader.good;
}
