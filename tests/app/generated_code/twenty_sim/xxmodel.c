/* Written by hand: the variables of the submodel, and their names. */
#include "xxmodel.h"

XXDouble xx_time = 0.0;
XXDouble xx_step_size = 0.002;
XXDouble xx_P[5];
XXDouble xx_s[2];

/* the names of the variables, commented out as the generator leaves them
XXString xx_input_names[] = {
    "pan\\wanted",
    "pan\\measured",
    "tilt\\wanted",
    "tilt\\measured"
,   NULL
};
XXString xx_output_names[] = {
    "pan\\torque",
    "tilt\\torque"
,   NULL
};
XXString xx_parameter_names[] = {
    "pan\\kp",
    "pan\\kd",
    "tilt\\kp",
    "tilt\\kd",
    "torque_max"
,   NULL
};
*/
