/* ESI files that the bus file names at its slaves: what is taken from them, what the bus file overrules, what is
 * refused and in which words; and that a simulated slave is configured by it. */
#include "bus_support.h"
#include "cm1e/io.h"

#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

static char bus_path[sizeof CM1E_TEST_OUTPUT + 40], esi_path[sizeof CM1E_TEST_OUTPUT + 40];

/** This test runs several times at once, on other devices: each run has a folder of its own. */
static void make_folder(void)
{
    char folder[sizeof CM1E_TEST_OUTPUT + 24];
    snprintf(folder, sizeof folder, CM1E_TEST_OUTPUT "/bus_esi.%d", (int)getpid());
    ck_assert(mkdir(folder, 0700) == 0 || errno == EEXIST);
    snprintf(bus_path, sizeof bus_path, "%s/bus_esi.yaml", folder);
    snprintf(esi_path, sizeof esi_path, "%s/bus_esi.xml", folder);
}

static void remove_folder(void)
{
    remove(bus_path);
    remove(esi_path);
    *strrchr(bus_path, '/') = '\0';
    remove(bus_path);
}

/* Two channels, each with a PDO for state and value and one for the value alone, as the simulated analog device has.
 * The second device is another one; of the first there are two revisions. */
#define ENTRY(INDEX, SUB, BITS, NAME, TYPE)                                                                          \
    "<Entry><Index>#x" #INDEX "</Index><SubIndex>#x" #SUB "</SubIndex><BitLen>" #BITS "</BitLen><Name>" NAME         \
    "</Name><DataType>" TYPE "</DataType></Entry>"
#define GAP(BITS) "<Entry><Index>0</Index><BitLen>" #BITS "</BitLen></Entry>"
#define TXPDO(SM, INDEX, NAME, ENTRIES)                                                                              \
    "<TxPdo" SM "><Index>#x" #INDEX "</Index><Name>" NAME "</Name>" ENTRIES "</TxPdo>"
#define COMMAND(TRANSITION, INDEX, SUB, DATA)                                                                        \
    "<InitCmd><Transition>" TRANSITION "</Transition><Index>#x" #INDEX "</Index><SubIndex>" #SUB "</SubIndex><Data>"  \
    DATA "</Data></InitCmd>"
#define WHOLE(INDEX, SUB, DATA)                                                                                      \
    "<InitCmd CompleteAccess='1'><Transition>PS</Transition><Index>#x" #INDEX "</Index><SubIndex>" #SUB              \
    "</SubIndex><Data>" DATA "</Data></InitCmd>"
#define DEVICE(PRODUCT, REVISION, TYPE, COE, PDOS, REST)                                                              \
    "<Device Physics='YY'><Type ProductCode='#x" #PRODUCT "' RevisionNo='#x" #REVISION "'>" TYPE "</Type><Name>" TYPE  \
    "</Name><GroupType>G</GroupType>" PDOS COE REST "</Device>"
#define COMPACT TXPDO(" Sm='3'", 1A01, "Compact 1", ENTRY(6000, 11, 16, "Value", "INT"))                              \
                TXPDO(" Sm='3'", 1A03, "Compact 2", ENTRY(6010, 11, 16, "Value", "INT"))
#define STANDARD TXPDO("", 1A00, "Standard 1", ENTRY(6000, 1, 1, "Underrange", "BOOL")                                \
                       ENTRY(6000, 2, 1, "Overrange of the first of all channels", "BOOL") GAP(14)                     \
                       ENTRY(6000, 11, 16, "Value", "INT"))
#define EITHER "<TxPdo Sm='3'><Index>#x1A00</Index><Name>Standard</Name><Exclude>#x1A01</Exclude>"                      \
               ENTRY(6000, 11, 16, "Value", "INT") "</TxPdo>"                                                           \
               TXPDO("", 1A01, "Compact", ENTRY(6000, 11, 16, "Value", "INT"))
#define COE(COMMANDS) "<Mailbox><CoE SdoInfo='1' PdoAssign='1'>" COMMANDS "</CoE></Mailbox>"
#define MODE(NAME, ACTIVATE, TIMES) "<OpMode><Name>" NAME "</Name><AssignActivate>#x" #ACTIVATE "</AssignActivate>"  \
                                    TIMES "</OpMode>"
#define MODES "<Dc>" MODE("SM", 0, "") MODE("DC", 300, "<CycleTimeSync0 Factor='-2'>0</CycleTimeSync0>"              \
              "<ShiftTimeSync0>25000</ShiftTimeSync0>") "</Dc>"
#define COMMANDS COMMAND("PS", 8000, 18, "0700") COMMAND("SO", 8010, 18, "F7FF") COMMAND("SP", 8010, 18, "1111")
#define FILE_OF(DEVICES)                                                                                              \
    "<EtherCATInfo><Vendor><Id>#x12</Id><Name>Maker</Name></Vendor><Descriptions><Groups><Group><Type>G</Type>"       \
    "<Name>G</Name></Group></Groups><Devices>" DEVICES "</Devices></Descriptions></EtherCATInfo>"

static const char good[] = FILE_OF(DEVICE(A0002, 1, "AI-old", COE(""), COMPACT, "")
                                   DEVICE(A0002, 2, "AI", COE(COMMANDS), STANDARD COMPACT, MODES)
                                   DEVICE(A0003, 1, "Other", "", TXPDO(" Sm='0'", 1A00, "", GAP(3)
                                          ENTRY(6000, 1, 1, "Input 4", "BOOL") ENTRY(6000, 2, 12, "Counter", "UINT")),
                                          "<Sm StartAddress='#x1000' ControlByte='0' Enable='1'>Inputs</Sm>")
                                   DEVICE(A0007, 1, "Fourth", COE(""), COMPACT, ""));

static const char whole[] = FILE_OF(DEVICE(A0004, 1, "Whole", COE(WHOLE(8000, 1, "0900")
                                           WHOLE(1A01, 0, "0300010100600700000010110060")
                                           COMMAND("PS", 8010, 18, "0400")), COMPACT, "")
                                    DEVICE(A0008, 1, "Either", COE(""), EITHER, "")
                                    DEVICE(A0005, 1, "Wrong", COE(WHOLE(8000, 2, "0102")), COMPACT, "")
                                    DEVICE(A0006, 1, "Empty", COE(WHOLE(8000, 0, "")), COMPACT, ""));

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    ck_assert_ptr_nonnull(file);
    ck_assert_uint_eq(fwrite(text, 1, strlen(text), file), strlen(text));
    ck_assert_int_eq(fclose(file), 0);
}

/** A bus file with one slave, which has these keys beside its ESI, and an ESI. */
static cm1e_error_t load(const char *esi, const char *keys)
{
    char text[2000];
    snprintf(text, sizeof text, "bus: {virtual_time: true}\nslaves:\n  - {name: ai, position: 1, esi: bus_esi.xml, %s\n"
             "     sim: {device: analog, inputs: 2}}\n", keys);
    write_text(bus_path, text);
    if (esi)
        write_text(esi_path, esi);
    cm1e_bus_config_free(&config);
    return cm1e_bus_config_load(&config, bus_path, &diag);
}

static const cm1e_signal_config_t *signal_at(unsigned n)
{
    ck_assert_uint_lt(n, config.slaves[0].signal_count);
    return &config.slaves[0].signals[n];
}

START_TEST(test_what_is_taken)
{
    ck_assert_msg(load(good, "product: 0x000A0002,") == CM1E_OK, "%s", diag.text);
    const cm1e_slave_config_t *slave = &config.slaves[0];
    ck_assert_uint_eq(slave->vendor, 0x12);
    ck_assert_uint_eq(slave->product, 0xA0002);
    ck_assert_uint_eq(slave->revision, 0); /* that of the file is no condition */
    ck_assert_uint_eq(slave->inputs_pdo_count, 2);
    ck_assert_uint_eq(slave->inputs_pdos[0], 0x1A01);
    ck_assert_uint_eq(slave->inputs_pdos[1], 0x1A03);
    ck_assert_uint_eq(slave->outputs_pdo_count, 0);
    ck_assert_uint_eq(slave->sdo_count, 2);
    ck_assert(slave->sdos[0].index == 0x8000 && slave->sdos[0].subindex == 0x12 && slave->sdos[0].value == 7);
    ck_assert(!slave->sdos[0].before_op && slave->sdos[0].bytes == 2);
    ck_assert(slave->sdos[1].index == 0x8010 && slave->sdos[1].value == 0xFFF7 && slave->sdos[1].before_op);
    ck_assert_uint_eq(slave->signal_count, 2);
    ck_assert_str_eq(signal_at(0)->name, "Compact 1 Value");
    ck_assert_str_eq(signal_at(1)->name, "Compact 2 Value");
    ck_assert(signal_at(0)->index == 0x6000 && signal_at(0)->subindex == 0x11 && signal_at(0)->type == CM1E_IO_INT);
    ck_assert_double_eq(slave->dc.sync0_us, 0.0);
}
END_TEST

/* The end of a name is its own end, and no letter is cut: neither the second byte of one is left alone, nor the first. */
START_TEST(test_a_long_name_loses_its_middle_in_whole_letters)
{
    static const char long_names[] = FILE_OF(DEVICE(000A0002, 1, "Names", COE(""), TXPDO(" Sm='3'", 1A00, "Standard",
        ENTRY(6000, 1, 1, "thirteen char\u00E4cters, then others, \u00E4234567890123456", "BOOL")
        ENTRY(6000, 2, 1, "a name of more than sixty bytes, which is all that was looked at once, channel 2", "BOOL")
        GAP(14)
        ENTRY(6000, 11, 16, "a name of more than sixty bytes, which is all that was looked at once, channel 17", "INT")),
        ""));
    ck_assert_msg(load(long_names, "product: 0x000A0002,") == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(config.slaves[0].signal_count, 3);
    ck_assert_str_eq(signal_at(0)->name, "thirteen char~234567890123456");
    ck_assert_str_eq(signal_at(1)->name, "a name of more~ once, channel 2");
    ck_assert_str_eq(signal_at(2)->name, "a name of more~once, channel 17");
}
END_TEST

/* PDOs, values and names of the bus file stay; the names of other PDOs are those of the ESI; pulses by the name of the
 * mode. */
START_TEST(test_the_bus_file_overrules)
{
    ck_assert_msg(load(good, "product: 0x000A0002, inputs_pdos: [0x1A00], esi_mode: dc,\n"
                       "     sdo: [{object: 0x8000:12, type: INT, value: 3}],\n"
                       "     inputs: [{name: boiler, object: 0x6000:11}],") == CM1E_OK, "%s", diag.text);
    const cm1e_slave_config_t *slave = &config.slaves[0];
    ck_assert_uint_eq(slave->inputs_pdo_count, 1);
    ck_assert_uint_eq(slave->inputs_pdos[0], 0x1A00);
    ck_assert_uint_eq(slave->sdo_count, 2);
    ck_assert_uint_eq(slave->sdos[0].value, 3);
    ck_assert_uint_eq(slave->sdos[1].index, 0x8010);
    ck_assert_uint_eq(slave->signal_count, 3);
    ck_assert_str_eq(signal_at(0)->name, "boiler");
    ck_assert_str_eq(signal_at(1)->name, "Underrange");
    ck_assert_str_eq(signal_at(2)->name, "Overrange of t~ of all channels"); /* its middle is cut */
    ck_assert_double_eq(slave->dc.sync0_us, 500.0);
    ck_assert_double_eq(slave->dc.shift_us, 525.0); /* half a cycle, and its own */
}
END_TEST

/* Of SM and DC only the second one has SYNC0. */
START_TEST(test_the_first_mode_with_sync0_is_the_default_of_its_maker)
{
    ck_assert_msg(load(good, "product: 0x000A0002, esi_mode: first,") == CM1E_OK, "%s", diag.text);
    ck_assert_double_eq(config.slaves[0].dc.sync0_us, 500.0);
    ck_assert_msg(load(good, "product: 0x000A0002,") == CM1E_OK, "%s", diag.text);
    ck_assert_double_eq(config.slaves[0].dc.sync0_us, 0.0);
}
END_TEST

/* Without CoE the process data lies as the file says, so a name is one of bits; "Input 4" would be a place. */
START_TEST(test_a_slave_without_a_mailbox_is_named_by_its_bits)
{
    ck_assert_msg(load(good, "product: 0x000A0003,") == CM1E_OK, "%s", diag.text);
    const cm1e_slave_config_t *slave = &config.slaves[0];
    ck_assert_uint_eq(slave->inputs_pdo_count, 0);
    ck_assert_uint_eq(slave->signal_count, 1);
    ck_assert_str_eq(signal_at(0)->name, "Counter");
    ck_assert(signal_at(0)->index == 0 && signal_at(0)->bit == 4 && signal_at(0)->bits == 12);
}
END_TEST

START_TEST(test_a_bad_file_is_told_in_words)
{
    static const struct {
        const char *esi, *keys, *place, *words;
    } cases[] = {
        {good, "", ":3:34: ", "describes 4 devices, AI-old (0x000A0002)"},
        {good, "vendor: 0x00000013,", ":3:34: ", "does not describe vendor 0x00000013"},
        {good, "product: 0x000A0002, revision: 0x00000003,", ":3:34: ", "revision 0x00000003"},
        {good, "product: 0x000A0002, esi_mode: FreeRun,", ":3:", "has no OpMode 'FreeRun'; it has SM, DC"},
        {good, "product: 0x000A0002, esi_mode: DC, dc: {sync0_us: 500},", ":3:", "and dc states some too"},
        {whole, "product: 0x000A0005,", ":3:34: ", "object 0x8000 has complete access from sub-index 2 on"},
        {whole, "product: 0x000A0008, inputs_pdos: [0x1A00, 0x1A01],", ":3:", "the PDO 0x1A00 excludes 0x1A01, and both "
         "are assigned; expected one of them in inputs_pdos"},
        {whole, "product: 0x000A0006,", ":3:34: ", "object 0x8000:00 has 0 bytes"},
        {"", "", ":3:34: ", "bus_esi.xml: "},
        {"<EtherCATInfo>", "", ":3:34: ", "bus_esi.xml: "},
        {"<Devices/>", "", ":3:34: ", "the root element of an ESI is EtherCATInfo"},
        {FILE_OF(""), "", ":3:34: ", "there is neither a device nor a module"},
        {good, "product: 0x000A0002, inputs: [{name: a, object: 0x6010:11}, {name: A, bit: 0}],", ":3:",
         "the name 'A'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ck_assert_msg(load(cases[i].esi, cases[i].keys) == CM1E_ERROR_CONFIG, "case %zu", i);
        ck_assert_msg(strstr(diag.text, cases[i].words) && strstr(diag.text, cases[i].place), "case %zu: %s", i,
                      diag.text);
    }
    ck_assert_int_eq(remove(esi_path), 0);
    ck_assert_int_eq(load(NULL, ""), CM1E_ERROR_CONFIG);
    ck_assert_msg(strstr(diag.text, "bus_esi.xml: cannot be read: No such file"), "%s", diag.text);
    ck_assert_int_eq(load(whole, "product: 0x000A0005, sdo: [{object: 0x8000:01, type: INT, value: 3}],"), CM1E_OK);
}
END_TEST

/* A FIFO without a writer would let the program wait for ever, and a folder is no ESI that is too large. */
START_TEST(test_only_a_regular_file_is_read)
{
    remove(esi_path);
    ck_assert_int_eq(mkfifo(esi_path, 0600), 0);
    ck_assert_int_eq(load(NULL, ""), CM1E_ERROR_CONFIG);
    ck_assert_msg(strstr(diag.text, "bus_esi.xml: is not a regular file; expected the file of an ESI"), "%s", diag.text);
    ck_assert_int_eq(remove(esi_path), 0);
    ck_assert_int_eq(mkdir(esi_path, 0700), 0);
    ck_assert_int_eq(load(NULL, ""), CM1E_ERROR_CONFIG);
    ck_assert_msg(strstr(diag.text, "bus_esi.xml: is a folder; expected the file of an ESI"), "%s", diag.text);
    ck_assert_int_eq(remove(esi_path), 0);
}
END_TEST

START_TEST(test_a_slave_is_configured_by_it)
{
    cm1e_io_t io;
    ck_assert_msg(load(good, "product: 0x000A0002,") == CM1E_OK, "%s", diag.text);
    cm1e_bus_t *bus = start_bus();
    simulate(bus, "input 1 1 100");
    simulate(bus, "input 1 2 1000");
    cycles(bus, 5);
    ck_assert_msg(cm1e_io_find(bus, "ai.Compact 1 Value", &io, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_io_integer(&io), 107);
    ck_assert_msg(cm1e_io_find(bus, "ai.compact 2 value", &io, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_io_integer(&io), 991);
    cm1e_bus_close(bus);
}
END_TEST

/* Where its signals will be is known from the file while the slave is absent; when it comes, its PDOs are compared. */
START_TEST(test_an_absent_slave_has_its_signals_from_the_file)
{
    static const char text[] = "bus: {virtual_time: true}\nslaves:\n"
                               "  - {name: valves, position: 1, sim: {device: digital, outputs: 2}}\n"
                               "  - {name: ai, alias: 9, optional: true, esi: bus_esi.xml, product: 0x000A0002,\n"
                               "     sim: {device: analog, inputs: 2, absent: true}}\n";
    cm1e_io_t io;
    write_text(bus_path, text);
    write_text(esi_path, good);
    cm1e_bus_config_free(&config);
    ck_assert_msg(cm1e_bus_config_load(&config, bus_path, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_t *bus = start_bus();
    ck_assert_msg(cm1e_io_find(bus, "ai.Compact 2 Value", &io, &diag) == CM1E_OK, "%s", diag.text);
    cycles(bus, 5);
    ck_assert_int_eq(cm1e_io_quality(&io), CM1E_IO_OFFLINE);
    simulate(bus, "attach 2");
    simulate(bus, "input 2 2 1000");
    for (int n = 0; n < 4000 && cm1e_io_quality(&io) != CM1E_IO_GOOD; n++)
        ck_assert_int_eq(cycle(bus), CM1E_OK);
    cycles(bus, 5);
    ck_assert_int_eq(cm1e_io_quality(&io), CM1E_IO_GOOD);
    ck_assert_int_eq(cm1e_io_integer(&io), 991); /* with the offset that a start-up command writes */
    cm1e_bus_close(bus);
}
END_TEST

/* ---- ENI --------------------------------------------------------------------------------------------------------- */

static void eni_of_file(cm1e_file_t *file)
{
    const cm1e_generate_options_t options = {.format = CM1E_FILE_ENI, .network = &config};
    ck_assert_msg(cm1e_generate(file, &options, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_findings_t *findings = NULL;
    ck_assert_int_eq(cm1e_check_file(&findings, file->bytes, file->size, &diag), CM1E_OK);
    ck_assert_msg(cm1e_findings_count(findings) == 0, "%s", cm1e_findings_at(findings, 0)->text);
    cm1e_findings_free(findings);
}

/** How often a text comes in a file, whose bytes end with a 0. */
static unsigned count_of(const cm1e_file_t *file, const char *text)
{
    unsigned count = 0;
    for (const char *at = strstr((const char *)file->bytes, text); at; at = strstr(at + 1, text))
        count++;
    return count;
}

/* Complete access: the whole object in one transfer, also of more than 8 bytes; the bus file overrules it as a whole. */
START_TEST(test_start_up_commands_with_complete_access)
{
    cm1e_io_t io;
    ck_assert_msg(load(whole, "product: 0x000A0004,") == CM1E_OK, "%s", diag.text);
    const cm1e_slave_config_t *slave = &config.slaves[0];
    ck_assert_uint_eq(slave->sdo_count, 3);
    ck_assert(slave->sdos[0].complete_access && slave->sdos[0].bytes == 2 && slave->sdos[0].value == 9);
    ck_assert(slave->sdos[1].complete_access && slave->sdos[1].bytes == 0 && slave->sdos[1].size == 14);
    ck_assert(!slave->sdos[2].complete_access);
    cm1e_bus_t *bus = start_bus();
    simulate(bus, "input 1 1 100");
    cycles(bus, 5);
    ck_assert_msg(cm1e_io_find(bus, "ai.Compact 1 Value", &io, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_io_integer(&io), 109);
    ck_assert_uint_eq(cm1e_bus_slave(bus, 1)->input_bytes, 5); /* a bit and a gap before the first value */
    cm1e_bus_close(bus);
    cm1e_file_t eni;
    bus = open_bus();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_generate_eni_of_bus(&eni, bus, CM1E_MAPPING_DYNAMIC, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
    ck_assert_uint_eq(count_of(&eni, "CompleteAccess=\"true\"") + count_of(&eni, "CompleteAccess=\"1\""), 2);
    ck_assert_uint_eq(count_of(&eni, "0300010100600700000010110060"), 1);
    cm1e_file_free(&eni);
    ck_assert_msg(load(whole, "product: 0x000A0004, sdo: [{object: 0x1A01:01, type: UDINT, value: 0x60000101}],") ==
                  CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(config.slaves[0].sdo_count, 3);
    ck_assert(config.slaves[0].sdos[1].index == 0x8000 && !config.slaves[0].sdos[0].complete_access);
}
END_TEST

/** A motor between a coupler, terminals and an analog device with everything that the bus file can write into it. */
static void load_machine(void)
{
    write_text(bus_path, "bus: {virtual_time: true}\n"
               "axes: [{name: feed, position: 3}]\n"
               "slaves:\n"
               "  - {name: coupler, position: 1, sim: {device: coupler}}\n"
               "  - {name: valves, position: 2, outputs: [{name: clamp, bit: 3}], sim: {device: digital, outputs: 4}}\n"
               "  - name: ai\n"
               "    position: 4\n"
               "    mapping: [{pdo: 0x1A00, entries: [0x6000:01/1, gap/7, 0x6000:11/16]}]\n"
               "    inputs_pdos: [0x1A03, 0x1A00]\n"
               "    sdo:\n"
               "      - {object: 0x8000:12, type: INT, value: -2}\n"
               "      - {object: 0x8010:12, type: INT, value: 5, before: op}\n"
               "    inputs: [{name: boiler, object: 0x6000:11}]\n"
               "    sim: {device: analog, inputs: 2}\n");
    cm1e_bus_config_free(&config);
    ck_assert_msg(cm1e_bus_config_load(&config, bus_path, &diag) == CM1E_OK, "%s", diag.text);
}

/* What the bus file says gives the file that a scan of this network gives with it, byte for byte. */
START_TEST(test_an_eni_of_the_bus_file_is_that_of_a_scan)
{
    cm1e_file_t by_file, by_scan;
    load_machine();
    eni_of_file(&by_file);
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_generate_eni_of_bus(&by_scan, bus, CM1E_MAPPING_DYNAMIC, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
    ck_assert_uint_eq(by_file.size, by_scan.size);
    ck_assert_mem_eq(by_file.bytes, by_scan.bytes, by_file.size);
    ck_assert_uint_eq(count_of(&by_file, ".boiler</Name>"), 1);
    ck_assert_uint_eq(count_of(&by_file, ".clamp</Name>"), 1);
    ck_assert_uint_eq(count_of(&by_file, "<Data>feff</Data>") + count_of(&by_file, "<Data>FEFF</Data>"), 1);
    ck_assert_uint_eq(count_of(&by_file, "<Index>6656</Index>"), 5); /* 0x1A00: emptied, three entries, counted */
    cm1e_file_free(&by_file);
    cm1e_file_free(&by_scan);
}
END_TEST

/* Its start-up commands would be lost with the mailbox. */
START_TEST(test_an_eni_needs_the_size_of_a_mailbox)
{
#define MAILBOX(SIZE) "<Sm " SIZE "StartAddress='#x1000' ControlByte='#x26' Enable='1'>MBoxOut</Sm><Sm " SIZE             \
                      "StartAddress='#x1080' ControlByte='#x22' Enable='1'>MBoxIn</Sm>"
    static const char *const files[] = {
        FILE_OF(DEVICE(000A0002, 1, "Sized", MAILBOX("DefaultSize='128' ") COE(COMMANDS), "", "")),
        FILE_OF(DEVICE(000A0002, 1, "Unsized", MAILBOX("") COE(COMMANDS), "", "")),
        FILE_OF(DEVICE(000A0002, 1, "None", COE(COMMANDS), "", ""))};
    for (int i = 0; i < 3; i++) {
        cm1e_file_t file;
        ck_assert_msg(load(files[i], "product: 0x000A0002,") == CM1E_OK, "%s", diag.text);
        strcpy(config.interface_name, "eth1");
        config.virtual_time = false;
        const cm1e_generate_options_t options = {.format = CM1E_FILE_ENI, .network = &config};
        ck_assert_int_eq(cm1e_generate(&file, &options, &diag), i == 0 ? CM1E_OK : CM1E_ERROR_CONFIG);
        ck_assert_msg(i == 0 || strstr(diag.text, "ai: it has a mailbox, and its description does not state the size"),
                      "%s", diag.text);
        ck_assert_msg(i != 0 || count_of(&file, "<Ccs>1</Ccs>") == 2, "the start-up commands");
        cm1e_file_free(&file);
    }
}
END_TEST

START_TEST(test_an_eni_takes_the_esi)
{
    cm1e_file_t file;
    ck_assert_msg(load(good, "product: 0x000A0003,") == CM1E_OK, "%s", diag.text);
    strcpy(config.interface_name, "eth1"); /* a real network: what is there says the ESI alone */
    config.virtual_time = false;
    const cm1e_generate_options_t options = {.format = CM1E_FILE_ENI, .network = &config};
    ck_assert_msg(cm1e_generate(&file, &options, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(count_of(&file, "Counter</Name>"), 2); /* of the entry and of the variable */
    cm1e_file_free(&file);
    strcpy(config.slaves[0].esi, "nowhere.xml");
    ck_assert_int_eq(cm1e_generate(&file, &options, &diag), CM1E_ERROR_IO);
    ck_assert_msg(strstr(diag.text, "slave ai: nowhere.xml cannot be read: No such file"), "%s", diag.text);
    config.slaves[0].esi[0] = '\0';
    ck_assert_int_eq(cm1e_generate(&file, &options, &diag), CM1E_ERROR_UNSUPPORTED);
    ck_assert_msg(strstr(diag.text, "slave ai: the bus file does not say what its process data are"), "%s", diag.text);
    load_machine();
    config.slaves[2].address = 7;
    ck_assert_int_eq(cm1e_generate(&file, &options, &diag), CM1E_ERROR_CONFIG);
    ck_assert_msg(strstr(diag.text, "slave ai: its place on the wire"), "%s", diag.text);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus esi");
    TCase *tests = tcase_create("esi");
    tcase_add_unchecked_fixture(tests, make_folder, remove_folder);
    tcase_add_test(tests, test_what_is_taken);
    tcase_add_test(tests, test_a_long_name_loses_its_middle_in_whole_letters);
    tcase_add_test(tests, test_the_bus_file_overrules);
    tcase_add_test(tests, test_the_first_mode_with_sync0_is_the_default_of_its_maker);
    tcase_add_test(tests, test_a_slave_without_a_mailbox_is_named_by_its_bits);
    tcase_add_test(tests, test_a_bad_file_is_told_in_words);
    tcase_add_test(tests, test_only_a_regular_file_is_read);
    tcase_add_test(tests, test_a_slave_is_configured_by_it);
    tcase_add_test(tests, test_an_absent_slave_has_its_signals_from_the_file);
    tcase_add_test(tests, test_start_up_commands_with_complete_access);
    tcase_add_test(tests, test_an_eni_of_the_bus_file_is_that_of_a_scan);
    tcase_add_test(tests, test_an_eni_needs_the_size_of_a_mailbox);
    tcase_add_test(tests, test_an_eni_takes_the_esi);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
