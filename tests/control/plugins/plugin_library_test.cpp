// Plug-ins from outside: what one brings works as if it were built in; whatever does not fit is refused with a reason.
#include "control/plugin_library.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>

#include <doctest/doctest.h>

#include "control/drive/spring_torque.h"
#include "control/made_objects.h"
#include "control/two_joint_robot.h"
#include "kadans/control/catalog.h"
#include "kadans/control/plugin.h"
#include "kadans/testing/allocation_count.h"

using namespace kadans;

namespace fs = std::filesystem;

namespace {

const fs::path folder = fs::path(KADANS_BINARY_DIR) / "tests" / "plugins";

fs::path plugin(const std::string& name) { return folder / (name + "_plugin.so"); }

struct Loaded {
  ControlObjectTypes types;
  std::vector<MakePlantType> plants;

  explicit Loaded(const fs::path& file) { load_plugin(file, types, plants); }
};

// Why a library is refused, without its path.
std::string refusal(const fs::path& file) {
  Loaded loaded(plugin("spring"));
  loaded.types.add("joint_pid", make_joint_pid);
  try {
    load_plugin(file, loaded.types, loaded.plants);
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what(), begin = "plug-in " + file.string() + ": ";
    return text.starts_with(begin) ? text.substr(begin.size()) : "without the file: " + text;
  }
  return "accepted";
}

constexpr const char* remedy =
    ": build it again with the headers and libraries of this program's package, its compiler and its flags";

std::vector<std::string> parts_of_build() {
  std::vector<std::string> parts;
  const std::string build = KADANS_BUILD;
  for (std::size_t at = 0, comma = 0; comma != std::string::npos; at = comma + 2) {
    comma = build.find(", ", at);
    parts.push_back(build.substr(at, comma - at));
  }
  return parts;
}

// One object on the first two joints of the two-joint robot, whose hip and knee have springs.
struct Bench {
  RobotModel model = two_joint_robot();
  Catalog catalog;
  std::unique_ptr<ControlObject> object;
  JointStates joints;
  RobotStatus status;
  ActuationFrame written, computed;
  std::int64_t time_ns = 0;

  Bench(const MakeControlObject& make, std::vector<std::size_t> driven,
        std::map<std::string, std::string> options = {}) {
    const DriveLaw spring{.effort_max_Nm = 20, .spring_Nm_per_rad = 300, .rotor_inertia_kg_m2 = 0.02};
    object = make({model, std::move(driven), std::move(options), {spring, spring, spring}});
    Declaration declaration("o", 3, catalog.parameters, catalog.setpoints, catalog.signals);
    object->declare(declaration);
    joints.count = written.joint_count = computed.joint_count = 3;
  }
  ControlInput input() const { return {joints, status, written, time_ns, 0.001}; }
  void step() {
    object->step(input(), computed);
    time_ns += 1'000'000;
  }
  std::vector<double> signals() const {
    std::vector<double> row(catalog.signals.size());
    catalog.signals.gather(row);
    return row;
  }
  double signal(const char* name) const { return signals()[catalog.signals.find(name).value()]; }
};

// All that an object says in a motion in which everything is asked of it that can be.
std::vector<double> answers(const MakeControlObject& make, const std::map<std::string, std::string>& options) {
  Bench bench(make, {0, 1}, options);
  for (ParameterId id = 0; id < bench.catalog.parameters.size(); ++id) {
    const Parameter& parameter = bench.catalog.parameters.info(id);
    (void)bench.catalog.parameters.set(id, std::min(parameter.max, 1.1 * parameter.initial + 1));
  }
  bench.object->parameters_changed();
  bench.object->start(bench.input());
  std::vector<double> said;
  for (int tick = 0; tick < 300; ++tick) {
    JointState& hip = bench.joints.joints[0];
    hip = {.position_rad = 0.001 * tick, .velocity_rad_s = 1, .effort_Nm = 0.3};
    for (JointActuation& joint : bench.computed.joints) joint = {.effort_Nm = 2, .mode = ActuationMode::effort};
    if (bench.catalog.setpoints.size() > 0) {
      if (tick == 20) bench.object->set_point(0, 0.4, 0.1);
      if (tick >= 150 && tick < 250) bench.object->follow(0, {.value = 0.4 - 0.001 * (tick - 150), .velocity = -1});
      if (tick == 250) bench.object->cancel_motion(0);
      SetpointState state;
      said.push_back(bench.object->setpoint_state(0, state) ? state.value : -9);
      said.push_back(state.velocity);
    }
    bench.object->rehearse(bench.input());
    bench.step();
    if (tick % 10 == 0) bench.object->update(Snapshot{});
    for (const JointActuation& joint : bench.computed.joints) {
      for (const double number : {joint.effort_Nm, joint.position_rad, joint.velocity_rad_s, joint.stiffness_Nm_per_rad,
                                  joint.damping_Nms_per_rad, static_cast<double>(joint.mode)})
        said.push_back(number);
    }
    said.push_back(bench.object->motion_remaining_s());
    const std::vector<double> signals = bench.signals();
    said.insert(said.end(), signals.begin(), signals.end());
    bench.written = bench.computed;
  }
  return said;
}

}  // namespace

TEST_CASE("A plug-in's object declares parameters, set-points and signals as its class does") {
  const Loaded loaded(plugin("spring"));
  const Bench bench(*loaded.types.find("spring"), {1});
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
  const Loaded loaded(plugin("spring"));
  Bench bench(*loaded.types.find("spring"), {1});
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
  CHECK(bench.object->motion_remaining_s() == doctest::Approx(0.249));
  bench.object->cancel_motion(7);
  CHECK(bench.object->motion_remaining_s() == 0);
  CHECK(allocations == 0);
}

TEST_CASE("Shipped objects say the same to every call, built in or out of a plug-in: rehearse, follow, drives, all") {
  const Loaded loaded(plugin("shipped"));
  const struct {
    const char* name;
    std::unique_ptr<ControlObject> (*make)(const ObjectSetup&);
    std::map<std::string, std::string> options;
  } shipped[] = {{"plugged_joint_pid", make_joint_pid, {}},
                 {"plugged_joint_impedance", make_joint_impedance, {}},
                 {"plugged_joint_impedance", make_joint_impedance, {{"loop", "drive"}}},
                 {"plugged_profile_position", make_profile_position, {}},
                 {"plugged_spring_torque", make_spring_torque, {}}};
  for (const auto& one : shipped) {
    CAPTURE(one.name);
    const MakeControlObject* const out_of_plugin = loaded.types.find(one.name);
    REQUIRE(out_of_plugin != nullptr);
    const std::vector<double> built_in = answers(one.make, one.options), plugged = answers(*out_of_plugin, one.options);
    CHECK(built_in == plugged);
    CHECK(built_in.size() > 6000);
  }
}

TEST_CASE("What is thrown when an object is made arrives as it was thrown") {
  const Loaded spring(plugin("spring")), refusing(plugin("refusing"));
  const RobotModel model = two_joint_robot();
  const auto make = [&](const Loaded& from, const char* type, std::size_t joint) {
    return (*from.types.find(type))({model, {joint}});
  };
  CHECK_THROWS_WITH_AS(make(spring, "spring", 2), "joint toe has no motor for a spring", std::invalid_argument);
  CHECK_THROWS_WITH_AS(make(refusing, "throws_own", 0), "boo", std::runtime_error);
  CHECK(make(refusing, "makes_nothing", 0) == nullptr);
  std::string option;
  try {
    (void)make(refusing, "refuses_option", 0);
  } catch (const OptionError& error) {
    option = error.option();
  }
  CHECK(option == "loop");
}

TEST_CASE("Options reach the plug-in, and which ones it knows comes back") {
  const Loaded loaded(plugin("spring"));
  const RobotModel model = two_joint_robot();
  const ObjectSetup given{model, {1}, {{{"colour", "red"}}}};
  CHECK((*loaded.types.find("spring"))(given) != nullptr);
  CHECK(given.options.asked() == std::vector<std::string>{"refuse"});
  const ObjectSetup refused{model, {1}, {{{"refuse", "as you like"}}}};
  CHECK_THROWS_WITH_AS((*loaded.types.find("spring"))(refused), "told to refuse: as you like", std::invalid_argument);
}

TEST_CASE("A plug-in brings types of plants beside control objects, each robot has settings of its own") {
  const Loaded loaded(plugin("spring"));
  REQUIRE(loaded.plants.size() == 1);
  const std::unique_ptr<PlantType> type = loaded.plants[0](), other = loaded.plants[0]();
  CHECK(type != other);
  CHECK(type->name() == "floating");
  const RobotModel model = two_joint_robot();
  PlantSettings settings;
  settings.position_rad.resize(3);
  CHECK(type->make_world({model, settings})->robot(0).truth().base.position_m[2] == 1);
  CHECK_THROWS_AS((void)type->make_plant({}), std::logic_error);
}

TEST_CASE("A file that is no plug-in is refused with a reason") {
  CHECK(refusal(folder / "nowhere.so").starts_with("cannot be loaded: "));
  const fs::path text = folder / "text.so", empty = folder / "empty.so";
  std::ofstream(text) << "not a library at all, but long enough to have a header in it, if it were one\n";
  std::ofstream(empty).close();
  CHECK(refusal(text).find("invalid ELF header") != std::string::npos);
  CHECK(refusal(empty).find("file too short") != std::string::npos);
  CHECK(refusal(folder).starts_with("cannot be loaded: "));
  CHECK(refusal(plugin("missing_symbol")) == "exports no kadans_plugin, so it is no plug-in of Kadans");
}

TEST_CASE("A plug-in that was cut off is refused before it is mapped") {
  for (const std::uintmax_t bytes : {100U, 1000U, 5000U}) {
    const fs::path file = folder / ("cut_" + std::to_string(bytes) + ".so");
    fs::copy_file(plugin("spring"), file, fs::copy_options::overwrite_existing);
    fs::resize_file(file, bytes);
    CHECK(refusal(file) == "is cut off after " + std::to_string(bytes) + " bytes: copy or build it again");
  }
}

TEST_CASE("A plug-in that was built otherwise is refused with both sides and what to do, whatever part it is") {
  const std::vector<std::string> parts = parts_of_build();
  REQUIRE(parts.size() == 9);  // each has its plug-in
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string other = '?' + parts[i].substr(1);
    CHECK(refusal(plugin("build_" + std::to_string(i))) ==
          "was built with " + other + ", this program with " + parts[i] + remedy);
  }
  CHECK(refusal(plugin("old_strings")) ==
        std::string("was built with string ABI 0, this program with string ABI 1") + remedy);
  CHECK(refusal(plugin("checking_containers")) ==
        std::string("was built with containers that check, this program with containers that do not check") + remedy);
  CHECK(refusal(plugin("wide_alignment")).starts_with("was built with Eigen aligned to 32, this program with Eigen "));
}

TEST_CASE("A plug-in that differs in what changes no object is taken") {
  CHECK(refusal(plugin("with_assertions")) == "accepted");
  CHECK(refusal(plugin("without_assert")) == "accepted");
}

TEST_CASE("A descriptor that makes no sense is refused") {
  CHECK(refusal(plugin("other_kind")) ==
        "exports a kadans_plugin of another kind than this program's, " KADANS_SDK + std::string(remedy));
  const std::string own = std::to_string(sizeof(PluginDescriptor)),
                    other = std::to_string(sizeof(PluginDescriptor) + 8);
  CHECK(refusal(plugin("other_size")) ==
        "says that its descriptor has " + other + " bytes, this program's has " + own + remedy);
  CHECK(refusal(plugin("nothing")) == "brings 0 types, 1..64 are possible");
  CHECK(refusal(plugin("many_types")) == "brings 4000000000 types, 1..64 are possible");
  CHECK(refusal(plugin("bad_name")) == "names a type with other than 1..64 of a-z, 0-9 and _");
  CHECK(refusal(plugin("no_maker")) == "a type of control object needs a name and a function that makes it");
  CHECK(refusal(plugin("name_taken")) == "the type of control object 'joint_pid' of the plug-in is taken by kadans");
  CHECK(refusal(plugin("no_plant")) == "makes no type of plant where it promises one");
}
