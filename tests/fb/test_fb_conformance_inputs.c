/**
 * When inputs of a block act (PLCopen Part 1 v2.0, 2.4.1, 2.4.6): at the edge alone, or, with ContinuousUpdate, while
 * it is TRUE; nonsense in a running command changes nothing; and one instance may serve one axis after the other.
 */
#include "axis/axis_parameters.h"
#include "block_bench.h"

enum { RECORDED = 1500 };

static instance_t mover, subject;

#define FOR_EACH_BLOCK(type)                                                                                         \
    for (const block_t *type = block_table; type < block_table + block_count; type++)

/** Set-points of a run. */
typedef struct record {
    int64_t counts[RECORDED];
    double velocity[RECORDED];
} record_t;
static record_t undisturbed, disturbed;

static bool is_command(const block_t *type)
{
    return type->rules && member_of(type, "Execute") && !type->rules->unchanged &&
           type->rules[CM1E_AXIS_CONTINUOUS_MOTION].refusal == CM1E_OK;
}

/** Every input but the trigger and BufferMode gets another value that makes sense. */
static void change_inputs(instance_t *fb, double factor)
{
    const block_t *type = fb->view->type;
    for (size_t i = 0; i < type->member_count; i++) {
        const block_member_t *m = &type->members[i];
        if (m->section == BLOCK_INPUT && m->type == BLOCK_LREAL)
            put(fb, m->name, real_of(fb, m->name) * factor);
        if (m->section == BLOCK_INPUT && strcmp(m->name, "Direction") == 0)
            put(fb, m->name, mcNegativeDirection);
        if (m->section == BLOCK_INPUT && m->type == BLOCK_DINT)
            put(fb, m->name, 3);
        if (m->section == BLOCK_INPUT && strcmp(m->name, "SlaveOffset") == 0)
            put(fb, m->name, 0.25);
    }
}

/** Starts the block into an axis that moves already, lets the caller disturb it, and writes down what comes out. */
static void run(const block_t *type, bool updates, void (*disturb)(int cycle), record_t *record)
{
    into(CM1E_AXIS_CONTINUOUS_MOTION, &mover);
    make(&subject, type->name);
    put(&subject, "ContinuousUpdate", updates);
    trigger(&subject, true);
    for (int n = 0; n < RECORDED; n++) {
        cycle();
        record->counts[n] = judged.axis->setpoint.position.counts;
        record->velocity[n] = judged.axis->setpoint.velocity;
        if (disturb)
            disturb(n);
    }
}

static int first_difference(void)
{
    for (int n = 0; n < RECORDED; n++)
        if (undisturbed.counts[n] != disturbed.counts[n] || undisturbed.velocity[n] != disturbed.velocity[n])
            return n;
    return RECORDED;
}

/* ---- the edge ---------------------------------------------------------------------------------------------------- */

static void change_at_once(int n)
{
    if (n == 0)
        change_inputs(&subject, 0.5);
}

static void change_and_ask_for_updates(int n)
{
    if (n == 0)
        put(&subject, "ContinuousUpdate", 1);
    if (n == 1)
        change_inputs(&subject, 0.5);
}

START_TEST(test_inputs_act_at_the_edge_alone)
{
    int checked = 0;
    FOR_EACH_BLOCK(type) {
        if (!is_command(type))
            continue;
        snprintf(judged.scene, sizeof judged.scene, "%s: inputs change after the edge", type->name);
        run(type, false, NULL, &undisturbed);
        MUST(first_difference() == RECORDED || checked > 0 || undisturbed.velocity[0] != 0, "nothing moves");
        run(type, false, change_at_once, &disturbed);
        MUST(first_difference() == RECORDED, "they act in cycle %d", first_difference());
        run(type, false, change_and_ask_for_updates, &disturbed); /* 2.4.6: to be TRUE at the edge */
        MUST(first_difference() == RECORDED, "they act in cycle %d, by a ContinuousUpdate that came late",
             first_difference());
        checked++;
    }
    ck_assert_int_ge(checked, 4);
}
END_TEST

/* ---- wrong values ------------------------------------------------------------------------------------------------ */

/** That need no other axis, cam or table. */
static bool stands_alone(const block_t *type)
{
    return type->rules && member_of(type, "Execute") && !type->rules->unchanged && !member_of(type, "Master") &&
           !member_of(type, "Master1") && type->rules[CM1E_AXIS_STANDSTILL].refusal == CM1E_OK;
}

/** Whatever is refused for its value, is told with its value. */
static void expect_told(const block_t *type, const block_member_t *member, double value, const char *told)
{
    char text[512];
    snprintf(judged.scene, sizeof judged.scene, "%s: %s is %s", type->name, member->name, told);
    into(CM1E_AXIS_STANDSTILL, &mover);
    make(&subject, type->name);
    put(&subject, member->name, value);
    trigger(&subject, true);
    cycle();
    if (!subject.now.error || subject.now.error_id == cm1e_error_id(CM1E_ERROR_UNSUPPORTED))
        return;
    cm1e_axis_error_text(judged.reference, text, sizeof text);
    MUST(strstr(text, told), "0x%04X: %s", subject.now.error_id, text);
}

START_TEST(test_a_refused_value_is_in_the_text)
{
    int checked = 0;
    FOR_EACH_BLOCK(type) {
        for (size_t i = 0; i < type->member_count && stands_alone(type); i++) {
            const block_member_t *member = &type->members[i];
            if (member->section != BLOCK_INPUT || (member->type != BLOCK_LREAL && member->type != BLOCK_ENUM))
                continue;
            expect_told(type, member, member->type == BLOCK_ENUM ? 77 : NAN, member->type == BLOCK_ENUM ? "77" : "nan");
            checked++;
        }
    }
    ck_assert_int_ge(checked, 60);
}
END_TEST

/** A block that refuses by itself leaves no text of an earlier refusal. */
START_TEST(test_the_text_is_of_the_last_refusal)
{
    char text[512];
    snprintf(judged.scene, sizeof judged.scene, "a refusal after another one");
    into(CM1E_AXIS_STANDSTILL, &mover);
    make(&mover, "MC_MoveVelocity");
    put(&mover, "Velocity", NAN);
    trigger(&mover, true);
    cycle();
    cm1e_axis_error_text(judged.reference, text, sizeof text);
    MUST(strstr(text, "nan"), "%s", text);
    make(&subject, "MC_TorqueControl");
    trigger(&subject, true);
    cycle();
    cm1e_axis_error_text(judged.reference, text, sizeof text);
    MUST(subject.now.error && strstr(text, cm1e_strerror(CM1E_ERROR_AXIS_NO_TORQUE_MODE)), "%s", text);
}
END_TEST

START_TEST(test_a_block_that_begins_in_standstill_says_so)
{
    static const struct { cm1e_axis_state_t state; const char *block, *told; } cases[] = {
        {CM1E_AXIS_CONTINUOUS_MOTION, "MC_Home", "ContinuousMotion: MC_Home was refused: it begins in Standstill."},
        {CM1E_AXIS_DISCRETE_MOTION, "MC_HomeDirect", "a step of a homing was refused: it begins in Standstill."},
        {CM1E_AXIS_STANDSTILL, "MC_FinishHoming", "it ends a homing, which begins with another step."},
    };
    char text[512];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        snprintf(judged.scene, sizeof judged.scene, "%s", cases[i].block);
        into(cases[i].state, &mover);
        make(&subject, cases[i].block);
        trigger(&subject, true);
        cycle();
        cm1e_axis_error_text(judged.reference, text, sizeof text);
        MUST(subject.now.error_id == cm1e_error_id(CM1E_ERROR_AXIS_STATE) && strstr(text, cases[i].told), "%s", text);
    }
}
END_TEST

/** An Error of the block leaves no text of an earlier refusal. `member` gets `value`; NULL: none does. */
static void expect_own_text(const block_t *type, const block_member_t *member, double value)
{
    static const char *const earlier = "parameter 31999";
    char text[512];
    snprintf(judged.scene, sizeof judged.scene, "%s: %s is %g", type->name, member ? member->name : "no input", value);
    make(&subject, type->name);
    if (member && member->section == BLOCK_IN_OUT)
        point_at(&subject, member->name, NULL);
    else if (member)
        put(&subject, member->name, value);
    MUST(cm1e_axis_write_parameter(judged.axis, 31999, 1.0) != CM1E_OK, "there is a parameter 31999");
    cm1e_axis_error_text(judged.reference, text, sizeof text);
    MUST(strstr(text, earlier), "%s", text);
    trigger(&subject, true);
    subject.view->type->call(subject.memory);
    WORD id = 0;
    if (flag(&subject, subject.view->error))
        memcpy(&id, subject.memory + subject.view->error_id, sizeof id);
    cm1e_axis_error_text(judged.reference, text, sizeof text);
    const bool names_no_axis = id == cm1e_error_id(CM1E_ERROR_FB_AXIS_REF);
    MUST(id == 0 || names_no_axis || (text[0] && !strstr(text, earlier)), "Error 0x%04X, %s", id, text);
}

static bool takes_nonsense(const block_member_t *member)
{
    const bool triggers = strcmp(member->name, "Execute") == 0 || strcmp(member->name, "Enable") == 0;
    const bool number = member->type != BLOCK_BOOL && member->type != BLOCK_STRUCT && member->type != BLOCK_POINTER &&
                        member->type != BLOCK_STRING;
    return !triggers && (member->section == BLOCK_IN_OUT || (member->section == BLOCK_INPUT && number));
}

START_TEST(test_every_refusal_has_a_text_of_its_own)
{
    static const cm1e_axis_state_t states[] = {CM1E_AXIS_DISABLED, CM1E_AXIS_STANDSTILL, CM1E_AXIS_HOMING,
                                               CM1E_AXIS_CONTINUOUS_MOTION, CM1E_AXIS_STOPPING};
    static const double values[] = {-1.0, 77.0, NAN, 1e300};
    FOR_EACH_BLOCK(type) {
        if (member_of(type, "AxesGroup") || strcmp(type->name, "MC_Power") == 0 || !member_of(type, "ErrorID"))
            continue;
        into(states[_i], &mover);
        expect_own_text(type, NULL, 0.0);
        for (size_t i = 0; i < type->member_count; i++) {
            const block_member_t *member = &type->members[i];
            const int most = member->section == BLOCK_IN_OUT ? 1 : member->type == BLOCK_LREAL ? 4 : 2;
            const int count = takes_nonsense(member) ? most : 0;
            for (int v = 0; v < count; v++) {
                into(states[_i], &mover);
                expect_own_text(type, member, values[v]);
            }
        }
    }
}
END_TEST

/* ---- ContinuousUpdate -------------------------------------------------------------------------------------------- */

static void change_later(int n)
{
    if (n == 20)
        change_inputs(&subject, 0.9);
}

static void end_updates_then_change(int n)
{
    if (n == 10)
        put(&subject, "ContinuousUpdate", 0);
    if (n == 15)
        put(&subject, "ContinuousUpdate", 1); /* once gone it does not come back */
    change_later(n);
}

START_TEST(test_continuous_update_acts_while_it_is_true)
{
    FOR_EACH_BLOCK(type) {
        if (!is_command(type) || !member_of(type, "ContinuousUpdate"))
            continue;
        snprintf(judged.scene, sizeof judged.scene, "%s: ContinuousUpdate", type->name);
        run(type, true, NULL, &undisturbed);
        if (subject.now.error_id == cm1e_error_id(CM1E_ERROR_UNSUPPORTED))
            continue; /* said so, and nothing moved by it */
        MUST(!subject.now.error, "Error 0x%04X", subject.now.error_id);
        run(type, true, change_later, &disturbed);
        /* On its way into a cam a slave may brake at its limit for as long by the old inputs as by the new ones. */
        const int latest = strcmp(type->name, "MC_CamIn") == 0 ? 400 : 80;
        MUST(first_difference() >= 20 && first_difference() < latest, "the inputs act in cycle %d", first_difference());
        MUST(!subject.now.error, "Error 0x%04X", subject.now.error_id);
        run(type, true, end_updates_then_change, &disturbed);
        MUST(first_difference() == RECORDED, "the inputs act in cycle %d, without ContinuousUpdate",
             first_difference());
    }
}
END_TEST

static const char *nonsense_input;
static double nonsense_value;

static void put_nonsense(int n)
{
    if (n == 20)
        put(&subject, nonsense_input, nonsense_value);
}

START_TEST(test_nonsense_under_continuous_update_changes_nothing)
{
    static const double values[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300};
    FOR_EACH_BLOCK(type) {
        if (!is_command(type) || !member_of(type, "ContinuousUpdate"))
            continue;
        run(type, true, NULL, &undisturbed);
        for (size_t i = 0; i < type->member_count; i++) {
            if (type->members[i].section != BLOCK_INPUT || type->members[i].type != BLOCK_LREAL)
                continue;
            for (size_t v = 0; v < sizeof values / sizeof values[0]; v++) {
                nonsense_input = type->members[i].name;
                nonsense_value = values[v];
                snprintf(judged.scene, sizeof judged.scene, "%s.%s becomes %g", type->name, nonsense_input,
                         nonsense_value);
                run(type, true, put_nonsense, &disturbed);
                MUST(first_difference() == RECORDED, "it acts in cycle %d", first_difference());
            }
        }
    }
}
END_TEST

/* ---- one instance, two axes -------------------------------------------------------------------------------------- */

static struct cm1e_bus other_bus;
static cm1e_axis_t *other_axis;

/** Which axis the block is to have changed the state of; the other one is not to know of it. */
static void call_for(cm1e_axis_t *axis)
{
    cm1e_axis_t *const first = judged.axis;
    judged.axis = axis;
    judged.state = axis->state;
    call(&subject);
    judged.axis = first;
    judged.state = first->state;
}

static void cycles_of_both(int n, cm1e_axis_t *on)
{
    while (n-- > 0) {
        fake_bus_cycle(&other_bus, judged.cycle_ns);
        cm1e_axis_inputs(other_axis, CM1E_OK, CM1E_OK, other_bus.clock.virtual_now_ns);
        cm1e_axis_power(other_axis, &other_bus, true, true, true);
        cycle_begin();
        if (on)
            call_for(on);
        cycle_end();
        cm1e_axis_outputs(other_axis);
    }
}

START_TEST(test_instance_serves_one_axis_after_the_other)
{
    cm1e_diag_t diag;
    FOR_EACH_BLOCK(type) {
        if (!is_command(type) || strcmp(type->name, "MC_HaltSuperimposed") == 0 || member_of(type, "Slave"))
            continue; /* slaves: test_fb_conformance_slaves */
        snprintf(judged.scene, sizeof judged.scene, "%s on another axis", type->name);
        into(CM1E_AXIS_STANDSTILL, &mover);
        fake_bus_init(&other_bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        other_bus.config.axes[0].table_profiles = true;
        MUST(cm1e_axis_create(&other_axis, &other_bus, 0, &diag) == CM1E_OK, "%s", diag.text);
        AXIS_REF_t other = cm1e_axis_reference(other_axis);
        fake_bus_show(&other_bus);
        cycles_of_both(30, NULL);
        make(&subject, type->name);
        trigger(&subject, true);
        cycles_of_both(300, judged.axis);
        MUST(other_axis->setpoint.velocity == 0.0 && other_axis->state == CM1E_AXIS_STANDSTILL, "the other axis moves");
        bench.power.Enable = FALSE; /* which ends the first command */
        cycles_of_both(900, judged.axis);
        trigger(&subject, false);
        cycles_of_both(1, judged.axis);
        MUST(!subject.now.busy, "still Busy");
        point_at_axis(&subject, &other);
        trigger(&subject, true);
        cycles_of_both(3, other_axis);
        MUST(!subject.now.error && other_axis->state != CM1E_AXIS_DISABLED, "Error 0x%04X", subject.now.error_id);
        const double at_first = bench.info.set_position;
        cycles_of_both(50, other_axis);
        MUST(bench.info.set_position == at_first && judged.axis->state == CM1E_AXIS_DISABLED, "the first axis moves");
        const bool stands = strstr(type->name, "Halt") || strstr(type->name, "Stop");
        MUST(stands || other_axis->setpoint.velocity != 0.0 || subject.now.done, "the other axis does not move");
        cm1e_axis_destroy(other_axis);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("conformance: inputs");
    bench.with_master = true;
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_test(all, test_inputs_act_at_the_edge_alone);
    tcase_add_test(all, test_a_refused_value_is_in_the_text);
    tcase_add_test(all, test_the_text_is_of_the_last_refusal);
    tcase_add_test(all, test_a_block_that_begins_in_standstill_says_so);
    tcase_add_loop_test(all, test_every_refusal_has_a_text_of_its_own, 0, 5);
    tcase_add_test(all, test_continuous_update_acts_while_it_is_true);
    tcase_add_test(all, test_nonsense_under_continuous_update_changes_nothing);
    tcase_add_test(all, test_instance_serves_one_axis_after_the_other);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
