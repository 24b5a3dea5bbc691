/**
 * @file esi_write.h
 * What the sources of the ESI writer share.
 */
#ifndef CM1E_GENERATE_ESI_WRITE_H
#define CM1E_GENERATE_ESI_WRITE_H

#include "description/description.h"
#include "generate/xml_write.h"

/** <element DependOnSlot="1">#x6040</element> */
void cm1e_esi_put_index(cm1e_xml_writer_t *xml, const char *element, uint16_t index, bool depends_on_slot);

/** Dictionary: the data types that the objects need, then the objects. `scratch` may go afterwards. */
void cm1e_esi_put_dictionary(cm1e_xml_writer_t *xml, cm1e_arena_t *scratch, const cm1e_object_list_t *objects);

#endif
