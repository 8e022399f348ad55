/* Written by hand after the FMI 2.0 standard: a spring and a filtered damper, each instance with its own numbers. */
#include <stddef.h>

#define FMI2_FUNCTION_PREFIX Servo_
#define NAMED(name) Servo_##name

enum { filtered, reference, position, torque, k, d, count };

typedef struct {
  void (*logger)(void *, const char *, int, const char *, const char *, ...);
  void *(*allocateMemory)(size_t, size_t);
  void (*freeMemory)(void *);
  void (*stepFinished)(void *, int);
  void *componentEnvironment;
} fmi2CallbackFunctions;

typedef struct {
  double values[count];
  int begun;
  const fmi2CallbackFunctions *functions;
} Servo;

static void start_values(Servo *servo)
{
  int i;
  for (i = 0; i < count; ++i) servo->values[i] = 0.0;
  servo->values[k] = 2.0;
  servo->values[d] = 0.11;
  servo->begun = 0;
}

void *NAMED(fmi2Instantiate)(const char *name, int type, const char *guid, const char *resources,
                             const fmi2CallbackFunctions *functions, int visible, int logging)
{
  Servo *servo = functions->allocateMemory(1, sizeof(Servo));
  (void)name, (void)type, (void)guid, (void)resources, (void)visible, (void)logging;
  if (servo == NULL) return NULL;
  servo->functions = functions;
  start_values(servo);
  return servo;
}

void NAMED(fmi2FreeInstance)(void *c)
{
  if (c != NULL) ((Servo *)c)->functions->freeMemory(c);
}

int NAMED(fmi2SetupExperiment)(void *c, int tolerance_given, double tolerance, double start, int stop_given, double stop)
{
  (void)c, (void)tolerance_given, (void)tolerance, (void)start, (void)stop_given, (void)stop;
  return 0;
}

int NAMED(fmi2EnterInitializationMode)(void *c) { return c == NULL; }
int NAMED(fmi2ExitInitializationMode)(void *c) { return c == NULL; }
int NAMED(fmi2Terminate)(void *c) { return c == NULL; }

int NAMED(fmi2Reset)(void *c)
{
  start_values(c);
  return 0;
}

int NAMED(fmi2GetReal)(void *c, const unsigned *references, size_t number, double *values)
{
  size_t i;
  for (i = 0; i < number; ++i) {
    if (references[i] >= count) return 3;
    values[i] = ((Servo *)c)->values[references[i]];
  }
  return 0;
}

int NAMED(fmi2SetReal)(void *c, const unsigned *references, size_t number, const double *values)
{
  size_t i;
  for (i = 0; i < number; ++i) {
    if (references[i] >= count) return 3;
    ((Servo *)c)->values[references[i]] = values[i];
  }
  return 0;
}

int NAMED(fmi2DoStep)(void *c, double time, double step, int no_return)
{
  Servo *const servo = c;
  double *const v = servo->values;
  const double rate = step > 0.0 ? 1.0 / (step + 0.005) : 0.0;
  (void)time, (void)no_return;
  if (!servo->begun) v[filtered] = v[position];
  servo->begun = 1;
  v[torque] = v[k] * (v[reference] - v[position]) - v[d] * rate * (v[position] - v[filtered]);
  v[filtered] += step * rate * (v[position] - v[filtered]);
  return 0;
}
