// `kadans behavior check | graph | test`: commands for the author of a behavior, before it moves a robot.
#pragma once

#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct BehaviorOptions {
  std::vector<std::string> files;
  std::string robot;               // configuration; "": the one for the behavior's folder
  std::string format = "mermaid";  // format of the graph: mermaid, dot or svg
  std::string only;                // run only tests whose names contain this
  std::string junit;
  bool json = false;
  bool plugins = false;  // check loads plug-ins
};

void add_behavior(CLI::App& app, BehaviorOptions& options);
// After parsing. Returns the program's exit code.
int run_behavior(const CLI::App& app, const BehaviorOptions& options);
int run_behavior_test(const BehaviorOptions& options);

}  // namespace kadans
