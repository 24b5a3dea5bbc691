/* Handles: a place and a count of its uses; who finds an object finds the handle in it. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include <unity.h>

#include "core/handle.h"

enum { PLACES = 4, ROUNDS = 200000 };

typedef struct object {
    uint16_t handle;
} object_t;

static cm1e_handle_table_t places;
static object_t objects[PLACES + 1];

void setUp(void)
{
    memset(&places, 0, sizeof places);
}

void tearDown(void) {}

static object_t *find(uint16_t handle)
{
    object_t *object = cm1e_handle_object(&places, handle);
    return object && object->handle == handle ? object : NULL;
}

static bool take(object_t *object) { return cm1e_handle_take(&places, PLACES, object, &object->handle); }

static void test_every_object_is_found_by_its_own_handle_until_the_table_is_full(void)
{
    for (int i = 0; i < PLACES; i++)
        TEST_ASSERT_TRUE(take(&objects[i]));
    objects[PLACES].handle = 77;
    TEST_ASSERT_FALSE(take(&objects[PLACES]));
    TEST_ASSERT_EQUAL_HEX16(0, objects[PLACES].handle);
    for (int i = 0; i < PLACES; i++)
        TEST_ASSERT_EQUAL_PTR(&objects[i], find(objects[i].handle));
    for (unsigned handle = 0; handle <= UINT16_MAX; handle++) {
        unsigned owner = PLACES;
        for (unsigned i = 0; i < PLACES; i++)
            owner = objects[i].handle == handle ? i : owner;
        TEST_ASSERT_EQUAL_PTR(owner < PLACES ? &objects[owner] : NULL, find((uint16_t)handle));
    }
}

/** The next so many objects, one after the other, are not found by the handle of this one; the one behind them is. */
static void check_kept_handle(int further)
{
    TEST_ASSERT_TRUE(take(&objects[0]));
    const uint16_t kept = objects[0].handle;
    for (int i = 0; i < further; i++) {
        cm1e_handle_give_back(&places, objects[0].handle);
        TEST_ASSERT_NULL(find(kept));
        TEST_ASSERT_TRUE(take(&objects[0]));
        TEST_ASSERT_NOT_EQUAL(0, objects[0].handle >> CM1E_HANDLE_PLACE_BITS);
        TEST_ASSERT_NULL(find(kept));
        TEST_ASSERT_EQUAL_PTR(&objects[0], find(objects[0].handle));
    }
    cm1e_handle_give_back(&places, objects[0].handle);
    TEST_ASSERT_TRUE(take(&objects[0]));
    TEST_ASSERT_EQUAL_HEX16(kept, objects[0].handle);
}

static void test_a_handle_that_is_kept_names_none_for_126_further_uses_of_the_only_free_place(void)
{
    for (int i = 1; i < PLACES; i++)
        TEST_ASSERT_TRUE(take(&objects[i]));
    check_kept_handle(126);
}

static void test_a_handle_that_is_kept_names_none_for_127_uses_of_each_free_place(void)
{
    check_kept_handle(PLACES * 127 - 1);
}

static void test_a_count_of_uses_that_begins_anew_makes_no_handle_0(void)
{
    places.uses[0] = UINT32_MAX - 1;
    for (int i = 1; i < PLACES; i++)
        places.uses[i] = UINT32_MAX;
    for (int i = 0; i < 3 * PLACES; i++) {
        TEST_ASSERT_TRUE(take(&objects[0]));
        TEST_ASSERT_NOT_EQUAL(0, objects[0].handle >> CM1E_HANDLE_PLACE_BITS);
        cm1e_handle_give_back(&places, objects[0].handle);
    }
}

/* ---- threads ----------------------------------------------------------------------------------------------------- */

static atomic_bool ended;
static atomic_uint unwritten;

/** Looks at every place all the time: who finds an object there finds its handle written. */
static void *watch(void *unused)
{
    while (!ended)
        for (unsigned i = 0; i < PLACES; i++) {
            const object_t *object = cm1e_handle_object(&places, (uint16_t)(1u << CM1E_HANDLE_PLACE_BITS | i));
            if (object && cm1e_handle_place(object->handle) != i)
                unwritten++;
        }
    return unused;
}

/** Objects that are never used again, as those of the library are made by calloc(). */
static void *take_and_give_back(void *rounds)
{
    object_t *made = rounds;
    for (int n = 0; n < ROUNDS; n++) {
        made[n].handle = UINT16_MAX;
        if (take(&made[n]))
            cm1e_handle_give_back(&places, made[n].handle);
    }
    return NULL;
}

static void test_an_object_is_found_only_when_its_handle_is_written(void)
{
    object_t *made[2] = {calloc(ROUNDS, sizeof(object_t)), calloc(ROUNDS, sizeof(object_t))};
    pthread_t watcher, takers[2];
    TEST_ASSERT_EQUAL_INT(0, pthread_create(&watcher, NULL, watch, NULL));
    for (int i = 0; i < 2; i++)
        TEST_ASSERT_EQUAL_INT(0, pthread_create(&takers[i], NULL, take_and_give_back, made[i]));
    for (int i = 0; i < 2; i++)
        pthread_join(takers[i], NULL);
    ended = true;
    pthread_join(watcher, NULL);
    TEST_ASSERT_EQUAL_UINT(0, unwritten);
    for (int i = 0; i < PLACES; i++)
        TEST_ASSERT_NULL(places.objects[i]);
    free(made[0]);
    free(made[1]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_object_is_found_by_its_own_handle_until_the_table_is_full);
    RUN_TEST(test_a_handle_that_is_kept_names_none_for_126_further_uses_of_the_only_free_place);
    RUN_TEST(test_a_handle_that_is_kept_names_none_for_127_uses_of_each_free_place);
    RUN_TEST(test_a_count_of_uses_that_begins_anew_makes_no_handle_0);
    RUN_TEST(test_an_object_is_found_only_when_its_handle_is_written);
    return UNITY_END();
}
