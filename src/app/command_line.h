// The command line: its parser, and the structs into which the options of each command are read. Help, completion, the
// tests of all commands and the program itself use this one table.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/commission/commission_command.h"
#include "app/new/new_options.h"
#include "commands.h"

namespace kadans {

struct CommandLine {
  CommandLine();
  CommandLine(const CommandLine&) = delete;  // the parser points into it
  CommandLine& operator=(const CommandLine&) = delete;

  CLI::App app;
  SimOptions sim;
  TestOptions test;
  ReplayOptions replay;
  DebugOptions debug;
  CheckOptions check;
  SweepOptions sweep;
  MergeOptions merge;
  MarginOptions margin;
  ShrinkOptions shrink;
  TuneOptions tune;
  BehaviorOptions behavior;
  ReplOptions repl;
  StubsOptions stubs;
  ParamsOptions params;
  RunOptions run;
  RunOptions behavior_process;
  PlantOptions plant;
  JogOptions jog;
  CommissionOptions commission;
  DynamixelOptions dynamixel;
  JitterOptions jitter;
  CtlOptions ctl;
  PushOptions push;
  ReceiveOptions receive;
  CompletionOptions completion;
  ViewOptions view;
  RenderOptions render;
  LogOptions log;
  DoctorOptions doctor;
  NewOptions made;
  ReferenceOptions reference;
};

// A command that can be run, not a group of commands.
struct CommandEntry {
  std::string words;  // "ctl fault list"
  const CLI::App* command = nullptr;
  std::vector<const CLI::Option*> options;  // without --help; for verbs of `ctl` also the options of `ctl`
};
// The commands directly below a group or the program, without hidden ones.
std::vector<const CLI::App*> visible_below(const CLI::App& app);
// All commands in the order of the help, without hidden ones.
std::vector<CommandEntry> commands_of(const CommandLine& line);

// examples.cpp. Adds examples and exit codes to the end of the --help of each command and group.
void add_examples(CLI::App& app);

}  // namespace kadans
