// The program's commands. Each returns the program's exit code and throws InputError for a wrong file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kadans {

struct SimOptions {
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::optional<double> duration_s;
  bool json = false;
  bool verbose = false;
  bool no_record = false;
  bool realtime = false;
  bool watch = false;
  std::string play;    // a list in place of the scenario's; "" = the scenario's
  std::string record;  // "" = NAME.mcap in the working directory
};
int run_sim(const SimOptions& options);

struct CheckOptions {
  std::vector<std::string> files;
  std::string robot;  // configuration that behaviors are checked against; "" = that of the folder they are in
};
int run_check(const CheckOptions& options);

struct NewControlObjectOptions {
  std::string name;
  std::string folder = ".";  // in which its own folder is made
  bool plugin = false;
};
int run_new_control_object(const NewControlObjectOptions& options);

}  // namespace kadans
