#include "config/esi_reader.h"

static cm1e_esi_reader_t registered;

void cm1e_esi_register_reader(cm1e_esi_reader_t reader) { registered = reader; }

cm1e_esi_reader_t cm1e_esi_reader(void) { return registered; }
