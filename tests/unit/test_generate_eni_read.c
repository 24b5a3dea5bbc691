/* ENI files of others: what is tolerated, and what is refused with its line. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "chance.h"
#include "description/describe.h"
#include "eni_networks.h"
#include "generate/eni.h"
#include "unity.h"

static cm1e_diag_t diag;
static cm1e_eni_t document;

void setUp(void) { diag = (cm1e_diag_t){0}; }
void tearDown(void) { cm1e_eni_free(&document); }

static cm1e_error_t read_text(const char *text)
{
    cm1e_eni_free(&document);
    return cm1e_eni_read(&document, text, strlen(text), &diag);
}

#define MASTER "<Master><Info><Name><![CDATA[Device 1 (EtherCAT)]]></Name></Info></Master>"
#define CONFIG(content) "<?xml version=\"1.0\"?>\n<EtherCATConfig><Config>" MASTER content "</Config></EtherCATConfig>"
#define SLAVE(content) CONFIG("<Slave><Info><Name>A</Name><PhysAddr>1001</PhysAddr></Info>" content "</Slave>")
#define COMMAND(content) SLAVE("<InitCmds><InitCmd><Transition>IP</Transition>" content "</InitCmd></InitCmds>")

static void reads(const char *text)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, read_text(text), diag.text);
}

static void refused(const char *text, const char *what)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_FILE, read_text(text), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "line "), diag.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, what), diag.text);
}

/* ---- tolerated -------------------------------------------------------------------------------------------------- */

static void test_numbers_are_taken_as_files_write_them(void)
{
    reads(CONFIG("<Slave><Info><Name>A</Name><PhysAddr>#x3E9</PhysAddr><AutoIncAddr>-1</AutoIncAddr>"
                 "<VendorId>0x2</VendorId><ProductCode>-1</ProductCode><RevisionNo>-2147483647</RevisionNo>"
                 "</Info></Slave>"));
    const cm1e_eni_device_t *device = &document.devices.at[0];
    TEST_ASSERT_EQUAL(1001, device->station);
    TEST_ASSERT_EQUAL(65535, device->position);
    TEST_ASSERT_EQUAL_HEX32(2, device->vendor_id);
    TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFF, device->product_code);
    TEST_ASSERT_EQUAL_HEX32(0x80000001, device->revision);
    TEST_ASSERT_EQUAL_STRING("Device 1 (EtherCAT)", document.master_name);
    TEST_ASSERT_EQUAL(2, device->place);
}

static void test_what_is_not_known_is_passed_over(void)
{
    reads(SLAVE("<HotConnect/><Mailbox><Send><Start>1</Start><Length>2</Length></Send><EoE><InitCmds/></EoE>"
                "<CoE><Profile><ChannelInfo/></Profile></CoE></Mailbox><ProcessData><Sm0><Type>Sm0</Type></Sm0>"
                "</ProcessData>"));
    TEST_ASSERT_TRUE(document.devices.at[0].mailbox.present);
    TEST_ASSERT_EQUAL(CM1E_SM_UNUSED, document.devices.at[0].sync_managers.at[0].manager.use);
}

static void test_numbers_that_are_not_there_are_0(void)
{
    reads(CONFIG("<Slave><Info/><Mailbox><CoE><InitCmds><InitCmd><Transition>PS</Transition></InitCmd></InitCmds></CoE>"
                 "</Mailbox><ProcessData><Sm0/><TxPdo><Entry/></TxPdo></ProcessData></Slave>"
                 "<ProcessImage><Inputs><Variable/></Inputs><Outputs/></ProcessImage>"));
    const cm1e_eni_mailbox_t *mailbox = &document.devices.at[0].mailbox;
    const cm1e_eni_sdo_t *sdo = &mailbox->sdos.at[0];
    TEST_ASSERT_EQUAL(1, sdo->specifier);
    TEST_ASSERT_EQUAL(0, sdo->timeout_ms + sdo->index + sdo->subindex + sdo->data.size);
    TEST_ASSERT_FALSE(sdo->fixed || sdo->complete_access || sdo->disabled);
    const cm1e_described_sync_manager_t *manager = &document.devices.at[0].sync_managers.at[0].manager;
    TEST_ASSERT_EQUAL(0, manager->start + manager->length + manager->minimum_length + manager->maximum_length);
    TEST_ASSERT_EQUAL(0, manager->control);
    TEST_ASSERT_FALSE(manager->enable || manager->length_given);
    const cm1e_described_pdo_t *pdo = &document.devices.at[0].pdos.at[0];
    TEST_ASSERT_EQUAL(0, pdo->index + pdo->entries.at[0].index + pdo->entries.at[0].subindex + pdo->entries.at[0].bits);
    TEST_ASSERT_TRUE(document.has_image);
    TEST_ASSERT_EQUAL(0, document.inputs.bytes + document.outputs.bytes);
    TEST_ASSERT_EQUAL(0, document.inputs.variables.at[0].bits + document.inputs.variables.at[0].offset);
}

static void test_the_master_has_an_address_and_states_of_mailboxes(void)
{
    reads("<?xml version=\"1.0\"?>\n<EtherCATConfig><Config><Master><Info><Name>M</Name><Destination>ffffffffffff</Destination>"
          "<Source>010101010203</Source><EtherType>a488</EtherType></Info><MailboxStates><StartAddr>150994944</StartAddr>"
          "<Count>7</Count></MailboxStates></Master></Config></EtherCATConfig>");
    TEST_ASSERT_EQUAL_STRING("M", document.master_name);
    TEST_ASSERT_TRUE(document.has_mailbox_states);
    TEST_ASSERT_EQUAL_HEX32(0x09000000, document.mailbox_states_start);
    TEST_ASSERT_EQUAL_UINT32(7, document.mailbox_states_count);
    TEST_ASSERT_EQUAL_size_t(6, document.source.size);
    TEST_ASSERT_EQUAL_MEMORY("\1\1\1\1\2\3", document.source.data, 6);
    TEST_ASSERT_EQUAL_MEMORY("\xFF\xFF\xFF\xFF\xFF\xFF", document.destination.data, 6);
    TEST_ASSERT_EQUAL_size_t(2, document.ether_type.size);
    reads(SLAVE(""));
    TEST_ASSERT_FALSE(document.has_mailbox_states);
}

/** Where no command writes the sync managers of a mailbox, they are what the mailbox says. */
static void test_a_mailbox_has_its_sync_managers_without_commands(void)
{
    cm1e_arena_t arena = {0};
    reads(SLAVE("<Mailbox><Send><Start>4096</Start><Length>128</Length></Send><Recv><Start>4224</Start><Length>130</Length>"
                "</Recv></Mailbox>"));
    const cm1e_description_t described = cm1e_eni_describe(&arena, &document.devices.at[0]);
    TEST_ASSERT_EQUAL(2, described.sync_managers.count);
    static const uint16_t starts[] = {4096, 4224}, lengths[] = {128, 130};
    for (int n = 0; n < 2; n++) {
        const cm1e_described_sync_manager_t *manager = &described.sync_managers.at[n];
        TEST_ASSERT_EQUAL(n ? CM1E_SM_MAILBOX_IN : CM1E_SM_MAILBOX_OUT, manager->use);
        TEST_ASSERT_EQUAL(starts[n], manager->start);
        TEST_ASSERT_EQUAL(lengths[n], manager->length);
        TEST_ASSERT_EQUAL_HEX8(n ? 0x22 : 0x26, manager->control);
        TEST_ASSERT_TRUE(manager->length_given && manager->enable);
        TEST_ASSERT_EQUAL(2, manager->place);
    }
    cm1e_arena_free(&arena);
}

static void test_flags_may_be_words(void)
{
    reads(COMMAND("<BeforeSlave>true</BeforeSlave><Cmd>8</Cmd><Ado>16</Ado><DataLength>2</DataLength>"));
    TEST_ASSERT_TRUE(document.devices.at[0].commands.at[0].before_slave);
}

static void test_a_command_without_data_has_zeros_of_its_length(void)
{
    reads(COMMAND("<Cmd>8</Cmd><Adp>0</Adp><Ado>1536</Ado><DataLength>256</DataLength>"));
    const cm1e_eni_command_t *command = &document.devices.at[0].commands.at[0];
    TEST_ASSERT_EQUAL(256, command->length);
    TEST_ASSERT_EQUAL(0, command->data.size);
    TEST_ASSERT_EQUAL(CM1E_ENI_NOT_GIVEN, command->count);
    TEST_ASSERT_FALSE(command->validates);
}

static void test_every_transition_and_state_is_known(void)
{
    for (int bit = 0; bit < CM1E_ENI_TRANSITION_COUNT; bit++) {
        char text[600];
        snprintf(text, sizeof text,
                 SLAVE("<InitCmds><InitCmd><Transition>%s</Transition><Cmd>1</Cmd><Ado>0</Ado></InitCmd></InitCmds>"),
                 cm1e_eni_transition_names[bit]);
        reads(text);
        TEST_ASSERT_EQUAL_HEX16(1u << bit, document.devices.at[0].commands.at[0].transitions);
    }
    reads(CONFIG("<Cyclic><Frame><Cmd><State>INIT</State><State>PREOP</State><State>SAFEOP</State><State>OP</State>"
                 "<Cmd>12</Cmd><Addr>-65536</Addr><DataLength>4</DataLength></Cmd></Frame></Cyclic>"));
    TEST_ASSERT_EQUAL_HEX8(0x0F, document.cyclics.at[0].frames.at[0].commands.at[0].states);
    TEST_ASSERT_EQUAL_HEX32(0xFFFF0000, document.cyclics.at[0].frames.at[0].commands.at[0].address);
}

/* ---- refused ---------------------------------------------------------------------------------------------------- */

static void test_what_is_no_eni_is_refused(void)
{
    refused("<EtherCATInfo/>", "EtherCATConfig");
    refused("<EtherCATConfig/>", "Config");
    refused("<EtherCATConfig><Config/></EtherCATConfig>", "Master");
    refused("<EtherCATConfig><Config>", "line 1");
    refused(CONFIG("<Slave/>"), "Info");
}

static void test_what_cannot_be_meant_is_refused(void)
{
    refused(COMMAND("<Ado>16</Ado>"), "Cmd");
    refused(COMMAND("<Cmd>15</Cmd><Ado>16</Ado>"), "15");
    refused(COMMAND("<Cmd>2</Cmd><Adp>0</Adp>"), "Ado");
    refused(COMMAND("<Cmd>12</Cmd><Adp>0</Adp><Ado>0</Ado>"), "Addr");
    refused(COMMAND("<Cmd>2</Cmd><Ado>65536</Ado>"), "65536");
    refused(COMMAND("<Cmd>2</Cmd><Ado>16</Ado><Data>0</Data>"), "hexadecimal");
    refused(COMMAND("<Cmd>2</Cmd><Ado>16</Ado><DataLength>1487</DataLength>"), "1487");
    refused(COMMAND("<Cmd>2</Cmd><Ado>16</Ado><Cnt>-1</Cnt>"), "-1");
    refused(SLAVE("<InitCmds><InitCmd><Transition>XY</Transition><Cmd>1</Cmd><Ado>0</Ado></InitCmd></InitCmds>"), "XY");
    refused(SLAVE("<Mailbox><Protocol>XoE</Protocol></Mailbox>"), "XoE");
    refused(SLAVE("<PreviousPort><Port>E</Port></PreviousPort>"), "E");
    refused(SLAVE("<PreviousPort><PhysAddr>1</PhysAddr></PreviousPort>"), "Port");
    refused(CONFIG("<Cyclic><Frame><Cmd><State>RUN</State><Cmd>7</Cmd><Ado>304</Ado></Cmd></Frame></Cyclic>"), "RUN");
    refused(CONFIG("<Slave><Info><PhysAddr>x</PhysAddr></Info></Slave>"), "PhysAddr");
}

static void test_data_longer_than_a_datagram_are_refused(void)
{
    enum { BYTES = 1487 };
    char text[4000] = "", digits[2 * BYTES + 1];
    memset(digits, '0', sizeof digits - 1);
    digits[sizeof digits - 1] = '\0';
    snprintf(text, sizeof text, COMMAND("<Cmd>2</Cmd><Ado>16</Ado><Data>%s</Data>"), digits);
    refused(text, "1487");
}

/* `count` times `element` within `before` and `after`. */
static char *repeated(const char *before, const char *element, size_t count, const char *after)
{
    char *text = malloc(strlen(before) + count * strlen(element) + strlen(after) + 1), *end = text;
    TEST_ASSERT_NOT_NULL(text);
    end = stpcpy(end, before);
    for (size_t i = 0; i < count; i++)
        end = stpcpy(end, element);
    strcpy(end, after);
    return text;
}

static void test_more_than_any_network_has_is_refused(void)
{
    static const struct {
        const char *before, *element, *after, *what;
        size_t limit;
    } rows[] = {
        {"<EtherCATConfig><Config>" MASTER, "<Slave><Info/></Slave>", "</Config></EtherCATConfig>", "<Slave>", 65535},
        {"<EtherCATConfig><Config>" MASTER "<Slave><Info/><ProcessData>", "<TxPdo/>",
         "</ProcessData></Slave></Config></EtherCATConfig>", "<TxPdo>", 1024},
        {"<EtherCATConfig><Config>" MASTER "<Slave><Info/><ProcessData><Sm2>", "<Pdo>5632</Pdo>",
         "</Sm2></ProcessData></Slave></Config></EtherCATConfig>", "<Pdo>", 255},
        {"<EtherCATConfig><Config>" MASTER "<Cyclic><Frame>", "<Cmd><Cmd>0</Cmd></Cmd>",
         "</Frame></Cyclic></Config></EtherCATConfig>", "<Cmd>", 4096},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        for (size_t more = 0; more < 2; more++) {
            char *text = repeated(rows[i].before, rows[i].element, rows[i].limit + more, rows[i].after);
            const cm1e_error_t error = read_text(text);
            free(text);
            TEST_ASSERT_EQUAL_MESSAGE(more ? CM1E_ERROR_FILE : CM1E_OK, error, rows[i].what);
            if (more)
                TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, rows[i].what), diag.text);
        }
}

/* ---- damaged ---------------------------------------------------------------------------------------------------- */

/* A file of ours, cut or with bytes changed, is read or refused; what was read is checked and written. */
static char attempt[40];

static void try_bytes(const char *bytes, size_t size)
{
    cm1e_eni_t damaged = {0};
    cm1e_file_t out = {0};
    cm1e_findings_t *findings = cm1e_findings_create();
    cm1e_diag_t own = {0};
    const cm1e_error_t error = cm1e_eni_read(&damaged, bytes, size, &own);
    if (error == CM1E_OK) {
        cm1e_eni_check(findings, &damaged);
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_eni_write(&out, &damaged, &own), attempt);
    } else {
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_FILE, error, attempt);
        TEST_ASSERT_TRUE_MESSAGE(own.text[0] != '\0', attempt);
    }
    cm1e_file_free(&out);
    cm1e_findings_free(findings);
    cm1e_eni_free(&damaged);
}

static void test_damaged_files_are_read_or_refused(void)
{
    static const char alphabet[] = "0123456789<>/-#x ";
    enum { CUTS = 200, RUNS = 1000 };
    cm1e_description_file_t described = {0};
    cm1e_eni_t made = {0};
    cm1e_file_t good = {0};
    TEST_ASSERT_EQUAL(CM1E_OK, eni_network_make(&made, &described, &eni_networks[ENI_MIXED], &diag));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_eni_write(&good, &made, &diag));
    char *bytes = malloc(good.size);
    TEST_ASSERT_NOT_NULL(bytes);
    const size_t cuts = CUTS / (size_t)slowness();
    for (size_t i = 0; i < cuts; i++)
        try_bytes((const char *)good.bytes, good.size * i / cuts);
    for (int run = 0; run < seed_count(RUNS); run++) {
        chance_seed(seed_of(run));
        snprintf(attempt, sizeof attempt, "CM1E_TEST_SEED=%u", seed_of(run));
        memcpy(bytes, good.bytes, good.size);
        for (int n = 0; n < 3; n++)
            bytes[pick((int)good.size)] = alphabet[pick(sizeof alphabet - 1)];
        try_bytes(bytes, good.size);
    }
    free(bytes);
    cm1e_file_free(&good);
    cm1e_eni_free(&made);
    cm1e_description_file_free(&described);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_numbers_are_taken_as_files_write_them);
    RUN_TEST(test_what_is_not_known_is_passed_over);
    RUN_TEST(test_numbers_that_are_not_there_are_0);
    RUN_TEST(test_the_master_has_an_address_and_states_of_mailboxes);
    RUN_TEST(test_a_mailbox_has_its_sync_managers_without_commands);
    RUN_TEST(test_flags_may_be_words);
    RUN_TEST(test_a_command_without_data_has_zeros_of_its_length);
    RUN_TEST(test_every_transition_and_state_is_known);
    RUN_TEST(test_what_is_no_eni_is_refused);
    RUN_TEST(test_what_cannot_be_meant_is_refused);
    RUN_TEST(test_data_longer_than_a_datagram_are_refused);
    RUN_TEST(test_more_than_any_network_has_is_refused);
    RUN_TEST(test_damaged_files_are_read_or_refused);
    return UNITY_END();
}
