/** Check, with assertions that cost nothing where they hold. Check's own tell the process that collects the results their
 * place, each by a write to a file: a third of the time of tests that judge every cycle. After a crash Check therefore
 * names the test, and no line. */
#ifndef CM1E_TESTS_QUICK_CHECK_H
#define CM1E_TESTS_QUICK_CHECK_H

#include <check.h>

#undef ck_assert_msg
#define ck_assert_msg(condition, ...) \
    ((condition) ? (void)0 \
                 : _ck_assert_failed(__FILE__, __LINE__, "Assertion '" #condition "' failed", ##__VA_ARGS__))

#endif
