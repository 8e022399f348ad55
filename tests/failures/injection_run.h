// A run of the light robot into which one fault is put. Parts: injection.cpp (commands, actuation, timing),
// injection_sensor.cpp, injection_script.cpp.
#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "injection.h"
#include "light_robot.h"
#include "safety/detection.h"

namespace kadans::failures {

class Injection {
 public:
  Injection(Category category, std::uint64_t seed)
      : category_(category), seed_(seed), random_(seed, "injection"), robot_(seed) {}
  Outcome go();

 private:
  std::size_t pick(std::size_t count) { return static_cast<std::size_t>(random_.next() % count); }
  double sign() { return pick(2) == 0 ? -1 : 1; }
  double not_finite() {
    return pick(2) == 0 ? std::numeric_limits<double>::quiet_NaN() : sign() * std::numeric_limits<double>::infinity();
  }
  void require(bool kept, const std::string& what) {
    if (!kept && outcome_.problem.empty()) outcome_.problem = what;
  }
  void begin(const std::string& what) {
    outcome_.injected = what;
    onset_ = robot_.ticks();
  }
  std::int64_t promised(FaultCode code) const { return detection_ticks(code, robot_.limits(), 0.001); }
  void require_found(FaultCode code, std::int64_t shows);
  void require_level(SafetyLevel level, SafetyLevel wanted, const char* whose);

  void recover();
  void sensor();
  void joint_sensor(ScenarioFault::Kind kind);
  void imu_sensor(ScenarioFault::Kind kind);
  void foot_sensor(ScenarioFault::Kind kind);
  void plan(ScenarioFault::Kind kind, SensorKind place, std::size_t index, double size);
  void command();
  void flood();
  void actuation();
  void timing();
  void heartbeat_stop();
  void script();

  Category category_;
  std::uint64_t seed_;
  RandomStream random_;
  LightRobot robot_;
  Outcome outcome_;
  std::int64_t onset_ = 0;
};

}  // namespace kadans::failures
