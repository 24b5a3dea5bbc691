/* The state diagram of an axes group (Part 4): members, every command in every state, power, errors, reset. */
#include "unity.h"

#include "../support/group_bench.h"

void setUp(void) { group_begin(3); }
void tearDown(void) { group_end(); }

static void again(void)
{
    group_end();
    group_begin(3);
}

static void into(cm1e_group_state_t state)
{
    again();
    switch (state) {
    case CM1E_GROUP_DISABLED: TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_disable(group)); break;
    case CM1E_GROUP_MOVING: group_line(5.0, 2.0, 1.0, mcAborting); break;
    case CM1E_GROUP_STOPPING:
        group_line(5.0, 2.0, 1.0, mcAborting);
        axes_cycles(100);
        group_stop();
        break;
    case CM1E_GROUP_ERROR_STOP: fake_bus_fault(axes_motor(1), 0x2310); break;
    default: break;
    }
    axes_cycles(5);
    group_must_be(state);
}

/* ---- every command in every state -------------------------------------------------------------------------------- */

typedef enum what {
    ADD = 0, REMOVE, UNGROUP, ENABLE, DISABLE, RESET, LINE, RELATIVE, ARC, BEND, HALT, STOP, INTERRUPT, CONTINUE, WHATS
} what_t;

static cm1e_error_t post(what_t what)
{
    static const cm1e_group_command_t commands[] = {
        {.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {6.0, 2.0}, .velocity = 1.0},
        {.kind = CM1E_GROUP_LINEAR_RELATIVE, .position = {1.0, 2.0}, .velocity = 1.0},
        {.kind = CM1E_GROUP_CIRCULAR_ABSOLUTE, .auxiliary = {7.0, 4.0}, .position = {8.0, 2.0}, .velocity = 1.0},
        {.kind = CM1E_GROUP_CIRCULAR_RELATIVE, .auxiliary = {1.0, 1.0}, .position = {2.0, 0.0}, .velocity = 1.0},
        {.kind = CM1E_GROUP_HALT},
        {.kind = CM1E_GROUP_STOP},
        {.kind = CM1E_GROUP_INTERRUPT},
    };
    cm1e_command_id_t id;
    switch (what) {
    case ADD: return cm1e_group_add(group, axes_reference(0), 8);
    case REMOVE: return cm1e_group_remove(group, 3);
    case UNGROUP: return cm1e_group_ungroup(group);
    case ENABLE: return cm1e_group_enable(group);
    case DISABLE: return cm1e_group_disable(group);
    case RESET: return cm1e_group_reset(group);
    case CONTINUE: return cm1e_group_continue(group);
    default: return cm1e_group_start(group, &commands[what - LINE], &id);
    }
}

/* By hand from the standard. D, S, M, P, E: taken, and the group is then in GroupDisabled, Standby, Moving, stopPing,
 * ErrorStop. Lower case: refused, d: GROUP_DISABLED, s: GROUP_STATE, p: GROUP_STOPPING, e: GROUP_ERROR_STOP; m:
 * GROUP_MEMBER, for it is one already. */
static const char *const expected[CM1E_GROUP_STATE_COUNT] = {
    /* add remove ungroup enable disable reset line relative arc bend halt stop interrupt continue (nothing) */
    [CM1E_GROUP_DISABLED] = "mDDSDDdddddddd",
    [CM1E_GROUP_STANDBY] = "ssDSDSMMMMSPss",
    [CM1E_GROUP_MOVING] = "ssDsDMMMMMMPMs",
    [CM1E_GROUP_STOPPING] = "ppDpDPpppppppp",
    [CM1E_GROUP_ERROR_STOP] = "eeDeDEeeeeeeee", /* the reset takes its time */
};

static cm1e_error_t refusal(char code)
{
    switch (code) {
    case 'd': return CM1E_ERROR_GROUP_DISABLED;
    case 's': return CM1E_ERROR_GROUP_STATE;
    case 'p': return CM1E_ERROR_GROUP_STOPPING;
    case 'e': return CM1E_ERROR_GROUP_ERROR_STOP;
    case 'm': return CM1E_ERROR_GROUP_MEMBER;
    default: return CM1E_OK;
    }
}

static cm1e_group_state_t state_behind(char code, cm1e_group_state_t before)
{
    switch (code) {
    case 'D': return CM1E_GROUP_DISABLED;
    case 'S': return CM1E_GROUP_STANDBY;
    case 'M': return CM1E_GROUP_MOVING;
    case 'P': return CM1E_GROUP_STOPPING;
    case 'E': return CM1E_GROUP_ERROR_STOP;
    default: return before;
    }
}

static void test_every_command_in_every_state(void)
{
    for (int state = 0; state < CM1E_GROUP_STATE_COUNT; state++)
        for (int what = 0; what < WHATS; what++) {
            char where[80];
            into((cm1e_group_state_t)state);
            const cm1e_error_t error = post((what_t)what);
            const char code = expected[state][what];
            snprintf(where, sizeof where, "%s, command %d", cm1e_group_state_name((cm1e_group_state_t)state), what);
            axes_bench.run = where;
            TEST_ASSERT_EQUAL_INT_MESSAGE(refusal(code), error, where);
            TEST_ASSERT_EQUAL_INT_MESSAGE(state_behind(code, (cm1e_group_state_t)state), group_info().state, where);
            axes_cycles(500); /* the witness watches */
        }
}

static void test_names_of_states(void)
{
    TEST_ASSERT_EQUAL_STRING("GroupDisabled", cm1e_group_state_name(CM1E_GROUP_DISABLED));
    TEST_ASSERT_EQUAL_STRING("GroupErrorStop", cm1e_group_state_name(CM1E_GROUP_ERROR_STOP));
    TEST_ASSERT_EQUAL_STRING("unknown", cm1e_group_state_name(CM1E_GROUP_STATE_COUNT));
}

/* ---- members ----------------------------------------------------------------------------------------------------- */

static void test_members_by_place(void)
{
    AXIS_REF_t axis;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_STATE, cm1e_group_remove(group, 2));
    group_told("MC_GroupDisable first");
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_disable(group));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_remove(group, 2));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_MEMBER, cm1e_group_member(group, 2, &axis));
    TEST_ASSERT_EQUAL_UINT(0, axis.Handle);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_MEMBER, cm1e_group_remove(group, 2));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_MEMBER, cm1e_group_remove(group, 0));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_MEMBER, cm1e_group_remove(group, 9));
    group_told("9 was given. There is no axis at this place");
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_MEMBER, cm1e_group_add(group, axes_reference(1), 9));
    group_told("9 was given. IdentInGroup must be 1 ... 8");
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_MEMBER, cm1e_group_add(group, axes_reference(1), 1));
    group_told("place is taken");
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_MEMBER, cm1e_group_add(group, axes_reference(0), 5));
    group_told("has this place in the group already");
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FB_AXIS_REF, cm1e_group_add(group, (AXIS_REF_t){0}, 2));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FB_AXIS_REF, cm1e_group_add(group, (AXIS_REF_t){4711}, 2));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_add(group, axes_reference(1), 8));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_member(group, 8, &axis));
    TEST_ASSERT_EQUAL_UINT(axes_reference(1).Handle, axis.Handle);
    TEST_ASSERT_EQUAL_INT(3, group_info().axes);
}

static void test_a_full_group_says_so(void)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_disable(group));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_remove(group, 2));
    for (int i = 0; i < CM1E_GROUP_AXES; i++)
        if (group->member[i].Handle == 0)
            group->member[i].Handle = 4711; /* there are more places than axes of the bench */
    for (uint32_t ident = 0; ident <= CM1E_GROUP_AXES + 1; ident++) {
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_MEMBER, cm1e_group_add(group, axes_reference(1), ident));
        group_told("The group is full: it has 8 axes");
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_MEMBER, cm1e_group_add(group, axes_reference(0), ident));
        group_told("has this place in the group already");
    }
    for (int i = 0; i < CM1E_GROUP_AXES; i++)
        if (group->member[i].Handle == 4711)
            group->member[i].Handle = 0;
}

static void test_what_is_refused_is_in_the_text(void)
{
    for (int i = 0; i < CM1E_GROUP_COMMANDS; i++)
        group_line(5, 5, 1, i == 0 ? mcAborting : mcBuffered);
    group_refused(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_RELATIVE, .buffer_mode = mcBuffered}, CM1E_ERROR_FULL);
    group_told("Wait until one of the commands of the group is done");
}

static void test_positions_go_by_place(void)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_disable(group));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_remove(group, 2));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_add(group, axes_reference(1), 8));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_enable(group));
    group_done(group_command(&(cm1e_group_command_t){
        .kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {1.0, NAN, 2.0, NAN, NAN, NAN, NAN, 3.0}}));
    TEST_ASSERT_EQUAL_DOUBLE(1.0, group_at(0));
    TEST_ASSERT_EQUAL_DOUBLE(3.0, group_at(1));
    TEST_ASSERT_EQUAL_DOUBLE(2.0, group_at(2));
}

static void test_an_axis_is_in_one_group(void)
{
    AXES_GROUP_REF_t other;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_create(&other, NULL, NULL));
    cm1e_group_t *second = cm1e_group_from_reference(&other);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_MEMBER, cm1e_group_add(second, axes_reference(1), 0));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_MEMBER, cm1e_group_enable(second));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_ungroup(group));
    TEST_ASSERT_EQUAL_INT(0, group_info().axes);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_add(second, axes_reference(1), 0));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_destroy(other));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_REF, cm1e_group_destroy(other));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_add(group, axes_reference(1), 0));
}

static void test_axes_of_another_bus_are_refused(void)
{
    static cm1e_bus_t far;
    cm1e_axis_t *stranger;
    fake_bus_init(&far, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_create(&stranger, &far, 0, NULL));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_disable(group));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_MEMBER, cm1e_group_add(group, cm1e_axis_reference(stranger), 0));
    group_told("another bus");
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_ungroup(group));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_add(group, cm1e_axis_reference(stranger), 0));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_MEMBER, cm1e_group_add(group, axes_reference(0), 0));
    cm1e_axis_destroy(stranger);
}

static void test_motions_of_the_drive_are_no_members(void)
{
    group_end();
    axes_describe(1);
    fake_bus_init(axes_motor(0), CM1E_MAPPING_PROFILE, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    axes_config(0)->motion = CM1E_MOTION_DRIVE;
    axes_make();
    group_create();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED, cm1e_group_add(group, axes_reference(0), 0));
    group_told("motion: host");
}

static void test_encoders_are_no_members(void)
{
    group_end();
    axes_describe(1);
    axes_config(0)->type = CM1E_AXIS_ENCODER;
    axes_make();
    group_create();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_VIRTUAL, cm1e_group_add(group, axes_reference(0), 0));
    group_told("cannot be moved");
}

static void test_handles(void)
{
    AXES_GROUP_REF_t groups[GROUP_HANDLES], one;
    cm1e_group_info_t info;
    cm1e_diag_t diag;
    int made = 0;
    while (made < GROUP_HANDLES && cm1e_group_create(&groups[made], NULL, &diag) == CM1E_OK)
        made++;
    TEST_ASSERT_EQUAL_INT(GROUP_HANDLES - 1, made); /* beside that of the bench */
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FULL, diag.error);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_read(groups[0], &info));
    for (int i = 0; i < made; i++)
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_destroy(groups[i]));
    for (int i = 0; i < 1000; i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_create(&one, NULL, NULL));
        TEST_ASSERT_NOT_EQUAL_UINT(0, one.Handle);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_destroy(one));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_REF, cm1e_group_read(one, &info));
    }
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_REF, cm1e_group_read((AXES_GROUP_REF_t){0}, &info));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_group_create(NULL, NULL, NULL));
    char text[8] = "x";
    cm1e_group_error_text(one, text, sizeof text);
    TEST_ASSERT_EQUAL_STRING("", text);
}

static void test_a_group_that_moves_is_not_destroyed(void)
{
    group_line(5.0, 2.0, 1.0, mcAborting);
    axes_cycles(100);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_STATE, cm1e_group_destroy(group_reference));
    const cm1e_command_id_t stop = group_stop();
    group_done(stop);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_destroy(group_reference)); /* held, but at rest */
    for (int n = 0; n < 3; n++)
        axes_must_be(n, CM1E_AXIS_STANDSTILL);
    axes_cycles(10);
}

static void test_axes_may_go_before_their_group(void)
{
    group_line(5.0, 2.0, 1.0, mcAborting);
    axes_cycles(100);
    axes_end();
    group_must_be(CM1E_GROUP_ERROR_STOP);
    group_told("does not exist any more");
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_destroy(group_reference));
}

/* ---- stop, halt, disable ----------------------------------------------------------------------------------------- */

static void test_stop_holds_until_execute_falls(void)
{
    const cm1e_command_id_t line = group_line(5.0, 2.0, 1.0, mcAborting);
    axes_cycles(300);
    const cm1e_command_id_t stop = group_stop();
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, group_state_of(line));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(stop));
    group_done(stop);
    axes_cycles(100);
    group_must_be(CM1E_GROUP_STOPPING);
    TEST_ASSERT_TRUE(group_off_line(0, 0, 5, 2) < 5e-9);
    axes_refused(0, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1.0},
                 CM1E_ERROR_AXIS_IN_GROUP);
    cm1e_group_hold_stop(group, stop + 1, false); /* somebody else's */
    axes_cycles(2);
    group_must_be(CM1E_GROUP_STOPPING);
    cm1e_group_hold_stop(group, stop, false);
    axes_cycles(2);
    group_must_be(CM1E_GROUP_STANDBY);
    for (int n = 0; n < 3; n++)
        axes_must_be(n, CM1E_AXIS_STANDSTILL);
}

static void test_stop_released_early_may_be_repeated_until_it_stands(void)
{
    group_line(5.0, 2.0, 1.0, mcAborting);
    axes_cycles(300);
    const cm1e_command_id_t stop = group_stop();
    cm1e_group_hold_stop(group, stop, false);
    axes_cycles(2);
    group_must_be(CM1E_GROUP_STOPPING);
    const cm1e_command_id_t second = group_stop();
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, group_state_of(stop));
    cm1e_group_hold_stop(group, second, false);
    group_done(second);
    axes_cycles(2);
    group_must_be(CM1E_GROUP_STANDBY);
}

static void test_stop_in_standby_holds_the_axes(void)
{
    const cm1e_command_id_t stop = group_stop();
    axes_cycles(2);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(stop));
    group_must_be(CM1E_GROUP_STOPPING);
    for (int n = 0; n < 3; n++)
        axes_refused(n, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 1.0},
                     CM1E_ERROR_AXIS_IN_GROUP);
    axes_power(1, false); /* what stands may lose its power */
    axes_cycles(50);
    group_must_be(CM1E_GROUP_STOPPING);
    cm1e_group_hold_stop(group, stop, false);
    axes_cycles(2);
    group_must_be(CM1E_GROUP_STANDBY);
    axes_must_be(0, CM1E_AXIS_STANDSTILL);
    axes_must_be(1, CM1E_AXIS_DISABLED);
}

/* They are not at 0, and no path of the group has led there. */
static void move_apart(void)
{
    for (int n = 0; n < 3; n++)
        axes_wait(n, axes_move_to(n, 1.5 - n, 5.0), 3000);
}

static void test_a_relative_line_counts_from_where_the_axes_are(void)
{
    move_apart();
    group_done(group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_RELATIVE, .position = {1, 2, -3},
                                                     .velocity = 2.0}));
    static const double ends[] = {2.5, 2.5, -3.5};
    for (int n = 0; n < 3; n++)
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, ends[n], axes_info(n).set_position);
}

/* A direction that is not permitted concerns a line that goes that way, and no other one. */
static void test_a_line_asks_for_the_directions_of_axes_that_it_moves_only(void)
{
    for (int direction = -1; direction <= 1; direction += 2) {
        again();
        axes_bench.positive[1] = direction < 0;
        axes_bench.negative[1] = direction > 0;
        axes_cycles(1);
        group_refused(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_RELATIVE, .position = {1.0, direction},
                                              .velocity = 1.0}, CM1E_ERROR_AXIS_DIRECTION_DISABLED);
        group_done(group_line(1.0, 0.0, 5.0, mcAborting));
        TEST_ASSERT_EQUAL_DOUBLE(1.0, group_at(0));
    }
}

static void test_stop_in_standby_holds_the_axes_where_they_are(void)
{
    move_apart();
    const cm1e_command_id_t stop = group_stop();
    for (int i = 0; i < 50; i++) {
        axes_cycles(1);
        for (int n = 0; n < 3; n++)
            TEST_ASSERT_EQUAL_DOUBLE(1.5 - n, axes_info(n).set_position);
    }
    group_must_be(CM1E_GROUP_STOPPING);
    cm1e_group_hold_stop(group, stop, false);
    axes_cycles(2);
    for (int n = 0; n < 3; n++) {
        axes_must_be(n, CM1E_AXIS_STANDSTILL);
        TEST_ASSERT_EQUAL_DOUBLE(1.5 - n, axes_info(n).set_position);
    }
}

static void test_stop_without_power_holds_the_group(void)
{
    for (int n = 0; n < 3; n++)
        axes_power(n, false);
    axes_cycles(50);
    const cm1e_command_id_t stop = group_stop();
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(stop));
    group_must_be(CM1E_GROUP_STOPPING);
    cm1e_group_hold_stop(group, stop, false);
    group_must_be(CM1E_GROUP_STANDBY);
}

/* Before the first step after MC_GroupStop, so that nobody asks the group for a set-point any more. */
static void test_stop_that_loses_all_axes_at_once_is_done(void)
{
    for (int held = 0; held <= 1; held++) {
        again();
        const cm1e_command_id_t stop = group_stop();
        cm1e_group_hold_stop(group, stop, held);
        for (int n = 0; n < 3; n++)
            axes_power(n, false);
        axes_cycles(1);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(stop));
        group_must_be(held ? CM1E_GROUP_STOPPING : CM1E_GROUP_STANDBY);
        cm1e_group_hold_stop(group, stop, false);
        group_must_be(CM1E_GROUP_STANDBY);
        TEST_ASSERT_EQUAL_INT(0, group_info().commands);
    }
}

static void test_halt_may_be_aborted_and_be_waited_for(void)
{
    const cm1e_group_command_t halt = {.kind = CM1E_GROUP_HALT, .deceleration = 2.0};
    const cm1e_command_id_t line = group_line(5.0, 2.0, 1.0, mcAborting);
    axes_cycles(300);
    const cm1e_command_id_t first = group_command(&halt);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, group_state_of(line));
    group_must_be(CM1E_GROUP_MOVING);
    axes_cycles(20);
    const cm1e_command_id_t other = group_line(0.0, 3.0, 1.0, mcAborting);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, group_state_of(first));
    axes_cycles(100);
    const cm1e_command_id_t second = group_command(&halt);
    group_refused(&(cm1e_group_command_t){.kind = CM1E_GROUP_CIRCULAR_RELATIVE, .auxiliary = {1.0}, .position = {2.0},
                                          .velocity = 1.0}, CM1E_ERROR_GROUP_PATH); /* three points on a line */
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(second));
    const cm1e_command_id_t last = group_line(1.0, 1.0, 1.0, mcBuffered);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, group_state_of(other));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, group_state_of(last));
    group_done(second);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, group_state_of(last));
    group_done(last);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, group_at(0));
    axes_cycles(1);
    group_must_be(CM1E_GROUP_STANDBY);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(group_command(&halt)));
    group_must_be(CM1E_GROUP_STANDBY);
}

static void test_a_buffered_halt_lets_the_line_end(void)
{
    const cm1e_command_id_t line = group_line(1.0, 2.0, 5.0, mcAborting);
    const cm1e_command_id_t halt =
        group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_HALT, .buffer_mode = mcBuffered});
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, group_state_of(halt));
    group_done(line);
    group_done(halt);
    TEST_ASSERT_EQUAL_DOUBLE(2.0, group_at(1));
    group_refused(&(cm1e_group_command_t){.kind = CM1E_GROUP_HALT, .buffer_mode = mcBlendingLow},
                  CM1E_ERROR_AXIS_BUFFER_MODE);
}

static void test_a_halt_that_waits_for_a_halt(void)
{
    group_line(5.0, 2.0, 1.0, mcAborting);
    axes_cycles(300);
    const cm1e_command_id_t first = group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_HALT});
    const cm1e_command_id_t second =
        group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_HALT, .buffer_mode = mcBuffered});
    axes_cycles(1000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(first));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, group_state_of(second));
    group_must_be(CM1E_GROUP_STANDBY);
}

static void test_disable_stops_along_the_path(void)
{
    const cm1e_command_id_t line = group_line(5.0, 2.0, 2.0, mcAborting);
    const cm1e_command_id_t next = group_line(5.0, 5.0, 2.0, mcBuffered);
    axes_cycles(300);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_disable(group));
    group_must_be(CM1E_GROUP_DISABLED);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, group_state_of(line));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, group_state_of(next));
    axes_must_be(0, CM1E_AXIS_SYNCHRONIZED_MOTION);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_STATE, cm1e_group_enable(group));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_STATE, cm1e_group_remove(group, 1));
    group_told("have not come to rest yet");
    while (axes_state(0) == CM1E_AXIS_SYNCHRONIZED_MOTION) {
        axes_cycles(1);
        TEST_ASSERT_TRUE(group_off_line(0, 0, 5, 2) < 5e-9);
    }
    axes_must_be(1, CM1E_AXIS_STANDSTILL);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_enable(group));
}

static void test_ungrouped_in_motion_the_axes_are_members_until_they_stand(void)
{
    group_line(5.0, 2.0, 2.0, mcAborting);
    axes_cycles(300);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_ungroup(group));
    TEST_ASSERT_EQUAL_INT(3, group_info().axes);
    axes_cycles(1000);
    TEST_ASSERT_EQUAL_INT(0, group_info().axes);
    axes_must_be(0, CM1E_AXIS_STANDSTILL);
}

/* ---- errors and their reset -------------------------------------------------------------------------------------- */

static void test_a_fault_in_standby_is_the_groups(void)
{
    fake_bus_fault(axes_motor(2), 0x2310);
    axes_cycles(3);
    group_must_be(CM1E_GROUP_ERROR_STOP);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_GROUP_AXIS, group_info().error);
    group_told("\"axis2\" (IdentInGroup 3)");
    group_told("torque overload");
}

/** An axis that the group does not move is looked at when somebody asks: a reset asks too. */
static void test_reset_sees_a_fault_that_nobody_has_read(void)
{
    fake_bus_fault(axes_motor(2), 0x2310);
    axes_cycles(3);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_reset(group));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, cm1e_group_reset_state(group, NULL));
    axes_cycles(200);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, cm1e_group_reset_state(group, NULL));
    axes_must_be(2, CM1E_AXIS_STANDSTILL);
}

static void test_reset_brings_back_group_and_axes(void)
{
    into(CM1E_GROUP_ERROR_STOP);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_reset(group));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, cm1e_group_reset_state(group, NULL));
    int waited = 0;
    cm1e_error_t error = CM1E_ERROR_STATE;
    while (cm1e_group_reset_state(group, &error) == CM1E_COMMAND_ACTIVE && waited++ < 1000)
        axes_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, cm1e_group_reset_state(group, NULL));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, error);
    group_must_be(CM1E_GROUP_STANDBY);
    TEST_ASSERT_EQUAL_STRING("", group_text());
    axes_cycles(100);
    axes_must_be(1, CM1E_AXIS_STANDSTILL);
    group_done(group_line(1.0, 1.0, 1.0, mcAborting));
}

static void test_a_reset_that_fails_says_so(void)
{
    into(CM1E_GROUP_ERROR_STOP);
    axes_motor(1)->fault_stays = true;
    cm1e_group_reset(group);
    axes_cycles(2500);
    cm1e_error_t error;
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, cm1e_group_reset_state(group, &error));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_RESET_TIMEOUT, error);
    group_must_be(CM1E_GROUP_ERROR_STOP);
    axes_motor(1)->fault_stays = false;
    cm1e_group_reset(group);
    axes_cycles(200);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, cm1e_group_reset_state(group, &error));
    group_must_be(CM1E_GROUP_STANDBY);
}

static void test_a_reset_that_is_overtaken_by_disable_is_cancelled(void)
{
    into(CM1E_GROUP_ERROR_STOP);
    cm1e_group_reset(group);
    cm1e_group_disable(group);
    cm1e_error_t error;
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, cm1e_group_reset_state(group, &error));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CANCELLED, error);
    group_must_be(CM1E_GROUP_DISABLED);
}

static void test_disable_and_enable_do_not_hide_a_failed_axis(void)
{
    into(CM1E_GROUP_ERROR_STOP);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_disable(group));
    group_must_be(CM1E_GROUP_DISABLED);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_enable(group));
    group_must_be(CM1E_GROUP_ERROR_STOP);
}

/* ---- commands ---------------------------------------------------------------------------------------------------- */

static void test_commands_are_remembered_for_a_while(void)
{
    const cm1e_command_id_t first = group_line(0.01, 0.0, 1.0, mcAborting);
    for (int i = 0; i < GROUP_RECORDS + 2; i++)
        group_line(0.01, 0.0, 1.0, mcAborting);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_UNKNOWN, group_state_of(first));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_UNKNOWN, group_state_of(0));
    const cm1e_group_command_t none = {.kind = CM1E_GROUP_KIND_COUNT};
    cm1e_command_id_t id = 3;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_group_start(group, &none, &id));
    TEST_ASSERT_EQUAL_UINT32(0, id);
}

static void test_one_more_than_fits_is_refused_and_all_that_fit_are_done(void)
{
    cm1e_command_id_t last = 0;
    for (int i = 0; i < CM1E_GROUP_COMMANDS; i++)
        last = group_line(0.01 * (i % 3), 0.005 * i, 5.0, i ? mcBuffered : mcAborting);
    group_refused(&(cm1e_group_command_t){.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .buffer_mode = mcBuffered},
                  CM1E_ERROR_FULL);
    group_done(last);
    TEST_ASSERT_EQUAL_INT(0, group_info().commands);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_command_in_every_state);
    RUN_TEST(test_names_of_states);
    RUN_TEST(test_members_by_place);
    RUN_TEST(test_a_full_group_says_so);
    RUN_TEST(test_what_is_refused_is_in_the_text);
    RUN_TEST(test_positions_go_by_place);
    RUN_TEST(test_an_axis_is_in_one_group);
    RUN_TEST(test_axes_of_another_bus_are_refused);
    RUN_TEST(test_motions_of_the_drive_are_no_members);
    RUN_TEST(test_encoders_are_no_members);
    RUN_TEST(test_handles);
    RUN_TEST(test_a_group_that_moves_is_not_destroyed);
    RUN_TEST(test_axes_may_go_before_their_group);
    RUN_TEST(test_stop_holds_until_execute_falls);
    RUN_TEST(test_stop_released_early_may_be_repeated_until_it_stands);
    RUN_TEST(test_stop_in_standby_holds_the_axes);
    RUN_TEST(test_stop_in_standby_holds_the_axes_where_they_are);
    RUN_TEST(test_a_relative_line_counts_from_where_the_axes_are);
    RUN_TEST(test_a_line_asks_for_the_directions_of_axes_that_it_moves_only);
    RUN_TEST(test_stop_without_power_holds_the_group);
    RUN_TEST(test_stop_that_loses_all_axes_at_once_is_done);
    RUN_TEST(test_halt_may_be_aborted_and_be_waited_for);
    RUN_TEST(test_a_buffered_halt_lets_the_line_end);
    RUN_TEST(test_a_halt_that_waits_for_a_halt);
    RUN_TEST(test_disable_stops_along_the_path);
    RUN_TEST(test_ungrouped_in_motion_the_axes_are_members_until_they_stand);
    RUN_TEST(test_a_fault_in_standby_is_the_groups);
    RUN_TEST(test_reset_sees_a_fault_that_nobody_has_read);
    RUN_TEST(test_reset_brings_back_group_and_axes);
    RUN_TEST(test_a_reset_that_fails_says_so);
    RUN_TEST(test_a_reset_that_is_overtaken_by_disable_is_cancelled);
    RUN_TEST(test_disable_and_enable_do_not_hide_a_failed_axis);
    RUN_TEST(test_commands_are_remembered_for_a_while);
    RUN_TEST(test_one_more_than_fits_is_refused_and_all_that_fit_are_done);
    return UNITY_END();
}
