#include "fuzz_instance.h"

#include <cstdio>

namespace kadans::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr ScriptLimits limits{.tick_instructions = 20'000,
                              .load_instructions = 50'000,
                              .tick_wall_ns = 100'000'000,
                              .load_wall_ns = 100'000'000,
                              .memory_bytes = std::size_t{1} << 20};

constexpr const char* configuration = R"({
  // Found on the bench.
  "name": "bench",
  "control": { "objects": [
    { "name": "posture", "type": "joint_pid", "parameters": { "*.kp_Nm_per_rad": 40 } },
    { "name": "spare", "type": "joint_pid" } ] }
}
)";
constexpr const char* nod = R"(local k = require 'kadans'
local P = k.params { hold_s = { 0.5, min = 0.1, max = 2, unit = 's', doc = 'how long' } }
return k.behavior 'nod' { initial = 'a', k.state 'a' { { after = P.hold_s, to = 'b' } }, k.final 'b' {} }
)";
constexpr const char* wait = R"(local k = require 'kadans'
k.events { seen = { far_m = { 'm', min = 0, max = 5 }, left = { k.flag, optional = true }, word = { k.text, optional = true } } }
return k.behavior 'wait' { initial = 'a', k.state 'a' { endless = true, { on = 'seen', to = 'a' } } }
)";

Catalog& with_parameters_by_object(Catalog& catalog) {
  for (ParameterId id = 0; id < catalog.parameters.size(); ++id)
    catalog.objects.at(catalog.parameters.owner(id)).parameters.push_back(id);
  return catalog;
}

Instance::Facts facts_of(const fs::path& root) {
  return {.name = "bench",
          .mode = "fuzzed",
          .version = "0",
          .configuration = root / "config/bench/robot.json",
          .root = root,
          .folders = {root / "robot.json", "bench"},
          .records = root / "records"};
}

}  // namespace

FuzzProject::FuzzProject() {
  folder_.write("behaviors/bench/nod.lua", nod);
  folder_.write("behaviors/bench/wait.lua", wait);
  std::fprintf(stderr, "inputs that an instance had before lie in %s\n", (root() / "inputs").c_str());
}

const FuzzProject& FuzzProject::only() {
  static const FuzzProject project;
  return project;
}

const FuzzProject& FuzzProject::fresh() {
  const FuzzProject& project = only();
  fs::remove_all(project.root() / "records");
  fs::remove_all(project.root() / "inputs");
  fs::create_directories(project.root() / "records");
  project.folder_.write("config/bench/robot.json", configuration);
  return project;
}

void FuzzProject::keep(std::string_view input, int number) {
  only().folder_.write("inputs/" + std::to_string(100 + number), std::string(input));
}

FuzzInstance::FuzzInstance()
    : host({.root = root_, .limits = limits, .describe = behaviors_description},
           with_parameters_by_object(robot.catalog), log),
      instance(facts_of(root_), robot.catalog, robot.safety.emergency_stop()) {
  log.add(record_side);
  robot.control.record_to(&control_side);
  record_side.record_as({.settings = {.file = {.chunk_bytes = 1U << 14U}}});  // a record is short here
}

LiveHub::Parts FuzzInstance::hub_parts(LivePace* pace) {
  return {.instance = instance,
          .port = instance.open_port(),
          .texts = {.name = "bench", .urdf = "<robot name=\"bench\"/>", .description = "{}"},
          .urdf_file = root_ / "bench.urdf",
          .timing = {},
          .pace = pace};
}

void FuzzInstance::step() {
  lockstep.step();
  behavior_side.beside_tick(lockstep.time_ns());
  {
    const auto snapshot = robot.exchange->snapshot.read(0);
    host.tick(*snapshot, robot.behaviors.sender());
  }
  for (Fault fault; robot.safety.log().try_pop(fault);) instance.tell(fault);
  (void)record_side.beat({.due_ns = lockstep.time_ns()});
  instance.publish(status_of(robot.exchange->snapshot.newest(1), record_side.status()));
}

bool FuzzInstance::runs() {
  return !robot.exchange->snapshot.newest(1).status.safety.stopped && !record_side.status().goes_on;
}

}  // namespace kadans::fuzz
