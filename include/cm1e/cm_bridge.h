/**
 * @file cm_bridge.h
 * Blocks for Cool Muscle motors behind an EtherCAT Cool MUSCLE Bridge: CML, modes of operation, commands of CMD.
 * PLCopen does not define these blocks; they keep its rules of Execute and Enable. A CM1-E refuses them. They work
 * while the axis is Disabled (CM_SendCML also in ErrorStop, if the motor is in CML already); the axis stays in that
 * state.
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
    cmCSP = 0,  /**< the mode for motion; active after power-on */
    cmCML = 1,  /**< strings in CML; CM_SendCML switches to it, MC_Power switches back */
    cmCMD = 2,  /**< commands of CM_Command. Only switching the bridge off and on leads back to CSP */
    cmCPIO = 3, /**< as CSP, with inputs and outputs in every cycle. Only switching off and on leads back to CSP */
} CM_MODE;

/** A command of CMD mode (BR 7.1.2). */
typedef enum CM_COMMAND {
    cmMotorFree = 0,
    cmMotorEnable = 1,  /**< the motor holds its position; also clears its error */
    cmOriginSearch = 2, /**< moves the motor */
    cmResetCounter = 3, /**< the present position becomes 0 */
    cmOriginSearchAbort = 4,
} CM_COMMAND;

/** BR 7.2. Sends a string in CML to the motor and waits for its answer. The block switches to CML mode by itself
 *  and leaves the motor there; MC_Power returns to CSP before it enables. Done comes at once if no answer is
 *  expected (a parameter, an output), with the value of every query, and at the end of a list or of an origin
 *  search. If a string that may have moved the motor fails, or if the axis leaves CML, the motor is freed.
 *  @rt cycle */
typedef struct CM_SendCML_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    STRING80 Command;  /**< 1 ... 64 bytes; "?99.1", "K53.1=100"; ".ID" is the connector of this motor, or missing */
    TIME Timeout;      /**< ns; for the answer, and for each further line; 0 selects 1 s, for an origin search 70 s */
    BOOL AllowMotion;  /**< TRUE: strings that may move the motor or change its power are allowed */
    INT Line;          /**< 1 ... Lines; number of the line that Response shows; 0 selects the first. It acts also
                            after Done */
    /* outputs */
    BOOL Done;         /**< the answer is complete, or none is expected */
    BOOL Busy, Error;
    WORD ErrorID;
    STRING80 Response; /**< a line of the answer; with CML_ANSWER the damaged line. All lines of a list except the
                            first are lost when another string of this axis is sent */
    INT Lines;         /**< 0 ... 128; number of lines of the answer */
    INT Strays;        /**< received lines that do not belong to this query: of an earlier query, or unsolicited */
    cm1e_fb_private_t Private;
} CM_SendCML_t;
CM1E_API void CM_SendCML(CM_SendCML_t *fb);

/** BR 6.2.2. Switches the mode of operation (BR appendix 3); the motor must be at rest and without an error. From
 *  CMD and CPIO only switching the bridge off and on leads back to CSP. @rt cycle */
typedef struct CM_SetMode_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    CM_MODE Mode;
    BOOL Insist; /**< TRUE: allows CML and CSP also after CMD or CPIO, although the motor "will possibly result in
                      operating abnormal" (BR 6 note 2) */
    /* outputs */
    BOOL Done;   /**< object 0x6061 shows the mode */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} CM_SetMode_t;
CM1E_API void CM_SetMode(CM_SetMode_t *fb);

/** BR 7.1. Gives a command of CMD mode (BR appendix 1). An origin search moves the motor by the bridge's own
 *  parameters, without limits of the axis. It is aborted and the motor is freed when its time is over, after a loss
 *  of the bus, and at the end of the run. @rt cycle */
typedef struct CM_Command_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    CM_COMMAND Command;
    TIME Timeout; /**< ns; of an origin search; 0 selects 90 s */
    /* outputs */
    BOOL Done;    /**< the motor has answered; after an origin search it is at its origin */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} CM_Command_t;
CM1E_API void CM_Command(CM_Command_t *fb);

#ifdef __cplusplus
}
#endif
#endif
