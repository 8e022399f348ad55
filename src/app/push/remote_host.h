// Runs kadans on another computer over ssh. Which user, port and key that takes is the business of ssh and of its own
// configuration. The program `ssh` is looked for in PATH.
#pragma once

#include <string>
#include <vector>

namespace kadans {

class RemoteHost {
 public:
  // As ssh takes it: "robot.local", "kadans@10.0.0.2". Throws InputError for a text that is no such name.
  explicit RemoteHost(std::string name);

  // Runs `kadans WORDS` there, with this program's output and error and with `input`, a descriptor, to read. Returns
  // its exit code; exit_usage when ssh itself failed, which it has told then. Throws InputError when there is no ssh
  // here. `terminal`: it gets a terminal there when this program has one here.
  int run(const std::vector<std::string>& words, int input, bool terminal) const;

 private:
  std::string name_;
};

}  // namespace kadans
