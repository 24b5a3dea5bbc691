#include "cm1e/version.h"

#include <stdio.h>
#include <unity.h>

void setUp(void) {}
void tearDown(void) {}

static void test_the_library_has_the_version_of_its_headers(void)
{
    char text[32];
    snprintf(text, sizeof text, "%d.%d.%d", CM1E_VERSION_MAJOR, CM1E_VERSION_MINOR, CM1E_VERSION_PATCH);
    TEST_ASSERT_EQUAL_STRING(text, cm1e_version());
    TEST_ASSERT_EQUAL_UINT32(CM1E_VERSION_NUMBER, cm1e_version_number());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_library_has_the_version_of_its_headers);
    return UNITY_END();
}
