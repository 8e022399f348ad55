// The program's commands. Each returns the program's exit code and throws InputError for a wrong file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/ctl/ctl_service.h"
#include "app/live/live_service.h"
#include "app/ros2/ros2_service.h"
#include "app/run/run_request.h"
#include "record_options.h"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct SimOptions : RunRequest {
  bool json = false;
  bool verbose = false;
  bool no_record = false;
  bool realtime = false;
  bool watch = false;
  std::string metrics;  // plan whose metrics are reported; "": none
  std::string record;   // "": NAME.mcap in the working directory
  RecordOptions recording;
  std::vector<std::string> checkpoints;  // "2.5=crouched.mcap"
  std::string from;                      // a checkpoint; settings and plays then count from there
  bool allow_plugins = false;            // with from: load the project's plug-ins, even if they differ
  std::vector<std::string> push;         // with from
  std::vector<std::string> branches;     // "hard: push torso=0,3,0"
  std::optional<double> hash_every_s;
  CtlServiceOptions ctl;  // always with realtime, else when a folder is named
  LiveServiceOptions live;
  ReportOptions report;
  Ros2Options ros2;
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
  bool fail_fast = false;
  bool rerun_failed = false;
  bool list = false;
  bool json = false;
  bool golden = false;        // state hashes must equal those of the golden file
  bool renew_golden = false;  // write them to the golden file instead
  std::string junit;
  ReportOptions report;
};
void add_test(CLI::App& app, TestOptions& options);
int run_test(const TestOptions& options);

struct CheckOptions {
  std::vector<std::string> files;
  std::string robot;     // configuration against which behaviors are checked; "": the one for their folder
  bool plugins = false;  // load plug-ins
};
void add_check(CLI::App& app, CheckOptions& options);
int run_check(const CheckOptions& options);

struct RunOptions {
  std::string robot;
  std::string plant = "bullet";
  std::string peer;      // address of the drives; "": the robot's own
  std::string play;      // a list; "": nothing plays, the robot holds
  std::string joystick;  // a device or a recording; "": the robot's own
  std::string record;    // "" = none
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
  std::string behaviors = "thread";    // where behaviors play: "thread" or "process"
  double behaviors_patience_s = 0;     // time for the process to answer; 0: the default
  std::uint32_t behaviors_deaths = 0;  // deaths in a row before it stays down; 0: the default
  double behaviors_memory_MB = 256;    // beyond what the process has when it begins to play
  CtlServiceOptions ctl;               // on virtual time only when a folder is named
  LiveServiceOptions live;
  Ros2Options ros2;
};
void add_run(CLI::App& app, RunOptions& options);
int run_live(const RunOptions& options);
// The hidden command that run_live starts for behaviors in a process of their own. It uses robot, play and seed.
void add_behavior_process(CLI::App& app, RunOptions& options);
int run_behavior_process(const RunOptions& options);

struct PlantOptions {
  std::string robot;
  std::string listen;
  std::string plant = "bullet", as = "udp";  // plant types: of the served model, of the protocol
  std::uint64_t seed = 1;
  bool soft = false;  // also without the rights for real time
  bool once = false;  // ends with the first session
  int cpu = -1;       // -1: the CPU that `kadans run` takes
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

struct DoctorOptions {
  std::string root = "/";  // root folder of the machine that is examined
  bool json = false;
};
void add_doctor(CLI::App& app, DoctorOptions& options);
int run_doctor(const DoctorOptions& options);

struct NewControlObjectOptions {
  std::string name;
  std::string folder = ".";  // the object's folder is made in this folder
  bool plugin = false;
};
void add_new(CLI::App& app, NewControlObjectOptions& options);
int run_new_control_object(const NewControlObjectOptions& options);

}  // namespace kadans
