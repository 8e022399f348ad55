// The three tables: parameters, set-points, signals.
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/signal/parameter.h"
#include "kadans/signal/setpoint.h"
#include "kadans/signal/signal.h"
#include "kadans/testing/allocation_count.h"

namespace kadans {
namespace {

using testing::AllocationCount;

constexpr double infinity = std::numeric_limits<double>::infinity();
const double not_a_number = std::nan("");

Parameter gain(const std::string& name) {
  return {.name = name, .unit = "Nm/rad", .min = 0, .max = 200, .initial = 50, .doc = "Stiffness."};
}

TEST_CASE("a parameter sets its owner's variable to the initial value when it is declared") {
  ParameterTable table;
  double kp = -1;
  const ParameterId id = table.add(gain("posture.kp"), &kp, 3);
  CHECK(kp == 50);
  CHECK(table.get(id) == 50);
  CHECK(table.owner(id) == 3);
  CHECK(table.info(id).unit == "Nm/rad");
}

TEST_CASE("what other threads see of a parameter is what was set last, not what its owner made of it") {
  ParameterTable table;
  double kp = -1;
  const ParameterId id = table.add(gain("posture.kp"), &kp);
  CHECK(table.newest(id) == 50);
  CHECK(table.set(id, 60));
  CHECK(table.newest(id) == 60);
  CHECK_FALSE(table.set(id, 201));
  kp = 70;
  CHECK(table.newest(id) == 60);
}

TEST_CASE("a parameter takes every value of its range, ends included, and nothing else") {
  ParameterTable table;
  double kp = 0;
  const ParameterId id = table.add(gain("kp"), &kp);
  for (const double value : {0.0, 200.0, 123.456}) {
    CHECK(table.set(id, value));
    CHECK(kp == value);
  }
  for (const double value : {-1e-9, 200.0000001, not_a_number, infinity, -infinity}) {
    CHECK_FALSE(table.accepts(id, value));
    CHECK_FALSE(table.set(id, value));
    CHECK(kp == 123.456);
  }
  CHECK_FALSE(table.set(id + 1, 1.0));
}

TEST_CASE("a parameter without limits still refuses what is not finite") {
  ParameterTable table;
  double x = 0;
  const ParameterId id = table.add({.name = "x", .unit = "", .doc = ""}, &x);
  CHECK(table.set(id, -1e300));
  CHECK_FALSE(table.set(id, infinity));
  CHECK_FALSE(table.set(id, -infinity));
  CHECK_FALSE(table.set(id, not_a_number));
  CHECK(x == -1e300);
}

TEST_CASE("parameters are numbered from 0 and found by name") {
  ParameterTable table;
  double a = 0, b = 0;
  CHECK(table.add(gain("a"), &a) == 0);
  CHECK(table.add(gain("b"), &b) == 1);
  CHECK(table.find("b") == ParameterId{1});
  CHECK_FALSE(table.find("c").has_value());
  CHECK(table.names() == std::vector<std::string>{"a", "b"});
  CHECK(table.size() == 2);
  CHECK_THROWS_AS(table.info(2), std::out_of_range);
}

TEST_CASE("a parameter declared twice, with an empty range or a wrong initial value is refused by name") {
  ParameterTable table;
  double first = 0, second = 7;
  table.add(gain("kp"), &first);
  CHECK_THROWS_WITH_AS(table.add(gain("kp"), &second), "parameter kp is declared twice", std::invalid_argument);
  Parameter parameter = gain("ki");
  parameter.min = 300;
  CHECK_THROWS_WITH_AS(table.add(parameter, &second), "parameter ki: empty range", std::invalid_argument);
  parameter.min = not_a_number;
  CHECK_THROWS_AS(table.add(parameter, &second), std::invalid_argument);
  parameter = gain("ki");
  parameter.initial = -1e-9;
  CHECK_THROWS_WITH_AS(table.add(parameter, &second), "parameter ki: initial value -1e-09 is outside 0..200",
                       std::invalid_argument);
  parameter.max = infinity;
  parameter.initial = infinity;
  CHECK_THROWS_AS(table.add(parameter, &second), std::invalid_argument);
  CHECK(second == 7);
  CHECK(table.size() == 1);
  CHECK(table.names() == std::vector<std::string>{"kp"});
}

TEST_CASE("a set-point accepts the finite values of its range") {
  SetpointTable table;
  const SetpointId knee =
      table.add({.name = "posture.l_knee.position_rad", .unit = "rad", .min = 0, .max = 2, .doc = "", .joint = 4});
  const SetpointId free = table.add({.name = "free", .unit = "", .min = -infinity, .max = infinity, .doc = ""});
  CHECK(table.accepts(knee, 0));
  CHECK(table.accepts(knee, 2));
  for (const double value : {-0.001, 2.001, not_a_number, infinity}) CHECK_FALSE(table.accepts(knee, value));
  CHECK(table.accepts(free, 1e12));
  CHECK_FALSE(table.accepts(free, -infinity));
  CHECK_FALSE(table.accepts(free + 1, 0));
  CHECK(table[knee].joint == 4);
  CHECK(table.find("free") == free);
  CHECK(table.names() == std::vector<std::string>{"posture.l_knee.position_rad", "free"});
}

TEST_CASE("a set-point declared twice or with an empty range is refused by name") {
  SetpointTable table;
  table.add({.name = "x", .unit = "", .min = 0, .max = 1, .doc = ""});
  CHECK_THROWS_WITH_AS(table.add({.name = "x", .unit = "", .min = 0, .max = 1, .doc = ""}),
                       "set-point x is declared twice", std::invalid_argument);
  CHECK_THROWS_WITH_AS(table.add({.name = "y", .unit = "", .min = 1, .max = 0, .doc = ""}), "set-point y: empty range",
                       std::invalid_argument);
  for (const double safe : {-0.5, 1.5})
    CHECK_THROWS_WITH_AS(table.add({.name = "z", .unit = "", .min = 0, .max = 1, .doc = "", .safe = safe}),
                         "set-point z: its safe value is outside its range", std::invalid_argument);
  CHECK(table.size() == 1);
  CHECK_FALSE(table.find("y").has_value());
}

TEST_CASE("signals of every kind are gathered into one row in the order of their declaration") {
  SignalTable table;
  double position_rad = 0.5;
  bool contact = true;
  std::uint32_t faults = 4'000'000'000U;
  double velocity_rad_s = -1;
  CHECK(table.add({"joint.knee.position_rad", "rad", "Angle."}, &position_rad) == 0);
  table.add({"foot.left.contact", "", "On the ground."}, &contact);
  table.add({"safety.faults", "", "Count."}, &faults);
  table.add({"joint.knee.velocity_rad_s", "rad/s", "Speed."}, &velocity_rad_s);
  std::array<double, 4> row{};
  table.gather(row);
  CHECK(row == std::array<double, 4>{0.5, 1, 4e9, -1});
  contact = false;
  position_rad = not_a_number;
  table.gather(row);
  CHECK(std::isnan(row[0]));
  CHECK(row[1] == 0);
  CHECK(table.find("safety.faults") == SignalId{2});
  CHECK(table.info(3).unit == "rad/s");
  CHECK_THROWS_WITH_AS(table.add({"safety.faults", "", ""}, &contact), "signal safety.faults is declared twice",
                       std::invalid_argument);
  CHECK(table.size() == 4);
  table.gather(row);
}

TEST_CASE("what the tick asks of the tables does not allocate") {
  ParameterTable parameters;
  SetpointTable setpoints;
  SignalTable signals;
  double kp = 0;
  const ParameterId id = parameters.add(gain("kp"), &kp);
  const SetpointId point = setpoints.add({.name = "x", .unit = "", .min = 0, .max = 1, .doc = ""});
  signals.add({"kp", "", ""}, &kp);
  std::array<double, 1> row{};
  const AllocationCount heap;
  const bool was_set = parameters.set(id, 1) && !parameters.set(id, -1) && setpoints.accepts(point, 1);
  signals.gather(row);
  const long allocations = heap.count();
  CHECK(was_set);
  CHECK(row[0] == 1);
  CHECK(allocations == 0);
}

}  // namespace
}  // namespace kadans
