/**
 * @file c_locale.h
 * Numbers with a decimal point, whatever locale the program has chosen: printf() and strtod() follow that of the
 * thread, so under a German one 1.5 would be read as 1, and written as 1,5.
 */
#ifndef CM1E_CORE_C_LOCALE_H
#define CM1E_CORE_C_LOCALE_H

#include <locale.h>
#include <stdbool.h>

typedef struct c_locale {
    locale_t own, callers;
} c_locale_t;

/** The thread has the C locale from here to the end. false: no memory, and nothing has changed. */
static inline bool cm1e_c_locale_begin(c_locale_t *locale)
{
    locale->own = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (locale->own == (locale_t)0)
        return false;
    locale->callers = uselocale(locale->own);
    return true;
}

static inline void cm1e_c_locale_end(const c_locale_t *locale)
{
    uselocale(locale->callers);
    freelocale(locale->own);
}

#endif
