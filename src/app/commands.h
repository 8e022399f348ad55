// The program's commands: add_ puts one on the command line; run_, after parsing, returns the program's exit code and
// throws InputError for a wrong file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/assembly/robot.h"
#include "app/run/run_choices.h"
#include "campaign/sweep/tuning_score.h"
#include "config/scenario/scenario_config.h"
#include "record_options.h"
#include "services.h"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct SimOptions : RunChoices, ServiceOptions {
  bool json = false, verbose = false, no_record = false, realtime = false, watch = false;
  std::string metrics;  // plan whose metrics are reported; "": none
  std::string record;   // "": NAME.mcap in the working directory
  RecordOptions recording;
  std::vector<std::string> checkpoints;  // "2.5=crouched.mcap"
  std::string from;                      // a checkpoint; settings and plays then count from there
  bool allow_plugins = false;            // with from: load the project's plug-ins, even if they differ
  std::vector<std::string> push;         // with from
  std::vector<std::string> branches;     // "hard: push torso=0,3,0"
  std::optional<double> hash_every_s;
  ReportOptions report;
  double speed = 1;  // with live or ros2: multiple of the wall clock's speed
};
void add_sim(CLI::App& app, SimOptions& options);
int run_sim(const SimOptions& options);

struct TestOptions {
  std::vector<std::string> selectors;  // files, folders, tags, names
  std::string folder;                  // where scenarios are searched; "": config/scenarios of the project
  unsigned jobs = 0;                   // 0: one for each core
  std::optional<std::uint32_t> repeat;
  std::optional<std::uint64_t> seed;
  bool fail_fast = false, rerun_failed = false, list = false, json = false;
  bool golden = false;        // state hashes must equal those of the golden file
  bool renew_golden = false;  // write them to the golden file instead
  std::string junit;
  ReportOptions report;
};
void add_test(CLI::App& app, TestOptions& options);
int run_test(const TestOptions& options);

struct CheckOptions {
  std::vector<std::string> files;
  std::string robot;                  // configuration against which behaviors are checked; "": the one for their folder
  bool plugins = false;               // load plug-ins
  bool strict = false;                // warnings are mistakes
  std::vector<std::string> packages;  // "NAME=FOLDER", where a URDF's meshes are
};
void add_check(CLI::App& app, CheckOptions& options);
int run_check(const CheckOptions& options);

struct RunOptions : ServiceOptions {
  std::string robot;
  std::string plant = "bullet";
  std::string peer;        // address of the drives; "": the robot's own
  std::string imu;         // serial port of the IMU beside them; "": the robot's own
  bool read_only = false;  // nothing is asked of the drives
  std::string play;        // a list; "": nothing plays, the robot holds
  std::string joystick;    // a device or a recording; "": the robot's own
  std::string record;      // "" = none
  RecordOptions recording;
  std::optional<double> duration_s;
  std::optional<std::uint64_t> seed;
  bool soft = false;          // also without the rights for real time
  bool virtual_time = false;  // the same threads; virtual time stands still while a thread is at work
  bool sleep_only = false;
  bool keep_awake = true;
  double spin_us = 0;  // 0: the default
  int cpu = -1;        // of the control thread; -1: an isolated one, else the last
  bool verbose = false;
  std::string log_file;  // "": none
  bool json = false;
  std::string behaviors = "thread", decisions;  // "thread" or "process"; "": decisions as behaviors
  double behaviors_patience_s = 0;              // time for the process to answer; 0: the default
  std::uint32_t behaviors_deaths = 0;           // deaths in a row before it stays down; 0: the default
  double behaviors_memory_MB = 256;             // beyond what the process has when it begins to play
};
void add_run(CLI::App& app, RunOptions& options);
int run_live(const RunOptions& options);
// The hidden command that run_live starts for behaviors in a process of their own. It uses robot, play and seed.
void add_behavior_process(CLI::App& app, RunOptions& options);
int run_behavior_process(const RunOptions& options);

struct PlantOptions {
  std::string robot;                // or a scenario
  std::vector<std::string> listen;  // for each robot
  std::string imu;                  // link to the IMU's terminal; "": none is served
  std::string plant, as = "udp";    // plant types: of the served model ("": as the file says), of the protocol
  std::optional<std::uint64_t> seed;
  bool soft = false;                // also without the rights for real time
  bool once = false;                // ends with the first session
  std::vector<std::string> faults;  // "KIND:OF@FROM+FOR=SIZE"
  bool in_step = false;             // time passes with the peer's ticks
  int cpu = -1;                     // -1: the CPU that `kadans run` takes
  bool json = false;
};
void add_plant(CLI::App& app, PlantOptions& options);
int run_plant(const PlantOptions& options);

struct JitterOptions {
  double seconds = 60;  // of our own samples; cyclictest takes the same time again
  bool load = false;
  bool sleep_only = false;
  bool keep_awake = true;
  bool json = false;
  int cpu = -1;  // -1: the CPU that `kadans run` takes
  int priority = 90;
  double spin_us = 0;  // 0: the default of `kadans run`
  std::string svg;     // "" = none
};
void add_jitter(CLI::App& app, JitterOptions& options);
int run_jitter(const JitterOptions& options);

struct JogOptions {
  std::string robot, joint;
  std::string plant = "bullet";
  std::string peer;          // address of the drives; "": the robot's own
  std::string imu;           // serial port of the IMU beside them; "": the robot's own
  double share = 0.1;        // of the joint's greatest torque
  double speed_rad_s = 0.5;  // at which none is left
};
void add_jog(CLI::App& app, JogOptions& options);
int run_jog(const JogOptions& options);

struct CommissionOptions {
  std::string robot;
  std::string plant;  // "": the only type with wiring that the robot's configuration has
  std::string peer;   // address of the drives; "": the robot's own
  double share = 0.1;
  std::vector<std::string> steps;  // none: all
  std::vector<std::string> joints;
  std::string answers;  // file of lines; "": the terminal, or lines of the standard input
  bool again = false;
};
void add_commission(CLI::App& app, CommissionOptions& options);
int run_commission(const CommissionOptions& options);

// The bench of servos: each of its commands is one of `kadans dynamixel`.
struct DynamixelOptions {
  std::string device;
  std::uint32_t baud = 0;  // 0: scan looks at all, the others take 1000000
  std::uint32_t id = 1, new_id = 1, new_baud = 1'000'000;
  bool json = false;
};
void add_dynamixel(CLI::App& app, DynamixelOptions& options);
int run_dynamixel(const CLI::App& app, const DynamixelOptions& options);

struct DoctorOptions {
  std::string robot;       // "": of the machine alone
  std::string root = "/";  // root folder of the machine that is examined
  bool json = false;
};
void add_doctor(CLI::App& app, DoctorOptions& options);
int run_doctor(const DoctorOptions& options);

// The hidden command by which a build writes what is made from the program's own tables: man pages, completion, editor
// stubs and the pages of reference of the manual.
struct ReferenceOptions {
  std::string folder;
};
void add_reference(CLI::App& app, ReferenceOptions& options);
int run_reference(const CLI::App& app, const ReferenceOptions& options);

// `kadans replay`: runs a record again, with the files on the disk or inside it, and compares every recorded signal in
// every tick, bit for bit. It prints that all is the same, or where the runs differ and which inputs changed.
struct ReplayOptions {
  std::string record;
  bool from_record = false, allow_plugins = false, json = false;  // the first: its files, not those on the disk
  std::vector<std::string> with;                                  // files that take the place of the record's
  std::string then_simulate;  // a scenario in which a run on threads goes on; "": none
  double at_s = 0;            // when
  std::string written;        // record of what the repetition of a run on threads computes; "": none
};
void add_replay(CLI::App& app, ReplayOptions& options);
// Returns 0 when everything is the same, else 1. Throws InputError when the record cannot be run again.
int run_replay(const ReplayOptions& options);

// `kadans debug`: serves the Debug Adapter Protocol for a simulation or the repetition of a record (docs/debugging.md).
struct DebugOptions {
  std::string file;         // scenario or record; "": the client names it
  std::optional<int> port;  // of this machine, for one client; nullopt: stdin and stdout
  double memory_MB = 1024;  // of all processes of the run
  bool from_record = false, allow_plugins = false;
};
void add_debug(CLI::App& app, DebugOptions& options);
int run_debug(const DebugOptions& options);

// `kadans sweep` runs the cases of a plan, each in a process of its own. `kadans merge` makes one table of the results
// of several sweeps of the same plan.
struct SweepOptions {
  std::string plan;
  std::optional<std::uint32_t> cases;
  std::optional<std::uint64_t> seed;
  unsigned jobs = 0;  // 0: one for each core
  std::string shard;  // "0/4"; "": the shard of a Slurm array, else all cases
  std::string out;    // "": sweeps/NAME-HASH in the working directory
  bool json = false;
};
void add_sweep(CLI::App& app, SweepOptions& options);
int run_sweep(const SweepOptions& options);

struct MergeOptions {
  std::vector<std::string> folders;
  std::string sqlite, csv, heat_map;  // files, or ""
  std::string x, y, metric;           // of the heat map; "": the plan's
  bool json = false;
};
void add_merge(CLI::App& app, MergeOptions& options);
int run_merge(const MergeOptions& options);

// `kadans margin`: how far quantities may go from their nominal values until a scenario of the robot fails, by
// bisection over the same seeds.
struct MarginOptions {
  std::string robot;
  std::vector<std::string> scenarios;   // files, folders, tags, names; none: those with the tag "margin"
  std::vector<std::string> quantities;  // "delay", "ground.friction=0.02"; none: the usual ones
  std::uint32_t seeds = 8;
  std::uint64_t seed = 1;
  unsigned jobs = 0;  // 0: one for each core
  std::string out;    // "": margins in the working directory
  bool json = false;
};
void add_margin(CLI::App& app, MarginOptions& options);
int run_margin(const MarginOptions& options);

// `kadans shrink`: the least with which a scenario, or a case of a sweep, still fails in the same way.
struct ShrinkOptions : RunChoices {     // `scenario` may also be the results of a sweep, or one of them
  std::string check;                    // that shall fail; "": the first that does
  std::optional<std::uint32_t> number;  // of the sweep's case
  std::uint32_t runs_max = 2000;
  unsigned jobs = 0;  // 0: one for each core
  std::string out;    // "": NAME_shrunk.json
  bool overwrite = false;
  bool json = false;
};
void add_shrink(CLI::App& app, ShrinkOptions& options);
int run_shrink(const ShrinkOptions& options);

// Checks a plan beyond its fields: patterns, ranges, signals. Throws InputError with all mistakes. Returns a
// description of the plan.
std::string check_sweep_plan(const std::string& file, const PluginGate& gate);

// `kadans tune`: searches the parameters with which the scenarios have the best score. The search is a separate
// program, kadans-tune, beside this one, because its library takes longer to load than a short run takes.
struct TuneOptions {
  std::string plan;
  std::optional<std::uint64_t> seed;
  std::optional<std::uint32_t> generations, runs;
  unsigned jobs = 0;
  std::string shard;
  double wait_s = 600;  // time to wait for the other shards' part of a generation
  std::string out;      // folder; "": tunings/NAME-HASH
  std::string write;    // file; "": robot.json in that folder
  bool overwrite = false;
  bool json = false;
};
void add_tune(CLI::App& app, TuneOptions& options);

// Replaces this process by kadans-tune with the same arguments. Throws InputError when that fails.
int start_tune_program(char** argv);

// The robot of all scenarios of the plan. Throws InputError when they have different robots.
Robot tuned_robot(const TunePlan& plan, const PluginGate& gate = {});
// The parameters of the robot that the plan tunes. Throws InputError for a pattern that chooses nothing, for a range
// outside a parameter's range, and for a start outside the range.
std::vector<TunedAxis> tuned_axes(const TunePlan& plan, const Robot& robot);

// Checks a plan beyond its fields. Throws InputError with all mistakes. Returns a description of the plan.
std::string check_tune_plan(const std::string& file, const PluginGate& gate);

// `kadans behavior check | graph | test`: commands for the author of a behavior, before it moves a robot.
struct BehaviorOptions {
  std::vector<std::string> files;
  std::string robot;               // configuration; "": the one for the behavior's folder
  std::string format = "mermaid";  // format of the graph: mermaid, dot or svg
  std::string only;                // run only tests whose names contain this
  std::string junit;
  bool json = false;
  bool plugins = false;  // check loads plug-ins
};
void add_behavior(CLI::App& app, BehaviorOptions& options);
int run_behavior(const CLI::App& app, const BehaviorOptions& options);

// `kadans repl`: a console in a simulation. On a terminal the simulation runs at the pace of the wall clock meanwhile.
// From a pipe time passes only by `:run`, so the output is repeatable.
struct ReplOptions {
  std::string scenario;  // "": the project's only robot, and nothing plays
  std::string play;      // replaces the scenario's list
  std::optional<std::uint64_t> seed;
  double speed = 1;  // on a terminal: simulated seconds per second; 0: time passes only by :run
};
void add_repl(CLI::App& app, ReplOptions& options);
int run_repl(const ReplOptions& options);

// `kadans lua-stubs` and `kadans params`: show the tables of a robot and of a behavior, for editors and for people.
struct StubsOptions {
  std::string robot, output = ".";
  bool markdown = false;
};
void add_stubs(CLI::App& app, StubsOptions& options);
int run_stubs(const StubsOptions& options);

struct ParamsOptions {
  std::string file, robot;
  bool json = false;
};
void add_params(CLI::App& app, ParamsOptions& options);
int run_params(const ParamsOptions& options);

// `kadans ctl`: talks to a running instance.
struct CtlOptions {
  std::string socket;  // "": the usual places
  std::string host;    // "": this computer
  bool json = false;
  bool names = false;                                                               // list only the names
  std::optional<long> count;                                                        // of samples; nullopt: until Ctrl-C
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> given{};  // by verb and argument
};
void add_ctl(CLI::App& app, CtlOptions& options);
// `words` are those of the whole command line.
int run_ctl(const CLI::App& app, const CtlOptions& options, const std::vector<std::string>& words);

// `kadans push`: brings a robot's files to its computer.
struct PushOptions {
  std::string host;
  std::string robot;           // its configuration; "": the only one of the project
  std::string folder, socket;  // on the other computer; "": the usual ones
  bool undo = false, tested = false, check = false;
};
void add_push(CLI::App& app, PushOptions& options);
int run_push(const PushOptions& options);

// `kadans receive`: what `push` starts there.
struct ReceiveOptions {
  std::string robot;  // its name
  std::string folder, socket;
  bool undo = false, check = false;
};
void add_receive(CLI::App& app, ReceiveOptions& options);
int run_receive(const ReceiveOptions& options);

struct CompletionOptions {
  std::string shell;  // "bash" or "zsh"
};
void add_completion(CLI::App& app, CompletionOptions& options);
std::string completion_script(const CLI::App& app, const std::string& shell);
int run_completion(const CLI::App& app, const CompletionOptions& options);

// `kadans view` shows a record in the web page; `kadans render` makes pictures of it.
struct ViewOptions {
  std::string record;
  LiveServiceOptions live;
};
void add_view(CLI::App& app, ViewOptions& options);
// Serves the record until SIGINT or SIGTERM.
int run_view(const ViewOptions& options);

struct RenderOptions {
  std::string record;
  std::optional<double> at_s, every_s;
  bool film = false;
  int frames_per_s = 20;
  std::string out;  // file, or a folder with every_s; "": named as the record, in the working directory
  std::string theme = "light", size = "960x720";
};
void add_render(CLI::App& app, RenderOptions& options);
int run_render(const RenderOptions& options);

// `kadans log`: shows what is in a record, without running anything.
struct LogOptions {
  std::string file, other;           // other: the second record of diff
  std::vector<std::string> signals;  // names or patterns
  std::vector<std::string> topics;
  std::optional<double> from_s, to_s, every_s;
  std::string out;
  double tolerance = 0;
  bool json = false;
  bool force = false, inputs = false;  // replaces an existing output file; a cut can be repeated
};
void add_log(CLI::App& app, LogOptions& options);
int run_log(const CLI::App& app, const LogOptions& options);

}  // namespace kadans
