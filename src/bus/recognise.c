#include "bus/recognise.h"

#include "core/bytes.h"

/** ns; for one answer (ETG.1020: 200 ms ... 10 s by device). */
#define ANSWER_NS INT64_C(1000000000)

static const cm1e_device_t *device(void) { return cm1e_device_recognised(CM1E_BY_OBJECTS); }

void cm1e_recognise_begin(cm1e_recognition_t *job, uint16_t position, int64_t deadline_ns)
{
    *job = (cm1e_recognition_t){.busy = true, .deadline_ns = deadline_ns, .sdo = {.position = position}};
}

void cm1e_recognise_cancel(cm1e_recognition_t *job) { job->busy = false; }

/** Takes an answer; false: a bridge does not answer so. */
static bool took(cm1e_recognition_t *job)
{
    const cm1e_question_t *question = &device()->questions[job->question];
    const bool failed = cm1e_sdo_state(&job->sdo) == CM1E_SDO_ERROR;
    const uint32_t value = failed ? 0 : (uint32_t)cm1e_get_uint(job->data, (unsigned)job->sdo.size);
    job->shown = value;
    job->wanted = question->wanted;
    if (question->index == OBJ_1000_DEVICE_TYPE)
        job->device_type = value;
    if (question->wanted)
        return !failed && value == question->wanted;
    if (question->index == OBJ_1018_IDENTITY)
        job->facts.revision = value;
    else
        job->facts.motors[question->index - OBJ_F511_CONFIG_AXIS_1] = value;
    return !failed || job->sdo.error == CM1E_ERROR_SDO_ABORT; /* a refusal is an answer, silence is not */
}

cm1e_sdo_t *cm1e_recognise_next(cm1e_recognition_t *job, int64_t now_ns)
{
    if (!job->busy)
        return NULL;
    if (job->started && !took(job)) {
        job->busy = false;
        return NULL;
    }
    job->question = (uint8_t)(job->question + job->started);
    job->recognised = job->question == device()->question_count;
    const int64_t left_ns = job->deadline_ns - now_ns;
    if (job->recognised || left_ns <= 0) {
        job->busy = false;
        return NULL;
    }
    const cm1e_question_t *question = &device()->questions[job->question];
    job->started = true;
    job->sdo = (cm1e_sdo_t){.position = job->sdo.position, .index = question->index, .subindex = question->subindex,
                            .data = job->data, .size = sizeof job->data, .state = CM1E_SDO_BUSY,
                            .timeout_ns = left_ns < ANSWER_NS ? left_ns : ANSWER_NS};
    return &job->sdo;
}

bool cm1e_recognise_model(const cm1e_bridge_facts_t *facts, cm1e_device_model_t *model)
{
    const char *names[CM1E_BRIDGE_AXES];
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++) {
        const bool known = facts->motors[i] == CM1E_BRIDGE_CM1 || facts->motors[i] == CM1E_BRIDGE_CM2;
        names[i] = known ? cm1e_bridge_motor_name((cm1e_bridge_motor_t)facts->motors[i]) : "?";
    }
    return cm1e_bridge_model_with(names, model);
}
