// `kadans new control-object`: writes its files. In the templates @type@ and @Class@ stand for its names.
// Their control law is a spring and a damper: a working example that the author replaces.
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "app/option_checks.h"
#include "app/terminal.h"
#include "new_files.h"
#include "signal/input_file.h"

namespace kadans {

inline constexpr std::string_view header_template =
    R"(// Control object "@type@": what it does in one sentence, and where its law comes from.
//
//   torque = stiffness (reference - position) - damping velocity
//
// Set-points  <joint>.position_rad
// Parameters  <joint>.stiffness_Nm_per_rad, <joint>.damping_Nms_per_rad
// Signals     <joint>.reference_rad, <joint>.effort_Nm
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kadans/control/control_object.h"

class @Class@ final : public kadans::ControlObject {
 public:
  // Throws std::invalid_argument for a joint without a motor.
  explicit @Class@(const kadans::ObjectSetup& setup);

  void declare(kadans::Declaration& declaration) override;
  void start(const kadans::ControlInput& input) noexcept override;
  void step(const kadans::ControlInput& input, kadans::ActuationFrame& actuation) noexcept override;
  bool setpoint_state(std::uint32_t channel, kadans::SetpointState& state) const noexcept override;
  void follow(std::uint32_t channel, const kadans::SetpointState& state) noexcept override;
  void pass_state(kadans::StateBytes& bytes) noexcept override;

 private:
  struct Axis {  // one joint: its tunables, and its state, which is recorded
    std::size_t joint;
    std::string name;
    double lower_rad, upper_rad;
    double stiffness_Nm_per_rad = 0, damping_Nms_per_rad = 0;
    kadans::SetpointState reference{};
    double effort_Nm = 0;
  };
  std::vector<Axis> axes_;
};

std::unique_ptr<kadans::ControlObject> make_@type@(const kadans::ObjectSetup& setup);
)";

inline constexpr std::string_view source_template = R"(#include "@type@.h"

#include <algorithm>
#include <stdexcept>

using namespace kadans;

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
    declaration.signal({axis.name + ".reference_rad", "rad", "Set-point of the position."}, &axis.reference.value);
    declaration.signal({axis.name + ".effort_Nm", "Nm", "Torque computed."}, &axis.effort_Nm);
  }
}

// Takes over where the joint is; what is left of a step in torque the framework fades out.
void @Class@::start(const ControlInput& input) noexcept {
  for (Axis& axis : axes_) {
    axis.reference = {.value = std::clamp(input.joints.joints[axis.joint].position_rad, axis.lower_rad, axis.upper_rad)};
  }
}

// Each tick: no allocation, no lock, no exception, no clock.
void @Class@::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  for (Axis& axis : axes_) {
    const JointState& joint = input.joints.joints[axis.joint];
    axis.effort_Nm = axis.stiffness_Nm_per_rad * (axis.reference.value - joint.position_rad) -
                     axis.damping_Nms_per_rad * joint.velocity_rad_s;
    actuation.joints[axis.joint] = {.effort_Nm = axis.effort_Nm, .mode = ActuationMode::effort};
  }
}

// The engine plans how the set-point gets to where it shall be, and leads the object along.
bool @Class@::setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept {
  return state = axes_[channel].reference, true;
}

void @Class@::follow(std::uint32_t channel, const SetpointState& state) noexcept { axes_[channel].reference = state; }

// All that changes from tick to tick, to save and restore it.
void @Class@::pass_state(StateBytes& bytes) noexcept {
  for (Axis& axis : axes_) bytes(axis.reference, axis.effort_Nm);
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
  find_package(kadans 0.2 REQUIRED)
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

namespace fs = std::filesystem;

std::string class_name_of(const std::string& name) {
  std::string result;
  bool begins = true;
  for (const char c : name) {
    if (c != '_') result += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = c == '_';
  }
  return result;
}

namespace {

// A folder with a control object, its test, and a program or a plug-in that contains it. It builds and its test passes
// without changes, on its own (find_package(kadans)) and as a subdirectory of a project that already contains Kadans.
int run_new_control_object(const NewControlObjectOptions& options) {
  const std::string& type = options.name;
  refuse_bad_name(type, "a control object", "knee_damper");
  if (!options.from_c.empty()) return run_new_from_c(options, options.plugin ? plugin_template : program_template);
  if (options.period_s) refuse("--period", "is that of C code: it goes with --from-c");
  const std::string class_name = class_name_of(type);
  const auto filled = [&](std::string_view text) {
    return filled_template(text, {{"@type@", type}, {"@Class@", class_name}});
  };
  const fs::path folder = fs::path(options.folder) / type;
  const bool plugin = options.plugin;
  write_new_files({folder},
                  {{folder / (type + ".h"), filled(header_template)},
                   {folder / (type + ".cpp"), filled(source_template)},
                   {folder / (type + "_test.cpp"), filled(test_template)},
                   {folder / (plugin ? "plugin.cpp" : "main.cpp"), filled(plugin ? plugin_template : program_template)},
                   {folder / "CMakeLists.txt",
                    filled(cmake_template) + filled(plugin ? cmake_plugin_template : cmake_program_template)}});
  tell_build(folder, type);
  return exit_passed;
}

}  // namespace

void add_new_control_object(CLI::App& made, CommandLine& line) {
  const auto [object, options] = line.add<NewControlObjectOptions>(
      made, "control-object", "Write a control object: source, test and build files", run_new_control_object);
  object->add_option("name", options.name, "Name of its type, for example knee_damper")->required()->type_name("NAME");
  object->add_option("--in", options.folder, "Folder in which its folder is created (default: this one)")
      ->type_name("FOLDER");
  object
      ->add_option("--from-c", options.from_c,
                   "Wrap the C code in this folder, made by 20-sim, Simulink Coder or OpenModelica")
      ->type_name("FOLDER");
  add_number(*object, "--period", options.period_s, 1e-5, 10.0, "S",
             "Time between two steps of that code (default: what it says)");
  object->add_flag("--plugin", options.plugin, "Write a plug-in instead of a program");
}

}  // namespace kadans
