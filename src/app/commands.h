// The program's commands: each puts itself on the command line. Here are also the options that files of several folders
// know; the others are beside what reads them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/run/run_choices.h"
#include "command_line.h"
#include "config/scenario/scenario_config.h"
#include "record_options.h"
#include "services.h"

namespace kadans {

void add_sim(CommandLine& line);
void add_test(CommandLine& line);
void add_replay(CommandLine& line);
void add_debug(CommandLine& line);
void add_check(CommandLine& line);
void add_sweep(CommandLine& line);
void add_merge(CommandLine& line);
void add_margin(CommandLine& line);
void add_shrink(CommandLine& line);
void add_tune(CommandLine& line);
void add_behavior(CommandLine& line);
void add_repl(CommandLine& line);
void add_stubs(CommandLine& line);
void add_params(CommandLine& line);
void add_run(CommandLine& line);
void add_behavior_process(CommandLine& line);  // hidden: what `run` starts
void add_plant(CommandLine& line);
void add_jog(CommandLine& line);
void add_commission(CommandLine& line);
void add_dynamixel(CommandLine& line);
void add_jitter(CommandLine& line);
void add_ctl(CommandLine& line);
void add_push(CommandLine& line);
void add_receive(CommandLine& line);  // what `push` starts on the other computer
void add_completion(CommandLine& line);
void add_view(CommandLine& line);
void add_render(CommandLine& line);
void add_log(CommandLine& line);
void add_doctor(CommandLine& line);
void add_new(CommandLine& line);
void add_reference(CommandLine& line);  // hidden: a build calls it

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

}  // namespace kadans
