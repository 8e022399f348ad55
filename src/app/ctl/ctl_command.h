// `kadans ctl`: talks to a running instance.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct CtlOptions {
  std::string socket;  // "" = where an instance may be
  bool json = false;
  bool names = false;  // of a list: nothing but
  std::string what;    // of list
  std::string name;    // of a parameter, signal, behavior, control set, record
  double value = 0;
  std::string preset;  // "" = none
  std::string list;    // to be played
  bool replace = false;
  std::vector<std::string> signals;
  double rate_hz = 10;
  std::optional<long> count;  // of samples; without: until Ctrl-C
};

void add_ctl(CLI::App& app, CtlOptions& options);
// After parsing. Returns the program's exit code.
int run_ctl(const CLI::App& app, const CtlOptions& options);

struct CompletionOptions {
  std::string shell;  // "bash" or "zsh"
};
void add_completion(CLI::App& app, CompletionOptions& options);
// Prints the script.
int run_completion(const CLI::App& app, const CompletionOptions& options);

}  // namespace kadans
