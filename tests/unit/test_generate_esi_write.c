/* The ESI writer: every device that we describe is valid by ETG's schemas, says what the tables say, in the same bytes
 * every time. */
#include "esi_judge.h"
#include "golden.h"

static void write_device(const cm1e_device_options_t *options, cm1e_esi_layout_t layout)
{
    cm1e_description_file_free(&description);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_describe(&description, options, layout, &diag), diag.text);
    write_file();
}

static cm1e_device_options_t cm1e_of(int firmware, cm1e_mapping_t mapping)
{
    cm1e_device_options_t options = {.mapping = mapping};
    strcpy(options.firmware, cm1e_firmware_info((cm1e_firmware_t)firmware)->version);
    return options;
}

static void need_schema(void)
{
    if (!schema)
        TEST_IGNORE_MESSAGE("no ETG schemas: set CM1E_ESI_SCHEMAS to the folder with EtherCATInfo.xsd");
}

static void check_every_choice(cm1e_device_options_t options, cm1e_esi_layout_t layout)
{
    for (int choice = 0; choice < 4; choice++) {
        options.distributed_clocks = choice & 1;
        options.complete_access = choice & 2;
        write_device(&options, layout);
        TEST_ASSERT_EQUAL_STRING("", schema_error());
    }
}

static void test_every_cm1e_is_valid_by_the_schema(void)
{
    need_schema();
    for (int firmware = 0; firmware < CM1E_FIRMWARE_COUNT; firmware++)
        for (int mapping = 0; mapping < 4; mapping++)
            for (int order = 0; order < 2; order++)
                for (int layout = 0; layout < 2; layout++) {
                    cm1e_device_options_t options = cm1e_of(firmware, (cm1e_mapping_t)mapping);
                    options.order = (cm1e_pdo_order_t)order;
                    check_every_choice(options, (cm1e_esi_layout_t)layout);
                }
}

/* Vendor and product are the user's: the guide does not state them. */
static cm1e_device_options_t bridge(cm1e_device_model_t model, uint32_t axes)
{
    return (cm1e_device_options_t){.model = model, .axes = axes, .vendor_id = 0xAA77, .product_code = 0x00EB0012,
                                   .revision = 1};
}

static void test_every_bridge_is_valid_by_the_schema(void)
{
    need_schema();
    for (int model = CM1E_DEVICE_EB01; model <= CM1E_DEVICE_EB12; model++)
        for (uint32_t axes = 1; axes <= 4; axes++)
            for (int layout = 0; layout < 2; layout++)
                check_every_choice(bridge((cm1e_device_model_t)model, axes), (cm1e_esi_layout_t)layout);
}

static void test_a_file_with_an_eeprom_is_valid_by_the_schema(void)
{
    need_schema();
    const cm1e_device_options_t options = {.config_data = {0x05, 0x0E}, .config_data_size = 14};
    write_device(&options, CM1E_ESI_FLAT);
    TEST_ASSERT_EQUAL_INT(1, count(DEVICE "/Eeprom"));
    TEST_ASSERT_EQUAL_STRING("", schema_error());
}

static void test_the_schema_sees_what_is_wrong(void)
{
    need_schema();
    const cm1e_device_options_t options = {0};
    write_device(&options, CM1E_ESI_FLAT);
    xmlNode *root = xmlDocGetRootElement(document);
    xmlNewChild(root, NULL, BAD_CAST "Vendor", BAD_CAST "twice");
    TEST_ASSERT_NOT_EQUAL('\0', schema_error()[0]);
}

/* ---- golden files ----------------------------------------------------------------------------------------------- */

static void compare_golden(const char *name, const cm1e_device_options_t *options, cm1e_esi_layout_t layout)
{
    write_device(options, layout);
    golden_compare(name, file.bytes, file.size);
}

static void test_files_are_the_golden_ones(void)
{
    cm1e_device_options_t options = {0};
    compare_golden("esi-cm1e-1.3.5-flat.xml", &options, CM1E_ESI_FLAT);
    compare_golden("esi-cm1e-1.3.5-mdp.xml", &options, CM1E_ESI_MDP);
    options = cm1e_of(CM1E_FIRMWARE_1_2_0, CM1E_MAPPING_DYNAMIC);
    compare_golden("esi-cm1e-1.2.0-flat.xml", &options, CM1E_ESI_FLAT);
    compare_golden("esi-cm1e-1.2.0-mdp.xml", &options, CM1E_ESI_MDP);
}

static void test_a_file_with_everything_else_is_the_golden_one(void)
{
    const cm1e_device_options_t options = {
        .mapping = CM1E_MAPPING_CSP, .order = CM1E_PDO_ORDER_UG_7_2, .complete_access = true,
        .distributed_clocks = true, .config_data = {0x05, 0x0E, 0x03, 0x44}, .config_data_size = 14};
    compare_golden("esi-cm1e-csp-dc-eeprom.xml", &options, CM1E_ESI_FLAT);
}

static void test_a_file_of_the_bridge_is_the_golden_one(void)
{
    const cm1e_device_options_t options = bridge(CM1E_DEVICE_EB12, 4);
    compare_golden("esi-eb12-mdp.xml", &options, CM1E_ESI_MDP);
}

static void test_the_same_device_gives_the_same_bytes(void)
{
    const cm1e_device_options_t options = {.mapping = CM1E_MAPPING_PROFILE};
    for (int layout = 0; layout < 2; layout++) {
        cm1e_file_t again = {0};
        write_device(&options, (cm1e_esi_layout_t)layout);
        cm1e_description_file_free(&description);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&description, &options, (cm1e_esi_layout_t)layout, &diag));
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_esi_write(&again, &description, &diag));
        TEST_ASSERT_EQUAL_size_t(file.size, again.size);
        TEST_ASSERT_EQUAL_MEMORY(file.bytes, again.bytes, file.size);
        cm1e_file_free(&again);
    }
}

/* ---- what stands in the file of a CM1-E ------------------------------------------------------------------------- */

static void test_identity_is_that_of_the_firmware(void)
{
    for (int firmware = 0; firmware < CM1E_FIRMWARE_COUNT; firmware++) {
        const cm1e_firmware_info_t *info = cm1e_firmware_info((cm1e_firmware_t)firmware);
        const cm1e_device_options_t options = cm1e_of(firmware, CM1E_MAPPING_DYNAMIC);
        write_device(&options, CM1E_ESI_FLAT);
        TEST_ASSERT_EQUAL_STRING("#x00004441", text("/EtherCATInfo/Vendor/Id"));
        TEST_ASSERT_EQUAL_STRING("Myostat Motion Control Inc.", text("/EtherCATInfo/Vendor/Name"));
        TEST_ASSERT_EQUAL_STRING("CM1-E", text(DEVICE "/Type"));
        TEST_ASSERT_EQUAL_STRING("#x44412002", text(DEVICE "/Type/@ProductCode"));
        TEST_ASSERT_EQUAL_HEX32(info->revision, (uint32_t)number(text(DEVICE "/Type/@RevisionNo")));
        TEST_ASSERT_NOT_NULL(strstr(text(DEVICE "/Comment"), info->version));
        for (int motor = 0; motor < 4; motor++)
            TEST_ASSERT_NOT_NULL(strstr(text(DEVICE "/Comment"), cm1e_device_motors[motor].name));
        TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/Info/IdentificationReg134"));
        TEST_ASSERT_EQUAL_STRING("402", text(DEVICE "/Profile/ChannelInfo/ProfileNo"));
        TEST_ASSERT_EQUAL_STRING("4", text(DEVICE "/Profile/ChannelInfo/AddInfo"));
        TEST_ASSERT_EQUAL_STRING(text(DEVICE "/GroupType"), text("/EtherCATInfo/Descriptions/Groups/Group/Type"));
    }
}

/* Little endian, as hexBinary shows it. */
static const char *hex(int64_t value, unsigned bits)
{
    static char digits[17];
    for (unsigned i = 0; i < bits / 8; i++)
        snprintf(digits + 2 * i, 3, "%02X", (unsigned)((uint64_t)value >> (8 * i)) & 0xFF);
    return digits;
}

static void check_access(const char *flags, uint8_t access)
{
    TEST_ASSERT_EQUAL_STRING(access & CM1E_ACCESS_WRITE ? "rw" : "ro", text("%s/Access", flags));
    TEST_ASSERT_EQUAL_STRING(access & CM1E_ACCESS_WRITE_PREOP_ONLY ? "PreOP" : "?",
                             text("%s/Access/@WriteRestrictions", flags));
    TEST_ASSERT_EQUAL_STRING(access & CM1E_ACCESS_RXPDO ? "R" : access & CM1E_ACCESS_TXPDO ? "T" : "?",
                             text("%s/PdoMapping", flags));
}

static void check_simple_object(const cm1e_object_t *object, const char *where)
{
    const cm1e_entry_t *entry = &object->entries[0];
    char flags[300];
    snprintf(flags, sizeof flags, "%s/Flags", where);
    TEST_ASSERT_EQUAL_INT(entry->bits, number(text("%s/BitSize", where)));
    TEST_ASSERT_EQUAL_INT(entry->bits,
                          number(text(DICTIONARY "/DataTypes/DataType[Name='%s']/BitSize", text("%s/Type", where))));
    check_access(flags, entry->access);
    if (entry->unit[0] != '\0') {
        char unit[64];
        snprintf(unit, sizeof unit, "[%s]", entry->unit);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text("%s/Comment", where), unit), object->name);
    }
    if (!entry->default_string)
        TEST_ASSERT_EQUAL_STRING(hex(entry->default_value, entry->bits), text("%s/Info/DefaultData", where));
}

static void check_sub_indexes(const cm1e_object_t *object, const char *where)
{
    int end = 0;
    char type[64];
    strcpy(type, text("%s/Type", where));
    for (unsigned i = 0; i < object->entry_count; i++) {
        const cm1e_entry_t *entry = &object->entries[i];
        char item[300], flags[320];
        snprintf(item, sizeof item, DICTIONARY "/DataTypes/DataType[Name='%s']/SubItem[SubIdx='%u']", type,
                 entry->subindex);
        snprintf(flags, sizeof flags, "%s/Flags", item);
        const char *name = text("%s/DisplayName", item);
        TEST_ASSERT_EQUAL_STRING(entry->name, name[0] == '?' ? text("%s/Name", item) : name);
        TEST_ASSERT_EQUAL_INT(entry->bits, number(text("%s/BitSize", item)));
        TEST_ASSERT_EQUAL_INT(i == 1 ? 16 : end, number(text("%s/BitOffs", item)));
        check_access(flags, entry->access);
        end = number(text("%s/BitOffs", item)) + entry->bits;
        if (entry->maximum < 1000000 && entry->minimum > 0 && (entry->access & CM1E_ACCESS_WRITE))
            TEST_ASSERT_EQUAL_STRING(hex(entry->minimum, entry->bits),
                                     text("%s/Info/SubItem[Name='%s']/Info/MinData", where, entry->name));
    }
    TEST_ASSERT_EQUAL_INT(end, number(text("%s/BitSize", where)));
    TEST_ASSERT_EQUAL_INT(end, number(text(DICTIONARY "/DataTypes/DataType[Name='%s']/BitSize", type)));
}

static void test_dictionary_is_that_of_the_tables(void)
{
    const cm1e_device_options_t options = {0};
    write_device(&options, CM1E_ESI_FLAT);
    size_t objects;
    const cm1e_object_t *object = cm1e_device_objects(&objects);
    TEST_ASSERT_EQUAL_INT(objects, count(DICTIONARY "/Objects/Object"));
    for (size_t i = 0; i < objects; i++, object++) {
        char where[128];
        snprintf(where, sizeof where, DICTIONARY "/Objects/Object[Index='#x%04X']", object->index);
        TEST_ASSERT_EQUAL_STRING(object->name, text("%s/Name", where));
        if (object->object_code == CM1E_OBJECT_VAR)
            check_simple_object(object, where);
        else
            check_sub_indexes(object, where);
    }
}

static void test_texts_are_default_data_too(void)
{
    const cm1e_device_options_t options = {0};
    write_device(&options, CM1E_ESI_FLAT);
    TEST_ASSERT_EQUAL_STRING("434D312D45", text(DICTIONARY "/Objects/Object[Index='#x1008']/Info/DefaultData"));
    TEST_ASSERT_EQUAL_STRING("STRING(5)", text(DICTIONARY "/Objects/Object[Index='#x1008']/Type"));
}

static void test_velocities_have_the_unit_and_the_range_of_the_firmware(void)
{
    for (int firmware = 0; firmware < CM1E_FIRMWARE_COUNT; firmware++) {
        const bool per_ms = cm1e_firmware_info((cm1e_firmware_t)firmware)->velocity_in_counts_per_ms;
        const cm1e_device_options_t options = cm1e_of(firmware, CM1E_MAPPING_DYNAMIC);
        write_device(&options, CM1E_ESI_FLAT);
        TEST_ASSERT_EQUAL_STRING(per_ms ? "[counts/ms] -2500 ... 2500" : "[counts/s] -2500000 ... 2500000",
                                 text(DICTIONARY "/Objects/Object[Index='#x60FF']/Comment"));
        TEST_ASSERT_EQUAL_STRING(per_ms ? "C4090000" : "A0252600",
                                 text(DICTIONARY "/Objects/Object[Index='#x60FF']/Info/MaxData"));
        TEST_ASSERT_EQUAL_STRING(per_ms ? "counts/ms" : "counts/s",
                                 text(DEVICE "/RxPdo[Index='#x1600']/Entry[Index='#x60FF']/Comment"));
        TEST_ASSERT_EQUAL_STRING(per_ms ? "counts/ms" : "counts/s",
                                 text(DEVICE "/TxPdo[Index='#x1A02']/Entry[Index='#x606C']/Comment"));
    }
}

static void test_what_the_guide_does_not_tell_is_not_stated(void)
{
    const cm1e_device_options_t options = {0};
    write_device(&options, CM1E_ESI_FLAT);
    TEST_ASSERT_EQUAL_INT(0, count(DEVICE "/Info/StateMachine|" DEVICE "/Info/Mailbox|" DEVICE
                                          "/Info/EtherCATController"));
    TEST_ASSERT_EQUAL_INT(0, count(DEVICE "/Sm/@MinSize|" DEVICE "/Sm/@MaxSize"));
    TEST_ASSERT_EQUAL_INT(0, count(DICTIONARY "/Objects/Object[Index='#x60F6']/Info/SubItem[Name='K21']/Info/*"));
    TEST_ASSERT_EQUAL_INT(0, count(DICTIONARY "/Objects/Object[Index='#x60F6']/Info/SubItem[Name='K48']"));
    TEST_ASSERT_EQUAL_STRING("1E00", text(DICTIONARY "/Objects/Object[Index='#x60F6']/Info/SubItem[Name='K47']/Info/"
                                                     "DefaultData"));
}

/* Values of sub-indexes stand in the type's order without gaps: some readers go by that instead of the names. */
static void test_values_of_sub_indexes_are_found_by_name_and_by_order(void)
{
    const cm1e_device_options_t options = {0};
    write_device(&options, CM1E_ESI_FLAT);
    const int objects = count(DICTIONARY "/Objects/Object");
    TEST_ASSERT_GREATER_THAN_INT(40, objects);
    for (int i = 1; i <= objects; i++) {
        char object[120];
        snprintf(object, sizeof object, DICTIONARY "/Objects/Object[%d]", i);
        for (int item = 1; item <= count("%s/Info/SubItem", object); item++) {
            char name[120];
            snprintf(name, sizeof name, "%s", text("%s/Info/SubItem[%d]/Name", object, item));
            TEST_ASSERT_EQUAL_STRING(name, text(DICTIONARY "/DataTypes/DataType[Name=%s/Type]/SubItem[%d]/Name", object,
                                                item));
        }
    }
}

static void check_pdo(const cm1e_pdo_t *pdo, const char *where, bool has_sync_manager, bool in_module)
{
    const bool transmit = pdo->index >= 0x1A00;
    TEST_ASSERT_EQUAL_STRING(pdo->name, text("%s/Name", where));
    TEST_ASSERT_EQUAL_STRING("1", text("%s/@Fixed", where));
    TEST_ASSERT_EQUAL_STRING(!has_sync_manager ? "?" : transmit ? "3" : "2", text("%s/@Sm", where));
    TEST_ASSERT_EQUAL_STRING("?", text("%s/@Mandatory", where));
    TEST_ASSERT_EQUAL_INT(in_module ? 0 : 3, count("%s/Exclude", where));
    TEST_ASSERT_EQUAL_INT(0, count("%s/Exclude[.='#x%04X']", where, pdo->index));
    TEST_ASSERT_EQUAL_INT(pdo->entry_count, count("%s/Entry", where));
    for (unsigned i = 0; i < pdo->entry_count; i++) {
        TEST_ASSERT_EQUAL_HEX16(pdo->entries[i].index, number(text("%s/Entry[%u]/Index", where, i + 1)));
        TEST_ASSERT_EQUAL_INT(pdo->entries[i].bits, number(text("%s/Entry[%u]/BitLen", where, i + 1)));
        TEST_ASSERT_EQUAL_STRING("0", text("%s/Entry[%u]/SubIndex", where, i + 1));
        TEST_ASSERT_EQUAL_INT(pdo->entries[i].bits, cm1e_type_bits(text("%s/Entry[%u]/DataType", where, i + 1)));
        TEST_ASSERT_EQUAL_STRING(in_module && pdo->entries[i].index >= 0x6000 ? "1" : "?",
                                 text("%s/Entry[%u]/Index/@DependOnSlot", where, i + 1));
    }
}

static void test_flat_pdos_are_those_of_the_tables(void)
{
    for (int firmware = 0; firmware < CM1E_FIRMWARE_COUNT; firmware++)
        for (int chosen = 0; chosen < 4; chosen++)
            for (int order = 0; order < 2; order++) {
                cm1e_device_options_t options = cm1e_of(firmware, (cm1e_mapping_t)chosen);
                options.order = (cm1e_pdo_order_t)order;
                write_device(&options, CM1E_ESI_FLAT);
                for (int n = 0; n < 8; n++) {
                    cm1e_pdo_t pdo;
                    char where[128];
                    cm1e_device_pdo(&pdo, (cm1e_mapping_t)(n / 2), n % 2, options.order, (cm1e_firmware_t)firmware);
                    snprintf(where, sizeof where, DEVICE "/%s[Index='#x%04X']", n % 2 ? "TxPdo" : "RxPdo", pdo.index);
                    check_pdo(&pdo, where, n / 2 == chosen, false);
                }
            }
}

static void test_mdp_pdos_are_in_the_modules(void)
{
    const cm1e_device_options_t options = {.mapping = CM1E_MAPPING_CSV};
    write_device(&options, CM1E_ESI_MDP);
    TEST_ASSERT_EQUAL_INT(0, count(DEVICE "/RxPdo|" DEVICE "/TxPdo"));
    TEST_ASSERT_EQUAL_INT(4, count(MODULE));
    for (int n = 0; n < 8; n++) {
        cm1e_pdo_t pdo;
        char where[128];
        cm1e_device_pdo(&pdo, (cm1e_mapping_t)(n / 2), n % 2, options.order, CM1E_FIRMWARE_1_3_5);
        snprintf(where, sizeof where, MODULE "[%d]/%s", n / 2 + 1, n % 2 ? "TxPdo" : "RxPdo");
        TEST_ASSERT_EQUAL_HEX16(pdo.index, number(text("%s/Index", where)));
        TEST_ASSERT_EQUAL_STRING("1", text("%s/Index/@DependOnSlot", where));
        check_pdo(&pdo, where, true, true);
    }
}

static void test_mdp_slot_offers_every_module_and_chooses_one(void)
{
    for (int chosen = 0; chosen < 4; chosen++) {
        const cm1e_device_options_t options = {.mapping = (cm1e_mapping_t)chosen};
        write_device(&options, CM1E_ESI_MDP);
        TEST_ASSERT_EQUAL_STRING("#x10", text(DEVICE "/Slots/@SlotPdoIncrement"));
        TEST_ASSERT_EQUAL_STRING("#x0800", text(DEVICE "/Slots/@SlotIndexIncrement"));
        TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/Slots/Slot/@MinInstances"));
        TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/Slots/Slot/@MaxInstances"));
        TEST_ASSERT_EQUAL_INT(4, count(DEVICE "/Slots/Slot/ModuleIdent"));
        for (int n = 1; n <= 4; n++) {
            TEST_ASSERT_EQUAL_STRING(text(MODULE "[%d]/Type/@ModuleIdent", n),
                                     text(DEVICE "/Slots/Slot/ModuleIdent[%d]", n));
            TEST_ASSERT_EQUAL_STRING("402", text(MODULE "[%d]/Profile/ProfileNo", n));
        }
        TEST_ASSERT_EQUAL_STRING(text(MODULE "[%d]/Type/@ModuleIdent", chosen + 1),
                                 text(DEVICE "/Slots/Slot/ModuleIdent[@Default='1']"));
    }
}

/* Device and module together have every object once. */
static void test_mdp_dictionaries_are_the_flat_one_together(void)
{
    const cm1e_device_options_t options = {0};
    write_device(&options, CM1E_ESI_MDP);
    size_t objects;
    const cm1e_object_t *object = cm1e_device_objects(&objects);
    for (size_t i = 0; i < objects; i++, object++) {
        const int in_device = count(DICTIONARY "/Objects/Object[Index='#x%04X']", object->index);
        for (int module = 1; module <= 4; module++) {
            const int in_module = count(MODULE "[%d]/Profile/Dictionary/Objects/Object[Index='#x%04X']"
                                               "[Index/@DependOnSlot='1']", module, object->index);
            TEST_ASSERT_EQUAL_INT_MESSAGE(1, in_device + in_module, object->name);
        }
    }
}

static void test_mdp_module_sets_its_mode(void)
{
    static const char *const modes[] = {"08", "08", "09", "01"};
    const cm1e_device_options_t options = {0};
    write_device(&options, CM1E_ESI_MDP);
    TEST_ASSERT_EQUAL_INT(0, count(DEVICE "/Mailbox/CoE/InitCmd[Index='#x6060']"));
    for (int n = 0; n < 4; n++) {
        TEST_ASSERT_EQUAL_STRING(modes[n], text(MODULE "[%d]/Mailbox/CoE/InitCmd[Index='#x6060']/Data", n + 1));
        TEST_ASSERT_EQUAL_STRING("1", text(MODULE "[%d]/Mailbox/CoE/InitCmd/Index/@DependOnSlot", n + 1));
    }
}

static void test_sync_managers_are_those_of_the_tables(void)
{
    static const char *const uses[] = {"MBoxOut", "MBoxIn", "Outputs", "Inputs"};
    const cm1e_device_options_t options = {.mapping = CM1E_MAPPING_CSP};
    write_device(&options, CM1E_ESI_FLAT);
    TEST_ASSERT_EQUAL_INT(4, count(DEVICE "/Sm"));
    for (int n = 0; n < 4; n++) {
        const cm1e_sync_manager_t *manager = &cm1e_device_sync_managers[n];
        TEST_ASSERT_EQUAL_STRING(uses[n], text(DEVICE "/Sm[%d]", n + 1));
        TEST_ASSERT_EQUAL_HEX16(manager->start, number(text(DEVICE "/Sm[%d]/@StartAddress", n + 1)));
        TEST_ASSERT_EQUAL_HEX8(manager->control, number(text(DEVICE "/Sm[%d]/@ControlByte", n + 1)));
        TEST_ASSERT_EQUAL_INT(manager->enable, number(text(DEVICE "/Sm[%d]/@Enable", n + 1)));
    }
    TEST_ASSERT_EQUAL_STRING("128", text(DEVICE "/Sm[1]/@DefaultSize"));
    TEST_ASSERT_EQUAL_STRING("8", text(DEVICE "/Sm[3]/@DefaultSize")); /* 6040 60FE 607A */
    TEST_ASSERT_EQUAL_STRING("Outputs", text(DEVICE "/Fmmu[1]"));
    TEST_ASSERT_EQUAL_STRING("Inputs", text(DEVICE "/Fmmu[2]"));
    TEST_ASSERT_EQUAL_STRING("MBoxState", text(DEVICE "/Fmmu[3]"));
}

static void test_mailbox_offers_what_was_asked_for(void)
{
    for (int complete_access = 0; complete_access < 2; complete_access++) {
        const cm1e_device_options_t options = {.complete_access = complete_access};
        write_device(&options, CM1E_ESI_FLAT);
        TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/Mailbox/@DataLinkLayer"));
        TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/Mailbox/CoE/@SdoInfo"));
        TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/Mailbox/CoE/@PdoAssign"));
        TEST_ASSERT_EQUAL_STRING("0", text(DEVICE "/Mailbox/CoE/@PdoConfig"));
        TEST_ASSERT_EQUAL_STRING(complete_access ? "1" : "0", text(DEVICE "/Mailbox/CoE/@CompleteAccess"));
        TEST_ASSERT_EQUAL_INT(1, count(DEVICE "/Mailbox/FoE"));
        TEST_ASSERT_EQUAL_INT(0, count(DEVICE "/Mailbox/EoE|" DEVICE "/Mailbox/SoE|" DEVICE "/Mailbox/AoE"));
    }
}

/* UG 11.2.1: both assignments emptied, then set; then the mode. */
static void test_start_up_commands_assign_the_mapping_and_set_the_mode(void)
{
    static const struct {
        const char *index, *subindex, *data, *adapts;
    } wanted[] = {{"#x1C12", "0", "00", "1"}, {"#x1C13", "0", "00", "1"}, {"#x1C12", "1", "0216", "1"},
                  {"#x1C12", "0", "01", "1"}, {"#x1C13", "1", "021A", "1"}, {"#x1C13", "0", "01", "1"},
                  {"#x6060", "0", "09", "?"}};
    const cm1e_device_options_t options = {.mapping = CM1E_MAPPING_CSV};
    write_device(&options, CM1E_ESI_FLAT);
    TEST_ASSERT_EQUAL_INT(7, count(DEVICE "/Mailbox/CoE/InitCmd"));
    for (int n = 0; n < 7; n++) {
        TEST_ASSERT_EQUAL_STRING("PS", text(DEVICE "/Mailbox/CoE/InitCmd[%d]/Transition", n + 1));
        TEST_ASSERT_EQUAL_STRING(wanted[n].index, text(DEVICE "/Mailbox/CoE/InitCmd[%d]/Index", n + 1));
        TEST_ASSERT_EQUAL_STRING(wanted[n].subindex, text(DEVICE "/Mailbox/CoE/InitCmd[%d]/SubIndex", n + 1));
        TEST_ASSERT_EQUAL_STRING(wanted[n].data, text(DEVICE "/Mailbox/CoE/InitCmd[%d]/Data", n + 1));
        TEST_ASSERT_EQUAL_STRING(wanted[n].adapts,
                                 text(DEVICE "/Mailbox/CoE/InitCmd[%d]/Data/@AdaptAutomatically", n + 1));
    }
}

static void test_clock_modes_begin_with_the_one_of_the_guide(void)
{
    cm1e_device_options_t options = {0};
    write_device(&options, CM1E_ESI_FLAT);
    TEST_ASSERT_EQUAL_STRING("#x0000", text(DEVICE "/Dc/OpMode/AssignActivate"));
    options.distributed_clocks = true;
    write_device(&options, CM1E_ESI_FLAT);
    TEST_ASSERT_EQUAL_STRING("#x0000", text(DEVICE "/Dc/OpMode[1]/AssignActivate"));
    TEST_ASSERT_EQUAL_STRING("DC Synchronous", text(DEVICE "/Dc/OpMode[2]/Name"));
    TEST_ASSERT_EQUAL_STRING("#x0300", text(DEVICE "/Dc/OpMode[2]/AssignActivate"));
    TEST_ASSERT_EQUAL_STRING("1", text(DEVICE "/Dc/OpMode[2]/CycleTimeSync0/@Factor"));
}

/* A wrong configuration makes a device unreachable: a file that does not know it offers nothing to write. */
static void test_an_eeprom_that_is_not_known_is_not_there(void)
{
    for (int layout = 0; layout < 2; layout++) {
        cm1e_device_options_t options = {0};
        write_device(&options, (cm1e_esi_layout_t)layout);
        TEST_ASSERT_EQUAL_INT(0, count("//Eeprom|//ConfigData|//BootStrap"));
        TEST_ASSERT_EQUAL_INT(1, count(DEVICE "/comment()[contains(., 'Do not write an EEPROM')]"));
        for (int i = 0; i < 14; i++)
            options.config_data[i] = (uint8_t)(0xA0 + i);
        options.config_data_size = 14;
        write_device(&options, (cm1e_esi_layout_t)layout);
        TEST_ASSERT_EQUAL_INT(0, count("//comment()"));
        TEST_ASSERT_EQUAL_STRING("2048", text(DEVICE "/Eeprom/ByteSize"));
        TEST_ASSERT_EQUAL_STRING("A0A1A2A3A4A5A6A7A8A9AAABACAD", text(DEVICE "/Eeprom/ConfigData"));
        TEST_ASSERT_EQUAL_STRING("0010800080108000", text(DEVICE "/Eeprom/BootStrap"));
    }
}

int main(void)
{
    load_schema();
    UNITY_BEGIN();
    RUN_TEST(test_every_cm1e_is_valid_by_the_schema);
    RUN_TEST(test_every_bridge_is_valid_by_the_schema);
    RUN_TEST(test_a_file_with_an_eeprom_is_valid_by_the_schema);
    RUN_TEST(test_the_schema_sees_what_is_wrong);
    RUN_TEST(test_files_are_the_golden_ones);
    RUN_TEST(test_a_file_with_everything_else_is_the_golden_one);
    RUN_TEST(test_a_file_of_the_bridge_is_the_golden_one);
    RUN_TEST(test_the_same_device_gives_the_same_bytes);
    RUN_TEST(test_identity_is_that_of_the_firmware);
    RUN_TEST(test_dictionary_is_that_of_the_tables);
    RUN_TEST(test_texts_are_default_data_too);
    RUN_TEST(test_velocities_have_the_unit_and_the_range_of_the_firmware);
    RUN_TEST(test_what_the_guide_does_not_tell_is_not_stated);
    RUN_TEST(test_values_of_sub_indexes_are_found_by_name_and_by_order);
    RUN_TEST(test_flat_pdos_are_those_of_the_tables);
    RUN_TEST(test_mdp_pdos_are_in_the_modules);
    RUN_TEST(test_mdp_slot_offers_every_module_and_chooses_one);
    RUN_TEST(test_mdp_dictionaries_are_the_flat_one_together);
    RUN_TEST(test_mdp_module_sets_its_mode);
    RUN_TEST(test_sync_managers_are_those_of_the_tables);
    RUN_TEST(test_mailbox_offers_what_was_asked_for);
    RUN_TEST(test_start_up_commands_assign_the_mapping_and_set_the_mode);
    RUN_TEST(test_clock_modes_begin_with_the_one_of_the_guide);
    RUN_TEST(test_an_eeprom_that_is_not_known_is_not_there);
    const int failures = UNITY_END();
    free_schema();
    return failures;
}
