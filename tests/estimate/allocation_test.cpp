#include <cmath>

#include <doctest/doctest.h>

#include "estimate/tulip_fixture.h"
#include "kadans/testing/allocation_count.h"

TEST_CASE("An update does not allocate, in good times and in bad") {
  kadans::test::TulipFixture robot;
  const kadans::testing::AllocationCount heap;
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
  const long allocations = heap.count(), frees = heap.frees();
  CHECK(allocations == 0);
  CHECK(frees == 0);
}
