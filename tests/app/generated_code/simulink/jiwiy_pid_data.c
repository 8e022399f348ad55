/* Written by hand: the values of the parameters. */
#include "jiwiy_pid.h"

P_jiwiy_pid_T jiwiy_pid_P = {
  { 4.9, 2.0 }, /* Kp */
  5.0,          /* Ki */
  { 0.28, 0.11 } /* Kd */
};
