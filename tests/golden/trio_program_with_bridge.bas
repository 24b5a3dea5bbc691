' CM1E_START: the first motions of Myostat motors on a Trio controller (TrioBASIC).
'
' Motion Perfect: a new BASIC program of this name, this text into it. EC_EXTEND has to be loaded before.
' Input run_input on: the axes are enabled and go to and fro. Off: they stop. Nothing moves before it was
' seen off once. Input reset_input on: errors are cleared. The place of an axis when it is enabled: 0.
'
' This is no safety function: a safe stop takes the motors' power away.
' [UG] is what CM1-E User Guide 11.2.1 shows, [T] what public programs for Trio controllers show.
' Nobody has run this on a controller yet: motors uncoupled, a hand at the power switch.
'
' Made for:
'   CM1-E, revision 0x20020103: 1 axis
'   EB01, revision 0x00000007: 3 axes
' How many counts are a revolution of a motor at a bridge, its K37 says (appendix 5 of its guide):
' change travel_counts, slow_speed, ramp_rate and fe_most by it.

' ---- what you may want to change ------------------------------------------------------------------------

first_axis = 0
last_axis = 3 'one less than there are axes on the network
travel_counts = 50000 'counts, there and back; 50000 are one revolution of a CM1-E. [UG] 2500000
slow_speed = 50000 'counts/s. [UG] 1666667, which is the most that a CM1-E-23L20D can do
ramp_rate = 500000 'counts/s2. [UG] 1666667
fe_most = 25000 'counts between where an axis is and where it should be
run_input = 0 '[UG]
reset_input = 1
state_vr = 100 'a VR that no other program uses

' ---- the program ----------------------------------------------------------------------------------------

WDOG = 0
axes_enabled = 0
GOSUB check_network
PRINT "CM1E_START: waits for input ";run_input[0];", off and then on"
WAIT UNTIL IN(run_input) = 0
WHILE 1 '[UG]
    IF MOTION_ERROR <> 0 THEN
        axes_enabled = 0
        PRINT "CM1E_START: error, axis ";ERROR_AXIS[0];"; input ";reset_input[0];" clears it"
        WAIT UNTIL IN(reset_input) = 1
        GOSUB reset_axes
        WAIT UNTIL IN(reset_input) = 0 AND IN(run_input) = 0
    ELSEIF IN(run_input) = 1 THEN '[UG]
        IF axes_enabled = 0 THEN GOSUB set_up
        target_pos = travel_counts
        GOSUB move_axes
        target_pos = 0
        GOSUB move_axes
    ENDIF
    WA(10)
WEND
STOP

' ---- is all there? --------------------------------------------------------------------------------------

check_network:
    IF ETHERCAT($101) <> -1 THEN '[T] -1: EC_EXTEND was understood
        PRINT "CM1E_START: the controller refuses EC_EXTEND"
        STOP
    ENDIF
    ETHERCAT($22, 0, state_vr) '[T] 0 init, 1 pre-op, 2 safe-op, 3 op
    IF VR(state_vr) <> 3 THEN
        ETHERCAT(0, 0) '[T] starts the network anew
        WA(5000)
        ETHERCAT($22, 0, state_vr)
    ENDIF
    IF VR(state_vr) <> 3 THEN
        PRINT "CM1E_START: EtherCAT is not operational"
        STOP
    ENDIF
    FOR axis_no = first_axis TO last_axis
        IF ATYPE AXIS(axis_no) <> 65 THEN '[T] 65: position over EtherCAT
            PRINT "CM1E_START: no EtherCAT position axis: ";axis_no[0]
            STOP
        ENDIF
    NEXT axis_no
RETURN

' ---- set-up: the axes get their limits, and are enabled -------------------------------------------------

set_up:
    WDOG = 0
    FOR axis_no = first_axis TO last_axis
        BASE(axis_no) '[UG]
        SERVO = 0
        DRIVE_CW_MODE = 0 '[UG] the controller writes the controlword
        UNITS = 1 '[UG] one unit is one count
        ACCEL = ramp_rate '[UG]
        DECEL = ramp_rate '[UG]
        SPEED = slow_speed '[UG]
        FE_LIMIT = fe_most '[T]
        DEFPOS(0) '[T] here is 0
        WAIT UNTIL OFFPOS = 0 '[T]
        FS_LIMIT = travel_counts + fe_most 'no motion beyond what this program commands
        RS_LIMIT = -fe_most
        SERVO = 1 '[UG]
    NEXT axis_no
    WDOG = 1 '[UG] enables the motors
    WA(1000) '[T]
    axes_enabled = 1
RETURN

' ---- move: all axes to target, as long as the input is on -----------------------------------------------

move_axes:
    IF IN(run_input) = 0 OR MOTION_ERROR <> 0 THEN RETURN
    FOR axis_no = first_axis TO last_axis
        MOVEABS(target_pos) AXIS(axis_no) '[UG]
    NEXT axis_no
    FOR axis_no = first_axis TO last_axis
        WAIT UNTIL IDLE AXIS(axis_no) OR IN(run_input) = 0 OR MOTION_ERROR <> 0 '[UG] WAIT IDLE
    NEXT axis_no
    IF IN(run_input) = 0 THEN RAPIDSTOP(2) '[T] all axes
    FOR axis_no = first_axis TO last_axis
        WAIT IDLE AXIS(axis_no) '[UG]
    NEXT axis_no
RETURN

' ---- reset: errors of the motors, then those of the controller ------------------------------------------

reset_axes:
    WDOG = 0
    FOR axis_no = first_axis TO last_axis
        IF (AXISSTATUS AXIS(axis_no)).3 THEN '[T] the motor reports an error
            ETHERCAT($64, axis_no, 0, 100) '[T] clears it, within 100 ms
            WA(100)
        ENDIF
    NEXT axis_no
    DATUM(0) '[T] clears the errors of all axes
    IF SYSTEM_ERROR AND $100000 THEN UNIT_CLEAR '[T] emergency messages
    WA(100)
    ' A CM1-E of V1.3.5 restarts when its error 0x7510 is cleared (UG 10.1): it has to come back first.
    GOSUB check_network
    IF MOTION_ERROR <> 0 THEN PRINT "CM1E_START: an error remains: what does the motor's LED say?"
RETURN
