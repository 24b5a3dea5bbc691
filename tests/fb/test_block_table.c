/* Every block of the table: that it is there at all, that a zeroed struct may be called, what it says without an axis,
 * and what becomes of its command in every state of the axis (docs/blocks/README.md, from fb/interface/classes.md). */
#include <stdlib.h>

#include "axis/axis_api.h"
#include "coupling/coupling.h"
#include "block_table.h"
#include "fb_bench.h"
#include "../support/xorshift.h"

static _Alignas(16) unsigned char memory[4096];

static const block_member_t *member_of(const block_t *block, const char *name)
{
    for (size_t i = 0; i < block->member_count; i++)
        if (strcmp(block->members[i].name, name) == 0)
            return &block->members[i];
    return NULL;
}

static BOOL *flag(const block_t *block, const char *name)
{
    const block_member_t *member = member_of(block, name);
    return member ? memory + member->offset : NULL;
}

static WORD error_id(const block_t *block) { return *(WORD *)(memory + member_of(block, "ErrorID")->offset); }

/** Execute or Enable. NULL: the block has neither. */
static BOOL *trigger(const block_t *block)
{
    BOOL *execute = flag(block, "Execute");
    return execute ? execute : flag(block, "Enable");
}

static void clear(const block_t *block)
{
    ck_assert_msg(block->size <= sizeof memory, "%s has %zu bytes", block->name, block->size);
    memset(memory, 0, sizeof memory);
}

/* ---- without an axis ------------------------------------------------------------------------------------------- */

START_TEST(test_every_name_is_there_once_and_every_member_inside)
{
    ck_assert_uint_gt(block_count, 50);
    for (size_t i = 0; i < block_count; i++) {
        for (size_t k = 0; k < i; k++)
            ck_assert_str_ne(block_table[i].name, block_table[k].name);
        for (size_t m = 0; m < block_table[i].member_count; m++) {
            const block_member_t *member = &block_table[i].members[m];
            ck_assert_uint_le(member->offset + member->size, block_table[i].size);
        }
    }
}
END_TEST

/** A scan in which nothing is asked for: no output of any kind, but for blocks that look at their inputs only. */
START_TEST(test_zeroed_block_does_nothing)
{
    for (size_t i = 0; i < block_count; i++) {
        const block_t *block = &block_table[i];
        clear(block);
        for (int scan = 0; scan < 3; scan++)
            block->call(memory);
        for (size_t m = 0; m < block->member_count; m++) {
            const block_member_t *member = &block->members[m];
            if (member->section != BLOCK_OUTPUT || strcmp(member->name, "QU") == 0 || strcmp(member->name, "QD") == 0 ||
                strcmp(block->name, "CTU") == 0 || strcmp(block->name, "CTD") == 0)
                continue; /* a counter with PV = 0 has reached it */
            for (size_t byte = 0; byte < member->size; byte++)
                ck_assert_msg(memory[member->offset + byte] == 0, "%s.%s", block->name, member->name);
        }
        for (size_t byte = block->size; byte < sizeof memory; byte++)
            ck_assert_msg(memory[byte] == 0, "%s writes behind its end", block->name);
    }
}
END_TEST

START_TEST(test_block_without_axis_says_so)
{
    for (size_t i = 0; i < block_count; i++) {
        const block_t *block = &block_table[i];
        clear(block);
        if (!trigger(block))
            continue;
        *trigger(block) = TRUE;
        block->call(memory);
        ck_assert_msg(*flag(block, "Error") && error_id(block), "%s shows no error", block->name);
        ck_assert_msg(!flag(block, "Busy") || !*flag(block, "Busy"), "%s is busy without an axis", block->name);
        *trigger(block) = FALSE;
        block->call(memory);
        ck_assert_msg(!*flag(block, "Error") && !error_id(block), "%s keeps its error", block->name);
    }
}
END_TEST

/* ---- in every state -------------------------------------------------------------------------------------------- */

static const MC_CAM_POINT cam_points[] = {{0, 0, 0, 0}, {5, 1, 0, 0}};
static const MC_CAM_REF cam = {.Points = cam_points, .NumberOfPoints = 2};
static const MC_TP_REF positions = {.NumberOfPairs = 1, .MC_TP_Array = {{200000000, 1}}};
static const MC_TV_REF velocities = {.NumberOfPairs = 2, .MC_TV_Array = {{200000000, 1}, {200000000, 1}}};
static const MC_TA_REF accelerations = {.NumberOfPairs = 3,
                                        .MC_TA_Array = {{100000000, 5}, {100000000, 5}, {100000000, 0}}};

/** Inputs with which a block that may start does start. */
static void fill(const block_t *block)
{
    static const struct {
        const char *name;
        double value;
    } numbers[] = {{"Position", 1}, {"Distance", 0.5}, {"Velocity", 4}, {"EndVelocity", 1}, {"VelocityDiff", 0.5},
                   {"PhaseShift", 0.5}};
    const struct {
        const char *name;
        const void *pointer;
    } pointers[] = {{"Axis", &bench.reference}, {"Slave", &bench.reference}, {"CamTable", &cam},
                    {"Master", &bench.master_reference}, {"Master1", &bench.master_reference},
                    {"Master2", &bench.master_reference},
                    {"TimePosition", &positions}, {"TimeVelocity", &velocities},
                    {"TimeAcceleration", &accelerations}};
    clear(block);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        const block_member_t *member = member_of(block, numbers[i].name);
        if (member && member->section == BLOCK_INPUT && member->type == BLOCK_LREAL)
            memcpy(memory + member->offset, &numbers[i].value, sizeof(double));
    }
    if (strcmp(block->name, "MC_GearInPos") == 0 && bench.master) {
        MC_GearInPos_t *in = (MC_GearInPos_t *)memory;
        cm1e_axis_info_t master;
        cm1e_axis_get(bench.master, &master);
        in->MasterSyncPosition = master.set_position + 2;
        in->SlaveSyncPosition = bench.info.set_position + 1;
        in->Velocity = 30;
    }
    if (strcmp(block->name, "CM_FollowPosition") == 0 && bench.axis)
        ((CM_FollowPosition_t *)memory)->Position = bench.info.set_position;
    if (strcmp(block->name, "MC_CamIn") == 0 && bench.axis) {
        MC_CamIn_t *in = (MC_CamIn_t *)memory;
        (void)cm1e_axis_cam_select(bench.axis, &cam, true, false, true, &in->CamTableID);
        in->StartMode = mcRampIn;
    }
    for (size_t i = 0; i < block->member_count; i++) /* ratios */
        if (block->members[i].type == BLOCK_DINT || strcmp(block->members[i].name, "RatioDenominator") == 0)
            memcpy(memory + block->members[i].offset, &(DINT){1}, sizeof(DINT));
    for (size_t i = 0; i < sizeof pointers / sizeof *pointers; i++) {
        const block_member_t *member = member_of(block, pointers[i].name);
        if (member)
            memcpy(memory + member->offset, &pointers[i].pointer, sizeof(void *));
    }
}

/** By a step of Part 5, after which others may come; while MC_Home runs nothing is taken but MC_Stop. */
static void enter_homing(void)
{
    MC_StepBlock_t step = {.Axis = &bench.reference, .Execute = TRUE, .Velocity = 1, .TorqueLimit = 30};
    MC_StepBlock(&step);
    ck_assert(step.Busy);
}

static void enter_gear(void)
{
    MC_GearIn_t gear = {.Slave = &bench.reference, .Master = &bench.master_reference, .Execute = TRUE,
                        MC_GEARIN_DEFAULTS};
    MC_GearIn(&gear);
    ck_assert_msg(gear.Busy, "%#x", gear.ErrorID);
}

static void enter(cm1e_axis_state_t state)
{
    static const int kind_of[CM1E_AXIS_STATE_COUNT] = {
        [CM1E_AXIS_DISCRETE_MOTION] = ABSOLUTE, [CM1E_AXIS_CONTINUOUS_MOTION] = VELOCITY,
        [CM1E_AXIS_STOPPING] = STOP};
    bench_open_axes(2);
    if (state == CM1E_AXIS_DISABLED)
        return;
    bench_power_on();
    MC_MoveVelocity_t turn = {.Axis = &bench.master_reference, .Execute = TRUE, .Velocity = 1};
    MC_MoveVelocity(&turn);
    scans(100);
    if (state == CM1E_AXIS_ERROR_STOP)
        simulate("error 1 2310");
    else if (state == CM1E_AXIS_HOMING)
        enter_homing();
    else if (state == CM1E_AXIS_SYNCHRONIZED_MOTION)
        enter_gear();
    else if (state != CM1E_AXIS_STANDSTILL)
        bench.execute[0][kind_of[state]] = TRUE;
    if (state != CM1E_AXIS_STANDSTILL)
        SCAN_UNTIL(bench.info.state == state);
    scans(5);
    ck_assert_int_eq(bench.info.state, state);
}

/** FALSE: it is not as the page says; told at once, so that one run tells of all. */
static bool check_rule(const block_t *block, cm1e_axis_state_t state)
{
    const block_rule_t *rule = &block->rules[state];
    const char *name = cm1e_axis_state_name(state);
    enter(state);
    fill(block);
    *trigger(block) = TRUE;
    block->call(memory);
    const WORD expected = rule->unchanged ? error_id(block) : cm1e_error_id(rule->refusal), shown = error_id(block);
    const cm1e_axis_state_t next = rule->unchanged || rule->refusal != CM1E_OK ? state : rule->next;
    scan();
    const bool right = shown == expected && bench.info.state == next;
    if (!right)
        fprintf(stderr, "%s in %s: ErrorID %#x instead of %#x, then %s instead of %s\n", block->name, name, shown, expected,
                cm1e_axis_state_name(bench.info.state), cm1e_axis_state_name(next));
    bench_close();
    return right;
}

/** The way out of a cam, from a gear. */
static bool is_unmet(const block_t *block, cm1e_axis_state_t state)
{
    return state == CM1E_AXIS_SYNCHRONIZED_MOTION && strcmp(block->name, "MC_CamOut") == 0;
}

START_TEST(test_every_block_in_every_state_as_its_page_says)
{
    const cm1e_axis_state_t state = (cm1e_axis_state_t)_i;
    int faults = 0;
    for (size_t i = 0; i < block_count; i++)
        faults += block_table[i].rules && !is_unmet(&block_table[i], state) && !check_rule(&block_table[i], state);
    ck_assert_int_eq(faults, 0);
}
END_TEST

/* ---- anything at the inputs ------------------------------------------------------------------------------------ */

static uint64_t chance_state;

static uint32_t chance(uint32_t below)
{
    return (uint32_t)(xorshift(&chance_state) >> 33) % below;
}

static void random_value(const block_member_t *member)
{
    static const double numbers[] = {0, 1, -1, 0.1, 5, 1e9, -1e9, 1e300, 1e-300, INFINITY, -INFINITY, NAN, 3, -3};
    static const int64_t times[] = {0, -1, 1, 1000000, INT64_MAX, INT64_MIN};
    const double number = numbers[chance(sizeof numbers / sizeof *numbers)];
    const int64_t time = times[chance(sizeof times / sizeof *times)], whole = (int64_t)chance(12) - 2;
    switch (member->type) {
    case BLOCK_LREAL: memcpy(memory + member->offset, &number, sizeof number); break;
    case BLOCK_TIME: memcpy(memory + member->offset, &time, sizeof time); break;
    case BLOCK_BOOL: memory[member->offset] = (unsigned char)chance(2); break;
    case BLOCK_POINTER: break;
    default: memcpy(memory + member->offset, &whole, member->size < sizeof whole ? member->size : sizeof whole);
    }
}

/** Every second input stays one that makes sense. */
static void fill_anyhow(const block_t *block)
{
    fill(block);
    for (size_t i = 0; i < block->member_count; i++)
        if (block->members[i].section == BLOCK_INPUT && chance(2))
            random_value(&block->members[i]);
}

static void check_error_is_on_the_page(const block_t *block, unsigned seed)
{
    const cm1e_error_t *error = block->errors;
    while (*error != CM1E_OK && cm1e_error_id(*error) != error_id(block))
        error++;
    ck_assert_msg(*error != CM1E_OK, "seed %u: the page of %s lacks %#x, %s (state %s)", seed, block->name,
                  error_id(block), cm1e_strerror(cm1e_error_from_id(error_id(block))),
                  cm1e_axis_state_name(bench.info.state));
}

static void check_outputs(const block_t *block, unsigned seed)
{
    static const char *const exclusive[] = {"Done", "CommandAborted", "Error"};
    int results = 0;
    for (size_t i = 0; i < sizeof exclusive / sizeof *exclusive; i++)
        results += flag(block, exclusive[i]) && *flag(block, exclusive[i]);
    ck_assert_msg(results <= 1, "seed %u: %s shows %d results", seed, block->name, results);
    ck_assert_msg(!*flag(block, "Error") == !error_id(block), "seed %u: %s: Error and ErrorID", seed, block->name);
    if (error_id(block) && strcmp(block->name, "MC_Power") != 0) /* it shows any cause of ErrorStop */
        check_error_is_on_the_page(block, seed);
}

enum { RUNS = 40, BLOCKS_OF_A_RUN = 40, SCANS_OF_A_BLOCK = 12 };

START_TEST(test_every_error_is_on_its_page)
{
    const unsigned seed = (unsigned)_i;
    chance_state = (seed + 1) * UINT64_C(0x9E3779B97F4A7C15);
    cm1e_axis_state_t state = (cm1e_axis_state_t)chance(CM1E_AXIS_STATE_COUNT);
    enter(state);
    for (int n = 0; n < BLOCKS_OF_A_RUN; n++) {
        const block_t *block = &block_table[chance((uint32_t)block_count)];
        if (!trigger(block) || strcmp(block->name, "MC_Power") == 0)
            continue;
        fill_anyhow(block);
        for (int k = 0; k < SCANS_OF_A_BLOCK; k++) {
            *trigger(block) = k > 0 && (k < 8 || chance(2));
            block->call(memory);
            check_outputs(block, seed);
            scan();
        }
    }
    bench_close();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("block table");
    TCase *cases = tcase_create("block table");
    tcase_set_timeout(cases, 60);
    tcase_add_test(cases, test_every_name_is_there_once_and_every_member_inside);
    tcase_add_test(cases, test_zeroed_block_does_nothing);
    tcase_add_test(cases, test_block_without_axis_says_so);
    tcase_add_loop_test(cases, test_every_block_in_every_state_as_its_page_says, 0, CM1E_AXIS_STATE_COUNT);
    tcase_add_loop_test(cases, test_every_error_is_on_its_page, 0, RUNS);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
