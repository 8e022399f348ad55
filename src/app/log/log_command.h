// `kadans log`: shows what is in a record, without running anything.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct LogOptions {
  std::string file, other;           // other: the second record of diff
  std::vector<std::string> signals;  // names or patterns
  std::vector<std::string> topics;
  std::optional<double> from_s, to_s, every_s;
  std::string out;
  double tolerance = 0;
  bool json = false;
  bool force = false;  // replaces an existing output file
};
void add_log(CLI::App& app, LogOptions& options);
int run_log(const CLI::App& app, const LogOptions& options);

}  // namespace kadans
