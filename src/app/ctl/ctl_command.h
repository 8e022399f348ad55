// `kadans ctl`: talks to a running instance.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct CtlOptions {
  std::string socket;  // "": the usual places
  bool json = false;
  bool names = false;                                                               // list only the names
  std::optional<long> count;                                                        // of samples; nullopt: until Ctrl-C
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> given{};  // by verb and argument
};

void add_ctl(CLI::App& app, CtlOptions& options);
// After parsing. Returns the program's exit code.
int run_ctl(const CLI::App& app, const CtlOptions& options);

struct CompletionOptions {
  std::string shell;  // "bash" or "zsh"
};
void add_completion(CLI::App& app, CompletionOptions& options);
// Prints the completion script.
int run_completion(const CLI::App& app, const CompletionOptions& options);

}  // namespace kadans
