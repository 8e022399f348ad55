/* clang-format off */
#ifndef XX_MODEL_H
#define XX_MODEL_H

#include "xxtypes.h"

extern XXDouble xx_time, xx_step_size;
extern XXDouble xx_P[5]; /* parameters */
extern XXDouble xx_s[2]; /* states: what was measured in the step before */

#endif
