/* How far words are from each other, and which one was meant. */
#include <stdio.h>
#include <string.h>

#include "core/near.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static void test_distances_are_those_of_damerau_and_levenshtein(void)
{
    static const struct {
        const char *a, *b;
        size_t distance;
    } cases[] = {
        {"", "", 0}, {"", "abc", 3}, {"scan", "scan", 0}, {"Scan", "sCAN", 0}, {"sacn", "scan", 1}, {"scn", "scan", 1},
        {"scann", "scan", 1}, {"scat", "scan", 1}, {"kitten", "sitting", 3}, {"ca", "abc", 3}, {"ab", "ba", 1},
        {"abcd", "badc", 2}, {"velocty", "velocity", 1}, {"acceleraiton", "acceleration", 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        TEST_ASSERT_EQUAL_size_t_MESSAGE(cases[i].distance, cm1e_edit_distance(cases[i].a, cases[i].b), cases[i].a);
        TEST_ASSERT_EQUAL_size_t_MESSAGE(cases[i].distance, cm1e_edit_distance(cases[i].b, cases[i].a), cases[i].a);
    }
}

static void test_long_words_are_bounded(void)
{
    char word[5000];
    memset(word, 'x', sizeof word - 1);
    word[sizeof word - 1] = '\0';
    TEST_ASSERT_EQUAL_size_t(63, cm1e_edit_distance(word, ""));
    TEST_ASSERT_EQUAL_size_t(0, cm1e_edit_distance(word, word));
}

static const char *nearest(const char *word)
{
    static const char *const words[] = {"scan", "status", "sdo", "cml", "move", "home", "generate", "explain"};
    cm1e_near_t near = {.word = word};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        cm1e_near_look(&near, words[i]);
    return near.nearest;
}

static void test_the_nearest_word_is_what_was_meant(void)
{
    TEST_ASSERT_EQUAL_STRING("scan", nearest("sacn"));
    TEST_ASSERT_EQUAL_STRING("status", nearest("sttaus"));
    TEST_ASSERT_EQUAL_STRING("status", nearest("stat"));
    TEST_ASSERT_EQUAL_STRING("generate", nearest("gen"));
    TEST_ASSERT_EQUAL_STRING("generate", nearest("genrtae"));
    TEST_ASSERT_EQUAL_STRING("move", nearest("MOVE"));
    TEST_ASSERT_NULL(nearest("firmware"));
    TEST_ASSERT_NULL(nearest("x"));
    TEST_ASSERT_NULL(nearest(""));
}

static void test_texts_name_what_was_meant_or_nothing(void)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = "sacn"};
    TEST_ASSERT_EQUAL_STRING("", cm1e_near_text(&near, text, sizeof text));
    cm1e_near_look(&near, "scan");
    TEST_ASSERT_EQUAL_STRING("; did you mean \"scan\"?", cm1e_near_text(&near, text, sizeof text));
}

/** Of paths the parts that are right do not count: a wrong last part is near its own kind only, however long the path. */
static void test_paths_are_compared_behind_the_parts_that_are_right(void)
{
    static const char path[] = "Main.a_cell_with_a_long_name.another_part_of_the_machine[2].power.";
    char word[120], wrong[120], near_one[120], text[CM1E_NEAR_TEXT_BYTES], longest[300];
    snprintf(word, sizeof word, "%sStatsu", path);
    snprintf(wrong, sizeof wrong, "%sEnable", path);
    snprintf(near_one, sizeof near_one, "%sStatus", path);
    cm1e_near_t near = {.word = word};
    cm1e_near_look(&near, wrong);
    TEST_ASSERT_NULL(near.nearest);
    cm1e_near_look(&near, near_one);
    TEST_ASSERT_EQUAL_STRING(near_one, near.nearest);
    TEST_ASSERT_NOT_NULL(strstr(cm1e_near_text(&near, text, sizeof text), near_one));
    cm1e_near_t other = {.word = "Mian.goal"};
    cm1e_near_look(&other, "Main.goal");
    TEST_ASSERT_EQUAL_STRING("Main.goal", other.nearest);
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    TEST_ASSERT_EQUAL_STRING("", cm1e_near_text(&(cm1e_near_t){.word = "x", .nearest = longest}, text, sizeof text));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_distances_are_those_of_damerau_and_levenshtein);
    RUN_TEST(test_long_words_are_bounded);
    RUN_TEST(test_the_nearest_word_is_what_was_meant);
    RUN_TEST(test_paths_are_compared_behind_the_parts_that_are_right);
    RUN_TEST(test_texts_name_what_was_meant_or_nothing);
    return UNITY_END();
}
