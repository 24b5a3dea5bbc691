/**
 * @file cm_bridge.h
 * Blocks for Cool Muscle motors behind an EtherCAT Cool MUSCLE Bridge: CML, modes of operation, commands of CMD. They
 * are ours, not PLCopen's, and keep its rules of Execute and Enable. A CM1-E refuses them. They work while the axis is
 * Disabled (CM_SendCML also in ErrorStop, when the motor is in CML already); the axis stays in that state.
 * Generated from fb/interface/cm_bridge.st by fb/interface/generate.py; change it there.
 */
#ifndef CM1E_CM_BRIDGE_H
#define CM1E_CM_BRIDGE_H

#include "cm1e/api.h"
#include "cm1e/mc_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Mode of operation of a motor behind a bridge (BR 6). */
typedef enum CM_MODE {
    cmCSP = 0,  /**< the one to move in; after power-on */
    cmCML = 1,  /**< strings in CML; CM_SendCML and MC_Power come here and go back by themselves */
    cmCMD = 2,  /**< commands, CM_Command. No way leads back to CSP but switching the bridge off and on */
    cmCPIO = 3, /**< as CSP, with inputs and outputs in every cycle. No way back to CSP but switching off and on */
} CM_MODE;

/** A command of CMD mode (BR 7.1.2). */
typedef enum CM_COMMAND {
    cmMotorFree = 0,
    cmMotorEnable = 1,  /**< the motor holds; also ends its error */
    cmOriginSearch = 2, /**< moves the motor */
    cmResetCounter = 3, /**< the present position is 0 */
    cmOriginSearchAbort = 4,
} CM_COMMAND;

/** BR 7.2. Sends a string in CML to the motor and waits for its answer. Goes to CML mode by itself, and stays
 *  there: MC_Power returns to CSP before it enables. Done: at once where no answer is due (a parameter, an output);
 *  with the value of every query; at the end of a list or of an origin search. When a string that may have moved
 *  the motor fails, or when the axis leaves CML, the motor is freed. @rt cycle */
typedef struct CM_SendCML {
    AXIS_REF_t *Axis;
    BOOL Execute;
    STRING80 Command;  /**< 1 ... 64 bytes; "?99.1", "K53.1=100"; ".ID" is the connector of this motor, or missing */
    TIME Timeout;      /**< ns; for the answer, and for each further line; 0: 1 s, of an origin search 70 s */
    BOOL AllowMotion;  /**< TRUE: strings that may move the motor or change its power are sent, too */
    INT Line;          /**< 1 ... Lines; which line Response shows; 0: the first. Also after Done */
    /* outputs */
    BOOL Done;         /**< the answer is there, or none is due */
    BOOL Busy, Error;
    WORD ErrorID;
    STRING80 Response; /**< a line of the answer; with CML_ANSWER the damaged one. Of a list all but the first line
                            are gone when another string of this axis is under way */
    INT Lines;         /**< 0 ... 128; how many lines the answer has */
    INT Strays;        /**< lines that came and answer nothing that was asked: of an earlier query, or sent unasked */
    cm1e_fb_private_t Private;
} CM_SendCML_t;
CM1E_API void CM_SendCML(CM_SendCML_t *fb);

/** BR 6.2.2. Switches the mode of operation (BR appendix 3): at rest and without an error of the motor. CMD and
 *  CPIO are dead ends: from there no way leads to CSP but switching the bridge off and on. @rt cycle */
typedef struct CM_SetMode {
    AXIS_REF_t *Axis;
    BOOL Execute;
    CM_MODE Mode;
    BOOL Insist; /**< TRUE: to CML and CSP also after CMD or CPIO, though the motor "will possibly result in
                      operating abnormal" (BR 6 note 2) */
    /* outputs */
    BOOL Done;   /**< object 0x6061 shows the mode */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} CM_SetMode_t;
CM1E_API void CM_SetMode(CM_SetMode_t *fb);

/** BR 7.1. Gives a command of CMD mode (BR appendix 1). An origin search moves the motor by the bridge's own
 *  parameters, without limits of the axis; it is aborted and the motor freed when its time is over, when the bus
 *  was away, and at the end of the run. @rt cycle */
typedef struct CM_Command {
    AXIS_REF_t *Axis;
    BOOL Execute;
    CM_COMMAND Command;
    TIME Timeout; /**< ns; of an origin search; 0: 90 s */
    /* outputs */
    BOOL Done;    /**< the motor has answered; of an origin search: it is at its origin */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} CM_Command_t;
CM1E_API void CM_Command(CM_Command_t *fb);

#ifdef __cplusplus
}
#endif
#endif
