// `kadans replay`: runs a record again, with the files that are here now or with those inside it, and compares every
// recorded signal in every tick, bit for bit. Says that all is the same, or where the two part and what changed among
// the inputs. With the files of the record a change of the program or its libraries stands alone.
#pragma once

#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct ReplayOptions {
  std::string record;
  bool from_record = false;  // its files in place of those on the disk
  bool allow_plugins = false;
  bool json = false;
};

void add_replay(CLI::App& app, ReplayOptions& options);
// 0 the same, 1 not. Throws InputError for what cannot be run again.
int run_replay(const ReplayOptions& options);

}  // namespace kadans
