/**
 * The flow charts of appendix 2 of the bridge's guide, CML strings, with every motor of a bridge: each branch of each
 * chart is taken. What counts is what was on the wire: 0000h for five cycles, the string to F58xh, more than 1 ms, the
 * answers from F59xh until the right one comes, 10 ms between the lines of a list.
 */
#include "bridge_drives.h"
#include "drive/drive_cml.h"

enum { CML = CM1E_BRIDGE_MODE_CML, PDO_CYCLES = 5, WAIT_NS = 1000000, LINE_NS = 10000000 };

typedef enum way {
    K_EMPTY, K_NOT_EMPTY, K_RIGHT, K_OTHER,
    WRITTEN,
    QUERY_EMPTY, QUERY_NOT_EMPTY, QUERY_RIGHT, QUERY_OTHER,
    SEARCH_EMPTY, SEARCH_NOT_EMPTY, SEARCH_ORIGIN, SEARCH_NO_ORIGIN, SEARCH_FAILED, SEARCH_OTHER,
    LIST_EMPTY, LIST_BEGINS, LIST_GOES_ON, LIST_ENDS,
    OUTPUTS_SENT,
} way_t;

static branch_t branches[] = {
    [K_EMPTY] = {"2.1", "received Null", "yes: no data, receive again", 0},
    [K_NOT_EMPTY] = {"2.1", "received Null", "no", 0},
    [K_RIGHT] = {"2.1", "received K53.1=**", "yes: completed", 0},
    [K_OTHER] = {"2.1", "received K53.1=**", "no: of a query before, receive again", 0},
    [WRITTEN] = {"2.2", "K53.1=100", "sending completed", 0},
    [QUERY_EMPTY] = {"2.3", "received Null", "yes: no data, receive again", 0},
    [QUERY_NOT_EMPTY] = {"2.3", "received Null", "no", 0},
    [QUERY_RIGHT] = {"2.3", "received Ux.1=**", "yes: completed", 0},
    [QUERY_OTHER] = {"2.3", "received Ux.1=**", "no: of a query before, receive again", 0},
    [SEARCH_EMPTY] = {"2.4", "received Null", "yes: no data, receive again", 0},
    [SEARCH_NOT_EMPTY] = {"2.4", "received Null", "no", 0},
    [SEARCH_ORIGIN] = {"2.4", "received Origin.1=***", "yes: origin search complete", 0},
    [SEARCH_NO_ORIGIN] = {"2.4", "received Origin.1=***", "no", 0},
    [SEARCH_FAILED] = {"2.4", "received Ux.1=***", "yes: no origin, error termination", 0},
    [SEARCH_OTHER] = {"2.4", "received Ux.1=***", "no: receive again", 0},
    [LIST_EMPTY] = {"2.5", "received Null ahead of the first line", "yes: no data, receive again", 0},
    [LIST_BEGINS] = {"2.5", "received Null ahead of the first line", "no: process, wait 10 ms", 0},
    [LIST_GOES_ON] = {"2.5", "received Null behind a line", "no: process, wait 10 ms", 0},
    [LIST_ENDS] = {"2.5", "received Null behind a line", "yes: all lines received", 0},
    [OUTPUTS_SENT] = {"2.6", "O1.1,O2.1,F3.1,O4.1", "sending completed", 0},
};

/* ---- one motor --------------------------------------------------------------------------------------------------- */

static int asked;                /* number of the motor */
static cm1e_drive_cml_t cml;
static const char *stray;        /* comes into the mailbox as soon as a string is sent */
static bool late;                /* the motor takes longer with its answer than its string took */
static int sends_before;

static uint16_t send_index(void) { return (uint16_t)(OBJ_F581_CML_COMMAND_AXIS_1 + asked); }
static uint16_t receive_index(void) { return (uint16_t)(OBJ_F591_CML_RESPONSE_AXIS_1 + asked); }

static cm1e_error_t submit(void *context, cm1e_sdo_t *sdo)
{
    (void)context;
    return cm1e_sdo_submit(bus, sdo);
}

/* A line ahead of all that wait in the mailbox of the bridge. */
static void put_stray(void)
{
    cm1e_sim_cml_t *mailbox = &motor(asked)->cml;
    mailbox->first = (mailbox->first + CML_LINES - 1) % CML_LINES;
    mailbox->count++;
    mailbox->lines[mailbox->first].due_ns = 0;
    snprintf(mailbox->lines[mailbox->first].text, sizeof mailbox->lines[0].text, "%s\r\n", stray);
    stray = NULL;
}

enum { LATE_NS = 15000000 };

static void delay_answers(void)
{
    cm1e_sim_cml_t *mailbox = &motor(asked)->cml;
    if (mailbox->count == 0 && mailbox->list_next == 0)
        return;
    for (unsigned i = 0; i < mailbox->count; i++)
        mailbox->lines[(mailbox->first + i) % CML_LINES].due_ns += LATE_NS;
    mailbox->list_due_ns += LATE_NS;
    late = false;
}

static void step(void)
{
    const int last = bridge_wire.word_count[asked] - 1;
    const word_run_t *end = &bridge_wire.words[asked][last];
    const bool silent = last >= 0 && end->word == 0 && end->cycles >= PDO_CYCLES;
    const bool sent = count_sdos(true, send_index()) > sends_before;
    if (late && sent)
        delay_answers();
    if (stray && sent)
        put_stray();
    cm1e_drive_cml_step(&cml, now_ns(), silent && drives[asked].feedback.mode == CML);
}

static void open_cml(int n)
{
    open_drives();
    asked = n;
    stray = NULL;
    late = false;
    cm1e_drive_cml_init(&cml, 1, (uint8_t)(n + 1), submit, NULL);
    cycles(100);
    each_cycle = step;
    drives[n].command.mode = (cm1e_mode_t)CML; /* the first string waits until it is reached */
}

static void for_motor(char *text, size_t size, const char *format)
{
    size_t used = 0;
    for (; *format && used + 1 < size; format++)
        text[used++] = *format == '#' ? (char)('1' + asked) : *format;
    text[used] = '\0';
}

/** Sends a string ('#' is the motor) and waits for its end. */
static const cm1e_drive_cml_request_t *exchange(const char *format)
{
    char text[CM1E_CML_BYTES + 1];
    uint32_t ticket;
    for_motor(text, sizeof text, format);
    sends_before = count_sdos(true, send_index());
    ck_assert_msg(cm1e_drive_cml_send(&cml, text, 0, &ticket) == CM1E_OK, "%s is not taken", text);
    const cm1e_drive_cml_request_t *request = cm1e_drive_cml_request(&cml, ticket);
    for (int i = 0; i < 10000 && request->state < CM1E_DRIVE_CML_DONE; i++)
        cycles(1);
    return request;
}

static const cm1e_drive_cml_request_t *succeed(const char *format)
{
    const cm1e_drive_cml_request_t *request = exchange(format);
    ck_assert_msg(request->state == CM1E_DRIVE_CML_DONE, "%s: %s, \"%s\"", request->text,
                  cm1e_strerror(request->error), request->first);
    return request;
}

/* ---- what is judged ---------------------------------------------------------------------------------------------- */

static bool is_null(const sdo_seen_t *sdo) { return strcmp(sdo->data, "Null\r\n") == 0; }

/** The string went out once, behind 0000h for five cycles. Returns its number among the SDOs. */
static int check_sent(const cm1e_drive_cml_request_t *request)
{
    int number = -1;
    for (int i = 0; i <= sends_before; i++)
        ck_assert_msg(find_sdo(number + 1, true, send_index(), &number), "%s was not sent", request->text);
    const sdo_seen_t *sdo = &bridge_wire.sdos[number];
    ck_assert_str_eq(sdo->data, request->text);
    ck_assert_int_eq(count_sdos(true, send_index()), sends_before + 1);
    const word_run_t *word = &bridge_wire.words[asked][bridge_wire.word_count[asked] - 1];
    ck_assert_msg(word->word == 0 && sdo->sent_ns - word->from_ns >= (PDO_CYCLES - 1) * INT64_C(1000000),
                  "%s: not behind 0000h for five cycles:%s", request->text, words_seen((unsigned)asked));
    return number;
}

/** Receptions behind a string, each more than 1 ms later than what was before it. Returns how many were empty until the
 *  first that was not. */
static int check_receptions(int number)
{
    int empty = 0;
    bool found = false;
    for (const sdo_seen_t *sdo, *before = &bridge_wire.sdos[number];
         (sdo = find_sdo(number + 1, false, receive_index(), &number)); before = sdo) {
        ck_assert_msg(sdo->sent_ns - before->answered_ns >= WAIT_NS, "F59%dh is read after %.1f ms", asked + 1,
                      (double)(sdo->sent_ns - before->answered_ns) * 1e-6);
        found = found || !is_null(sdo);
        empty += !found && is_null(sdo);
    }
    ck_assert(found);
    return empty;
}

/** Charts 2.1 and 2.3: `other` is what another query would have been answered with. */
static void run_query(const char *query, const char *answer, const char *other, way_t first)
{
    char expected[CM1E_CML_BYTES + 1], text[CM1E_CML_BYTES + 1];
    late = true;
    const cm1e_drive_cml_request_t *request = succeed(query);
    for_motor(expected, sizeof expected, answer);
    ck_assert_msg(strncmp(request->first, expected, strlen(expected)) == 0 && request->strays == 0, "%s: %s",
                  request->text, request->first);
    branches[first].taken += check_receptions(check_sent(request)) > 0;
    branches[first + 1].taken++;
    branches[first + 2].taken++;

    for_motor(text, sizeof text, other);
    stray = text;
    request = succeed(query);
    ck_assert_msg(strncmp(request->first, expected, strlen(expected)) == 0, "%s: %s", request->text, request->first);
    ck_assert_uint_eq(request->strays, 1);
    check_receptions(check_sent(request));
    branches[first + 3].taken++;
}

/* ---- tests ------------------------------------------------------------------------------------------------------- */

START_TEST(test_parameter_is_read)
{
    open_cml(_i);
    run_query("K53.#", "K53.#=", "Ux.#=8", K_EMPTY);
    close_drives();
}
END_TEST

START_TEST(test_parameter_is_written)
{
    open_cml(_i);
    const cm1e_drive_cml_request_t *request = succeed("K53.#=100");
    ck_assert_uint_eq(request->lines, 0);
    check_sent(request);
    branches[WRITTEN].taken++;
    request = succeed("K53.#");
    ck_assert_msg(strstr(request->first, "=100"), "%s", request->first);
    close_drives();
}
END_TEST

START_TEST(test_status_is_queried)
{
    open_cml(_i);
    run_query("?99.#", "Ux.#=", "K53.#=5", QUERY_EMPTY);
    close_drives();
}
END_TEST

/** In the mailbox before the string was sent: taken out, and no answer to it. */
START_TEST(test_answer_that_came_before_is_none)
{
    char text[CM1E_CML_BYTES + 1];
    open_cml(_i);
    succeed("?99.#");
    for_motor(text, sizeof text, "K53.#=4711");
    stray = text;
    put_stray();
    const cm1e_drive_cml_request_t *request = succeed("K53.#");
    ck_assert_msg(!strstr(request->first, "4711"), "%s", request->first);
    ck_assert_uint_eq(request->strays, 1);
    close_drives();
}
END_TEST

START_TEST(test_origin_search)
{
    char text[CM1E_CML_BYTES + 1];
    open_cml(_i);
    succeed("K42.#=5000,K43.#=5000");
    succeed("(.#");
    for_motor(text, sizeof text, "K53.#=5");
    stray = text; /* neither Origin nor Ux */
    const cm1e_drive_cml_request_t *request = succeed("|.#");
    ck_assert_msg(strncmp(request->first, "Origin.", 7) == 0, "%s", request->first);
    ck_assert_uint_eq(request->strays, 1);
    check_receptions(check_sent(request));
    branches[SEARCH_EMPTY].taken++;
    branches[SEARCH_NOT_EMPTY].taken++;
    branches[SEARCH_NO_ORIGIN].taken++;
    branches[SEARCH_OTHER].taken++;
    branches[SEARCH_ORIGIN].taken++;
    cycles(100);
    ck_assert_msg(abs(bridge_wire.position[_i]) < 30, "ID%d: at %d after its search", _i + 1, bridge_wire.position[_i]);
    close_drives();
}
END_TEST

static int search_cycles;

static void step_and_fail(void)
{
    search_cycles += cm1e_sim_search_running(&motor(asked)->search);
    if (search_cycles == 200)
        simulate("motor 1 %d error overload", asked);
    step();
}

START_TEST(test_origin_search_that_fails)
{
    open_cml(_i);
    succeed("(.#");
    search_cycles = 0;
    each_cycle = step_and_fail;
    const cm1e_drive_cml_request_t *request = exchange("|.#");
    ck_assert_msg(request->state == CM1E_DRIVE_CML_ERROR && request->error == CM1E_ERROR_CM_SEARCH, "%s: %s",
                  request->text, cm1e_strerror(request->error));
    ck_assert_msg(strncmp(request->first, "Ux.", 3) == 0, "%s", request->first);
    check_sent(request);
    branches[SEARCH_FAILED].taken++;
    close_drives();
}
END_TEST

START_TEST(test_list_of_many_lines)
{
    open_cml(_i);
    late = true;
    const cm1e_drive_cml_request_t *request = succeed("?90.#");
    int number = check_sent(request), lines = 0, empty = 0;
    const sdo_seen_t *before = NULL;
    for (const sdo_seen_t *sdo; (sdo = find_sdo(number + 1, false, receive_index(), &number)); before = sdo) {
        if (before && !is_null(before))
            ck_assert_msg(sdo->sent_ns - before->answered_ns >= LINE_NS, "F59%dh is read %.1f ms behind a line",
                          asked + 1, (double)(sdo->sent_ns - before->answered_ns) * 1e-6);
        lines += !is_null(sdo);
        empty += is_null(sdo) && lines == 0;
    }
    ck_assert_int_gt(lines, 10);
    ck_assert_msg((unsigned)lines == request->lines && is_null(before), "%d lines on the wire, %u kept", lines,
                  request->lines);
    for (unsigned i = 0; i < request->lines; i++)
        ck_assert_msg(cm1e_drive_cml_line(&cml, request->ticket, i)[0] == 'K', "line %u: %s", i,
                      cm1e_drive_cml_line(&cml, request->ticket, i));
    branches[LIST_EMPTY].taken += empty > 0;
    branches[LIST_BEGINS].taken++;
    branches[LIST_GOES_ON].taken++;
    branches[LIST_ENDS].taken++;
    close_drives();
}
END_TEST

START_TEST(test_outputs_are_switched)
{
    open_cml(_i);
    const cm1e_drive_cml_request_t *request = succeed("O1.#,O2.#,F3.#,O4.#");
    ck_assert_uint_eq(request->lines, 0);
    check_sent(request);
    cycles(10);
    ck_assert_int_eq(motor(_i)->outputs, motor(_i)->motor == CM1E_BRIDGE_CM1 ? 0x02 : 0x0B);
    branches[OUTPUTS_SENT].taken++;
    close_drives();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("flow charts of appendix 2");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_loop_test(all, test_parameter_is_read, 0, DRIVES);
    tcase_add_loop_test(all, test_parameter_is_written, 0, DRIVES);
    tcase_add_loop_test(all, test_status_is_queried, 0, DRIVES);
    tcase_add_loop_test(all, test_answer_that_came_before_is_none, 0, DRIVES);
    tcase_add_loop_test(all, test_origin_search, 0, DRIVES);
    tcase_add_loop_test(all, test_origin_search_that_fails, 0, DRIVES);
    tcase_add_loop_test(all, test_list_of_many_lines, 0, DRIVES);
    tcase_add_loop_test(all, test_outputs_are_switched, 0, DRIVES);
    suite_add_tcase(suite, all);
    return run_flows(suite, branches, sizeof branches / sizeof branches[0]);
}
