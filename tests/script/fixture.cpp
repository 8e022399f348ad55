#include "script/fixture.h"

#include <algorithm>
#include <atomic>

#include <unistd.h>

#include "kadans/signal/input_error.h"

namespace kadans::script_test {

Scripts::Scripts() {
  static std::atomic<int> number{0};
  root = std::filesystem::temp_directory_path() /
         ("kadans_script_" + std::to_string(getpid()) + "_" + std::to_string(number++));
  std::filesystem::create_directories(root / "behaviors/lib");
}

Scripts::~Scripts() {
  std::error_code ignored;
  std::filesystem::remove_all(root, ignored);
}

std::filesystem::path Scripts::write(const std::string& name, const std::string& text) const {
  std::filesystem::create_directories((root / name).parent_path());
  std::ofstream(root / name, std::ios::binary) << text;
  return root / name;
}

Stage::Stage(const std::string& text, ScriptLimits limits, std::uint64_t seed) {
  const std::filesystem::path file = scripts.write("behaviors/test.lua", text);
  behavior = std::make_unique<Behavior>(
      Behavior::Settings{.root = scripts.root, .file = file, .seed = seed, .limits = limits}, robot.catalog, log);
}

Stage::Stage(const std::filesystem::path& root, const std::filesystem::path& file) {
  behavior = std::make_unique<Behavior>(Behavior::Settings{.root = root, .file = root / file}, robot.catalog, log);
}

bool Stage::tick(int times) {
  bool going = true;
  for (int i = 0; i < times && going; ++i) {
    going = behavior->tick(snapshot, sender);
    step();
  }
  return going;
}

Theatre::Theatre(const std::vector<std::string>& texts, const std::vector<std::uint32_t>& lanes) {
  ScriptHost::Settings settings;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::string name = "behaviors/b" + std::to_string(i) + ".lua";
    scripts.write(name, texts[i]);
    settings.play.push_back({.file = name, .lane = lanes.empty() ? 0 : lanes[i]});
  }
  open(settings);
}

void Theatre::open(ScriptHost::Settings settings) {
  settings.root = scripts.root;
  host = std::make_unique<ScriptHost>(settings, robot.catalog, log);
}

void Theatre::tick(int times) {
  for (int i = 0; i < times; ++i) {
    host->tick(snapshot, sender);
    step();
  }
}

std::vector<PlayItem> Theatre::list(const std::vector<std::string>& names) const {
  std::vector<PlayItem> items;
  for (const std::string& name : names) items.push_back({.file = scripts.root / "behaviors" / (name + ".lua")});
  return items;
}

void Engine::step() {
  if (applying) apply();
  snapshot.tick += 10;
  snapshot.time_ns += 10'000'000;
  snapshot.object_count = static_cast<std::uint32_t>(robot.catalog.objects.size());
  const ObjectMask running = SetPartition(robot.catalog).objects(snapshot.control_sets);
  for (std::uint32_t object = 0; object < snapshot.object_count; ++object) {
    const double remaining_s = moving_until_s_[object] - static_cast<double>(snapshot.time_ns) * 1e-9;
    snapshot.objects[object].active = (running >> object & 1U) != 0;
    snapshot.objects[object].motion_remaining_s = remaining_s > 1e-9 ? remaining_s : 0;
  }
}

void Engine::apply() {
  Command command;
  while (queue.try_pop(command)) {
    applied.push_back(command);
    if (command.kind == CommandKind::transaction) snapshot.transactions_applied = command.sequence;
    if (command.kind == CommandKind::switch_set)
      snapshot.control_sets = SetPartition(robot.catalog).after(snapshot.control_sets, command.index);
    if (command.kind == CommandKind::cancel_motion)
      moving_until_s_[robot.catalog.setpoints[command.index].owner] =
          static_cast<double>(snapshot.time_ns) * 1e-9 + 0.1;
    if (command.kind != CommandKind::set_point) continue;
    double& until_s = moving_until_s_[robot.catalog.setpoints[command.index].owner];
    until_s = std::max(until_s, static_cast<double>(snapshot.time_ns) * 1e-9 + command.duration_s);
    const auto joint = robot.catalog.setpoints[command.index].joint;
    if (joint < max_joints) snapshot.joints.joints[joint].position_rad = command.value;
  }
}

std::size_t Engine::commands(CommandKind kind) const {
  return static_cast<std::size_t>(
      std::count_if(applied.begin(), applied.end(), [&](const Command& command) { return command.kind == kind; }));
}

std::string output_of(const std::string& code) {
  Stage stage(on_enter(code));
  stage.tick();
  return stage.behavior->failed() ? stage.behavior->error().text() : stage.said();
}

std::string load_error(const std::string& text) {
  try {
    const Stage stage(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace kadans::script_test
