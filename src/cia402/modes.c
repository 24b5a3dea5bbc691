#include "cia402/cia402.h"

/* UG 6.2; bits as in UG 7.3.27, which lists PP where UG 7.3.4 and 7.3.5 forget it. */
static const cm1e_mode_row_t modes[] = {
    {CM1E_MODE_PP, 0, "PP", "Profile position mode"},
    {CM1E_MODE_PV, 2, "PV", "Profile velocity mode"},
    {CM1E_MODE_HM, 5, "HM", "Homing mode"},
    {CM1E_MODE_CSP, 7, "CSP", "Cyclic synchronous position mode"},
    {CM1E_MODE_CSV, 8, "CSV", "Cyclic synchronous velocity mode"},
};

const cm1e_mode_row_t *cm1e_mode_find(int8_t mode)
{
    for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++)
        if ((int8_t)modes[i].mode == mode)
            return &modes[i];
    return NULL;
}
