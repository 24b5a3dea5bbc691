/**
 * @file esi_read.h
 * What the sources of the ESI reader share.
 */
#ifndef CM1E_GENERATE_ESI_READ_H
#define CM1E_GENERATE_ESI_READ_H

#include "generate/esi.h"
#include "generate/xml_read.h"

/** Things by name, found fast: a hostile file has hundreds of thousands of them. */
typedef struct cm1e_esi_name {
    const char *name;
    size_t number;         /**< of the thing in its list */
} cm1e_esi_name_t;
typedef CM1E_LIST(cm1e_esi_name_t) cm1e_esi_names_t;

void cm1e_esi_names_add(cm1e_xml_reader_t *reader, cm1e_esi_names_t *names, const char *name, size_t number);
/** Call it when all are in. */
void cm1e_esi_names_sort(cm1e_esi_names_t *names);
/** Place of the first of that name; `names->count`: there is none. Others of the same name follow it. */
size_t cm1e_esi_names_find(const cm1e_esi_names_t *names, const char *name);

/** An index with its attribute DependOnSlot (NULL: not wanted); 0 where there is no such element. */
uint16_t cm1e_esi_index(cm1e_xml_reader_t *reader, const xmlNode *node, bool *depends_on_slot);
/** The text of the child of that name in English (LcId 1033), or the first one. */
const char *cm1e_esi_text(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name, const char *fallback);

void cm1e_esi_read_dictionary(cm1e_xml_reader_t *reader, const xmlNode *dictionary, cm1e_type_list_t *types,
                              cm1e_object_list_t *objects);
/** Of a device or a module. */
void cm1e_esi_read_pdos(cm1e_xml_reader_t *reader, const xmlNode *parent, cm1e_pdo_list_t *pdos);
void cm1e_esi_read_init_commands(cm1e_xml_reader_t *reader, const xmlNode *coe, cm1e_init_command_list_t *commands);
/** FMMUs, sync managers, mailbox, clocks, EEPROM. */
void cm1e_esi_read_communication(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_t *device);

#endif
