/* Written by hand: two springs with dampers that see positions alone, and differentiate them. */
#include "xxsubmod.h"

#include "xxfuncs.c"

static int xx_major; /* not the first step */

void XXInitializeSubmodel (XXDouble *u, XXDouble *y, XXDouble t)
{
	xx_P[0] = 4.9;  /* pan\kp */
	xx_P[1] = 0.28; /* pan\kd */
	xx_P[2] = 2.0;  /* tilt\kp */
	xx_P[3] = 0.11; /* tilt\kd */
	xx_P[4] = 0.9;  /* torque_max */
	xx_s[0] = u[1];
	xx_s[1] = u[3];
	y[0] = y[1] = 0.0;
	xx_time = t;
	xx_major = 0;
}

void XXCalculateSubmodel (XXDouble *u, XXDouble *y, XXDouble t)
{
	int i;
	for (i = 0; i < 2; ++i) {
		const XXDouble measured = u[2 * i + 1];
		const XXDouble speed = xx_major ? (measured - xx_s[i]) / xx_step_size : 0.0;
		y[i] = XXLimit (xx_P[2 * i] * (u[2 * i] - measured) - xx_P[2 * i + 1] * speed, xx_P[4]);
		xx_s[i] = measured;
	}
	xx_major = 1;
	xx_time = t + xx_step_size;
}

void XXTerminateSubmodel (XXDouble *u, XXDouble *y, XXDouble t)
{
	(void)u, (void)y, (void)t;
}
