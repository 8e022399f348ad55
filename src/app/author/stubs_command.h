// `kadans lua-stubs` and `kadans params`: show the tables of a robot and of a behavior, for editors and for people.
#pragma once

#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct StubsOptions {
  std::string robot, output = ".";
  bool markdown = false;
};
void add_stubs(CLI::App& app, StubsOptions& options);
int run_stubs(const StubsOptions& options);

struct ParamsOptions {
  std::string file, robot;
  bool json = false;
};
void add_params(CLI::App& app, ParamsOptions& options);
int run_params(const ParamsOptions& options);

}  // namespace kadans
