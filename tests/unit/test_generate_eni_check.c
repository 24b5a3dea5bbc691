/* Every rule about an ENI: a good file is broken in one way, and the checker finds that and nothing else. */
#include <stdio.h>
#include <string.h>

#include "core/bytes.h"
#include "description/describe.h"
#include "eni_networks.h"
#include "generate/eni.h"
#include "unity.h"

static cm1e_diag_t diag;
static cm1e_description_file_t described;
static cm1e_eni_t made, document;
static cm1e_file_t file;
static cm1e_findings_t *findings;

void setUp(void) { diag = (cm1e_diag_t){0}; }

void tearDown(void)
{
    cm1e_eni_free(&made);
    cm1e_eni_free(&document);
    cm1e_file_free(&file);
    cm1e_findings_free(findings);
    findings = NULL;
    cm1e_description_file_free(&described);
}

/* The network as a reader has it, with its lines. */
static void read_network(const eni_network_t *network)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, eni_network_make(&made, &described, network, &diag), diag.text);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_eni_write(&file, &made, &diag));
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_eni_read(&document, file.bytes, file.size, &diag), diag.text);
    findings = cm1e_findings_create();
}

static void test_what_we_make_has_no_findings(void)
{
    const eni_network_t large = {.count = 128}, alias = {.count = 2, .alias = 5};
    const eni_network_t *networks[] = {&eni_networks[ENI_ONE], &eni_networks[ENI_THREE], &eni_networks[ENI_MIXED],
                                       &eni_networks[ENI_BRIDGED], &large, &alias};
    for (size_t i = 0; i < sizeof networks / sizeof networks[0]; i++) {
        read_network(networks[i]);
        cm1e_eni_check(findings, &document);
        if (cm1e_findings_count(findings) > 0)
            TEST_FAIL_MESSAGE(cm1e_findings_at(findings, 0)->text);
        tearDown();
    }
}

/* ---- ways to break a file --------------------------------------------------------------------------------------- */

static cm1e_eni_device_t *device(size_t n) { return &document.devices.at[n]; }

static cm1e_eni_command_t *command(cm1e_eni_device_t *of, const char *comment)
{
    for (size_t i = 0; i < of->commands.count; i++)
        if (strcmp(of->commands.at[i].comment, comment) == 0)
            return &of->commands.at[i];
    TEST_FAIL_MESSAGE(comment);
    return NULL;
}

/* The data of a command, to be written to. */
static uint8_t *data_of(cm1e_eni_device_t *of, const char *comment)
{
    return (uint8_t *)(uintptr_t)command(of, comment)->data.data;
}

static cm1e_eni_command_t *cyclic_command(size_t frame, size_t n)
{
    return &document.cyclics.at[0].frames.at[frame].commands.at[n];
}

static void readdress(cm1e_eni_device_t *of, uint16_t station, uint16_t position)
{
    for (size_t i = 0; i < of->commands.count; i++) {
        cm1e_eni_command_t *c = &of->commands.at[i];
        c->adp = c->code == CM1E_ENI_FPRD || c->code == CM1E_ENI_FPWR ? station : position;
    }
    cm1e_put_u16(data_of(of, "set physical address"), station);
    of->station = station;
    of->position = position;
}

static void station_twice(void)
{
    readdress(device(2), device(0)->station, device(2)->position);
}
static void station_missing(void)
{
    readdress(device(0), 0, device(0)->position);
    device(1)->previous.count = 0;
}
static void position_out_of_order(void) { readdress(device(1), device(1)->station, 5); }
static void previous_port_nowhere(void) { device(2)->previous.at[0].station = 0x2000; }
static void previous_port_behind(void) { device(1)->previous.at[0].station = device(2)->station; }
static void command_to_another(void) { command(device(2), "set sm 2 (outputs)")->adp = device(0)->station; }
static void position_of_another(void) { command(device(2), "check vendor id")->adp = device(0)->position; }
static void another_address_given(void) { data_of(device(2), "set physical address")[0] ^= 0xFF; }
static void mask_too_short(void) { command(device(0), "check device state for OP")->mask.size = 2; }
static void answer_too_short(void) { command(device(0), "check device state for OP")->length = 4; }
static void nobody_asks_for_op(void) { command(device(0), "set device state to OP")->transitions = 0; }
static void asks_for_safeop_instead(void) { data_of(device(0), "set device state to OP")[0] = 4; }
/* As SOEM could do with: it asks by itself, and makes frames and images of its own. */
static void sdos_alone(void)
{
    device(0)->commands.count = 0;
    document.cyclics.count = 0;
    document.has_image = false;
    document.inputs.variables.count = document.outputs.variables.count = 0;
}
static void length_unlike_pdos(void) { data_of(device(0), "set sm 2 (outputs)")[2]++; }
static void control_unlike_stated(void) { data_of(device(0), "set sm 2 (outputs)")[4] = 0x24; }
static void mailbox_unlike_stated(void) { data_of(device(0), "set sm 0 (mailbox out)")[2] -= 8; }
static void send_unlike_pdos(void) { device(0)->send.length += 8; }
static void receive_unlike_pdos(void) { device(0)->receive.length -= 8; }
static void fmmu_of_no_type(void) { data_of(device(0), "set fmmu 0 (outputs)")[11] = 3; }
static void fmmu_on_no_sync_manager(void) { data_of(device(0), "set fmmu 0 (outputs)")[9] = 0x30; }
static void fmmu_on_the_wrong_sync_manager(void) { data_of(device(0), "set fmmu 0 (outputs)")[9] = 0x14; }
static void fmmu_beyond_the_frame(void) { data_of(device(0), "set fmmu 1 (inputs)")[0] += 4; }
static void coe_not_spoken(void) { device(0)->mailbox.coe = false; }
static void sdo_without_data(void) { device(0)->mailbox.sdos.at[0].data.size = 0; }
static void sdo_without_transition(void) { device(0)->mailbox.sdos.at[0].transitions = 0; }
static void sdo_that_does_nothing(void) { device(0)->mailbox.sdos.at[0].specifier = 3; }
static void mailbox_without_length(void)
{
    device(0)->mailbox.send.length = 0;
    data_of(device(0), "set sm 0 (mailbox out)")[2] = 0;
}
static void mailboxes_overlap(void)
{
    device(0)->mailbox.receive.start = 0x1040;
    data_of(device(0), "set sm 1 (mailbox in)")[0] = 0x40;
}
static void outputs_at_another_bit(void) { device(0)->send.start += 8; }
static void inputs_at_another_bit(void) { device(0)->receive.start -= 8; }
static void variable_behind_the_image(void)
{
    cm1e_eni_variable_t *last = &document.inputs.variables.at[document.inputs.variables.count - 1];
    last->offset = document.inputs.bytes * 8 - 7;
}
static void image_too_short(void) { document.inputs.bytes = 16 + 10 + 20; }
/* The last of 71 slaves is alone in the second frame. */
static void frames_over_each_other(void)
{
    cyclic_command(1, 0)->input_offset = cyclic_command(0, 0)->input_offset;
    device(70)->receive.start = device(0)->receive.start;
}
/* Only by the last byte. */
static void frames_share_a_byte(void)
{
    const int64_t before = cyclic_command(1, 0)->input_offset;
    cyclic_command(1, 0)->input_offset = cyclic_command(0, 0)->input_offset + cyclic_command(0, 0)->length - 1;
    device(70)->receive.start -= 8 * (uint32_t)(before - cyclic_command(1, 0)->input_offset);
}
static void variable_twice(void) { document.outputs.variables.at[3].name = document.outputs.variables.at[1].name; }
static void counts_wrong(void) { cyclic_command(0, 0)->count = 2; }
static void states_of_too_few(void) { cyclic_command(0, 1)->count--; }
static void frame_too_long(void) { cyclic_command(0, 0)->length += 1480; }
static void another_cycle_time(void) { document.cyclics.at[0].cycle_time_us = 2000; }
static void revision_unknown(void) { device(0)->revision = 1; }
/* 0x1A01, which is not assigned: nothing else depends on it. */
static void entry_that_no_mapping_has(void) { device(0)->pdos.at[1].entries.at[0].bits = 32; }
static void pdo_that_no_motor_has(void) { device(0)->pdos.at[1].index = 0x1A07; }
static void entry_missing(void) { device(0)->pdos.at[1].entries.count--; }

static const struct breakage {
    const char *rule;
    int network;
    size_t axes; /* instead of it, where not 0 */
    void (*break_it)(void);
    size_t findings;
} breakages[] = {
    {"eni-station", ENI_MIXED, 0, station_twice, 1},
    {"eni-station", ENI_ONE, 2, station_missing, 1},
    {"eni-position", ENI_MIXED, 0, position_out_of_order, 1},
    {"eni-previous-port", ENI_MIXED, 0, previous_port_nowhere, 1},
    {"eni-previous-port", ENI_MIXED, 0, previous_port_behind, 1},
    {"eni-command-address", ENI_MIXED, 0, command_to_another, 1},
    {"eni-command-address", ENI_MIXED, 0, position_of_another, 1},
    {"eni-command-address", ENI_MIXED, 0, another_address_given, 1},
    {"eni-validate", ENI_ONE, 0, mask_too_short, 1},
    {"eni-validate", ENI_ONE, 0, answer_too_short, 1},
    {"eni-start", ENI_ONE, 0, nobody_asks_for_op, 1},
    {"eni-start", ENI_ONE, 0, asks_for_safeop_instead, 1},
    {"eni-start", ENI_ONE, 0, sdos_alone, 3},
    {"eni-sync-manager", ENI_ONE, 0, length_unlike_pdos, 1},
    {"eni-sync-manager", ENI_ONE, 0, control_unlike_stated, 1},
    {"eni-sync-manager", ENI_ONE, 0, mailbox_unlike_stated, 1},
    {"eni-process-data", ENI_ONE, 0, send_unlike_pdos, 1},
    {"eni-process-data", ENI_ONE, 0, receive_unlike_pdos, 1},
    {"eni-fmmu", ENI_ONE, 0, fmmu_of_no_type, 1},
    {"eni-fmmu", ENI_ONE, 0, fmmu_on_no_sync_manager, 1},
    {"eni-fmmu", ENI_ONE, 0, fmmu_on_the_wrong_sync_manager, 1},
    {"eni-fmmu", ENI_ONE, 0, fmmu_beyond_the_frame, 1},
    {"eni-mailbox", ENI_ONE, 0, coe_not_spoken, 1},
    {"eni-mailbox", ENI_ONE, 0, sdo_without_data, 1},
    {"eni-mailbox", ENI_ONE, 0, sdo_without_transition, 1},
    {"eni-mailbox", ENI_ONE, 0, sdo_that_does_nothing, 1},
    {"mailbox-size", ENI_ONE, 0, mailbox_without_length, 1},
    {"sync-managers-overlap", ENI_ONE, 0, mailboxes_overlap, 1},
    {"eni-image-place", ENI_ONE, 0, outputs_at_another_bit, 1},
    {"eni-image-place", ENI_ONE, 0, inputs_at_another_bit, 1},
    {"eni-image-range", ENI_ONE, 0, variable_behind_the_image, 1},
    {"eni-image-range", ENI_ONE, 0, image_too_short, 2}, /* the slave's range, its last variable */
    {"eni-image-overlap", ENI_ONE, 71, frames_over_each_other, 2}, /* of slaves, and of commands */
    {"eni-image-overlap", ENI_ONE, 71, frames_share_a_byte, 2},
    {"eni-variable-twice", ENI_ONE, 0, variable_twice, 1},
    {"eni-working-counter", ENI_MIXED, 0, counts_wrong, 1},
    {"eni-working-counter", ENI_MIXED, 0, states_of_too_few, 1},
    {"eni-frame", ENI_ONE, 0, frame_too_long, 1},
    {"eni-cycle-time", ENI_ONE, 0, another_cycle_time, 1},
    {"eni-cm1e-revision", ENI_ONE, 0, revision_unknown, 1},
    {"eni-cm1e-pdo", ENI_ONE, 0, entry_that_no_mapping_has, 1},
    {"eni-cm1e-pdo", ENI_ONE, 0, pdo_that_no_motor_has, 1},
    {"eni-cm1e-pdo", ENI_ONE, 0, entry_missing, 1},
};
enum { BREAKAGES = sizeof breakages / sizeof breakages[0] };

static void test_every_breakage_is_found_and_nothing_else(void)
{
    for (size_t i = 0; i < BREAKAGES; i++) {
        const struct breakage *breakage = &breakages[i];
        const eni_network_t large = {.count = breakage->axes};
        char message[1200];
        read_network(breakage->axes > 0 ? &large : &eni_networks[breakage->network]);
        breakage->break_it();
        cm1e_eni_check(findings, &document);
        snprintf(message, sizeof message, "row %zu: %s", i, breakage->rule);
        TEST_ASSERT_EQUAL_MESSAGE(breakage->findings, cm1e_findings_count(findings), message);
        for (size_t n = 0; n < breakage->findings; n++) {
            const cm1e_finding_t *finding = cm1e_findings_at(findings, n);
            TEST_ASSERT_EQUAL_STRING_MESSAGE(breakage->rule, finding->rule, finding->text);
            TEST_ASSERT_TRUE_MESSAGE(finding->line > 0, finding->text);
            TEST_ASSERT_TRUE_MESSAGE(strlen(finding->text) > 20, finding->text);
        }
        tearDown();
    }
}

/* The list of rules and the rows above: none is left out. */
static void test_every_rule_of_eni_has_a_breakage(void)
{
    static const char *const names[] = {
#define NAME(enumerator, name, is_error) name,
        CM1E_RULES(NAME)
#undef NAME
    };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        bool broken = strncmp(names[i], "eni-", 4) != 0;
        for (size_t b = 0; b < BREAKAGES; b++)
            broken |= strcmp(breakages[b].rule, names[i]) == 0;
        TEST_ASSERT_TRUE_MESSAGE(broken, names[i]);
    }
}

/* Others count the image from the data, not from the datagram (eni.h); that is no finding. */
static void test_either_meaning_of_the_offsets_is_taken(void)
{
    read_network(&eni_networks[ENI_MIXED]);
    for (size_t f = 0; f < 1; f++)
        for (size_t i = 0; i < 2; i++) {
            cyclic_command(f, i)->input_offset += CM1E_ENI_DATAGRAM_HEADER;
            cyclic_command(f, i)->output_offset += CM1E_ENI_DATAGRAM_HEADER;
        }
    cm1e_eni_check(findings, &document);
    TEST_ASSERT_EQUAL(0, cm1e_findings_count(findings));
}

static void test_diagnosis_of_twincat_may_lie_behind_the_image(void)
{
    read_network(&eni_networks[ENI_ONE]);
    variable_behind_the_image();
    document.inputs.variables.at[document.inputs.variables.count - 1].name = "X.InfoData.State";
    cm1e_eni_check(findings, &document);
    TEST_ASSERT_EQUAL(0, cm1e_findings_count(findings));
}

/* The descriptions are optional; then the assignment names what nobody describes. */
static void test_pdos_may_be_named_without_being_described(void)
{
    read_network(&eni_networks[ENI_ONE]);
    device(0)->pdos.count = 0;
    cm1e_eni_check(findings, &document);
    TEST_ASSERT_EQUAL(0, cm1e_findings_count(findings));
}

/* ---- beside a live device --------------------------------------------------------------------------------------- */

static void test_a_position_that_the_file_does_not_have_is_said(void)
{
    read_network(&eni_networks[ENI_ONE]);
    cm1e_eni_compare(findings, &document, 2, &described.devices.at[0]);
    cm1e_eni_compare(findings, &document, 0, &described.devices.at[0]);
    TEST_ASSERT_EQUAL(2, cm1e_findings_count(findings));
    TEST_ASSERT_EQUAL_STRING("differs", cm1e_findings_at(findings, 0)->rule);
}

static void test_the_device_that_the_file_was_made_for_does_not_differ(void)
{
    read_network(&eni_networks[ENI_MIXED]);
    for (uint16_t position = 1; position <= document.devices.count; position++)
        cm1e_eni_compare(findings, &document, position, &described.devices.at[position - 1]);
    if (cm1e_findings_count(findings) > 0)
        TEST_FAIL_MESSAGE(cm1e_findings_at(findings, 0)->text);
}

static void test_another_device_is_told_apart(void)
{
    static const struct {
        const char *rule;
        void (*break_it)(void);
    } rows[] = {{"differs-identity", revision_unknown},
                {"differs-pdo", entry_that_no_mapping_has},
                {"differs-sync-manager", control_unlike_stated},
                {"differs-mailbox", coe_not_spoken}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        read_network(&eni_networks[ENI_ONE]);
        rows[i].break_it();
        cm1e_eni_compare(findings, &document, 1, &described.devices.at[0]);
        TEST_ASSERT_EQUAL_MESSAGE(1, cm1e_findings_count(findings), rows[i].rule);
        TEST_ASSERT_EQUAL_STRING(rows[i].rule, cm1e_findings_at(findings, 0)->rule);
        TEST_ASSERT_TRUE(cm1e_findings_at(findings, 0)->line > 0);
        tearDown();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_we_make_has_no_findings);
    RUN_TEST(test_every_breakage_is_found_and_nothing_else);
    RUN_TEST(test_every_rule_of_eni_has_a_breakage);
    RUN_TEST(test_either_meaning_of_the_offsets_is_taken);
    RUN_TEST(test_diagnosis_of_twincat_may_lie_behind_the_image);
    RUN_TEST(test_pdos_may_be_named_without_being_described);
    RUN_TEST(test_a_position_that_the_file_does_not_have_is_said);
    RUN_TEST(test_the_device_that_the_file_was_made_for_does_not_differ);
    RUN_TEST(test_another_device_is_told_apart);
    return UNITY_END();
}
