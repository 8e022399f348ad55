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
  std::vector<std::string> set, vary, listen;
  std::string report, record, signals, out, shard, robots, referee;
  std::optional<std::uint64_t> seed, live, cases, jobs;
  bool json = false, verbose = false;
};

extern const char* const usage;

// "": it was read into `options`; otherwise what is wrong.
std::string read_options(int argc, char** argv, Options& options);

}  // namespace kadans::football
