// `kadans repl`: a console in a simulation. From a terminal the simulation runs at the pace of the wall clock
// meanwhile; from a pipe time passes by `:run` only, so that what is printed repeats.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct ReplOptions {
  std::string scenario;  // "" = the project's only robot, nothing plays
  std::string play;      // in place of the scenario's list
  std::optional<std::uint64_t> seed;
  double speed = 1;  // of the simulation on a terminal, in seconds per second; 0: it stands still but for :run
};

void add_repl(CLI::App& app, ReplOptions& options);
// After parsing. Returns the program's exit code.
int run_repl(const ReplOptions& options);

}  // namespace kadans
