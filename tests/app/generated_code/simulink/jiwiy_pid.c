/* Written by hand. Sample time: [0.001s, 0.0s] */
#include "jiwiy_pid.h"

DW_jiwiy_pid_T jiwiy_pid_DW;
ExtU_jiwiy_pid_T jiwiy_pid_U;
ExtY_jiwiy_pid_T jiwiy_pid_Y;

void jiwiy_pid_step(void)
{
  int i;
  jiwiy_pid_Y.error = 0.0;
  for (i = 0; i < 2; i++) {
    const real_T error = jiwiy_pid_U.reference[i] - jiwiy_pid_U.position[i];
    if (!jiwiy_pid_U.enabled) {
      jiwiy_pid_Y.torque[i] = 0.0;
      continue;
    }
    jiwiy_pid_Y.torque[i] = jiwiy_pid_P.Kp[i] * error + jiwiy_pid_DW.Integrator_DSTATE[i] -
                            jiwiy_pid_P.Kd[i] * jiwiy_pid_U.velocity[i];
    jiwiy_pid_DW.Integrator_DSTATE[i] += 0.001 * jiwiy_pid_P.Ki * error;
    jiwiy_pid_Y.error += error * error;
  }
}

void jiwiy_pid_initialize(void)
{
  jiwiy_pid_DW.Integrator_DSTATE[0] = 0.0;
  jiwiy_pid_DW.Integrator_DSTATE[1] = 0.0;
}

void jiwiy_pid_terminate(void)
{
}
