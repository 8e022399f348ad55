#include "kadans/app/program.h"

#include <algorithm>
#include <cstdio>

#include <fcntl.h>
#include <unistd.h>

#include "app/run/real_time_start.h"
#include "command_line.h"
#include "kadans/signal/nearest_name.h"
#include "terminal.h"
#include "version.h"

namespace kadans {
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
