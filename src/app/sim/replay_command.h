// `kadans replay`: runs a record again, with the files on the disk or with those inside the record, and compares every
// recorded signal in every tick, bit for bit. It prints that everything is the same, or where the runs differ and which
// inputs changed. With the record's own files, only a change of the program or of its libraries can make a difference.
#pragma once

#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct ReplayOptions {
  std::string record;
  bool from_record = false;  // use its files instead of those on the disk
  bool allow_plugins = false;
  bool json = false;
};

void add_replay(CLI::App& app, ReplayOptions& options);
// Returns 0 when everything is the same, else 1. Throws InputError when the record cannot be run again.
int run_replay(const ReplayOptions& options);

}  // namespace kadans
