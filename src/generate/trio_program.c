#include <stdio.h>
#include <stdlib.h>

#include "generate/ec_extend.h"
#include "generate/generate_options.h"

/* Half a revolution of following error; one revolution at one a second. The guide's values are at the motor's limit. */
enum { FE_LIMIT = CM1E_COUNTS_PER_REVOLUTION / 2, TRAVEL = CM1E_COUNTS_PER_REVOLUTION,
       SPEED = CM1E_COUNTS_PER_REVOLUTION, RAMP = 10 * CM1E_COUNTS_PER_REVOLUTION };

static const char head[] =
    "' CM1E_START: the first motions of Myostat motors on a Trio controller (TrioBASIC).\n"
    "'\n"
    "' Motion Perfect: a new BASIC program of this name, this text into it. EC_EXTEND has to be loaded before.\n"
    "' Input run_input on: the axes are enabled and go to and fro. Off: they stop. Nothing moves before it was\n"
    "' seen off once. Input reset_input on: errors are cleared. The place of an axis when it is enabled: 0.\n"
    "'\n"
    "' This is no safety function: a safe stop takes the motors' power away.\n"
    "' [UG] is what CM1-E User Guide 11.2.1 shows, [T] what public programs for Trio controllers show.\n"
    "' Nobody has run this on a controller yet: motors uncoupled, a hand at the power switch.\n"
    "'\n"
    "' Made for:\n";

static const char settings[] =
    "' ---- what you may want to change ------------------------------------------------------------------------\n"
    "\n"
    "first_axis = 0\n"
    "last_axis = %u 'one less than there are axes on the network\n"
    "travel_counts = %d 'counts, there and back; %d are one revolution of a CM1-E. [UG] 2500000\n"
    "slow_speed = %d 'counts/s. [UG] 1666667, which is the most that a CM1-E-23L20D can do\n"
    "ramp_rate = %d 'counts/s2. [UG] 1666667\n"
    "fe_most = %d 'counts between where an axis is and where it should be\n"
    "run_input = 0 '[UG]\n"
    "reset_input = 1\n"
    "state_vr = 100 'a VR that no other program uses\n"
    "\n";

static const char program[] =
    "' ---- the program ----------------------------------------------------------------------------------------\n"
    "\n"
    "WDOG = 0\n"
    "axes_enabled = 0\n"
    "GOSUB check_network\n"
    "PRINT \"CM1E_START: waits for input \";run_input[0];\", off and then on\"\n"
    "WAIT UNTIL IN(run_input) = 0\n"
    "WHILE 1 '[UG]\n"
    "    IF MOTION_ERROR <> 0 THEN\n"
    "        axes_enabled = 0\n"
    "        PRINT \"CM1E_START: error, axis \";ERROR_AXIS[0];\"; input \";reset_input[0];\" clears it\"\n"
    "        WAIT UNTIL IN(reset_input) = 1\n"
    "        GOSUB reset_axes\n"
    "        WAIT UNTIL IN(reset_input) = 0 AND IN(run_input) = 0\n"
    "    ELSEIF IN(run_input) = 1 THEN '[UG]\n"
    "        IF axes_enabled = 0 THEN GOSUB set_up\n"
    "        target_pos = travel_counts\n"
    "        GOSUB move_axes\n"
    "        target_pos = 0\n"
    "        GOSUB move_axes\n"
    "    ENDIF\n"
    "    WA(10)\n"
    "WEND\n"
    "STOP\n"
    "\n"
    "' ---- is all there? --------------------------------------------------------------------------------------\n"
    "\n"
    "check_network:\n"
    "    IF ETHERCAT($101) <> -1 THEN '[T] -1: EC_EXTEND was understood\n"
    "        PRINT \"CM1E_START: the controller refuses EC_EXTEND\"\n"
    "        STOP\n"
    "    ENDIF\n"
    "    ETHERCAT($22, 0, state_vr) '[T] 0 init, 1 pre-op, 2 safe-op, 3 op\n"
    "    IF VR(state_vr) <> 3 THEN\n"
    "        ETHERCAT(0, 0) '[T] starts the network anew\n"
    "        WA(5000)\n"
    "        ETHERCAT($22, 0, state_vr)\n"
    "    ENDIF\n"
    "    IF VR(state_vr) <> 3 THEN\n"
    "        PRINT \"CM1E_START: EtherCAT is not operational\"\n"
    "        STOP\n"
    "    ENDIF\n"
    "    FOR axis_no = first_axis TO last_axis\n"
    "        IF ATYPE AXIS(axis_no) <> 65 THEN '[T] 65: position over EtherCAT\n"
    "            PRINT \"CM1E_START: no EtherCAT position axis: \";axis_no[0]\n"
    "            STOP\n"
    "        ENDIF\n"
    "    NEXT axis_no\n"
    "RETURN\n"
    "\n"
    "' ---- set-up: the axes get their limits, and are enabled -------------------------------------------------\n"
    "\n"
    "set_up:\n"
    "    WDOG = 0\n"
    "    FOR axis_no = first_axis TO last_axis\n"
    "        BASE(axis_no) '[UG]\n"
    "        SERVO = 0\n"
    "        DRIVE_CW_MODE = 0 '[UG] the controller writes the controlword\n"
    "        UNITS = 1 '[UG] one unit is one count\n"
    "        ACCEL = ramp_rate '[UG]\n"
    "        DECEL = ramp_rate '[UG]\n"
    "        SPEED = slow_speed '[UG]\n"
    "        FE_LIMIT = fe_most '[T]\n"
    "        DEFPOS(0) '[T] here is 0\n"
    "        WAIT UNTIL OFFPOS = 0 '[T]\n"
    "        FS_LIMIT = travel_counts + fe_most 'no motion beyond what this program commands\n"
    "        RS_LIMIT = -fe_most\n"
    "        SERVO = 1 '[UG]\n"
    "    NEXT axis_no\n"
    "    WDOG = 1 '[UG] enables the motors\n"
    "    WA(1000) '[T]\n"
    "    axes_enabled = 1\n"
    "RETURN\n"
    "\n"
    "' ---- move: all axes to target, as long as the input is on -----------------------------------------------\n"
    "\n"
    "move_axes:\n"
    "    IF IN(run_input) = 0 OR MOTION_ERROR <> 0 THEN RETURN\n"
    "    FOR axis_no = first_axis TO last_axis\n"
    "        MOVEABS(target_pos) AXIS(axis_no) '[UG]\n"
    "    NEXT axis_no\n"
    "    FOR axis_no = first_axis TO last_axis\n"
    "        WAIT UNTIL IDLE AXIS(axis_no) OR IN(run_input) = 0 OR MOTION_ERROR <> 0 '[UG] WAIT IDLE\n"
    "    NEXT axis_no\n"
    "    IF IN(run_input) = 0 THEN RAPIDSTOP(2) '[T] all axes\n"
    "    FOR axis_no = first_axis TO last_axis\n"
    "        WAIT IDLE AXIS(axis_no) '[UG]\n"
    "    NEXT axis_no\n"
    "RETURN\n"
    "\n"
    "' ---- reset: errors of the motors, then those of the controller ------------------------------------------\n"
    "\n"
    "reset_axes:\n"
    "    WDOG = 0\n"
    "    FOR axis_no = first_axis TO last_axis\n"
    "        IF (AXISSTATUS AXIS(axis_no)).3 THEN '[T] the motor reports an error\n"
    "            ETHERCAT($64, axis_no, 0, 100) '[T] clears it, within 100 ms\n"
    "            WA(100)\n"
    "        ENDIF\n"
    "    NEXT axis_no\n"
    "    DATUM(0) '[T] clears the errors of all axes\n"
    "    IF SYSTEM_ERROR AND $100000 THEN UNIT_CLEAR '[T] emergency messages\n"
    "    WA(100)\n"
    "    ' A CM1-E of V1.3.5 restarts when its error 0x7510 is cleared (UG 10.1): it has to come back first.\n"
    "    GOSUB check_network\n"
    "    IF MOTION_ERROR <> 0 THEN PRINT \"CM1E_START: an error remains: what does the motor's LED say?\"\n"
    "RETURN\n";

static cm1e_error_t check_mappings(const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    for (size_t i = 0; options->devices && i < options->device_count; i++) {
        const cm1e_mapping_t mapping = options->devices[i].mapping;
        if (mapping == CM1E_MAPPING_CSV || mapping == CM1E_MAPPING_PROFILE)
            return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                                 "device %zu: the start program moves by positions from the controller, for which it "
                                 "needs the mapping dynamic or csp; %s", i + 1,
                                 mapping == CM1E_MAPPING_CSV
                                     ? "with csv the gains of the controller's loop have to be tuned first"
                                     : "with profile the motor moves by itself");
    }
    return CM1E_OK;
}

static void put_program(FILE *out, const cm1e_ec_extend_t *document)
{
    unsigned axes = 0;
    bool has_bridge = false;
    fputs(head, out);
    for (size_t i = 0; i < document->profiles.count; i++) {
        const cm1e_ec_profile_t *profile = &document->profiles.at[i];
        const unsigned its_axes = (unsigned)document->slaves.at[i].axes;
        fprintf(out, "'   %s, revision 0x%08X: %u %s\n", profile->name, (unsigned)profile->revision, its_axes,
                its_axes == 1 ? "axis" : "axes");
        axes += its_axes;
        has_bridge = has_bridge || profile->product_code != CM1E_PRODUCT_CODE;
    }
    if (has_bridge)
        fputs("' How many counts are a revolution of a motor at a bridge, its K37 says (appendix 5 of its guide):\n"
              "' change travel_counts, slow_speed, ramp_rate and fe_most by it.\n",
              out);
    fputs("\n", out);
    fprintf(out, settings, axes - 1, TRAVEL, CM1E_COUNTS_PER_REVOLUTION, SPEED, RAMP, FE_LIMIT);
    fputs(program, out);
}

static cm1e_error_t generate(cm1e_file_t *file, const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    cm1e_ec_extend_t document = {0};
    char *text = NULL;
    size_t size = 0;
    cm1e_error_t error = check_mappings(options, diag);
    if (error == CM1E_OK)
        error = cm1e_ec_extend_make(&document, options, diag);
    FILE *out = error == CM1E_OK ? open_memstream(&text, &size) : NULL;
    if (out) {
        put_program(out, &document);
        const bool failed = ferror(out) != 0;
        if (fclose(out) != 0 || failed) {
            free(text);
            text = NULL;
        }
    }
    cm1e_ec_extend_free(&document);
    if (error == CM1E_OK && !text)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    file->bytes = (uint8_t *)text;
    file->size = size;
    if (text)
        snprintf(file->warning, sizeof file->warning,
                 "this program has not run on a controller yet: read it, and run it with the motors uncoupled");
    return error;
}

cm1e_error_t cm1e_generate_trio_program_sized(cm1e_file_t *file, const cm1e_generate_options_t *options, size_t size,
                                              size_t device_size, cm1e_diag_t *diag)
{
    return cm1e_generate_with(generate, file, options, size, device_size, diag);
}
