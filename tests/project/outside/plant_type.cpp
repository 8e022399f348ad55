// The bench in a program of one's own, which is kadans with it among its types of plants: a robot stands on it for a
// second of the wall clock.
//   bench_program [ROBOT]     its configuration; TULip's by default
#include <array>
#include <cstdio>

#include "bench.h"
#include "kadans/app/program.h"

KADANS_REGISTER_PLANT_TYPE(make_bench_type);

int main(int count, char** given) {
  const char* const robot = count > 1 ? given[1] : KADANS_DATA_DIR "/config/tulip/robot.json";
  std::array arguments{"kadans", "run", robot, "--plant", "bench", "--soft", "--json", "--no-ctl", "--duration", "1"};
  return kadans::run_program(static_cast<int>(arguments.size()), const_cast<char**>(arguments.data()));
}
