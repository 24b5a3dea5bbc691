#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "busfile/busfile.h"
#include "core/near.h"

typedef struct compare {
    yaml_document_t *document;
    cm1e_config_problem_t *problem;
} compare_t;

__attribute__((format(printf, 3, 4)))
static bool wrong(const compare_t *compare, const yaml_node_t *node, const char *format, ...)
{
    compare->problem->line = node->start_mark.line + 1;
    compare->problem->column = node->start_mark.column + 1;
    va_list args;
    va_start(args, format);
    vsnprintf(compare->problem->text, sizeof compare->problem->text, format, args);
    va_end(args);
    return false;
}

/* ---- texts ------------------------------------------------------------------------------------------------------- */

enum { SHOWN = 48 };

/* The contents of the file at this place, short and printable. */
static const char *found(const yaml_node_t *node, char text[SHOWN])
{
    if (node->type == YAML_SEQUENCE_NODE)
        return "a list";
    if (node->type == YAML_MAPPING_NODE)
        return "a group of keys";
    if (node->data.scalar.length == 0)
        return "nothing";
    size_t i;
    text[0] = '\'';
    for (i = 0; i < node->data.scalar.length && i < SHOWN - 6; i++) {
        const unsigned char c = node->data.scalar.value[i];
        text[1 + i] = (char)(c < 0x20 || c == 0x7F ? '?' : c);
    }
    snprintf(text + 1 + i, SHOWN - 1 - i, "%s", i < node->data.scalar.length ? "...'" : "'");
    return text;
}

static void append(char *text, size_t size, const char *part)
{
    const size_t length = strlen(text);
    snprintf(text + length, size - length, "%s", part);
}

enum { KEYS_BYTES = 380 }; /* all keys of an axis */

static void list_keys(char *text, size_t size, const cyaml_schema_field_t *fields)
{
    text[0] = '\0';
    for (const cyaml_schema_field_t *field = fields; field->key; field++) {
        append(text, size, field == fields ? "" : ", ");
        append(text, size, field->key);
    }
}

static void list_strings(char *text, size_t size, const cyaml_schema_value_t *schema)
{
    text[0] = '\0';
    for (uint32_t i = 0; i < schema->enumeration.count; i++) {
        append(text, size, i == 0 ? "" : ", ");
        append(text, size, schema->enumeration.strings[i].str);
    }
}

/* ---- scalars ----------------------------------------------------------------------------------------------------- */

static const char *skip_digits(const char *text)
{
    while (*text >= '0' && *text <= '9')
        text++;
    return text;
}

/* -?(0|[1-9][0-9]*): neither libcyaml's octal 010 nor its 0x10 are what a reader of the file expects. */
static bool is_integer(const char *text)
{
    text += *text == '-';
    const char *end = skip_digits(text);
    return end > text && *end == '\0' && (text[0] != '0' || end == text + 1);
}

/* [+-]? digits with at most one point, [eE][+-]?digits */
static bool is_number(const char *text)
{
    text += *text == '-' || *text == '+';
    const char *whole = skip_digits(text);
    const char *fraction = *whole == '.' ? skip_digits(whole + 1) : whole;
    if (whole == text && fraction <= whole + 1)
        return false;
    if (*fraction != 'e' && *fraction != 'E')
        return *fraction == '\0';
    const char *exponent = fraction + 1;
    exponent += *exponent == '-' || *exponent == '+';
    const char *end = skip_digits(exponent);
    return end > exponent && *end == '\0';
}

static bool compare_integer(const compare_t *compare, const yaml_node_t *node, const char *key)
{
    const cm1e_busfile_integer_range_t *range = cm1e_busfile_integer_ranges;
    while (range->key && strcmp(range->key, key) != 0)
        range++;
    const char *text = (const char *)node->data.scalar.value;
    errno = 0;
    const long long value = strtoll(text, NULL, 10);
    if (is_integer(text) && errno == 0 && value >= range->minimum && value <= range->maximum)
        return true;
    char shown[SHOWN];
    return wrong(compare, node, "%s is %s; expected a whole number, %lld ... %lld", key, found(node, shown),
                 (long long)range->minimum, (long long)range->maximum);
}

static bool compare_float(const compare_t *compare, const yaml_node_t *node, const char *key)
{
    const char *text = (const char *)node->data.scalar.value;
    char shown[SHOWN];
    if (!is_number(text))
        return wrong(compare, node, "%s is %s; expected a number%s", key, found(node, shown),
                     strchr(text, ',') ? " with a decimal point" : "");
    errno = 0;
    const double value = strtod(text, NULL);
    if (errno)
        return wrong(compare, node, "%s is %s; expected a number that is neither too large nor too small", key,
                     found(node, shown));
    if (value != 0)
        return true;
    for (const char *const *allowed = cm1e_busfile_zero_allowed; *allowed; allowed++)
        if (strcmp(*allowed, key) == 0)
            return true;
    return wrong(compare, node, "%s is 0; expected another number (leave the key out for its default)", key);
}

static bool compare_bool(const compare_t *compare, const yaml_node_t *node, const char *key)
{
    static const char *const words[] = {"true", "false", "yes", "no", "on", "off"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strcasecmp((const char *)node->data.scalar.value, words[i]) == 0)
            return true;
    char shown[SHOWN];
    return wrong(compare, node, "%s is %s; expected true or false", key, found(node, shown));
}

static bool compare_enum(const compare_t *compare, const yaml_node_t *node, const cyaml_schema_value_t *schema,
                         const char *key)
{
    for (uint32_t i = 0; i < schema->enumeration.count; i++)
        if (strcmp((const char *)node->data.scalar.value, schema->enumeration.strings[i].str) == 0)
            return true;
    char shown[SHOWN], words[200], meant[CM1E_NEAR_TEXT_BYTES];
    list_strings(words, sizeof words, schema);
    cm1e_near_t near = {.word = (const char *)node->data.scalar.value};
    for (uint32_t i = 0; i < schema->enumeration.count; i++)
        cm1e_near_look(&near, schema->enumeration.strings[i].str);
    return wrong(compare, node, "%s is %s; expected one of: %s%s", key, found(node, shown), words,
                 cm1e_near_text(&near, meant, sizeof meant));
}

static bool compare_scalar(const compare_t *compare, const yaml_node_t *node, const cyaml_schema_value_t *schema,
                           const char *key)
{
    char shown[SHOWN];
    if (node->type != YAML_SCALAR_NODE)
        return wrong(compare, node, "%s is %s; expected a single value", key, found(node, shown));
    const char *text = (const char *)node->data.scalar.value;
    const bool plain = node->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    if (strlen(text) != node->data.scalar.length)
        return wrong(compare, node, "%s holds a null character; expected text without it", key);
    if (text[0] == '\0' || (plain && (strcmp(text, "~") == 0 || strcasecmp(text, "null") == 0)))
        return wrong(compare, node, "%s is empty; expected a value (leave the key out for its default)", key);
    if (schema->type != CYAML_STRING && !plain)
        return wrong(compare, node, "%s is text in quotes; expected the value without them", key);
    switch (schema->type) {
    case CYAML_INT:
    case CYAML_UINT: return compare_integer(compare, node, key);
    case CYAML_FLOAT: return compare_float(compare, node, key);
    case CYAML_BOOL: return compare_bool(compare, node, key);
    case CYAML_ENUM: return compare_enum(compare, node, schema, key);
    default: break;
    }
    if (node->data.scalar.length > schema->string.max)
        return wrong(compare, node, "%s is %s, %zu bytes long; expected at most %u bytes", key, found(node, shown),
                     node->data.scalar.length, schema->string.max);
    return true;
}

/* ---- groups and lists -------------------------------------------------------------------------------------------- */

enum { MAX_FIELDS = 40 };

static bool compare_value(const compare_t *compare, const yaml_node_t *node, const cyaml_schema_value_t *schema,
                          const char *key);

static int find_field(const cyaml_schema_field_t *fields, const yaml_node_t *name)
{
    for (int i = 0; fields[i].key && name->type == YAML_SCALAR_NODE; i++)
        if (strlen(fields[i].key) == name->data.scalar.length &&
            memcmp(fields[i].key, name->data.scalar.value, name->data.scalar.length) == 0)
            return i;
    return -1;
}

static bool unknown_key(const compare_t *compare, const yaml_node_t *name, const char *key,
                        const cyaml_schema_field_t *fields)
{
    char shown[SHOWN], keys[KEYS_BYTES], meant[CM1E_NEAR_TEXT_BYTES] = "";
    list_keys(keys, sizeof keys, fields);
    if (name->type == YAML_SCALAR_NODE) {
        cm1e_near_t near = {.word = (const char *)name->data.scalar.value};
        for (int i = 0; fields[i].key; i++)
            cm1e_near_look(&near, fields[i].key);
        cm1e_near_text(&near, meant, sizeof meant);
    }
    /* What was meant comes first: behind a long path the list of keys may be cut off. */
    return wrong(compare, name, "unknown key %s in %s%s %sxpected one of: %s", found(name, shown), key,
                 meant[0] ? meant : ";", meant[0] ? "E" : "e", keys);
}

static const char *scalar(const compare_t *compare, int index)
{
    const yaml_node_t *node = yaml_document_get_node(compare->document, index);
    return node->type == YAML_SCALAR_NODE ? (const char *)node->data.scalar.value : "";
}

/* In braces a decimal comma ends the number: {velocity: 10,5} has a velocity of 10, and a key 5 without a value. Said
 * before any of them is compared, because the 0 of 0,5 would be refused for another reason. */
static bool compare_commas(const compare_t *compare, const yaml_node_t *node, const char *key)
{
    const yaml_node_pair_t *const first = node->data.mapping.pairs.start;
    for (const yaml_node_pair_t *pair = first; pair < node->data.mapping.pairs.top; pair++) {
        const char *name = scalar(compare, pair->key), *whole = pair > first ? scalar(compare, pair[-1].value) : "";
        if (skip_digits(name) == name || !is_number(name) || !is_integer(whole) || scalar(compare, pair->value)[0])
            continue;
        return wrong(compare, yaml_document_get_node(compare->document, pair->key), "unknown key '%s' in %s; expected "
                     "a decimal point, not a comma: %s: %s.%s", name, key, scalar(compare, pair[-1].key), whole, name);
    }
    return true;
}

static bool compare_mapping(const compare_t *compare, const yaml_node_t *node, const cyaml_schema_value_t *schema,
                            const char *key)
{
    const cyaml_schema_field_t *fields = schema->mapping.fields;
    char shown[SHOWN], keys[KEYS_BYTES];
    list_keys(keys, sizeof keys, fields);
    if (node->type != YAML_MAPPING_NODE)
        return wrong(compare, node, "%s is %s; expected a group with the keys: %s", key, found(node, shown), keys);
    if (!compare_commas(compare, node, key))
        return false;
    bool seen[MAX_FIELDS] = {false};
    for (const yaml_node_pair_t *pair = node->data.mapping.pairs.start; pair < node->data.mapping.pairs.top; pair++) {
        const yaml_node_t *name = yaml_document_get_node(compare->document, pair->key);
        const int i = find_field(fields, name);
        if (i < 0)
            return unknown_key(compare, name, key, fields);
        if (seen[i])
            return wrong(compare, name, "key '%s' is given twice in %s; expected once", fields[i].key, key);
        seen[i] = true;
        if (!compare_value(compare, yaml_document_get_node(compare->document, pair->value), &fields[i].value,
                           fields[i].key))
            return false;
    }
    for (int i = 0; fields[i].key; i++)
        if (!seen[i] && !(fields[i].value.flags & CYAML_FLAG_OPTIONAL))
            return wrong(compare, node, "key '%s' is missing in %s", fields[i].key, key);
    return true;
}

static bool compare_sequence(const compare_t *compare, const yaml_node_t *node, const cyaml_schema_value_t *schema,
                             const char *key)
{
    char shown[SHOWN];
    if (node->type != YAML_SEQUENCE_NODE)
        return wrong(compare, node, "%s is %s; expected a list, each entry beginning with '-'", key,
                     found(node, shown));
    const size_t count = (size_t)(node->data.sequence.items.top - node->data.sequence.items.start);
    if (count < schema->sequence.min)
        return wrong(compare, node, "%s is an empty list; expected at least one entry", key);
    for (size_t i = 0; i < count; i++) {
        const yaml_node_t *item = yaml_document_get_node(compare->document, node->data.sequence.items.start[i]);
        if (i >= schema->sequence.max)
            return wrong(compare, item, "%s has %zu entries; expected at most %u", key, count, schema->sequence.max);
        char name[32];
        snprintf(name, sizeof name, "%s[%zu]", key, i);
        if (!compare_value(compare, item, schema->sequence.entry, name))
            return false;
    }
    return true;
}

/* The depth of this recursion is the schema's. */
static bool compare_value(const compare_t *compare, const yaml_node_t *node, const cyaml_schema_value_t *schema,
                          const char *key)
{
    switch (schema->type) {
    case CYAML_MAPPING: return compare_mapping(compare, node, schema, key);
    case CYAML_SEQUENCE: return compare_sequence(compare, node, schema, key);
    default: return compare_scalar(compare, node, schema, key);
    }
}

bool cm1e_busfile_compare(yaml_document_t *document, const cyaml_schema_value_t *schema,
                          cm1e_config_problem_t *problem)
{
    const compare_t compare = {.document = document, .problem = problem};
    return compare_value(&compare, yaml_document_get_root_node(document), schema, "the file");
}
