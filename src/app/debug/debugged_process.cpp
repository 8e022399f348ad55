#include "debugged_process.h"

#include <exception>
#include <filesystem>

#include <fcntl.h>
#include <unistd.h>

#include "app/author/file_checks.h"
#include "app/sim/ordered_events.h"
#include "app/sim/played_behaviors.h"
#include "app/sim/repeated_run.h"
#include "app/sim/run_branches.h"
#include "config/robot/project_root.h"
#include "debugged_run.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "telemetry/record/record_folder.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t lines_kept = 1000;
constexpr std::size_t compared_bytes_max = std::size_t{1} << 20U;

bool same_text(const fs::path& one, const fs::path& other) {
  try {
    return read_input_file(one, compared_bytes_max) == read_input_file(other, compared_bytes_max);
  } catch (const InputError&) {
    return false;
  }
}

// What the debugger shows of it: the files of its behaviors, each at its place in the editor's project when it is the
// same there, and the states of their charts.
Json description(Assembly& assembly, const DebugSubject& subject) {
  const std::string recorded_root = subject.unpacked ? subject.inputs.fact("root") : "";
  const fs::path root = project_root(assembly.scenario().file);
  Json sources = Json::array(), states = Json::array();
  const auto describe = [&](Assembly& one) {
    const ScriptHost* host = one.own_host();
    if (host == nullptr) return;
    for (const fs::path& path : host->files()) {
      const std::string chunk = path.lexically_relative(root).generic_string();
      fs::path shown = path;
      for (const fs::path& project : {fs::path(recorded_root), fs::current_path()}) {
        if (!recorded_root.empty() && !project.empty() && same_text(path, project / chunk)) shown = project / chunk;
      }
      sources.push_back({{"chunk", chunk}, {"path", fs::absolute(shown).lexically_normal().string()}});
    }
    for (std::size_t i = 0; i < host->size(); ++i) {
      const Chart& chart = host->behavior(i).chart();
      for (const Chart::State& state : chart.states) states.push_back(chart.name + "." + state.path);
    }
  };
  describe(assembly);
  for (const auto& other : assembly.others()) describe(*other);
  return {{"file", fs::absolute(subject.launch.file).lexically_normal().string()},
          {"root", root.string()},
          {"sources", sources},
          {"states", states}};
}

std::string judgement(const RunResult& result) {
  std::string text = result.error.empty() ? "" : result.error + "\n";
  for (std::size_t i = 0; i < result.checks.size(); ++i) {
    const CheckResult& check = result.checks[i];
    text += std::string(check.passed ? "passed: " : "failed: ") + check.name + ", " + number_text(check.value) +
            wanted_clause(check) + "\n";
  }
  return text + printed("%.3f s, state hash ", result.duration_s) + hash_text(result.state_hash) + "\n";
}

void simulate(RunChannel& channel, const DebugSubject& subject, const RunChoices& choices) {
  ScenarioConfig scenario = read_scenario(choices);
  if (subject.recorded) add_ordered_events(subject.inputs, subject.launch.file, scenario);
  RunLog log({}, lines_kept);
  Assembly assembly(scenario, choices.seed.value_or(scenario.seed), log);
  if (!subject.recorded) refuse_faulty_behaviors(scenario, assembly.catalog());
  const double duration_s = choices.duration_s.value_or(scenario.duration_s);
  std::vector<ScenarioCheck> judged = scenario.checks;
  std::erase_if(judged, [&](const ScenarioCheck& check) {
    return duration_s < scenario.duration_s && !judges_run_until(check, duration_s);
  });
  Checks checks(assembly.catalog().signals, judged, scenario.file, assembly.signal_states());
  DebuggedRun run(channel, assembly, log, &checks);
  RecordedBranch branch(subject.inputs.run, scenario, assembly);
  run.begin(description(assembly, subject));
  const RunResult result = run_scenario(assembly.parts(), duration_s, checks, {&branch, &run});
  run.end({{"passed", result.passed}, {"text", judgement(result)}});
}

// A run on threads: its files come out of the record.
void repeat(RunChannel& channel, const DebugSubject& subject) {
  const ScenarioConfig scenario = unpacked_scenario(subject.inputs, subject.launch.file, *subject.unpacked);
  RepeatedRun repeated(
      subject.launch.file, scenario, *subject.unpacked, subject.inputs.fact("root"),
      played_elsewhere(subject.inputs) ? RepeatedRun::Behaviors::none : RepeatedRun::Behaviors::compared);
  DebuggedRun run(channel, repeated.assembly(), repeated.log(), nullptr);
  run.begin(description(repeated.assembly(), subject));
  repeated.go([] { return false; }, {&run});
  std::string parts = repeated.parting();
  if (repeated.comparison().parted()) parts = "in tick " + std::to_string(repeated.comparison().tick());
  const std::string text = repeated.same() ? "repeats the record" : "parts from the record " + parts;
  run.end({{"passed", repeated.same()}, {"text", "the run " + text + "\n"}});
}

void debug(RunChannel& channel, const DebugSubject& subject) {
  const DebugLaunch& launch = subject.launch;
  RunChoices choices = launch.choices;
  choices.scenario = launch.file;
  if (!subject.recorded) {
    require_kind(launch.file, JsonKind::scenario);
    return simulate(channel, subject, choices);
  }
  if (subject.inputs.fact("clock") == clock_of_threads) return repeat(channel, subject);
  choices = choices_of(subject.inputs.run, launch.file);
  const UnpackedInputs* const unpacked = subject.unpacked.get();
  choices.scenario = unpacked ? unpacked->scenario().string() : find_scenario(subject.inputs, launch.file).string();
  choices.plugins = unpacked ? unpacked->plugins() : plugins_beside(choices.scenario, launch.allow_plugins);
  simulate(channel, subject, choices);
}

}  // namespace

DebugSubject debug_subject(DebugLaunch launch) {
  DebugSubject subject{.launch = std::move(launch)};
  const std::string& file = subject.launch.file;
  const RunChoices& choices = subject.launch.choices;
  subject.recorded = is_record(file);
  if (!subject.recorded) return subject;
  if (choices.seed || choices.duration_s || !choices.play.empty() || !choices.set.empty())
    refuse(file, "is a record, which says itself what was played, and with which seed");
  subject.inputs = read_front(file);
  if (subject.launch.from_record || subject.inputs.fact("clock") == clock_of_threads)
    subject.unpacked = std::make_unique<UnpackedInputs>(subject.inputs, file, subject.launch.allow_plugins);
  return subject;
}

void debug_in_this_process(RunChannel channel, const DebugSubject& subject) {
  // The standard streams may be the editor's.
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  (void)dup2(nothing, STDIN_FILENO);
  (void)dup2(STDERR_FILENO, STDOUT_FILENO);
  try {
    debug(channel, subject);
  } catch (const std::exception& error) {
    (void)channel.send({{"event", "failed"}, {"text", error.what()}});
  }
  _exit(0);
}

}  // namespace kadans
