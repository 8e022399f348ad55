/* The generator's own main program. */
#include "jiwiy_pid.h"

int main(int argc, const char *argv[])
{
  (void)argc, (void)argv;
  jiwiy_pid_initialize();
  jiwiy_pid_step();
  jiwiy_pid_terminate();
  return 0;
}
