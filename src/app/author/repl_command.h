// `kadans repl`: a console in a simulation. On a terminal the simulation runs at the pace of the wall clock meanwhile.
// From a pipe time passes only by `:run`, so the output is repeatable.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct ReplOptions {
  std::string scenario;  // "": the project's only robot, and nothing plays
  std::string play;      // replaces the scenario's list
  std::optional<std::uint64_t> seed;
  double speed = 1;  // on a terminal: simulated seconds per second; 0: time passes only by :run
};

void add_repl(CLI::App& app, ReplOptions& options);
// After parsing. Returns the program's exit code.
int run_repl(const ReplOptions& options);

}  // namespace kadans
