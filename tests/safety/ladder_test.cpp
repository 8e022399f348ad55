#include "safety/ladder.h"

#include <set>
#include <string>

#include <doctest/doctest.h>

namespace ladder_test {

using namespace kadans;

namespace {

constexpr double dt_s = 0.001;

struct Fixture {
  Reactions reactions{};
  Ladder ladder;

  Fixture() {
    at(FaultCode::soft_stop) = {.joint = SafetyLevel::limited, .exit_s = 0.05};
    at(FaultCode::motor_hot) = {.joint = SafetyLevel::damp, .exit_s = 0.02};
    at(FaultCode::sensor_jump) = {.joint = SafetyLevel::off, .latch = true};
  }
  Reaction& at(FaultCode code) { return reactions[static_cast<std::size_t>(code)]; }
  FaultMask update(FaultMask faults, int ticks = 1) {
    FaultMask fresh = 0;
    for (int i = 0; i < ticks; ++i) fresh |= ladder.update(faults, dt_s, reactions, &Reaction::joint);
    return fresh;
  }
};

}  // namespace

TEST_CASE("The worst fault decides the rung, and each rung is left by its own exit time") {
  Fixture f;
  f.update(bit(FaultCode::soft_stop) | bit(FaultCode::motor_hot));
  CHECK(f.ladder.level() == SafetyLevel::damp);
  f.update(bit(FaultCode::soft_stop), 19);
  CHECK(f.ladder.level() == SafetyLevel::damp);
  f.update(bit(FaultCode::soft_stop), 2);
  CHECK(f.ladder.level() == SafetyLevel::limited);
  f.update(0, 49);
  CHECK(f.ladder.level() == SafetyLevel::limited);
  f.update(0, 2);
  CHECK(f.ladder.level() == SafetyLevel::normal);
  CHECK(f.ladder.idle());
}

TEST_CASE("A fault that flickers is one fault, one that returns after its exit time is another") {
  Fixture f;
  CHECK(f.update(bit(FaultCode::soft_stop)) == bit(FaultCode::soft_stop));
  for (int i = 0; i < 10; ++i) {
    CHECK(f.update(0, 30) == 0);
    CHECK(f.update(bit(FaultCode::soft_stop)) == 0);
  }
  f.update(0, 51);
  CHECK(f.update(bit(FaultCode::soft_stop)) == bit(FaultCode::soft_stop));
}

TEST_CASE("A latched rung stays until it is cleared, and its fault is told once") {
  Fixture f;
  CHECK(f.update(bit(FaultCode::sensor_jump)) != 0);
  f.update(0, 10000);
  CHECK(f.ladder.level() == SafetyLevel::off);
  CHECK(f.update(bit(FaultCode::sensor_jump)) == 0);
  f.ladder.clear();
  CHECK(f.ladder.level() == SafetyLevel::normal);
  CHECK(f.ladder.idle());
}

TEST_CASE("Every fault has a name and, but for none and the emergency stops, a key of the configuration") {
  std::set<std::string> names;
  for (std::size_t i = 0; i < fault_codes; ++i) {
    const auto code = static_cast<FaultCode>(i);
    names.insert(name(code));
    const bool no_key =
        code == FaultCode::none || code == FaultCode::emergency_stop || code == FaultCode::emergency_input;
    CHECK(std::string(configuration_key(code)).empty() == no_key);
  }
  CHECK(names.size() == fault_codes);
  CHECK(std::string(name(static_cast<FaultCode>(500))) == "unknown");
}

}  // namespace ladder_test
