// `kadans commission`: its command line and terminal; what it does is in commission.h.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace kadans {

struct CommissionOptions {
  std::string robot;
  std::string plant;  // "": the only type with wiring that the robot's configuration has
  std::string peer;   // address of the drives; "": the robot's own
  double share = 0.1;
  std::vector<std::string> steps;  // none: all
  std::vector<std::string> joints;
  std::string answers;  // file of lines; "": the terminal, or lines of the standard input
  bool again = false;
};
void add_commission(CLI::App& app, CommissionOptions& options);
int run_commission(const CommissionOptions& options);

}  // namespace kadans
