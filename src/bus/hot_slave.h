/**
 * @file hot_slave.h
 * Slaves that come and go while the others run.
 *
 * hot_plan.c keeps room in the process image for an optional slave that is absent at the start, and places what it has
 * when it has come. hot_search.c looks for devices on the wire that have no station address of ours, identifies them by
 * their SII, alias and explicit ID, and refuses strangers. hot_count.c judges the working counter for the slaves that
 * are there. hot_presence.c says how it stands with each.
 */
#ifndef CM1E_BUS_HOT_SLAVE_H
#define CM1E_BUS_HOT_SLAVE_H

#include "bus/al_machine.h"
#include "bus/sii_scout.h"
#include "cm1e/hot_connect.h"

typedef struct cm1e_bus_slave cm1e_bus_slave_t;

/** Of a slave. */
typedef struct cm1e_hot {
    bool optional;
    bool planned;            /**< it was never there: its process data are planned, and not read */
    bool moves;              /**< there are optional slaves, which move places when they come and go */
    bool away;               /**< nothing on the wire is identified as this slave */
    bool seen;               /**< in this walk of the search */
    bool counted;            /**< its share is in the expected working counter; else it may take part, and need not */
    uint16_t member;         /**< its place in its group; 1: it has an address of its own */
    uint16_t before;         /**< optional slaves before it on the wire at the scan */
    uint16_t place;          /**< on the wire, as seen last; 0: nowhere */
    uint32_t bound;          /**< number of times that its process data were placed in operation */
    uint32_t relaid;         /**< number of times that a motor had other process data than was known before it came */
    cm1e_recover_t policy;   /**< never DEFAULT */
    const char *group;       /**< "": none */
    const cm1e_axis_config_t *axis; /**< its first one; NULL: none */
    uint32_t outputs_begin, inputs_begin; /**< of its room in the process image, from the beginning of the outputs */
    const char *refused;     /**< why the device with its address was not taken; NULL: none is there */
    bool refused_again;      /**< since the last walk began in which strangers are identified again */
    uint32_t allowed;        /**< atomic: somebody has asked for it */
    uint32_t presence;       /**< atomic: cm1e_presence_t */
    uint64_t out_since;      /**< cycle in which it was taken out of the working counter */
    uint16_t room[2];        /**< bytes that are kept free for it: outputs, inputs */
    uint32_t vendor_id, product_code; /**< of a planned one: those that are expected; a vendor of 0: not known */
    bool stated[2];          /**< of a planned one: the configuration states its process data, so they are known */
    cm1e_scouted_t scouted;
} cm1e_hot_t;

typedef enum cm1e_search_step {
    SEARCH_PAUSE = 0,
    SEARCH_COUNT,            /**< how many devices are on the wire? */
    SEARCH_WALK,             /**< station address and alias of one after the other */
    SEARCH_ADDRESS,          /**< a device without an address of ours gets one for the search */
    SEARCH_RETURN,           /**< it was another device, because places have moved: it gets its own address again */
    SEARCH_ALIAS,
    SEARCH_CLEAR,            /**< its FMMUs: it must not touch our process data */
    SEARCH_INIT,
    SEARCH_SCOUT,            /**< its SII */
    SEARCH_ID,
    SEARCH_OFFER,            /**< no ID in Init: the EEPROM to the device, its mailbox, and Pre-Operational */
    SEARCH_MAILBOX,
    SEARCH_PRE_OP,
    SEARCH_LATE_ID,
    SEARCH_BACK,             /**< Init again */
    SEARCH_GIVE,             /**< it is one of ours and gets its address */
    SEARCH_RELEASE,          /**< it is a stranger: the address is taken back */
} cm1e_search_step_t;

/** The devices on the wire that are none of the slaves. The thread that owns the bus writes, any thread reads. */
enum { CM1E_STRANGER_WORDS = sizeof(cm1e_stranger_t) / sizeof(uint64_t) };
typedef struct cm1e_stranger_list {
    uint32_t version;        /**< atomic; odd: it is being written */
    uint32_t count;          /**< atomic */
    uint64_t words[CM1E_STRANGERS][CM1E_STRANGER_WORDS]; /**< atomic */
} cm1e_stranger_list_t;

/** The search of a bus. */
typedef struct cm1e_search {
    bool used;               /**< there are optional slaves */
    bool sent;               /**< the datagram of the supervision is of the search */
    cm1e_search_step_t step;
    int64_t due_ns, deadline_ns, walk_ns;
    uint16_t count;          /**< devices on the wire */
    uint16_t place, alias, station; /**< of the device that is looked at */
    uint16_t returned;       /**< station address that is given back */
    uint16_t orphan;         /**< place of a device with the address of the search; 0: none */
    bool crowded;            /**< there are several: one could not be reached for a while, and kept it */
    bool entered, turn;
    bool only_looks;         /**< in this walk no device gets the address of the search */
    uint8_t unanswered;      /**< questions to the device in a row */
    uint8_t doubles;         /**< walks in a row in which a slave was met twice */
    bool ends;               /**< the walk, with the device that is looked at */
    bool again;              /**< strangers are identified again in this walk */
    int64_t strangers_ns;    /**< when that is due next */
    unsigned doubt;          /**< cycles in a row in which an optional slave may have left (hot_count.c) */
    bool in_doubt;           /**< this cycle is one of them, and the optional slaves are asked at once */
    uint32_t doubted;        /**< index of the slave that was asked last because of that */
    cm1e_scout_t scout;
    cm1e_al_machine_t al;
    cm1e_bus_slave_t *candidate;
    uint64_t news;           /**< atomic */
    cm1e_stranger_list_t strangers;
    uint32_t seen_strangers; /**< bits: still there in this walk */
} cm1e_search_t;

/* strangers.c */
uint32_t cm1e_strangers_count(const cm1e_stranger_list_t *list);
/** For the thread that owns the bus. */
cm1e_stranger_t cm1e_strangers_at(const cm1e_stranger_list_t *list, uint32_t place);
/** Replaces the list, where it is another one. Returns whether it is. */
bool cm1e_strangers_set(cm1e_stranger_list_t *list, const cm1e_stranger_t *strangers, uint32_t count);

/** The station address of a device while it is identified; not one that SOEM or another master gives. */
enum { CM1E_SEARCH_STATION = 0x2FFE };

/* hot_plan.c */
/** The slave of the configuration that is absent; it gets a place behind the others. `group` and `member` of a slave of
 *  the list only. NULL, diagnosed: there are too many. */
cm1e_bus_slave_t *cm1e_hot_plan(cm1e_bus_t *bus, cm1e_address_kind_t kind, uint16_t address, cm1e_diag_t *diag);
/** Forgets what was planned, before slaves are identified. */
void cm1e_hot_forget(cm1e_bus_t *bus);
/** After all slaves are identified: what is known of each by the configuration. */
cm1e_error_t cm1e_hot_describe(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Room in the image for an absent slave. */
cm1e_error_t cm1e_hot_reserve(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, cm1e_diag_t *diag);
/** Places the process data of a planned slave that has come, from what was read of it; false: they do not fit, and
 *  hot.refused says why. @rt cycle */
bool cm1e_hot_place(cm1e_bus_slave_t *slave);

/* hot_search.c */
/** The next datagram of the search; false: none now. @rt cycle */
bool cm1e_search_next(cm1e_bus_t *bus, cm1e_datagram_t *datagram, int64_t now_ns);
void cm1e_search_result(cm1e_bus_t *bus, const cm1e_datagram_t *datagram, int64_t now_ns);

/* hot_count.c */
/** Working counter of all slaves that are there. @rt init */
void cm1e_hot_count_begin(cm1e_bus_t *bus);
/** Whether the working counter is right for the slaves that are there, and takes those out that have left. @rt cycle */
bool cm1e_hot_judge(cm1e_bus_t *bus, int working_counter);
/** Takes the inputs of the slaves that are there. @rt cycle */
void cm1e_hot_take_inputs(cm1e_bus_t *bus);

/* hot_presence.c */
/** The supervision has looked at a slave, or something else has changed. @rt cycle */
void cm1e_hot_note(cm1e_bus_t *bus, cm1e_bus_slave_t *slave);
/** A slave that answers is out of Operational, or has come: whether it is brought back now. `asked`: somebody has asked
 *  for it. @rt cycle */
bool cm1e_hot_may_recover(cm1e_bus_slave_t *slave, bool asked);
/** A recovery of an optional slave has failed: it is searched for again. @rt cycle */
void cm1e_hot_lose(cm1e_bus_slave_t *slave);
/** Notes why a device with its address is not taken; the search forgets it when no such device is met again.
 *  @rt cycle */
void cm1e_hot_refuse(cm1e_bus_slave_t *slave, const char *reason);

#endif
