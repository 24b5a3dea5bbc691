#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "generate/ec_extend.h"
#include "generate/xml_read.h"
#include "generate/xml_write.h"

static void put_comment(cm1e_xml_writer_t *writer, const xmlNode *node)
{
    char *comment = (char *)xmlNodeGetContent(node);
    const char *begin = comment ? comment : "";
    while (isspace((unsigned char)*begin))
        begin++;
    size_t length = strlen(begin);
    while (length > 0 && isspace((unsigned char)begin[length - 1]))
        length--;
    if (comment)
        comment[begin - comment + (ptrdiff_t)length] = '\0';
    cm1e_xml_put_comment(writer, begin);
    xmlFree(comment);
}

static void put_node(cm1e_xml_writer_t *writer, const xmlNode *node, cm1e_xml_reader_t *reader)
{
    if (node->type == XML_COMMENT_NODE)
        put_comment(writer, node);
    if (node->type != XML_ELEMENT_NODE)
        return;
    cm1e_xml_open(writer, (const char *)node->name);
    for (const xmlAttr *attribute = node->properties; attribute; attribute = attribute->next) {
        const char *name = (const char *)attribute->name;
        xmlChar *value = xmlGetNoNsProp(node, attribute->name);
        cm1e_xml_put_attribute(writer, name, "%s", value ? (const char *)value : "");
        xmlFree(value);
    }
    bool has_children = false;
    for (const xmlNode *child = node->children; child; child = child->next) {
        has_children = has_children || child->type != XML_TEXT_NODE;
        put_node(writer, child, reader);
    }
    const char *text = has_children ? "" : cm1e_xml_text(reader, node);
    if (*text)
        cm1e_xml_put_text(writer, "%s", text);
    cm1e_xml_close(writer);
}

cm1e_error_t cm1e_ec_extend_write(cm1e_file_t *out, const cm1e_ec_extend_t *document, cm1e_diag_t *diag)
{
    cm1e_arena_t texts = {0};
    cm1e_xml_reader_t reader = {.arena = &texts};
    cm1e_xml_writer_t writer;
    cm1e_xml_begin(&writer);
    for (const xmlNode *node = document->doc->children; node; node = node->next)
        put_node(&writer, node, &reader);
    writer.failed = writer.failed || texts.failed;
    cm1e_arena_free(&texts);
    if (document->warning)
        snprintf(out->warning, sizeof out->warning, "%s", document->warning);
    return cm1e_xml_finish(&writer, out, diag);
}
