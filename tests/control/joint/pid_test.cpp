#include "kadans/control/pid.h"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "kadans/testing/allocation_count.h"

namespace pid_test {

using kadans::Pid;

namespace {

constexpr double dt_s = 0.001;

Pid pid(const Pid::Config& config) {
  Pid law;
  law.config() = config;
  return law;
}

}  // namespace

TEST_CASE("Pid adds feed-forward, proportional and derivative torque") {
  Pid law = pid({.kp_Nm_per_rad = 100, .kd_Nms_per_rad = 4, .feedforward_Nm = 1.5, .effort_max_Nm = 50});
  law.start(0.2, 0, 0);
  CHECK(law.step(0.3, 0.5, 0.2, 0.25, dt_s) == doctest::Approx(1.5 + 100 * 0.1 + 4 * (0.5 - 0.25)));
  CHECK_FALSE(law.state().saturated);
}

TEST_CASE("Pid with velocity weight 0 differentiates the measurement alone") {
  Pid law = pid({.kd_Nms_per_rad = 4, .velocity_weight = 0, .effort_max_Nm = 50});
  law.start(0, 0, 0);
  CHECK(law.step(1.0, 3.0, 1.0, 0.25, dt_s) == doctest::Approx(-1.0));
}

TEST_CASE("Pid integrates the error and keeps the torque when ki changes") {
  Pid law = pid({.ki_Nm_per_rads = 10, .integral_max_Nm = 20, .effort_max_Nm = 20});
  law.start(0, 0, 0);
  for (int i = 0; i < 1000; ++i) law.step(0.5, 0, 0, 0, dt_s);
  CHECK(law.state().integral_Nm == doctest::Approx(5.0));
  law.config().ki_Nm_per_rads = 1000;
  CHECK(law.step(0, 0, 0, 0, dt_s) == doctest::Approx(5.0));
}

TEST_CASE("Pid limits its output, says so, and does not wind up meanwhile") {
  Pid law = pid({.kp_Nm_per_rad = 100, .ki_Nm_per_rads = 100, .integral_max_Nm = 5, .effort_max_Nm = 5});
  law.start(0, 0, 0);
  for (int i = 0; i < 5000; ++i) law.step(1.0, 0, 0, 0, dt_s);
  CHECK(law.state().effort_Nm == 5.0);
  CHECK(law.state().saturated);
  CHECK(law.state().integral_Nm == 0.0);
  law.step(-0.01, 0, 0, 0, dt_s);
  CHECK(law.state().effort_Nm == doctest::Approx(-1.0));  // free at once: nothing has to unwind first
}

TEST_CASE("Pid holds its integral within integral_max_Nm") {
  Pid law = pid({.ki_Nm_per_rads = 100, .integral_max_Nm = 2, .effort_max_Nm = 20});
  law.start(0, 0, 0);
  for (int i = 0; i < 1000; ++i) law.step(1.0, 0, 0, 0, dt_s);
  CHECK(law.state().integral_Nm == 2.0);
}

TEST_CASE("Pid takes over with the torque that was there") {
  Pid law = pid({.kp_Nm_per_rad = 300, .kd_Nms_per_rad = 6, .integral_max_Nm = 20, .effort_max_Nm = 25});
  law.start(0.4, -0.7, 8.0);
  CHECK(law.step(0.4, 0, 0.4, -0.7, dt_s) == doctest::Approx(8.0));
}

TEST_CASE("Pid's velocity filter passes its cut-off at 70 percent") {
  Pid law = pid({.kd_Nms_per_rad = 1, .kd_cutoff_Hz = 10, .effort_max_Nm = 50});
  law.start(0, 0, 0);
  const double omega_rad_s = 2 * 3.14159265358979 * 10;
  double largest = 0;
  for (int i = 0; i < 2000; ++i) {
    const double effort_Nm = law.step(0, 0, 0, std::sin(omega_rad_s * i * dt_s), dt_s);
    if (i > 1000) largest = std::max(largest, std::abs(effort_Nm));
  }
  CHECK(largest == doctest::Approx(std::sqrt(0.5)).epsilon(0.05));
}

TEST_CASE("Pid does not hide a measurement that is not finite") {
  Pid law = pid({.kp_Nm_per_rad = 100, .effort_max_Nm = 5});
  law.start(0, 0, 0);
  CHECK_FALSE(std::isfinite(law.step(0, 0, std::numeric_limits<double>::quiet_NaN(), 0, dt_s)));
}

TEST_CASE("Pid steps without allocating") {
  Pid law = pid({.kp_Nm_per_rad = 100, .ki_Nm_per_rads = 10, .integral_max_Nm = 1, .effort_max_Nm = 5});
  const kadans::testing::AllocationCount heap;
  law.start(0, 0, 0);
  law.step(1, 0, 0, 0, dt_s);
  const auto allocations = heap.count();
  CHECK(allocations == 0);
}

}  // namespace pid_test
