/**
 * The state diagram of PLCopen Part 1 v2.0, figure 2, by the table of blocks: every block in every state does what its
 * row says, the transition or the refusal; and what every block must do whatever it is for: inputs that are no numbers,
 * no axis, another axis, a zeroed struct, Enable and Execute taken away, an axis error in every phase.
 */
#include "block_bench.h"

static instance_t mover, subject;

/** Blocks that an axis has to do with. */
static bool has_axis(const block_t *type) { return member_of(type, "Axis") || member_of(type, "Slave"); }
static bool is(const block_t *type, const char *name) { return strcmp(type->name, name) == 0; }

/* Those of axes groups: test_fb_group. */
#define FOR_EACH_BLOCK(type)                                                                                         \
    for (const block_t *type = block_table; type < block_table + block_count; type++)                                \
        if (!member_of(type, "AxesGroup"))

static void scene(const char *what, const block_t *type, int state)
{
    snprintf(judged.scene, sizeof judged.scene, "%s: %s in %s", what, type->name,
             cm1e_axis_state_name((cm1e_axis_state_t)state));
}

/* ---- every block in every state ---------------------------------------------------------------------------------- */

/** The state after the cycle that brought the edge, and the answer. */
static void expect_by_rule(const block_t *type, cm1e_axis_state_t before)
{
    const block_rule_t *rule = &type->rules[before];
    const shown_t *now = &subject.now;
    if (rule->unchanged) {
        MUST(judged.state == before, "the state is %s", cm1e_axis_state_name(judged.state));
    } else if (rule->refusal != CM1E_OK) {
        MUST(now->error && now->error_id == cm1e_error_id(rule->refusal), "Error %d 0x%04X, 0x%04X is right",
             now->error, now->error_id, cm1e_error_id(rule->refusal));
        MUST(judged.state == before, "refused, but the state is %s", cm1e_axis_state_name(judged.state));
        MUST(!mover.view || !mover.now.aborted, "refused, but the running block is aborted");
    } else {
        MUST(!now->error, "Error 0x%04X", now->error_id);
        MUST(judged.state == rule->next, "the state is %s, %s is right", cm1e_axis_state_name(judged.state),
             cm1e_axis_state_name(rule->next));
    }
}

START_TEST(test_every_block_in_every_state_follows_the_diagram)
{
    int checked = 0;
    FOR_EACH_BLOCK(type) {
        if (!type->rules || is(type, "MC_Power") || is(type, "MC_Reset") || is(type, "MC_Jog"))
            continue;
        for (int state = 0; state < CM1E_AXIS_STATE_COUNT; state++) {
            scene("by the table", type, state);
            mover.view = NULL;
            const bool step = strstr(type->name, "MC_Step") || is(type, "MC_HomeDirect") || is(type, "MC_FinishHoming");
            if (step && state == CM1E_AXIS_HOMING) /* of the kind that is done in steps */
                into_by(CM1E_AXIS_HOMING, &mover, "MC_StepAbsoluteSwitch");
            else if (is(type, "MC_CamOut") && state == CM1E_AXIS_SYNCHRONIZED_MOTION)
                into_by(CM1E_AXIS_SYNCHRONIZED_MOTION, &mover, "MC_CamIn");
            else
                into((cm1e_axis_state_t)state, &mover);
            make(&subject, type->name);
            if (is(type, "CM_FollowPosition"))
                put(&subject, "Position", bench.info.set_position);
            trigger(&subject, true);
            cycle_begin();
            for (int i = 0; i < called_count; i++)
                call(called[i]);
            cycle_end();
            expect_by_rule(type, (cm1e_axis_state_t)state);
            cycles(30);
            checked++;
        }
    }
    ck_assert_int_gt(checked, 100);
}
END_TEST

/* ---- nonsense ---------------------------------------------------------------------------------------------------- */

/** Inputs that the block may well ignore: where the value means nothing in this use. */
static bool may_ignore(const block_t *type, const char *input)
{
    return is(type, "MC_TorqueControl") || (strcmp(input, "Direction") == 0 && !strstr(type->name, "Velocity")) ||
           (is(type, "MC_TouchProbe") && strstr(input, "Position")) || /* without WindowOnly */
           is(type, "MC_Jog");
}

START_TEST(test_no_number_is_refused_by_every_block_and_changes_nothing)
{
    static const double values[] = {NAN, INFINITY, -INFINITY};
    int checked = 0;
    FOR_EACH_BLOCK(type) {
        if (!has_axis(type) || is(type, "MC_Power"))
            continue;
        for (size_t i = 0; i < type->member_count; i++) {
            const block_member_t *m = &type->members[i];
            if (m->section != BLOCK_INPUT || m->type != BLOCK_LREAL || may_ignore(type, m->name))
                continue;
            for (size_t v = 0; v < 3; v++) {
                if (v == 0 && strstr(type->name, "Step") && strcmp(m->name, "SetPosition") == 0)
                    continue; /* NaN: none is set */
                snprintf(judged.scene, sizeof judged.scene, "%s.%s = %g", type->name, m->name, values[v]);
                into(CM1E_AXIS_STANDSTILL, &mover);
                make(&subject, type->name);
                put(&subject, m->name, values[v]);
                trigger(&subject, true);
                const double position = bench.info.set_position;
                cycle();
                MUST(subject.now.error, "it is taken");
                cycles(20);
                MUST(bench.info.set_position == position && judged.state == CM1E_AXIS_STANDSTILL, "it acted");
                checked++;
            }
        }
    }
    ck_assert_int_gt(checked, 100);
}
END_TEST

START_TEST(test_numbers_that_no_enumeration_has_are_refused)
{
    static const int values[] = {-1, 8, 77, 0x7FFFFFFF};
    int checked = 0;
    FOR_EACH_BLOCK(type) {
        if (!has_axis(type))
            continue;
        for (size_t i = 0; i < type->member_count; i++) {
            const block_member_t *m = &type->members[i];
            if (m->section != BLOCK_INPUT || m->type != BLOCK_ENUM || is(type, "MC_TorqueControl") ||
                is(type, "MC_Jog"))
                continue;
            const bool direction = strcmp(m->name, "Direction") == 0;
            for (size_t v = 0; v < sizeof values / sizeof values[0]; v++) {
                snprintf(judged.scene, sizeof judged.scene, "%s.%s = %d", type->name, m->name, values[v]);
                into(CM1E_AXIS_STANDSTILL, &mover);
                make(&subject, type->name);
                memcpy(subject.memory + m->offset, &values[v], sizeof values[v]);
                trigger(&subject, true);
                cycle();
                const bool modulo_only = direction && strstr(type->name, "Absolute") && !strstr(type->name, "Step");
                MUST(subject.now.error || modulo_only, "it is taken");
                checked++;
            }
        }
    }
    ck_assert_int_gt(checked, 40);
}
END_TEST

/* ---- no axis, another axis --------------------------------------------------------------------------------------- */

START_TEST(test_block_without_an_axis_is_an_error_and_survives)
{
    static AXIS_REF_t nobody, gone = {.Handle = 9999};
    AXIS_REF_t *const references[] = {NULL, &nobody, &gone};
    FOR_EACH_BLOCK(type) {
        if (!has_axis(type) || is(type, "MC_Power"))
            continue;
        for (size_t i = 0; i < 3; i++) {
            scene("no axis", type, CM1E_AXIS_STANDSTILL);
            into(CM1E_AXIS_STANDSTILL, &mover);
            make(&subject, type->name);
            point_at_axis(&subject, references[i]);
            trigger(&subject, true);
            put(&subject, "JogForward", 1);
            cycle();
            MUST(subject.now.error, "no Error");
            MUST(subject.now.error_id == cm1e_error_id(CM1E_ERROR_FB_AXIS_REF) || is(type, "MC_TorqueControl"),
                 "ErrorID 0x%04X", subject.now.error_id);
            cycles(3);
            trigger(&subject, false);
            put(&subject, "JogForward", 0);
            cycles(2);
            MUST(!subject.now.error, "the Error stays without a trigger");
        }
    }
}
END_TEST

START_TEST(test_zeroed_block_without_axis_is_harmless)
{
    FOR_EACH_BLOCK(type) {
        scene("zeroed", type, CM1E_AXIS_STANDSTILL);
        into(CM1E_AXIS_CONTINUOUS_MOTION, &mover);
        memset(&subject, 0, sizeof subject);
        subject.view = view_of(type->name);
        if (member_of(type, "Error") == NULL)
            continue; /* IEC 61131-3 */
        for (int n = 0; n < 3; n++) {
            cycle_begin();
            call(&subject);
            cycle_end();
            MUST(!subject.now.busy && !subject.now.error && !subject.now.done, "it does something");
        }
        trigger(&subject, true);
        put(&subject, "JogForward", 1);
        for (int n = 0; n < 3; n++) { /* nothing but the trigger: an error, not a crash */
            cycle_begin();
            call(&subject);
            cycle_end();
        }
        if (has_axis(type) && !is(type, "MC_Power"))
            MUST(subject.now.error, "no Error");
    }
}
END_TEST

START_TEST(test_busy_block_given_another_axis_is_an_error_and_both_axes_go_on)
{
    static AXIS_REF_t another = {.Handle = 4242};
    FOR_EACH_BLOCK(type) {
        if (!has_axis(type) || is(type, "MC_Power") || is(type, "MC_Jog"))
            continue;
        scene("another axis", type, CM1E_AXIS_STANDSTILL);
        into(CM1E_AXIS_STANDSTILL, &mover);
        make(&subject, type->name);
        trigger(&subject, true);
        cycles(3);
        if (!subject.now.busy)
            continue;
        const cm1e_axis_state_t state = judged.state;
        point_at_axis(&subject, &another);
        cycle();
        MUST(subject.now.error && subject.now.error_id == cm1e_error_id(CM1E_ERROR_FB_AXIS_CHANGED),
             "Error %d 0x%04X", subject.now.error, subject.now.error_id);
        MUST(judged.state == state, "the axis is in %s", cm1e_axis_state_name(judged.state));
        trigger(&subject, false);
        cycles(2);
        point_at_axis(&subject, &judged.reference); /* and the same instance works again */
        cycles(2);
        MUST(!subject.now.error, "the Error stays");
    }
}
END_TEST

/* ---- errors ------------------------------------------------------------------------------------------------------ */

/** 2.2.2: who loses the axis by its error shows Error, never CommandAborted; whatever phase it was in. */
START_TEST(test_axis_error_in_every_phase_is_an_error_of_the_block)
{
    static const int phases[] = {0, 1, 2, 5, 20, 60, 150, 300};
    int lost = 0;
    FOR_EACH_BLOCK(type) {
        if (!type->rules || is(type, "MC_Power") || is(type, "MC_Reset") || is(type, "MC_Jog"))
            continue;
        for (size_t i = 0; i < sizeof phases / sizeof phases[0]; i++) {
            snprintf(judged.scene, sizeof judged.scene, "axis error after %d cycles: %s", phases[i], type->name);
            into(CM1E_AXIS_STANDSTILL, &mover);
            make(&subject, type->name);
            trigger(&subject, true);
            cycles(1 + phases[i]);
            const bool busy = subject.now.busy, moves = type->rules[CM1E_AXIS_STANDSTILL].next != CM1E_AXIS_STANDSTILL;
            fake_bus_fault(&bench.bus, 0x2310);
            cycle();
            MUST(judged.state == CM1E_AXIS_ERROR_STOP, "the axis is in %s", cm1e_axis_state_name(judged.state));
            if (!busy || !moves || type->rules[CM1E_AXIS_STANDSTILL].unchanged)
                continue;
            MUST(!subject.now.aborted && (subject.now.error || subject.now.done), "Error %d, CommandAborted %d",
                 subject.now.error, subject.now.aborted); /* Done: it had ended in the cycle before */
            lost += subject.now.error;
        }
    }
    ck_assert_int_gt(lost, 30);
}
END_TEST

/* ---- triggers ---------------------------------------------------------------------------------------------------- */

START_TEST(test_pulse_of_one_call_shows_the_result_for_exactly_one_call)
{
    int ended = 0;
    FOR_EACH_BLOCK(type) {
        if (!has_axis(type) || !member_of(type, "Execute") || is(type, "MC_Stop"))
            continue;
        scene("pulse", type, CM1E_AXIS_STANDSTILL);
        into(CM1E_AXIS_STANDSTILL, &mover);
        make(&subject, type->name);
        trigger(&subject, true);
        cycle();
        trigger(&subject, false);
        int results = subject.now.done + subject.now.error;
        for (int n = 0; n < 3000; n++) {
            cycle();
            results += subject.now.done + subject.now.error + subject.now.aborted;
        }
        MUST(results == !subject.now.busy, "%d results, Busy %d", results, subject.now.busy);
        ended += results;
    }
    ck_assert_int_gt(ended, 15);
}
END_TEST

START_TEST(test_enable_taken_away_clears_all_outputs_at_once)
{
    FOR_EACH_BLOCK(type) {
        if (member_of(type, "Execute") || !member_of(type, "Enable") || is(type, "MC_Power"))
            continue;
        for (int state = 0; state < CM1E_AXIS_STATE_COUNT; state++) {
            scene("Enable", type, state);
            into((cm1e_axis_state_t)state, &mover);
            make(&subject, type->name);
            for (int n = 0; n < 3; n++) {
                trigger(&subject, true);
                cycles(3);
                MUST(subject.now.valid && subject.now.busy, "Valid %d, Busy %d, ErrorID 0x%04X", subject.now.valid,
                     subject.now.busy, subject.now.error_id);
                trigger(&subject, false);
                cycle();
            }
        }
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("conformance: states");
    bench.with_master = true;
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_test(all, test_every_block_in_every_state_follows_the_diagram);
    tcase_add_test(all, test_no_number_is_refused_by_every_block_and_changes_nothing);
    tcase_add_test(all, test_numbers_that_no_enumeration_has_are_refused);
    tcase_add_test(all, test_block_without_an_axis_is_an_error_and_survives);
    tcase_add_test(all, test_zeroed_block_without_axis_is_harmless);
    tcase_add_test(all, test_busy_block_given_another_axis_is_an_error_and_both_axes_go_on);
    tcase_add_test(all, test_axis_error_in_every_phase_is_an_error_of_the_block);
    tcase_add_test(all, test_pulse_of_one_call_shows_the_result_for_exactly_one_call);
    tcase_add_test(all, test_enable_taken_away_clears_all_outputs_at_once);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
