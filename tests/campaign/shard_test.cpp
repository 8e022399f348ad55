// Which part of the work a process does, by option and by what Slurm says.
#include "kadans/campaign/shard.h"

#include <cstdlib>

#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"

using namespace kadans;

namespace {

// A task of an array as Slurm describes it.
struct ArrayTask {
  ArrayTask(const char* id, const char* count, const char* min, const char* step) {
    setenv("SLURM_ARRAY_TASK_ID", id, 1);
    setenv("SLURM_ARRAY_TASK_COUNT", count, 1);
    setenv("SLURM_ARRAY_TASK_MIN", min, 1);
    setenv("SLURM_ARRAY_TASK_STEP", step, 1);
  }
  ~ArrayTask() {
    for (const char* name : {"ID", "COUNT", "MIN", "STEP"}) unsetenv((std::string("SLURM_ARRAY_TASK_") + name).c_str());
  }
};

}  // namespace

TEST_CASE("Every case belongs to exactly one part") {
  for (std::size_t number = 0; number < 20; ++number) {
    int parts = 0;
    for (const char* text : {"0/3", "1/3", "2/3"}) parts += parse_shard(text).holds(number) ? 1 : 0;
    CHECK(parts == 1);
  }
}

TEST_CASE("What is no part is refused") {
  for (const char* text : {"", "1", "1/", "/4", "4/4", "1/0", "-1/4", "1/4x", "a/b"}) {
    CAPTURE(text);
    CHECK_THROWS_AS((void)parse_shard(text), InputError);
  }
}

TEST_CASE("The part of a task of a Slurm array comes from its number, wherever the array begins and however it steps") {
  CHECK_FALSE(slurm_shard().has_value());
  {
    const ArrayTask task("3", "4", "0", "1");
    CHECK(slurm_shard()->index == 3);
    CHECK(slurm_shard()->count == 4);
  }
  {
    const ArrayTask task("14", "3", "10", "2");  // --array=10-14:2
    CHECK(slurm_shard()->index == 2);
  }
  const ArrayTask list("9", "3", "1", "1");  // --array=1,4,9
  CHECK_THROWS_AS((void)slurm_shard(), InputError);
}
