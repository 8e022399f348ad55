#include <algorithm>

#include <CLI/CLI.hpp>

#include "app/author/file_checks.h"
#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "input_files.h"
#include "repeated_run.h"
#include "signal/input_file.h"
#include "sim_run.h"

namespace kadans {
namespace {

std::vector<RunBranch> branches_of(const SimOptions& options) {
  std::vector<RunBranch> branches;
  for (const std::string& text : options.branches) branches.push_back(parse_branch(text));
  if (branches.empty())
    branches.push_back({.name = "", .set = options.set, .play = options.play, .push = options.push});
  return branches;
}

int go_on(const SimOptions& options) {
  SimContinuation continuation{.from = read_checkpoint(options.from), .branches = branches_of(options)};
  RunInputs& inputs = continuation.from.inputs;
  const UnpackedInputs unpacked(inputs, options.from, options.allow_plugins);
  if (std::ranges::any_of(continuation.branches, [](const RunBranch& branch) { return !branch.play.empty(); }))
    unpacked.add_behaviors(inputs);
  RunChoices choices = choices_of(inputs.run, options.from);
  choices.scenario = unpacked.scenario().string();
  choices.plugins = unpacked.plugins();
  if (options.duration_s) choices.duration_s = options.duration_s;
  const double at_s = static_cast<double>(continuation.from.at.time_ns) / 1e9;
  if (!(*choices.duration_s > at_s))
    refuse("--duration", "must be more than the " + number_text(at_s) + " s of the checkpoint");
  SimRun sim(options, choices, std::move(continuation));
  catch_interrupts();
  return sim.run();
}

void refuse_wrong_mixtures(const SimOptions& options) {
  if (options.from.empty() && options.scenario.empty()) refuse("name a scenario, or a checkpoint with --from");
  if (!options.from.empty() && !options.scenario.empty())
    refuse("--from", "a checkpoint has its own scenario: name one of the two");
  if (options.from.empty()) {
    if (!options.branches.empty()) refuse("--branch", "parts from a checkpoint: it goes with --from");
    if (!options.push.empty()) refuse("--push", "parts from a checkpoint: it goes with --from");
    if (options.allow_plugins) refuse("--allow-plugins", "is for the plug-ins of a checkpoint: it goes with --from");
    return;
  }
  if (options.seed) refuse("--seed", "a checkpoint goes on with the seed that it began with");
  if (!options.checkpoints.empty()) refuse("--checkpoint", "does not go with --from");
  if (options.watch) refuse("--watch", "does not go with --from");
  if (options.live.wanted()) refuse("--live", "does not go with --from");
  if (options.ros2.wanted()) refuse("--ros2", "does not go with --from");
  if (!options.branches.empty() && !(options.set.empty() && options.play.empty() && options.push.empty()))
    refuse("--branch", "says itself what to set, play and push");
}

// What a repeated record does not take.
void refuse_simulation(const SimOptions& options) {
  const auto refuse_option = [&](bool given, const char* option) {
    if (given) refuse(option, "is for simulations: " + options.scenario + " repeats a record as it was");
  };
  refuse_option(options.seed.has_value(), "--seed");
  refuse_option(!options.play.empty(), "--play");
  refuse_option(!options.set.empty(), "--set");
  refuse_option(!options.metrics.empty(), "--metrics");
  refuse_option(!options.record.empty(), "--record");
  refuse_option(options.realtime, "--realtime");
  refuse_option(!options.checkpoints.empty(), "--checkpoint");
  refuse_option(options.report.wanted(), "--report");
  refuse_option(options.ctl.wanted && !options.ctl.folder.empty(), "--ctl");
  refuse_option(options.live.wanted(), "--live");
  refuse_option(options.ros2.wanted(), "--ros2");
}

int run_sim(const SimOptions& options) {
  refuse_wrong_mixtures(options);
  if (!options.from.empty()) return go_on(options);
  require_kind(options.scenario, JsonKind::scenario);
  if (const ScenarioConfig test = read_tested_scenario(options.scenario); !test.record.empty()) {
    refuse_simulation(options);
    return run_record_test(options, test);
  }
  SimRun sim(options, options);
  catch_interrupts();
  return sim.run();
}

}  // namespace

void add_sim(CommandLine& line) {
  const auto [sim, options] =
      line.add<SimOptions>("sim", "Run a scenario in simulation, as fast as the machine allows", run_sim);
  sim->add_option("scenario", options.scenario, "Scenario file (JSON)")->type_name("FILE");
  add_seed(*sim, options.seed, "Seed of all random numbers (default: the scenario's)");
  add_number(*sim, "--duration", options.duration_s, 0.001, scenario_duration_max_s, "S",
             "Seconds to simulate (default: the scenario's)");
  sim->add_option("--play", options.play, "Behaviors to play instead of the scenario's: \"squat, wave\"")
      ->type_name("LIST");
  sim->add_option("--set", options.set, "Change a quantity of the robot or its world, such as ground.friction=0.3")
      ->type_name("NAME=NUMBER")
      ->allow_extra_args(false);
  sim->add_option("--metrics", options.metrics, "Report the metrics of this plan of a sweep or tuning")
      ->type_name("FILE");
  CLI::Option* record =
      sim->add_option("--record", options.record, "File of the record (default: NAME.mcap in this folder)")
          ->type_name("FILE");
  sim->add_flag("--no-record", options.no_record, "Write no record")->excludes(record);
  add_record_options(*sim, options.recording);
  CLI::Option* realtime = sim->add_flag("--realtime", options.realtime, "Run at the pace of the wall clock");
  sim->add_flag("--watch", options.watch, "Reload behaviors when their files are saved")->needs(realtime);
  sim->add_option("--checkpoint", options.checkpoints, "Write a checkpoint at second S, from which --from continues")
      ->type_name("S=FILE")
      ->allow_extra_args(false);
  sim->add_option("--from", options.from, "Continue from a checkpoint; --set, --play and --push apply from there on")
      ->type_name("FILE");
  sim->add_flag("--allow-plugins", options.allow_plugins,
                "With --from: load the project's plug-ins, even if they differ from the checkpoint's");
  sim->add_option("--push", options.push, "With --from: push a link with this impulse in Ns, such as torso=0,2,0")
      ->type_name("LINK=X,Y,Z")
      ->allow_extra_args(false);
  sim->add_option("--branch", options.branches,
                  "With --from, once or more: \"NAME: push LINK=X,Y,Z; set NAME=NUMBER; play LIST\"")
      ->type_name("BRANCH")
      ->allow_extra_args(false);
  add_number(*sim, "--hash-every", options.hash_every_s, 0.001, scenario_duration_max_s, "S",
             "With --json: print the state hash every S seconds");
  add_report_options(*sim, options.report, "Write a page about the run, NAME-SEED.html, into a folder", "always");
  add_services(*sim, options);
  add_number(*sim, "--speed", options.speed, 0.01, 100.0, "X",
             "With --live or --ros2: speed as a multiple of the wall clock's");
  sim->add_flag("--json", options.json, "Print one JSON object instead of text");
  sim->add_flag("-v,--verbose", options.verbose, "Show what the behaviors log");
}

}  // namespace kadans
