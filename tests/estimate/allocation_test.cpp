// No allocation in the tick: counted by operator new, which this file replaces for the whole test program.
#include <cmath>
#include <cstdlib>
#include <new>

#include <doctest/doctest.h>

#include "estimate/tulip_fixture.h"

namespace {
long allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

TEST_CASE("An update does not allocate, in good times and in bad") {
  kadans::test::TulipFixture robot;
  const long before = allocations;
  for (int n = 0; n < 2000; ++n) {
    robot.sensors.joints[3].position_rad = n % 100 < 10 ? std::nan("") : 0.001 * n;
    robot.sensors.imu.angular_velocity_rad_s[0] = n % 70 == 0 ? std::nan("") : 0.1;
    robot.sensors.feet[1].force_N.fill(n % 300 < 100 ? 0 : 20);
    robot.dt_s = n % 50 == 0 ? 0.0017 : 0.001;
    if (n % 10 == 3)
      robot.advance_in_silence();
    else
      robot.advance();
  }
  const long during = allocations - before;
  const bool moved = robot.estimator.set_velocity_cutoff(2, 60);
  const long after = allocations - before;
  CHECK(before > 0);
  CHECK(during == 0);
  CHECK(after == 0);
  CHECK(moved);
}
