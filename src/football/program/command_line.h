// The words of a command line: kadans-football COMMAND FILE... --options.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kadans::football {

struct Options {
  enum class Command : std::uint8_t { match, matches, merge, serve };

  Command command = Command::match;
  std::vector<std::string> files;  // matches; of merge folders
  std::vector<std::string> set, vary;
  std::string listen, report, record, signals, out, shard, robots, referee;
  std::string live;  // "": not shown; else the port, 0: any free one
  std::optional<std::uint64_t> seed, cases, jobs;
  bool json = false, verbose = false;
};

// Nothing: it was read into `options`. Otherwise it was answered or refused, and this is the program's exit code.
std::optional<int> read_options(int argc, char** argv, Options& options);

}  // namespace kadans::football
