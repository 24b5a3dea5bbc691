#include "generate/xml_read.h"

#include <ctype.h>
#include <errno.h>
#include <libxml/SAX2.h>
#include <libxml/parser.h>
#include <libxml/parserInternals.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What stops the parser from outside XML's own rules. */
typedef struct guard {
    unsigned elements;
    const char *refused; /* why, NULL: not refused */
    int line;
} guard_t;

static void refuse(xmlParserCtxt *context, const char *why)
{
    guard_t *guard = context->_private;
    if (!guard->refused) {
        guard->refused = why;
        guard->line = context->input ? context->input->line : 0;
    }
    xmlStopParser(context);
}

/* A DTD is where entities come from, and external files; none of the formats has one. */
static void on_dtd(void *context, const xmlChar *name, const xmlChar *external, const xmlChar *system)
{
    (void)name, (void)external, (void)system;
    refuse(context, "a DTD (<!DOCTYPE ...>) is not allowed here");
}

static void on_element(void *context, const xmlChar *name, const xmlChar *prefix, const xmlChar *uri, int namespaces,
                       const xmlChar **namespace_list, int attributes, int defaulted, const xmlChar **attribute_list)
{
    guard_t *guard = ((xmlParserCtxt *)context)->_private;
    if (++guard->elements > CM1E_XML_MAX_ELEMENTS)
        refuse(context, "more elements than any such file has");
    else
        xmlSAX2StartElementNs(context, name, prefix, uri, namespaces, namespace_list, attributes, defaulted,
                              attribute_list);
}

static const char *find(const char *text, size_t size, const char *what)
{
    return memmem(text, size, what, strlen(what));
}

/* Files of Trio's tools have comments before the XML declaration, where XML allows nothing. Returns where the document
 * begins; `*lines` is how many lines stand before it. */
static size_t skip_before_declaration(const char *text, size_t size, int *lines)
{
    static const char bom[] = "\xEF\xBB\xBF";
    size_t at = size >= 3 && memcmp(text, bom, 3) == 0 ? 3 : 0;
    *lines = 0;
    for (;;) {
        while (at < size && isspace((unsigned char)text[at]))
            at++;
        if (size - at < 4 || memcmp(text + at, "<!--", 4) != 0)
            break;
        const char *end = find(text + at, size - at, "-->");
        if (!end)
            break;
        at = (size_t)(end - text) + 3;
    }
    if (size - at < 5 || memcmp(text + at, "<?xml", 5) != 0)
        return 0; /* no declaration behind them: they are where XML allows them */
    for (size_t i = 0; i < at; i++)
        *lines += text[i] == '\n';
    return at;
}

/* The comments that were skipped stand before the root then, where XML allows them: nothing of a file is lost. */
static void keep_comments(xmlDoc *doc, const char *text, size_t skipped)
{
    for (const char *at = text; (at = memmem(at, skipped - (size_t)(at - text), "<!--", 4)) != NULL;) {
        const char *end = memmem(at, skipped - (size_t)(at - text), "-->", 3);
        const int length = end > at + 4 ? (int)(end - at) - 4 : 0;
        xmlChar *content = xmlStrndup((const xmlChar *)at + 4, length);
        xmlNode *comment = content ? xmlNewDocComment(doc, content) : NULL;
        if (comment)
            xmlAddPrevSibling(xmlDocGetRootElement(doc), comment);
        xmlFree(content);
        at = end + 3;
    }
}

static void report(cm1e_diag_t *diag, const guard_t *guard, const xmlError *error, int lines_before)
{
    char text[256];
    if (guard->refused) {
        cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "line %d: %s", guard->line, guard->refused);
        return;
    }
    (void)lines_before;
    snprintf(text, sizeof text, "%s", error && error->message ? error->message : "no XML document");
    text[strcspn(text, "\n")] = '\0';
    cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "line %d: %s", error ? error->line : 1, text);
}

xmlDoc *cm1e_xml_parse(const void *bytes, size_t size, cm1e_diag_t *diag)
{
    if (size > CM1E_XML_MAX_BYTES) {
        cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "the file has %zu bytes; more than %zu are not read", size,
                      CM1E_XML_MAX_BYTES);
        return NULL;
    }
    int lines = 0;
    const size_t skipped = skip_before_declaration(bytes, size, &lines);
    xmlParserCtxt *context = size > skipped ? xmlCreateMemoryParserCtxt((const char *)bytes + skipped,
                                                                        (int)(size - skipped))
                                            : NULL;
    if (!context) {
        cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, size > 0 ? "out of memory" : "the file is empty");
        return NULL;
    }
    guard_t guard = {0};
    context->_private = &guard;
    context->sax->internalSubset = on_dtd;
    context->sax->startElementNs = on_element;
    context->input->line += lines;
    xmlCtxtUseOptions(context, XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_NOCDATA |
                                   XML_PARSE_BIG_LINES);
    xmlParseDocument(context);
    xmlDoc *doc = context->myDoc;
    if (!context->wellFormed || guard.refused || !doc || !xmlDocGetRootElement(doc)) {
        report(diag, &guard, xmlCtxtGetLastError(context), lines);
        xmlFreeDoc(doc);
        doc = NULL;
    }
    if (doc)
        keep_comments(doc, bytes, skipped);
    xmlFreeParserCtxt(context);
    return doc;
}

void cm1e_xml_fail(cm1e_xml_reader_t *reader, const xmlNode *node, const char *format, ...)
{
    char text[400];
    va_list arguments;
    if (reader->failed)
        return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    cm1e_diag_set(reader->diag, CM1E_ERROR_FILE, 0, "line %u: %s", (unsigned)cm1e_xml_line(node), text);
    reader->failed = true;
}

cm1e_place_t cm1e_xml_line(const xmlNode *node)
{
    const long line = node ? xmlGetLineNo((xmlNode *)(uintptr_t)node) : 0;
    return line > 0 ? (cm1e_place_t)line : 0;
}

bool cm1e_xml_is(const xmlNode *node, const char *name)
{
    return node && node->type == XML_ELEMENT_NODE && strcmp((const char *)node->name, name) == 0;
}

static const xmlNode *first_element(const xmlNode *node, const char *name)
{
    while (node && !(node->type == XML_ELEMENT_NODE && (!name || cm1e_xml_is(node, name))))
        node = node->next;
    return node;
}

const xmlNode *cm1e_xml_child(const xmlNode *parent, const char *name)
{
    return parent ? first_element(parent->children, name) : NULL;
}

const xmlNode *cm1e_xml_next(const xmlNode *node, const char *name)
{
    return node ? first_element(node->next, name) : NULL;
}

const xmlNode *cm1e_xml_need(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name)
{
    const xmlNode *child = cm1e_xml_child(parent, name);
    if (parent && !child)
        cm1e_xml_fail(reader, parent, "<%s> has no <%s>", (const char *)parent->name, name);
    return child;
}

static const char *trimmed(cm1e_xml_reader_t *reader, xmlChar *content)
{
    const char *begin = content ? (const char *)content : "";
    while (isspace((unsigned char)*begin))
        begin++;
    size_t length = strlen(begin);
    while (length > 0 && isspace((unsigned char)begin[length - 1]))
        length--;
    char *copy = cm1e_arena_take(reader->arena, length + 1);
    const bool copied = !reader->arena->failed;
    if (copied)
        memcpy(copy, begin, length);
    xmlFree(content);
    return copied ? copy : "";
}

const char *cm1e_xml_text(cm1e_xml_reader_t *reader, const xmlNode *node)
{
    return node ? trimmed(reader, xmlNodeGetContent(node)) : NULL;
}

const char *cm1e_xml_child_text(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name,
                                const char *fallback)
{
    const xmlNode *child = cm1e_xml_child(parent, name);
    return child ? cm1e_xml_text(reader, child) : fallback;
}

const char *cm1e_xml_attribute(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name)
{
    xmlChar *value = node ? xmlGetNoNsProp(node, (const xmlChar *)name) : NULL;
    return value ? trimmed(reader, value) : NULL;
}

static bool parse_number(const char *text, int64_t *value)
{
    const bool hexadecimal = (text[0] == '#' || text[0] == '0') && (text[1] == 'x' || text[1] == 'X');
    const char *digits = hexadecimal ? text + 2 : text + (*text == '-' || *text == '+');
    char *end;
    if (!(hexadecimal ? isxdigit((unsigned char)*digits) : isdigit((unsigned char)*digits)))
        return false;
    errno = 0;
    *value = hexadecimal ? (int64_t)strtoull(digits, &end, 16) : strtoll(text, &end, 10);
    return errno == 0 && *end == '\0';
}

static int64_t checked_number(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name, const char *text,
                              int64_t minimum, int64_t maximum, int64_t fallback)
{
    int64_t value;
    if (!parse_number(text, &value))
        cm1e_xml_fail(reader, node, "%s is \"%.60s\", which is no number: 26, #x1A and 0x1A are", name, text);
    else if (value < minimum || value > maximum)
        cm1e_xml_fail(reader, node, "%s is %.60s, outside %lld ... %lld", name, text, (long long)minimum,
                      (long long)maximum);
    else
        return value;
    return fallback;
}

int64_t cm1e_xml_number(cm1e_xml_reader_t *reader, const xmlNode *node, int64_t minimum, int64_t maximum,
                        int64_t fallback)
{
    if (!node)
        return fallback;
    return checked_number(reader, node, (const char *)node->name, cm1e_xml_text(reader, node), minimum, maximum,
                          fallback);
}

int64_t cm1e_xml_child_number(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name, int64_t minimum,
                              int64_t maximum, int64_t fallback)
{
    return cm1e_xml_number(reader, cm1e_xml_child(parent, name), minimum, maximum, fallback);
}

int64_t cm1e_xml_attribute_number(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name, int64_t minimum,
                                  int64_t maximum, int64_t fallback)
{
    const char *text = cm1e_xml_attribute(reader, node, name);
    return text ? checked_number(reader, node, name, text, minimum, maximum, fallback) : fallback;
}

static bool parse_flag(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name, const char *text,
                       bool fallback)
{
    if (strcmp(text, "1") == 0 || strcasecmp(text, "true") == 0)
        return true;
    if (strcmp(text, "0") == 0 || strcasecmp(text, "false") == 0)
        return false;
    cm1e_xml_fail(reader, node, "%s is \"%.60s\"; true, false, 1 and 0 are allowed", name, text);
    return fallback;
}

bool cm1e_xml_attribute_flag(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name, bool fallback)
{
    const char *text = cm1e_xml_attribute(reader, node, name);
    return text ? parse_flag(reader, node, name, text, fallback) : fallback;
}

bool cm1e_xml_child_flag(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name, bool fallback)
{
    const xmlNode *child = cm1e_xml_child(parent, name);
    return child ? parse_flag(reader, child, name, cm1e_xml_text(reader, child), fallback) : fallback;
}

static int hex_digit(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

cm1e_bytes_t cm1e_xml_hex(cm1e_xml_reader_t *reader, const xmlNode *node)
{
    const char *text = cm1e_xml_text(reader, node);
    uint8_t *bytes = text && *text ? cm1e_arena_take(reader->arena, strlen(text) / 2 + 1) : NULL;
    size_t digits = 0;
    if (!bytes || reader->arena->failed)
        return (cm1e_bytes_t){0};
    for (; *text; text++) {
        const int digit = hex_digit(*text);
        if (isspace((unsigned char)*text))
            continue;
        if (digit < 0) {
            cm1e_xml_fail(reader, node, "%s is not hexadecimal bytes: \"%.20s\"", (const char *)node->name, text);
            return (cm1e_bytes_t){0};
        }
        bytes[digits / 2] = (uint8_t)(bytes[digits / 2] << 4 | digit);
        digits++;
    }
    if (digits % 2) {
        cm1e_xml_fail(reader, node, "%s has an odd number of hexadecimal digits", (const char *)node->name);
        return (cm1e_bytes_t){0};
    }
    return (cm1e_bytes_t){bytes, digits / 2};
}
