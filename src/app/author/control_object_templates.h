// The files of a new control object; @type@ and @Class@ stand for its names. Their control law is a spring and a
// damper: a working example that the author replaces.
#pragma once

#include <string_view>

namespace kadans {

inline constexpr std::string_view header_template =
    R"(// Control object "@type@": what it does in one sentence, and where its law comes from.
//
//   torque = stiffness (reference - position) - damping velocity
//
// Set-points  <joint>.position_rad, reached by a minimum-jerk motion in the time given.
// Parameters  <joint>.stiffness_Nm_per_rad, <joint>.damping_Nms_per_rad
// Signals     <joint>.reference_rad, <joint>.effort_Nm
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/minimum_jerk.h"

class @Class@ final : public kadans::ControlObject {
 public:
  // Throws std::invalid_argument for a joint without a motor.
  explicit @Class@(const kadans::ObjectSetup& setup);

  void declare(kadans::Declaration& declaration) override;
  void start(const kadans::ControlInput& input) noexcept override;
  void step(const kadans::ControlInput& input, kadans::ActuationFrame& actuation) noexcept override;
  void set_point(std::uint32_t channel, double value, double duration_s) noexcept override;
  void cancel_motion(std::uint32_t channel) noexcept override;
  double motion_remaining_s() const noexcept override;
  void pass_state(kadans::StateBytes& bytes) noexcept override;

 private:
  struct Axis {  // one joint: its tunables, and its state, which is recorded
    std::size_t joint;
    std::string name;
    double lower_rad, upper_rad;
    double stiffness_Nm_per_rad = 0, damping_Nms_per_rad = 0;
    kadans::MinimumJerk reference{};
    double reference_rad = 0, effort_Nm = 0;
  };
  std::vector<Axis> axes_;
};

std::unique_ptr<kadans::ControlObject> make_@type@(const kadans::ObjectSetup& setup);
)";

inline constexpr std::string_view source_template = R"(#include "@type@.h"

#include <algorithm>
#include <stdexcept>

using namespace kadans;

namespace {

constexpr double cancel_time_s = 0.1;

}  // namespace

@Class@::@Class@(const ObjectSetup& setup) {
  for (const std::size_t index : setup.joints) {
    const Joint& joint = setup.model.joints.at(index);
    if (joint.passive()) throw std::invalid_argument("joint " + joint.name + " has no motor");
    axes_.push_back({index, joint.name, std::max(joint.lower_rad, -1e6), std::min(joint.upper_rad, 1e6)});
  }
}

void @Class@::declare(Declaration& declaration) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    declaration.parameter({.name = axis.name + ".stiffness_Nm_per_rad", .unit = "Nm/rad", .min = 0, .max = 1000,
                           .initial = 50, .doc = "Torque per position error."},
                          &axis.stiffness_Nm_per_rad);
    declaration.parameter({.name = axis.name + ".damping_Nms_per_rad", .unit = "Nm s/rad", .min = 0, .max = 100,
                           .initial = 2, .doc = "Torque against the velocity."},
                          &axis.damping_Nms_per_rad);
    declaration.setpoint({.name = axis.name + ".position_rad", .unit = "rad", .min = axis.lower_rad,
                          .max = axis.upper_rad, .doc = "Where the joint shall be.",
                          .channel = static_cast<std::uint32_t>(i), .joint = static_cast<std::uint32_t>(axis.joint)});
    declaration.signal({axis.name + ".reference_rad", "rad", "Set-point of the position."}, &axis.reference_rad);
    declaration.signal({axis.name + ".effort_Nm", "Nm", "Torque computed."}, &axis.effort_Nm);
  }
}

// Takes over where the joint is; what is left of a step in torque the framework fades out.
void @Class@::start(const ControlInput& input) noexcept {
  for (Axis& axis : axes_) {
    axis.reference.reset(std::clamp(input.joints.joints[axis.joint].position_rad, axis.lower_rad, axis.upper_rad));
  }
}

// Each tick: no allocation, no lock, no exception, no clock.
void @Class@::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  for (Axis& axis : axes_) {
    const JointState& joint = input.joints.joints[axis.joint];
    axis.reference_rad = axis.reference.step(input.dt_s).position;
    axis.effort_Nm = axis.stiffness_Nm_per_rad * (axis.reference_rad - joint.position_rad) -
                     axis.damping_Nms_per_rad * joint.velocity_rad_s;
    actuation.joints[axis.joint] = {.effort_Nm = axis.effort_Nm, .mode = ActuationMode::effort};
  }
}

void @Class@::set_point(std::uint32_t channel, double value, double duration_s) noexcept {
  axes_[channel].reference.move(value, duration_s);
}

void @Class@::cancel_motion(std::uint32_t channel) noexcept { axes_[channel].reference.stop(cancel_time_s); }

double @Class@::motion_remaining_s() const noexcept {
  double remaining_s = 0;
  for (const Axis& axis : axes_) remaining_s = std::max(remaining_s, axis.reference.remaining_s());
  return remaining_s;
}

// All that changes from tick to tick, to save and restore it.
void @Class@::pass_state(StateBytes& bytes) noexcept {
  for (Axis& axis : axes_) bytes(axis.reference, axis.reference_rad, axis.effort_Nm);
}

std::unique_ptr<ControlObject> make_@type@(const ObjectSetup& setup) { return std::make_unique<@Class@>(setup); }
)";

inline constexpr std::string_view test_template = R"(#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "@type@.h"

#include <kadans/testing/doctest.h>

using namespace kadans;
using namespace kadans::testing;

namespace {

// A joint like a knee: a light leg, the rotor, some friction.
JointBenchConfig knee() {
  return {.plant = {.inertia_kg_m2 = 0.05, .rotor_inertia_kg_m2 = 0.02, .viscous_Nms_per_rad = 0.2, .torque_max_Nm = 50}};
}

}  // namespace

TEST_CASE("@Class@ reaches its set-point without much overshoot") {
  JointBench bench(knee(), make_@type@);
  CHECK(step_response(bench, {.to = 0.3}) <= StepLimits{.rise_time_s = 0.15, .overshoot_percent = 15, .settling_time_s = 0.6});
}

TEST_CASE("@Class@ keeps a margin for delay") {
  JointBench bench(knee(), make_@type@);
  const LoopMargins found = margins(measure_loop(bench, {}));
  INFO(found);
  CHECK(found.phase_margin_deg > 30);
}

TEST_CASE("@Class@ takes over from itself without a step") {
  JointBench bench(knee(), {{"before", make_@type@}, {"after", make_@type@}});
  bench.set_point(0.4, 0.5);
  bench.run(1.0);
  CHECK(record_switch(bench, "after") <= SwitchLimits{});
}

TEST_CASE("@Class@ holds still where it begins") {
  JointBench bench(knee(), make_@type@);
  bench.run(0.01);
  CHECK(bench.not_finite_ticks() == 0);
  CHECK(bench.signal("effort_Nm") == doctest::Approx(0));
}

TEST_CASE("@Class@ steps without allocating") {
  JointBench bench(knee(), make_@type@);
  bench.set_point(0.2, 0.1);
  const AllocationCount heap;
  for (int i = 0; i < 200; ++i) bench.tick();
  const long allocations = heap.count();
  CHECK(allocations == 0);
}
)";

inline constexpr std::string_view program_template =
    R"(// kadans, with "@type@" among the types of control objects: sim, check and all the rest.
#include <kadans/app/program.h>
#include <kadans/control/control_object_types.h>

#include "@type@.h"

KADANS_REGISTER_CONTROL_OBJECT("@type@", make_@type@);

int main(int argc, char** argv) { return kadans::run_program(argc, argv); }
)";

inline constexpr std::string_view plugin_template =
    R"(// "@type@" as a plug-in: name @type@.so under "plugins" in the robot's configuration.
#include <kadans/control/plugin.h>

#include "@type@.h"

KADANS_PLUGIN(kadans::plugin_type<make_@type@>("@type@"))
)";

inline constexpr std::string_view cmake_template = R"(cmake_minimum_required(VERSION 3.25)
project(@type@ LANGUAGES CXX)
if(NOT TARGET kadans::kadans)
  find_package(kadans 0.1 REQUIRED)
endif()
enable_testing()

add_executable(@type@_test @type@.cpp @type@_test.cpp)
target_link_libraries(@type@_test PRIVATE kadans::testing kadans::control)
add_test(NAME @type@ COMMAND @type@_test)
)";

inline constexpr std::string_view cmake_program_template = R"(
# The program with the new type in it: build/kadans_@type@ sim SCENARIO
add_executable(kadans_@type@ main.cpp @type@.cpp)
target_link_libraries(kadans_@type@ PRIVATE kadans::kadans)
)";

inline constexpr std::string_view cmake_plugin_template = R"(
# The plug-in: build/@type@.so
kadans_plugin(@type@ SOURCES plugin.cpp @type@.cpp)
)";

}  // namespace kadans
