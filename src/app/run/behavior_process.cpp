#include "behavior_process.h"

#include <cmath>
#include <optional>

#include "app/assembly/assembly.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "config/robot/project_root.h"
#include "estimate/estimator.h"
#include "kadans/signal/nearest_name.h"
#include "realtime/machine/machine.h"
#include "realtime/machine/placement.h"
#include "run_threads.h"
#include "script/process/behavior_server.h"
#include "telemetry/record/recorded_inputs.h"

namespace kadans {
namespace {

constexpr std::size_t behavior_heap_bytes = std::size_t{2} << 20U;
constexpr std::int64_t patience_on_virtual_time_ns = 10'000'000'000;

BehaviorLink::Setup setup_of(const RunOptions& options) {
  BehaviorLink::Setup setup;
  setup.memory_bytes = static_cast<std::uint64_t>(std::llround(1e6 * options.behaviors_memory_MB));
  if (options.virtual_time) return setup;
  setup.priority = read_rights("/").priority(control_priority) ? behavior_process_priority : 0;
  setup.cpu_to_leave = options.cpu >= 0 ? options.cpu : real_time_cpu("/");
  setup.locks_memory = 1;
  setup.on_wall_clock = 1;
  return setup;
}

// Sets locked memory, memory limit and priority as for an engine's thread, once everything is loaded.
void settle(const BehaviorLink::Setup& setup) noexcept {
  if (setup.locks_memory != 0) (void)lock_memory(behavior_heap_bytes);
  if (setup.memory_bytes > 0) (void)limit_memory(setup.memory_bytes);  // it counts what the lock looks for
  touch_stack();
  if (setup.priority > 0) (void)take_priority(setup.priority);
}

ProcessHost::Settings process_settings(const RunOptions& options, const char* command) {
  ProcessHost::Settings settings;
  settings.program = "/proc/self/exe";
  settings.arguments = {"kadans", command, options.robot};
  if (options.seed) settings.arguments.insert(settings.arguments.end(), {"--seed", std::to_string(*options.seed)});
  settings.time_stands = options.virtual_time;
  if (options.virtual_time) {
    settings.patience_ns = patience_on_virtual_time_ns;
    settings.start_patience_ns = 6 * patience_on_virtual_time_ns;
  }
  if (options.behaviors_patience_s > 0) settings.patience_ns = std::llround(1e9 * options.behaviors_patience_s);
  if (options.behaviors_deaths > 0) settings.restart.deaths_max = options.behaviors_deaths;
  settings.setup = setup_of(options);
  return settings;
}

}  // namespace

ScenarioConfig live_scenario(const RunOptions& options) {
  ScenarioConfig scenario;
  scenario.file = scenario.robot = options.robot;
  scenario.name = "run";
  scenario.plant = options.plant;
  scenario.peer = options.peer;
  scenario.imu = options.imu;
  scenario.read_only = options.read_only;
  scenario.joystick_device = options.joystick;
  scenario.on_wall_clock = !options.virtual_time;
  scenario.seed = options.seed.value_or(1);
  if (!options.play.empty()) scenario.behaviors = read_play_items(options.play, "--play", folders_of(scenario));
  return scenario;
}

std::unique_ptr<ProcessHost> start_behavior_process(const RunOptions& options, BehaviorLog& log) {
  ProcessHost::Settings settings = process_settings(options, "behavior-process");
  if (!options.play.empty()) settings.arguments.insert(settings.arguments.end(), {"--play", options.play});
  return std::make_unique<ProcessHost>(std::move(settings), log);
}

// Nobody in real time waits for it: it has neither a priority nor locked memory.
std::unique_ptr<ProcessHost> start_decision_process(const RunOptions& options, BehaviorLog& log,
                                                    std::int64_t period_ns) {
  ProcessHost::Settings settings = process_settings(options, "decision-process");
  settings.answer_ns = period_ns / 2;
  settings.setup.decides = 1;
  settings.setup.tells = options.record.empty() ? 0 : 1;
  settings.setup.priority = 0;
  settings.setup.locks_memory = 0;
  return std::make_unique<ProcessHost>(std::move(settings), log);
}

namespace {

int run_behavior_process(const RunOptions& options) {
  die_with_parent();
  be_first_victim();
  const SharedMemory memory(child_memory_descriptor, sizeof(BehaviorLink));
  // Open until the process has ended: the runtime takes a closed doorbell for its end, and what went wrong is told
  // later.
  static Doorbell bell(child_doorbell_descriptor);
  auto& link = *static_cast<BehaviorLink*>(memory.get());
  if (link.setup.cpu_to_leave >= 0) (void)leave_cpu(link.setup.cpu_to_leave);
  const KeptState& kept = link.setup.kept;
  const std::span bytes = std::span(kept.bytes).first(std::min<std::size_t>(kept.size, kept.bytes.size()));
  ScenarioConfig scenario = live_scenario(options);
  scenario.on_wall_clock = link.setup.on_wall_clock != 0;
  const Robot robot = read_robot(scenario.robot, scenario.plugins);
  const std::unique_ptr<ControlSystem> system = make_control_system(robot);
  system->catalog.seen = robot.config.supervisor.seen;
  ControlSets sets(system->catalog, std::move(system->objects));  // declares parameters too
  // The names of what the control engine measures, for conditions (m:on); the values stay in its own process.
  const auto measured = std::make_unique<Snapshot>();
  declare_signals(system->catalog.signals, robot.config.model, robot.config.estimate, *measured);
  SpokenLines lines(link);
  BehaviorLog log{&lines};
  if (link.setup.decides != 0) {
    Behavior::Settings settings = decision_settings(robot.config.supervisor, project_root(scenario.file),
                                                    folders_of(scenario), scenario.seed, scenario.on_wall_clock);
    BehaviorInputs* inputs = nullptr;
    std::optional<RecordedInputs> taken;
    if (link.setup.tells != 0 && robot.config.record.inputs)
      inputs = &taken.emplace(project_root(scenario.file).string(), names_of(robot.config.record.private_files));
    settings.limits.inputs = &inputs;
    Decisions decisions(settings, system->catalog, log);
    ServedDecisions served(decisions, log, bytes, inputs);
    settle(link.setup);
    return BehaviorServer(link, bell, served, log, lines, system->catalog, sets).serve();
  }
  const std::unique_ptr<ScriptHost> host =
      make_script_host(scenario, robot.config, system->catalog, scenario.seed, log, bytes);
  settle(link.setup);
  return BehaviorServer(link, bell, *host, log, lines, system->catalog, sets).serve();
}

}  // namespace

// A hidden command that `run` starts, under another name for each process, for those who list processes.
void add_behavior_process(CommandLine& line) {
  const auto [process, options] = line.add<RunOptions>("behavior-process", "", run_behavior_process);
  process->alias("decision-process")->group("");
  process->add_option("robot", options.robot)->required();
  process->add_option("--play", options.play);
  process->add_option("--seed", options.seed)->check(any_seed());
}

}  // namespace kadans
