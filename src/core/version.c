#include "cm1e/version.h"

#define TEXT_OF(number) #number
#define TEXT(number) TEXT_OF(number)

uint32_t cm1e_version_number(void) { return CM1E_VERSION_NUMBER; }

const char *cm1e_version(void)
{
    return TEXT(CM1E_VERSION_MAJOR) "." TEXT(CM1E_VERSION_MINOR) "." TEXT(CM1E_VERSION_PATCH);
}
