// The command line: its parser, and what each command does with its options. Help, completion, the tests of all
// commands and the program itself use this one table.
#pragma once

#include <any>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace kadans {

class CommandLine {
 public:
  CommandLine();
  CommandLine(const CommandLine&) = delete;  // the parser points into it
  CommandLine& operator=(const CommandLine&) = delete;

  template <typename Options>
  struct Command {
    CLI::App* command;
    Options& options;
  };
  // Adds a command with options, which are kept here. `does` gets them after parsing, and this line before them if it
  // wants it; it returns the program's exit code, and throws InputError for a wrong file.
  template <typename Options, typename Run>
  Command<Options> add(const char* name, const char* doc, Run* does) {
    return add<Options>(app, name, doc, does);
  }
  template <typename Options, typename Run>
  Command<Options> add(CLI::App& group, const char* name, const char* doc, Run* does) {
    Options& options = options_.emplace_back().emplace<Options>();
    CLI::App* const command = group.add_subcommand(name, doc);
    if constexpr (std::is_invocable_v<Run, const Options&>)
      runs_.emplace_back(command, [does, &options] { return does(options); });
    else
      runs_.emplace_back(command, [this, does, &options] { return does(*this, options); });
    return {command, options};
  }

  // After parsing: runs the command that was given. `arguments` is what was parsed, with the program's name and a null
  // behind it, for commands that hand it on. Returns the program's exit code.
  int run(std::span<char*> arguments);
  std::span<char*> arguments() const noexcept { return arguments_; }

  CLI::App app;

 private:
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
