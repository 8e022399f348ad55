#include "kadans/app/program.h"

#include <exception>

#include <CLI/CLI.hpp>

#include "behavior_command.h"
#include "commands.h"
#include "ctl/ctl_command.h"
#include "kadans/signal/nearest_name.h"
#include "live/page_commands.h"
#include "log/log_command.h"
#include "repl_command.h"
#include "replay_command.h"
#include "stubs_command.h"
#include "sweep_command.h"
#include "terminal.h"
#include "tune_command.h"
#include "version.h"

namespace kadans {
namespace {

constexpr const char* about =
    "Kadans: a scriptable control runtime for robots.\n"
    "A 1 kHz core executes compiled control objects; behaviors in Lua tell them what to do.\n";

constexpr const char* examples =
    "Examples:\n"
    "  kadans sim config/scenarios/squat.json             run a scenario, read what happened\n"
    "  kadans sim config/scenarios/squat.json --json      the same as one JSON object\n"
    "  kadans test push --jobs 2                          run all scenarios tagged push, two at a time\n"
    "  kadans replay squat.mcap                           run a record again; where does it part, and since what "
    "change\n"
    "  kadans repl config/scenarios/squat.json            look into a simulation, and command it\n"
    "  kadans run config/tulip/robot.json --play squat    drive the robot, or its model, on the wall clock\n"
    "  kadans view squat.mcap                             show a record in the browser: robot, plots, states\n"
    "  kadans log info squat.mcap                         what a record holds; also cat, csv, plot, diff, cut\n"
    "  kadans ctl status                                  how a running robot is; 'kadans ctl --help' lists the rest\n"
    "  kadans check behaviors/tulip/squat.lua             say what is wrong in a file, without running it\n"
    "  kadans new control-object knee_damper              write a control object with its test, ready to build\n"
    "\n"
    "Results go to stdout, progress and errors to stderr.\n"
    "Exit codes: 0 passed, 1 failed, 2 wrong usage or input, 3 internal error, 130 interrupted.\n";

void add_test(CLI::App& app, TestOptions& options) {
  CLI::App* test = app.add_subcommand("test", "Run scenarios side by side and say which failed, and how");
  test->add_option("selectors", options.selectors, "Files, folders, tags, or names of scenarios (default: all)")
      ->type_name("PATH|TAG|NAME...");
  test->add_option("--in", options.folder, "Folder of scenarios (default: config/scenarios)")->type_name("FOLDER");
  test->add_option("-j,--jobs", options.jobs, "Runs at the same time (default: one a core)")
      ->check(CLI::Range(1, 1024));
  test->add_option("--repeat", options.repeat, "Runs of each scenario, each with the next seed")
      ->check(CLI::Range(1, 1'000'000));
  test->add_option("--seed", options.seed, "First seed (default: each scenario's)")->type_name("N");
  test->add_flag("--fail-fast", options.fail_fast, "Stop at the first failure");
  test->add_flag("--rerun-failed", options.rerun_failed, "Only what failed the last time");
  test->add_flag("--list", options.list, "Say what would run");
  CLI::Option* golden =
      test->add_flag("--golden", options.golden, "Fail what ends in another state than FOLDER.golden.json says");
  CLI::Option* renew = test->add_flag("--renew-golden", options.renew_golden,
                                      "Write the states into that file, and say what that changes");
  renew->excludes(golden)->excludes(test->get_option("--seed"))->excludes(test->get_option("--repeat"));
  test->add_option("--junit", options.junit, "Write the results as JUnit XML")->type_name("FILE");
  add_report_place(*test, options.report, "Leave a page about each run in a folder, and index.html about all",
                   "failed");
  test->add_flag("--json", options.json, "Print one JSON object a run instead of text");
}

void add_check(CLI::App& app, CheckOptions& options) {
  CLI::App* check = app.add_subcommand("check", "Say what is wrong in files, without running them");
  check->add_option("files", options.files, "URDF, robot or scenario configuration (JSON), behavior (Lua)")
      ->required()
      ->type_name("FILE...");
  check->add_option("--robot", options.robot, "Robot that behaviors are checked against (default: by their folder)")
      ->type_name("FILE");
}

void add_run(CLI::App& app, RunOptions& options) {
  CLI::App* run =
      app.add_subcommand("run", "Drive a robot, or a model of it, on the wall clock until SIGINT or SIGTERM");
  run->add_option("robot", options.robot, "The robot's configuration (JSON)")->required()->type_name("FILE");
  run->add_option("--plant", options.plant, "What is driven: bullet (default), ideal, or udp: another machine's")
      ->check(CLI::IsMember({"bullet", "ideal", "udp"}));
  run->add_option("--peer", options.peer, "Where `kadans plant` runs (default: the configuration's plant.udp.peer)")
      ->type_name("HOST:PORT");
  run->add_option("--play", options.play, "What to play: \"squat, wave\" (default: nothing, the robot holds)")
      ->type_name("LIST");
  run->add_option("--joystick", options.joystick,
                  "/dev/input/event5, or a recording of one, for s.joystick of behaviors")
      ->type_name("FILE");
  run->add_option("--duration", options.duration_s, "Seconds to run (default: until it is told to stop)")
      ->type_name("S")
      ->check(CLI::Range(0.001, 1e9));
  run->add_option("--record", options.record, "Write a record (default: none)")->type_name("FILE");
  add_record_options(*run, options.recording);
  run->add_option("--seed", options.seed, "Seed of a model's noise (default: 1)")->type_name("N");
  run->add_flag("--soft", options.soft, "Go on without the rights that real time needs");
  run->add_flag("--threads-on-virtual-time", options.virtual_time,
                "The same threads, but time waits for all of them: as fast or slow as the machine is");
  CLI::Option* sleep = run->add_flag("--sleep-only", options.sleep_only, "Sleep to the end, without spinning");
  run->add_option("--spin-us", options.spin_us, "How long to spin after sleeping")
      ->type_name("US")
      ->check(CLI::Range(1.0, 900.0))
      ->excludes(sleep);
  run->add_flag("!--no-keep-awake", options.keep_awake, "Let the control thread's CPU idle between the ticks");
  run->add_option("--cpu", options.cpu, "CPU of the control thread (default: an isolated one, else the last)")
      ->type_name("N")
      ->check(CLI::Range(0, 1023));
  run->add_option("--behaviors", options.behaviors,
                  "Where behaviors play: in a thread (default), or in a process of their own that may die")
      ->check(CLI::IsMember({"thread", "process"}));
  run->add_option("--behaviors-patience", options.behaviors_patience_s,
                  "How long their process may be silent before it is killed (default: 0.3; on virtual time 10)")
      ->type_name("S")
      ->check(CLI::Range(0.01, 1000.0));
  run->add_option("--behaviors-deaths", options.behaviors_deaths,
                  "After how many deaths in a row their process stays down (default: 8)")
      ->type_name("N")
      ->check(CLI::Range(1, 1'000'000'000));
  run->add_option("--behaviors-memory", options.behaviors_memory_MB,
                  "What their process may take while it plays, above what it has then (default: 256)")
      ->type_name("MB")
      ->check(CLI::Range(1.0, 1e6));
  add_ctl_place(*run, options.ctl);
  add_live_place(*run, options.live);
  add_ros2_place(*run, options.ros2);
  run->add_flag("--json", options.json, "End with one JSON object on a line of its own");
  run->add_flag("-v,--verbose", options.verbose, "Show what the behaviors log, and their transitions");
}

// Not for people: `run` starts it.
void add_behavior_process(CLI::App& app, RunOptions& options) {
  CLI::App* process = app.add_subcommand("behavior-process", "")->group("");
  process->add_option("robot", options.robot)->required();
  process->add_option("--play", options.play);
  process->add_option("--seed", options.seed);
}

void add_jitter(CLI::App& app, JitterOptions& options) {
  CLI::App* jitter = app.add_subcommand("jitter", "Measure how punctual this machine is, beside cyclictest");
  jitter->add_option("--seconds", options.seconds, "Seconds of samples at 1 kHz (default: 60)")
      ->type_name("S")
      ->check(CLI::Range(0.1, 1000.0));
  jitter->add_flag("--load", options.load, "While other processes compute, fill memory, write, switch, set timers");
  CLI::Option* sleep = jitter->add_flag("--sleep-only", options.sleep_only, "Sleep to the end, without spinning");
  jitter->add_option("--spin-us", options.spin_us, "How long to spin after sleeping")
      ->type_name("US")
      ->check(CLI::Range(1.0, 900.0))
      ->excludes(sleep);
  jitter->add_flag("!--no-keep-awake", options.keep_awake, "Let the CPU idle between the beats");
  jitter->add_option("--cpu", options.cpu, "CPU to measure on (default: an isolated one, else the last)")
      ->type_name("N")
      ->check(CLI::Range(0, 1023));
  jitter->add_option("--priority", options.priority, "Of SCHED_FIFO (default: 90)")
      ->type_name("N")
      ->check(CLI::Range(1, 99));
  jitter->add_option("--svg", options.svg, "Draw the histogram into a file")->type_name("FILE");
  jitter->add_flag("--json", options.json, "End with one JSON object on a line of its own");
}

void add_doctor(CLI::App& app, DoctorOptions& options) {
  CLI::App* doctor = app.add_subcommand("doctor", "Say what of this machine is in the way of real time");
  doctor->add_option("--root", options.root, "Folder that stands for / (default: /)")->type_name("FOLDER");
  doctor->add_flag("--json", options.json, "Print one JSON object instead of text");
}

void add_new(CLI::App& app, NewControlObjectOptions& options) {
  CLI::App* made = app.add_subcommand("new", "Write a first version of something of your own");
  made->require_subcommand(1);
  CLI::App* object = made->add_subcommand("control-object", "A control object: source, test and what builds them");
  object->add_option("name", options.name, "Its type's name, for example knee_damper")->required()->type_name("NAME");
  object->add_option("--in", options.folder, "Folder in which its own folder is made (default: here)")
      ->type_name("FOLDER");
  object->add_flag("--plugin", options.plugin, "As a plug-in instead of a program of its own");
}

// "kadans smi", "kadans ctl stauts": the word that was meant.
std::string hint(const CLI::App& app, int argc, char** argv, const std::string& before = {}) {
  int at = 1;
  while (at < argc && argv[at][0] == '-') at += std::string_view(argv[at]) == "--socket" ? 2 : 1;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (at < argc && command->get_name() == argv[at])
      return hint(*command, argc - at, argv + at, before + command->get_name() + " ");
    names.push_back(command->get_name());
  }
  if (at >= argc || names.empty()) return {};
  return "unknown command '" + before + argv[at] + "'" + did_you_mean(argv[at], names);
}

int run(int argc, char** argv) {
  CLI::App app(about, "kadans");
  app.footer(examples);
  app.set_version_flag("--version", std::string("kadans ") + version);
  app.require_subcommand(1);
  SimOptions sim;
  CheckOptions check;
  add_sim(app, sim);
  TestOptions test;
  add_test(app, test);
  ReplayOptions replay;
  add_replay(app, replay);
  add_check(app, check);
  SweepOptions sweep;
  add_sweep(app, sweep);
  MergeOptions merge;
  add_merge(app, merge);
  TuneOptions tune;
  add_tune(app, tune);
  BehaviorOptions behavior;
  add_behavior(app, behavior);
  ReplOptions repl;
  add_repl(app, repl);
  StubsOptions stubs;
  add_stubs(app, stubs);
  ParamsOptions params;
  add_params(app, params);
  RunOptions live;
  add_run(app, live);
  RunOptions played;
  add_behavior_process(app, played);
  PlantOptions plant;
  add_plant(app, plant);
  JitterOptions jitter;
  add_jitter(app, jitter);
  CtlOptions ctl;
  add_ctl(app, ctl);
  CompletionOptions completion;
  add_completion(app, completion);
  ViewOptions view;
  add_view(app, view);
  RenderOptions render;
  add_render(app, render);
  LogOptions log;
  add_log(app, log);
  DoctorOptions doctor;
  add_doctor(app, doctor);
  NewControlObjectOptions new_object;
  add_new(app, new_object);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const std::string meant = hint(app, argc, argv);
    print_error(meant.empty() ? error.what() : meant);
    std::fprintf(stderr, "Run 'kadans --help' or 'kadans COMMAND --help'.\n");
    return exit_usage;
  }
  if (app.got_subcommand("test")) return run_test(test);
  if (app.got_subcommand("run")) return run_live(live);
  if (app.got_subcommand("behavior-process")) return run_behavior_process(played);
  if (app.got_subcommand("plant")) return run_plant(plant);
  if (app.got_subcommand("jitter")) return run_jitter(jitter);
  if (app.got_subcommand("ctl")) return run_ctl(app, ctl);
  if (app.got_subcommand("completion")) return run_completion(app, completion);
  if (app.got_subcommand("view")) return run_view(view);
  if (app.got_subcommand("render")) return run_render(render);
  if (app.got_subcommand("log")) return run_log(app, log);
  if (app.got_subcommand("doctor")) return run_doctor(doctor);
  if (app.got_subcommand("replay")) return run_replay(replay);
  if (app.got_subcommand("sweep")) return run_sweep(sweep);
  if (app.got_subcommand("merge")) return run_merge(merge);
  if (app.got_subcommand("tune")) return start_tune_program(argv);
  if (app.got_subcommand("new")) return run_new_control_object(new_object);
  if (app.got_subcommand("repl")) return run_repl(repl);
  if (app.got_subcommand("lua-stubs")) return run_stubs(stubs);
  if (app.got_subcommand("params")) return run_params(params);
  if (app.got_subcommand("behavior")) return run_behavior(app, behavior);
  return app.got_subcommand("sim") ? run_sim(sim) : run_check(check);
}

}  // namespace

int run_program(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const InputError& error) {
    print_problems(error);
    return exit_usage;
  } catch (const std::exception& error) {
    print_error(std::string("internal: ") + error.what());
    return exit_internal;
  }
}

}  // namespace kadans
