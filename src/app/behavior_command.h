// `kadans behavior check | graph | test`: what an author does with a behavior before it moves a robot.
#pragma once

#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct BehaviorOptions {
  std::vector<std::string> files;
  std::string robot;               // configuration; "" = by the behavior's folder
  std::string format = "mermaid";  // of the graph: mermaid, dot or svg
  std::string only;                // of the tests: part of their names
  std::string junit;
  bool json = false;
  bool plugins = false;  // are loaded by check
};

void add_behavior(CLI::App& app, BehaviorOptions& options);
// After parsing. Returns the program's exit code.
int run_behavior(const CLI::App& app, const BehaviorOptions& options);
int run_behavior_test(const BehaviorOptions& options);

}  // namespace kadans
