#include "kadans/app/program.h"

#include <algorithm>
#include <cstdio>

#include <fcntl.h>
#include <unistd.h>

#include "app/run/real_time_start.h"
#include "command_line.h"
#include "commands.h"
#include "kadans/plant/plant_type.h"
#include "kadans/signal/nearest_name.h"
#include "option_checks.h"
#include "terminal.h"
#include "version.h"

namespace kadans {
namespace {

// " bullet, the robot's model ...; udp, a plant on another machine"
std::string plant_type_docs() {
  std::string docs;
  for (const auto& type : plant_types()) {
    docs += docs.empty() ? " " : "; ";
    docs += std::string(type->name()) + ", " + std::string(type->doc());
  }
  return docs;
}

}  // namespace

void add_run(CLI::App& app, RunOptions& options) {
  CLI::App* run =
      app.add_subcommand("run", "Drive a robot, or a model of it, on the wall clock until SIGINT or SIGTERM");
  run->add_option("robot", options.robot, "The robot's configuration (JSON)")->required()->type_name("FILE");
  run->add_option("--plant", options.plant,
                  "Plant to drive (default: bullet):" + plant_type_docs() + "; or a plug-in's")
      ->type_name("TYPE");
  run->add_option("--peer", options.peer, "Address of the drives, or of `kadans plant` (default: the configuration's)")
      ->type_name("HOST:PORT");
  run->add_option("--imu", options.imu, "Serial port of the IMU beside the drives (default: the configuration's)")
      ->type_name("FILE");
  run->add_flag("--read-only", options.read_only, "Read every sensor, and ask nothing of the drives: none is enabled");
  run->add_option("--play", options.play,
                  "Behaviors to play: \"squat, wave\" (default: none, the robot holds its position)")
      ->type_name("LIST");
  run->add_option(
         "--joystick", options.joystick,
         "Joystick that behaviors read as s.joystick: a device such as /dev/input/event5, or a recording of one")
      ->type_name("FILE");
  add_number(*run, "--duration", options.duration_s, 0.001, 1e9, "S",
             "Seconds to run (default: until SIGINT or SIGTERM)");
  run->add_option("--record", options.record,
                  "Write a record to this file, or to numbered files in this folder (default: none)")
      ->type_name("PATH");
  add_record_options(*run, options.recording);
  add_number(*run, "--records-max", options.recording.folder_MB, 0.0, 1e7, "MB",
             "Room for numbered records and those of the flight recorder; the oldest go (default: the robot's "
             "record.folder_MB; 0: no bound)");
  add_seed(*run, options.seed, "Seed of a model's random numbers (default: 1)");
  run->add_flag("--soft", options.soft, "Run even without the rights that real time needs");
  run->add_flag("--threads-on-virtual-time", options.virtual_time,
                "Run the same threads on virtual time, which waits for all of them");
  CLI::Option* sleep = run->add_flag("--sleep-only", options.sleep_only, "Sleep until the next tick, without spinning");
  add_number(*run, "--spin-us", options.spin_us, 1.0, 900.0, "US", "Time to spin after sleeping")->excludes(sleep);
  run->add_flag("!--no-keep-awake", options.keep_awake, "Let the control thread's CPU idle between the ticks");
  add_whole(*run, "--cpu", options.cpu, 0, 1023, "CPU of the control thread (default: an isolated one, else the last)");
  run->add_option("--behaviors", options.behaviors,
                  "Play behaviors in a thread (default), or in a process of their own, which may die")
      ->check(CLI::IsMember({"thread", "process"}));
  run->add_option(
         "--decisions", options.decisions,
         "Run the supervisor's decisions in its thread, or in a process of their own (default: as --behaviors)")
      ->check(CLI::IsMember({"thread", "process"}));
  add_number(*run, "--behaviors-patience", options.behaviors_patience_s, 0.01, 1000.0, "S",
             "Time without an answer after which such a process is killed (default: 0.3; on virtual time 10)");
  add_whole(*run, "--behaviors-deaths", options.behaviors_deaths, 1, 1'000'000'000,
            "Deaths in a row after which such a process is not started again (default: 8)");
  add_number(*run, "--behaviors-memory", options.behaviors_memory_MB, 1.0, 1e6, "MB",
             "Memory that such a process may take in addition to what it has when it begins to play (default: 256)");
  add_services(*run, options);
  run->add_flag("--json", options.json, "Print one JSON object instead of text");
  run->add_flag("-v,--verbose", options.verbose, "Show what the behaviors log and their transitions");
  run->add_option("--log-file", options.log_file, "Append all log lines to this file, transitions too (default: none)")
      ->type_name("FILE");
}

// A hidden command that `run` starts, under another name for each process, for those who list processes.
void add_behavior_process(CLI::App& app, RunOptions& options) {
  CLI::App* process = app.add_subcommand("behavior-process", "")->alias("decision-process")->group("");
  process->add_option("robot", options.robot)->required();
  process->add_option("--play", options.play);
  process->add_option("--seed", options.seed)->check(any_seed());
}

namespace {

// The hint for a wrong option such as "--sed 1".
std::string unknown_option(const CLI::App& command, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::App* app = &command; app != nullptr; app = app->get_parent()) {
    for (const CLI::Option* option : app->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  }
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const std::string name = word.substr(0, word.find('='));
    if (!name.starts_with("--") || name == "--" || std::ranges::find(names, name) != names.end()) continue;
    return command.get_name() + " has no option '" + name + "'" + did_you_mean(name, names);
  }
  return {};
}

// The hint for a wrong word such as "kadans smi" or "kadans ctl stauts".
std::string hint(const CLI::App& app, int argc, char** argv, const std::string& before = {}) {
  int at = 1;
  while (at < argc && argv[at][0] == '-') {
    const std::string_view word = argv[at];
    at += word == "--socket" || word == "--host" ? 2 : 1;
  }
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (at < argc && command->get_name() == argv[at])
      return hint(*command, argc - at, argv + at, before + command->get_name() + " ");
    names.push_back(command->get_name());
  }
  if (names.empty()) return unknown_option(app, argc, argv);
  if (at >= argc) return {};
  return "unknown command '" + before + argv[at] + "'" + did_you_mean(argv[at], names);
}

int run(int argc, char** argv) {
  CommandLine line;
  CLI::App& app = line.app;
  app.set_version_flag("--version", std::string("kadans ") + version);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const std::string meant = hint(app, argc, argv);
    print_error(meant.empty() ? error.what() : meant);
    std::fprintf(stderr, "Run 'kadans --help' or 'kadans COMMAND --help'.\n");
    return exit_usage;
  }
  if (app.got_subcommand("run") || app.got_subcommand("plant") || app.got_subcommand("jitter")) bind_all_functions();
  return line.run({argv, static_cast<std::size_t>(argc)});
}

// Else the first files that are opened would get the numbers of those that are closed, and a record what is printed.
// What is done with them still fails.
void keep_standard_numbers() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(number, F_GETFD) < 0) (void)open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

}  // namespace

int run_program(int argc, char** argv) {
  keep_standard_numbers();
  return ended_well([&] { return run(argc, argv); });
}

}  // namespace kadans
