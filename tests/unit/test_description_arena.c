#include <stdint.h>
#include <string.h>

#include "description/arena.h"
#include "unity.h"

static cm1e_arena_t arena;

void setUp(void) { arena = (cm1e_arena_t){0}; }
void tearDown(void) { cm1e_arena_free(&arena); }

typedef struct item {
    uint64_t number;
    char rest[24];
} item_t;
typedef CM1E_LIST(item_t) item_list_t;
typedef struct page {
    char bytes[CM1E_ARENA_SINK];
} page_t;
typedef CM1E_LIST(page_t) page_list_t;

static bool is_zero(const void *memory, size_t size)
{
    const uint8_t *bytes = memory;
    for (size_t i = 0; i < size; i++)
        if (bytes[i] != 0)
            return false;
    return true;
}

/* No arena grows so far: from now on it refuses. */
static void use_up(void)
{
    cm1e_arena_take(&arena, CM1E_ARENA_LIMIT + 1);
    TEST_ASSERT_TRUE(arena.failed);
}

static void test_pieces_are_zeroed_aligned_and_apart(void)
{
    enum { PIECES = 2000 };
    uint8_t *pieces[PIECES];
    size_t sizes[PIECES];
    for (size_t i = 0; i < PIECES; i++) {
        sizes[i] = i % 97;
        pieces[i] = cm1e_arena_take(&arena, sizes[i]);
        TEST_ASSERT_NOT_NULL(pieces[i]);
        TEST_ASSERT_EQUAL_MESSAGE(0, (uintptr_t)pieces[i] % 16, "aligned for anything");
        TEST_ASSERT_TRUE(is_zero(pieces[i], sizes[i]));
        memset(pieces[i], (int)(i % 251) + 1, sizes[i]);
    }
    for (size_t i = 0; i < PIECES; i++)
        for (size_t k = 0; k < sizes[i]; k++)
            TEST_ASSERT_EQUAL_HEX8(i % 251 + 1, pieces[i][k]);
    TEST_ASSERT_FALSE(arena.failed);
}

static void test_a_piece_larger_than_a_block_is_one_piece(void)
{
    enum { LARGE = 1 << 20 };
    uint8_t *before = cm1e_arena_take(&arena, 8);
    uint8_t *large = cm1e_arena_take(&arena, LARGE);
    uint8_t *after = cm1e_arena_take(&arena, 8);
    memset(before, 0xAA, 8);
    memset(large, 0x55, LARGE);
    TEST_ASSERT_TRUE(is_zero(after, 8));
    memset(after, 0xAA, 8);
    TEST_ASSERT_EACH_EQUAL_HEX8(0xAA, before, 8);
    TEST_ASSERT_EACH_EQUAL_HEX8(0x55, large, LARGE);
    TEST_ASSERT_TRUE(arena.used >= LARGE);
    TEST_ASSERT_FALSE(arena.failed);
}

static void test_lists_grow_and_keep_their_items(void)
{
    enum { ITEMS = 100000 };
    item_list_t one = {0}, other = {0};
    for (uint64_t i = 0; i < ITEMS; i++) {
        item_t *item = CM1E_APPEND(&arena, &one);
        TEST_ASSERT_TRUE(is_zero(item, sizeof *item));
        item->number = i;
        memset(item->rest, 0xFF, sizeof item->rest);
        if (i % 3 == 0)
            ((item_t *)CM1E_APPEND(&arena, &other))->number = ~i;
    }
    TEST_ASSERT_EQUAL(ITEMS, one.count);
    TEST_ASSERT_EQUAL((ITEMS + 2) / 3, other.count);
    for (uint64_t i = 0; i < ITEMS; i++)
        TEST_ASSERT_EQUAL_UINT64(i, one.at[i].number);
    for (uint64_t i = 0; i < other.count; i++)
        TEST_ASSERT_EQUAL_UINT64(~(3 * i), other.at[i].number);
    TEST_ASSERT_FALSE(arena.failed);
}

static void test_the_limit_holds_however_it_is_reached(void)
{
    static const size_t sizes[] = {CM1E_ARENA_LIMIT + 1, SIZE_MAX, SIZE_MAX - 7, SIZE_MAX / 2};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        cm1e_arena_take(&arena, 8);
        TEST_ASSERT_FALSE(arena.failed);
        TEST_ASSERT_NOT_NULL(cm1e_arena_take(&arena, sizes[i]));
        TEST_ASSERT_TRUE(arena.failed);
        TEST_ASSERT_TRUE(arena.used <= CM1E_ARENA_LIMIT);
        cm1e_arena_free(&arena);
        TEST_ASSERT_FALSE(arena.failed);
    }
    enum { MEGABYTE = 1 << 20 };
    size_t taken = 0;
    for (; !arena.failed; taken++)
        cm1e_arena_take(&arena, MEGABYTE);
    TEST_ASSERT_EQUAL(CM1E_ARENA_LIMIT / MEGABYTE + 1, taken);
    TEST_ASSERT_EQUAL(CM1E_ARENA_LIMIT, arena.used);
}

static void test_a_list_stops_at_the_limit(void)
{
    page_list_t pages = {0};
    size_t appended = 0;
    for (; !arena.failed && appended <= CM1E_ARENA_LIMIT / sizeof(page_t); appended++)
        (void)CM1E_APPEND(&arena, &pages);
    TEST_ASSERT_TRUE(arena.failed);
    TEST_ASSERT_EQUAL(appended - 1, pages.count); /* the last one went into the sink */
    for (size_t i = 0; i < pages.count; i++)
        TEST_ASSERT_EQUAL(0, pages.at[i].bytes[0]);
}

static void test_what_is_asked_for_after_a_failure_goes_into_the_sink(void)
{
    const uint8_t *kept = cm1e_arena_bytes(&arena, "kept", 5);
    item_list_t list = {0};
    ((item_t *)CM1E_APPEND(&arena, &list))->number = 1;
    use_up();
    for (int i = 0; i < 100; i++) {
        uint8_t *sunk = cm1e_arena_take(&arena, CM1E_ARENA_SINK);
        TEST_ASSERT_NOT_NULL(sunk);
        memset(sunk, 0xFF, CM1E_ARENA_SINK);
        item_t *item = CM1E_APPEND(&arena, &list);
        TEST_ASSERT_TRUE(item < list.at || item >= list.at + 4);
        memset(item, 0xFF, sizeof *item);
    }
    TEST_ASSERT_EQUAL(1, list.count);
    TEST_ASSERT_EQUAL(1, list.at[0].number);
    TEST_ASSERT_EQUAL_STRING("kept", (const char *)kept);
    TEST_ASSERT_NULL(cm1e_arena_bytes(&arena, "x", 1));
    TEST_ASSERT_EQUAL_STRING("", cm1e_arena_text(&arena, "lost"));
    TEST_ASSERT_EQUAL_STRING("", cm1e_arena_format(&arena, "%d", 5));
    TEST_ASSERT_NULL(cm1e_arena_text(&arena, NULL));
    TEST_ASSERT_TRUE(arena.failed);
}

static void test_an_empty_list_that_cannot_grow_stays_empty(void)
{
    item_list_t list = {0};
    use_up();
    item_t *item = CM1E_APPEND(&arena, &list);
    TEST_ASSERT_NOT_NULL(item);
    item->number = 7;
    TEST_ASSERT_EQUAL(0, list.count);
    TEST_ASSERT_TRUE(is_zero(CM1E_APPEND(&arena, &list), sizeof *item));
}

static void test_copies_are_copies(void)
{
    char text[] = "abc";
    const char *copy = cm1e_arena_text(&arena, text);
    const uint8_t *bytes = cm1e_arena_bytes(&arena, text, 2);
    text[0] = 'X';
    TEST_ASSERT_EQUAL_STRING("abc", copy);
    TEST_ASSERT_EQUAL('a', bytes[0]);
    TEST_ASSERT_NULL(cm1e_arena_bytes(&arena, text, 0));
    TEST_ASSERT_EQUAL_STRING("", cm1e_arena_text(&arena, ""));
    TEST_ASSERT_NULL(cm1e_arena_text(&arena, NULL));
    TEST_ASSERT_EQUAL_STRING("7 apples", cm1e_arena_format(&arena, "%d %s", 7, "apples"));
    TEST_ASSERT_EQUAL_STRING("", cm1e_arena_format(&arena, "%s", ""));
}

static void test_a_long_text_is_whole(void)
{
    enum { LENGTH = 100000 };
    const char *text = cm1e_arena_format(&arena, "%*d", LENGTH, 5);
    TEST_ASSERT_EQUAL(LENGTH, strlen(text));
    TEST_ASSERT_EQUAL('5', text[LENGTH - 1]);
}

static void test_freed_it_is_as_new(void)
{
    use_up();
    cm1e_arena_free(&arena);
    TEST_ASSERT_EQUAL(0, arena.used);
    TEST_ASSERT_NULL(arena.blocks);
    TEST_ASSERT_EQUAL_STRING("again", cm1e_arena_text(&arena, "again"));
    TEST_ASSERT_FALSE(arena.failed);
    cm1e_arena_free(&arena);
    cm1e_arena_free(&arena);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_pieces_are_zeroed_aligned_and_apart);
    RUN_TEST(test_a_piece_larger_than_a_block_is_one_piece);
    RUN_TEST(test_lists_grow_and_keep_their_items);
    RUN_TEST(test_the_limit_holds_however_it_is_reached);
    RUN_TEST(test_a_list_stops_at_the_limit);
    RUN_TEST(test_what_is_asked_for_after_a_failure_goes_into_the_sink);
    RUN_TEST(test_an_empty_list_that_cannot_grow_stays_empty);
    RUN_TEST(test_copies_are_copies);
    RUN_TEST(test_a_long_text_is_whole);
    RUN_TEST(test_freed_it_is_as_new);
    return UNITY_END();
}
