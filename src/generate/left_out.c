#include "generate/left_out.h"

#include <stdio.h>
#include <string.h>

#include "generate/xml_read.h"

/* Names are few in real files; a file with more is compared as far as they go. */
enum { NAMES_MAX = 512, NAME_ROOM = 70, REST_ROOM = 40 };

/** An element, or an attribute, by its name and that of its parent. In one document equal names have one address. */
typedef struct name {
    const xmlChar *parent, *own;
    bool attribute;
} name_t;

typedef struct names {
    name_t at[NAMES_MAX];
    size_t count;
} names_t;

static bool add(names_t *names, const name_t *name)
{
    for (size_t i = 0; i < names->count; i++)
        if (names->at[i].own == name->own && names->at[i].parent == name->parent &&
            names->at[i].attribute == name->attribute)
            return false;
    if (names->count < NAMES_MAX)
        names->at[names->count++] = *name;
    return true;
}

static bool has(const names_t *names, const name_t *name)
{
    for (size_t i = 0; i < names->count; i++)
        if (names->at[i].attribute == name->attribute && xmlStrEqual(names->at[i].own, name->own) &&
            xmlStrEqual(names->at[i].parent, name->parent))
            return true;
    return false;
}

static name_t name_of(const xmlNode *node)
{
    const bool is_root = !node->parent || node->parent->type != XML_ELEMENT_NODE;
    return (name_t){is_root ? NULL : node->parent->name, node->name, false};
}

/** The element behind a node and, with `into`, its children; NULL: it was the last one of the document. */
static const xmlNode *behind(const xmlNode *node, const xmlNode *root, bool into)
{
    const xmlNode *next = into ? cm1e_xml_child(node, NULL) : NULL;
    while (!next && node && node != root) {
        next = cm1e_xml_next(node, NULL);
        node = node->parent;
    }
    return next;
}

/** Adds the names of a document that `known` (NULL: none) does not have. What stands in an unknown element is not
 *  looked at, where there are known ones. */
static void collect(names_t *names, const xmlNode *root, const names_t *known)
{
    bool into;
    for (const xmlNode *node = root; node && names->count < NAMES_MAX; node = behind(node, root, into)) {
        const name_t name = name_of(node);
        into = !known || has(known, &name);
        if (!known || !into)
            add(names, &name);
        for (const xmlAttr *attribute = node->properties; attribute && into; attribute = attribute->next) {
            const name_t own = {node->name, attribute->name, true};
            if (!known || !has(known, &own))
                add(names, &own);
        }
    }
}

static void warn(cm1e_file_t *file, const names_t *missing)
{
    char *const text = file->warning;
    size_t used = strlen(text), told = 0;
    if (used + NAME_ROOM + REST_ROOM > sizeof file->warning)
        return;
    used += (size_t)snprintf(text + used, NAME_ROOM, "%sthe new file does not have", used ? "; " : "");
    while (told < missing->count && used + NAME_ROOM + REST_ROOM < sizeof file->warning) {
        const name_t *name = &missing->at[told];
        used += (size_t)snprintf(text + used, NAME_ROOM, "%s %.30s/%s%.30s", told ? "," : "",
                                 name->parent ? (const char *)name->parent : "", name->attribute ? "@" : "",
                                 (const char *)name->own);
        told++;
    }
    if (told < missing->count)
        snprintf(text + used, sizeof file->warning - used, " and %zu more", missing->count - told);
}

void cm1e_warn_of_left_out(cm1e_file_t *file, const void *bytes, size_t size)
{
    xmlDoc *before = cm1e_xml_parse(bytes, size, NULL), *now = cm1e_xml_parse(file->bytes, file->size, NULL);
    names_t present = {.count = 0}, missing = {.count = 0};
    if (before && now) {
        collect(&present, xmlDocGetRootElement(now), NULL);
        collect(&missing, xmlDocGetRootElement(before), &present);
    }
    if (missing.count > 0)
        warn(file, &missing);
    xmlFreeDoc(before);
    xmlFreeDoc(now);
}
