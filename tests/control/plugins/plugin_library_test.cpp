// Plug-ins from outside: one that keeps to the seam works as if it were built in; every other is refused with a reason
// or kept from doing harm.
#include "kadans/control/plugin_library.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <doctest/doctest.h>

#include "control/two_joint_robot.h"
#include "kadans/control/catalog.h"
#include "kadans/control/joint_pid.h"
#include "kadans/control/plugin.h"
#include "kadans/testing/allocation_count.h"

using namespace kadans;

namespace fs = std::filesystem;

namespace {

const fs::path folder = fs::path(KADANS_BINARY_DIR) / "tests" / "plugins";

fs::path plugin(const std::string& name) { return folder / (name + "_plugin.so"); }

// Why a library is refused, without its path.
std::string refusal(const fs::path& file) {
  ControlObjectTypes types;
  types.add("joint_pid", make_joint_pid);
  try {
    load_plugin(file, types);
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what(), begin = "plug-in " + file.string() + ": ";
    return text.starts_with(begin) ? text.substr(begin.size()) : "without the file: " + text;
  }
  return "accepted";
}

// An object of a plug-in on the knee of the two-joint robot.
struct Bench {
  RobotModel model = two_joint_robot();
  ControlObjectTypes types;
  Catalog catalog;
  std::unique_ptr<ControlObject> object;
  JointStates joints;
  RobotStatus status;
  ActuationFrame written, computed;
  std::int64_t time_ns = 0;

  explicit Bench(const std::string& name, const char* type = "hostile", std::size_t joint = 1) {
    load_plugin(plugin(name), types);
    object = (*types.find(type))({model, {joint}});
    Declaration declaration("o", 3, catalog.parameters, catalog.setpoints, catalog.signals);
    object->declare(declaration);
    joints.count = written.joint_count = computed.joint_count = 3;
  }
  ControlInput input() const { return {joints, status, written, time_ns, 0.001}; }
  void step() {
    object->step(input(), computed);
    time_ns += 1'000'000;
  }
  double signal(const char* name) {
    std::vector<double> row(catalog.signals.size());
    catalog.signals.gather(row);
    return row[catalog.signals.find(name).value()];
  }
};

std::string make_refusal(const std::string& name, const char* type = "hostile", std::size_t joint = 1) {
  try {
    const Bench bench(name, type, joint);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("A plug-in's object declares parameters, set-points and signals as its class does") {
  const Bench bench("spring", "spring");
  const Parameter& stiffness =
      bench.catalog.parameters.info(bench.catalog.parameters.find("o.stiffness_Nm_per_rad").value());
  CHECK(stiffness.unit == "Nm/rad");
  CHECK(stiffness.max == 100);
  CHECK(stiffness.initial == 20);
  CHECK(stiffness.doc == "Pull to the rest position.");
  CHECK(bench.catalog.parameters.owner(0) == 3);
  const Setpoint& rest = bench.catalog.setpoints[bench.catalog.setpoints.find("o.rest_rad").value()];
  CHECK(rest.min == -1);
  CHECK(rest.max == 2);
  CHECK(rest.channel == 7);
  CHECK(rest.joint == 1);
  CHECK(rest.owner == 3);
  CHECK(bench.catalog.signals.find("control.o.effort_Nm"));
}

TEST_CASE("A plug-in's object starts, steps, moves and takes parameters as one that is built in, without allocating") {
  Bench bench("spring", "spring");
  bench.joints.joints[1] = {.position_rad = 0.5, .velocity_rad_s = -2, .effort_Nm = 0};
  const kadans::testing::AllocationCount heap;
  bench.object->start(bench.input());
  bench.step();
  const double first_Nm = bench.computed.joints[1].effort_Nm;
  bench.object->set_point(7, 1.0, 0.25);
  const bool set = bench.catalog.parameters.set(0, 40);
  bench.object->parameters_changed();
  bench.step();
  const long allocations = heap.count();
  CHECK(set);
  CHECK(first_Nm == doctest::Approx(2));
  CHECK(bench.computed.joints[1].effort_Nm == doctest::Approx(40 * 0.5 + 2));
  CHECK(bench.computed.joints[0].mode == ActuationMode::off);
  CHECK(bench.signal("control.o.effort_Nm") == doctest::Approx(22));
  CHECK(bench.signal("control.o.changes") == 1);
  CHECK(bench.signal("control.o.failed") == 0);
  CHECK(bench.object->motion_remaining_s() == doctest::Approx(0.249));
  bench.object->cancel_motion(7);
  CHECK(bench.object->motion_remaining_s() == 0);
  CHECK(allocations == 0);
}

TEST_CASE("What the class throws when it is made is the reason of the refusal") {
  CHECK(make_refusal("spring", "spring", 2) == "joint toe has no motor for a spring");
}

TEST_CASE("Options reach the plug-in, and which ones it knows comes back") {
  ControlObjectTypes types;
  load_plugin(plugin("spring"), types);
  const RobotModel model = two_joint_robot();
  const ObjectSetup given{model, {1}, {{{"colour", "red"}}}};
  CHECK((*types.find("spring"))(given) != nullptr);
  CHECK(given.options.asked() == std::vector<std::string>{"refuse"});
  const ObjectSetup refused{model, {1}, {{{"refuse", "as you like"}}}};
  CHECK_THROWS_WITH_AS((*types.find("spring"))(refused), "told to refuse: as you like", std::invalid_argument);
}

TEST_CASE("A file that is no plug-in is refused with a reason") {
  CHECK(refusal(folder / "nowhere.so").starts_with("cannot be loaded: "));
  const fs::path text = folder / "text.so", empty = folder / "empty.so";
  std::ofstream(text) << "not a library at all, but long enough to have a header in it, if it were one\n";
  std::ofstream(empty).close();
  CHECK(refusal(text).find("invalid ELF header") != std::string::npos);
  CHECK(refusal(empty).find("file too short") != std::string::npos);
  CHECK(refusal(folder).starts_with("cannot be loaded: "));
  CHECK(refusal(plugin("missing_symbol")) == "exports no function kadans_plugin, so it is no plug-in of Kadans");
}

TEST_CASE("A plug-in of another version or with other frames is refused before anything of it is used") {
  CHECK(refusal(plugin("wrong_version")) == "is made for version 7 of the seam, this program has 2: build it again");
  const std::string own = std::to_string(sizeof(ActuationFrame)), other = std::to_string(sizeof(ActuationFrame) + 8);
  CHECK(refusal(plugin("other_frames")) ==
        "was built with another ActuationFrame: " + other + " bytes, this program has " + own);
}

TEST_CASE("A plug-in with a table that makes no sense is refused") {
  CHECK(refusal(plugin("nothing")) == "does not say what it brings");
  CHECK(refusal(plugin("throwing_entry")) == "threw when it was asked what it brings");
  CHECK(refusal(plugin("many_types")) == "brings 4000000000 types, 1..64 are possible");
  CHECK(refusal(plugin("bad_name")) == "names a type with other than 1..64 of a-z, 0-9 and _");
  CHECK(refusal(plugin("missing_function")) == "lacks a function of type hostile");
  CHECK(refusal(plugin("name_taken")) == "the type of control object 'joint_pid' of the plug-in is taken by kadans");
}

TEST_CASE("A plug-in that cannot make or declare its object is refused with its reason, whatever it throws") {
  CHECK(make_refusal("makes_nothing") == "it made no object");
  CHECK(make_refusal("throwing_create") == "the plug-in threw while it made the object");
  CHECK(make_refusal("throwing_declare") == "the plug-in threw while it declared the object");
  CHECK(make_refusal("refusing_declare") == std::string(sizeof(PluginError) - 1, 'x'));
  CHECK(make_refusal("declaring_twice").find("o.k") != std::string::npos);
}

TEST_CASE("A plug-in that throws in step leaves NaN on its joints for the safety layer, and is not called again") {
  Bench bench("throwing_step");
  bench.object->start(bench.input());
  for (int i = 0; i < 5; ++i) bench.step();
  CHECK(bench.computed.joints[1].effort_Nm == 1);
  CHECK(bench.signal("control.o.failed") == 0);
  bench.step();
  CHECK(std::isnan(bench.computed.joints[1].effort_Nm));
  CHECK(bench.signal("control.o.failed") == 1);
  bench.time_ns = 0;  // where it would work again
  bench.computed = {};
  bench.step();
  CHECK(std::isnan(bench.computed.joints[1].effort_Nm));
  CHECK(bench.computed.joints[0].mode == ActuationMode::off);
}

TEST_CASE("A plug-in that throws in its high level fails in the control thread's next tick") {
  Bench bench("throwing_update");
  bench.object->start(bench.input());
  bench.step();
  CHECK(std::isfinite(bench.computed.joints[1].effort_Nm));
  bench.object->update(Snapshot{});
  bench.step();
  CHECK(std::isnan(bench.computed.joints[1].effort_Nm));
}

TEST_CASE("A plug-in's NaN is passed on as it is, its NaN of a duration is none") {
  Bench bench("not_finite");
  bench.object->start(bench.input());
  bench.step();
  CHECK(std::isnan(bench.computed.joints[1].effort_Nm));
  CHECK(bench.object->motion_remaining_s() == 0);
}
