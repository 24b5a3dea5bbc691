#include <stdlib.h>

#include "cm1e/generate.h"

void cm1e_file_free(cm1e_file_t *file)
{
    free(file->bytes);
    *file = (cm1e_file_t){0};
}
