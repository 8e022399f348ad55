// The command line: its parser, and where the options of each command go. Help, completion, the tests of all commands
// and the program itself are made from this one table.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "behavior_command.h"
#include "commands.h"
#include "ctl/ctl_command.h"
#include "live/page_commands.h"
#include "log/log_command.h"
#include "repl_command.h"
#include "replay_command.h"
#include "stubs_command.h"
#include "sweep_command.h"
#include "tune_command.h"

namespace kadans {

struct CommandLine {
  CommandLine();
  CommandLine(const CommandLine&) = delete;  // the parser points into it
  CommandLine& operator=(const CommandLine&) = delete;

  CLI::App app;
  SimOptions sim;
  TestOptions test;
  ReplayOptions replay;
  CheckOptions check;
  SweepOptions sweep;
  MergeOptions merge;
  TuneOptions tune;
  BehaviorOptions behavior;
  ReplOptions repl;
  StubsOptions stubs;
  ParamsOptions params;
  RunOptions run;
  RunOptions behavior_process;
  PlantOptions plant;
  JitterOptions jitter;
  CtlOptions ctl;
  CompletionOptions completion;
  ViewOptions view;
  RenderOptions render;
  LogOptions log;
  DoctorOptions doctor;
  NewControlObjectOptions new_object;
};

// A command that can be run, not a group of them.
struct CommandEntry {
  std::string words;  // "ctl fault list"
  const CLI::App* command = nullptr;
  std::vector<const CLI::Option*> options;  // also those of `ctl`, which its verbs take; --help aside
};
// In the order of the help. Those that are not for people are left out.
std::vector<CommandEntry> commands_of(const CommandLine& line);

// examples.cpp. Gives each command and group its examples and exit codes, as the end of its --help.
void add_examples(CLI::App& app);

}  // namespace kadans
