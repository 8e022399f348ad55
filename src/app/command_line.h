// The command line: its parser, and what each command does with its options. Help, completion, the tests of all
// commands and the program itself use this one table.
#pragma once

#include <any>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace kadans {

class CommandLine {
 public:
  CommandLine();
  CommandLine(const CommandLine&) = delete;  // the parser points into it
  CommandLine& operator=(const CommandLine&) = delete;

  // After parsing: runs the command that was given. `arguments` is what was parsed, with the program's name and a null
  // behind it, for commands that hand it on. Returns the program's exit code.
  int run(std::span<char*> arguments);

  CLI::App app;

 private:
  // `add` adds the command, with options that are kept here; `run` gets them, and the parser before them if it wants
  // it.
  template <typename Options, typename Run>
  void offer(void (*add)(CLI::App&, Options&), Run does);

  std::span<char*> arguments_;  // of run()
  std::deque<std::any> options_;
  std::vector<std::pair<const CLI::App*, std::function<int()>>> runs_;
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
