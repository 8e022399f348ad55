#include "config/robot/record_config.h"

#include <doctest/doctest.h>

#include "config/robot/robot_config.h"

namespace record_config_test {

using namespace kadans;

namespace {

const double zero = 0;
constexpr double period_s = 0.001;
using Ticks = std::vector<std::uint32_t>;

const SignalTable& table() {
  static const SignalTable signals = [] {
    SignalTable made;
    for (const char* name : {"joint.knee.position_rad", "joint.knee.effort_Nm", "base.tilt_rad"})
      made.add({name, "", ""}, &zero);
    return made;
  }();
  return signals;
}

std::string refusal(const std::string& text) {
  try {
    (void)ticks_between(parse_signal_choice(text, "--signals"), table(), period_s);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

SignalChoice in_file(const std::string& object) {
  RecordConfig record;
  record.signals.file = "robot.json";
  Problems problems("robot.json");
  read_fields(parse_json(object, "robot.json"), problems, [&](Fields& f) { record_fields(f, record); });
  problems.throw_if_any();
  return record.signals;
}

}  // namespace

TEST_CASE("On the command line a choice of signals is all that is recorded, the last pattern that fits counts") {
  const auto ticks = [](const char* text) {
    return ticks_between(parse_signal_choice(text, "--signals"), table(), period_s);
  };
  CHECK(ticks("joint.*") == Ticks{1, 1, 0});
  CHECK(ticks("*@100, *_Nm@1000 ,base.*@0") == Ticks{10, 1, 0});
  CHECK(ticks("base.tilt_rad@333.333") == Ticks{0, 0, 3});
  CHECK(ticks("base.*, plant.*, behavior.squat.state") == Ticks{0, 0, 1});  // which not every run has
}

TEST_CASE("In a robot's configuration signals that no pattern fits are recorded in each tick") {
  CHECK(ticks_between(in_file("{}"), table(), period_s).empty());
  CHECK(ticks_between(in_file(R"({"signals": {"joint.*": 50, "*effort*": 0}})"), table(), period_s) == Ticks{20, 0, 1});
}

TEST_CASE("A choice that fits nothing, or a rate that ticks cannot have, is refused with what was meant") {
  CHECK(refusal("jont.*") == "--signals: no signal is called 'jont.*', did you mean 'joint.*'?");
  CHECK(refusal("base.tilt") == "--signals: no signal is called 'base.tilt', did you mean 'base.tilt_rad'?");
  CHECK(refusal("joint.*@300") ==
        "--signals: 'joint.*' at 300 Hz: must be the control rate, 1000 Hz, divided by a whole number, such as "
        "333.3333333333333");
  CHECK(refusal("joint.*@2000").find("such as 1000") != std::string::npos);
  CHECK(refusal("joint.*@fast") == "--signals: 'joint.*@fast' must be PATTERN or PATTERN@HZ, such as base.*@100");
  CHECK(refusal("joint.*@-1").find("must be PATTERN") != std::string::npos);
  CHECK(refusal("joint.*@nan").find("must be PATTERN") != std::string::npos);
  CHECK(refusal("joint.*,,base.*").find("'' must be PATTERN") != std::string::npos);
  CHECK(refusal("").find("names no signals") != std::string::npos);
}

TEST_CASE("In a file the place of the pattern, or of its rate, is told") {
  const auto at = [](const std::string& object) -> std::string {
    try {
      (void)ticks_between(in_file(object), table(), period_s);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(at("{\n  \"signals\": {\"jont.*\": 100}\n}") ==
        "robot.json:2:15: no signal is called 'jont.*', did you mean 'joint.*'?");
  CHECK(at("{\n  \"signals\": {\"joint.*\": 300}\n}").starts_with("robot.json:2:26: 'joint.*' at 300 Hz: must be"));
  CHECK(at(R"({"signals": {"joint.*": -1}})").find("robot.json:1:25") == 0);
  CHECK(at(R"({"singals": {}})").find("did you mean 'signals'?") != std::string::npos);
}

}  // namespace record_config_test
