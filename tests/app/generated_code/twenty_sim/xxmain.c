/* The generator's own main program, which nobody needs here. */
#include "xxsubmod.h"

int main (void)
{
	XXDouble u[4] = {0}, y[2] = {0};
	XXInitializeSubmodel (u, y, 0.0);
	XXCalculateSubmodel (u, y, xx_time);
	XXTerminateSubmodel (u, y, xx_time);
	return 0;
}
