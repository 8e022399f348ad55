/* clang-format off */
/* Written by hand in the shape of Simulink Coder's nonreusable code for a model "jiwiy_pid". */
#ifndef jiwiy_pid_h_
#define jiwiy_pid_h_

#include "rtwtypes.h"

/* Block states (default storage) for system '<Root>' */
typedef struct {
  real_T Integrator_DSTATE[2]; /* '<Root>/Integrator' */
} DW_jiwiy_pid_T;

/* External inputs (root inport signals with default storage) */
typedef struct {
  real_T reference[2]; /* '<Root>/reference' */
  real_T position[2];  /* '<Root>/position' */
  real_T velocity[2];  /* '<Root>/velocity' */
  boolean_T enabled;   /* '<Root>/enabled' */
} ExtU_jiwiy_pid_T;

/* External outputs (root outports fed by signals with default storage) */
typedef struct {
  real_T torque[2]; /* '<Root>/torque' */
  real_T error;     /* '<Root>/error' */
} ExtY_jiwiy_pid_T;

/* Parameters (default storage) */
struct P_jiwiy_pid_T_ {
  real_T Kp[2];   /* Variable: Kp */
  real_T Ki;      /* Variable: Ki */
  real_T Kd[2];   /* Variable: Kd */
};
typedef struct P_jiwiy_pid_T_ P_jiwiy_pid_T;

extern P_jiwiy_pid_T jiwiy_pid_P;
extern DW_jiwiy_pid_T jiwiy_pid_DW;
extern ExtU_jiwiy_pid_T jiwiy_pid_U;
extern ExtY_jiwiy_pid_T jiwiy_pid_Y;

/* Model entry point functions */
extern void jiwiy_pid_initialize(void);
extern void jiwiy_pid_step(void);
extern void jiwiy_pid_terminate(void);

#endif
