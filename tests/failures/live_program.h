// `kadans run` as a process of its own, what it says, and the process in which it plays behaviors: to be killed.
#pragma once

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/types.h>

#include "app/program.h"

namespace kadans::failures {

class LiveProgram {
 public:
  // With its record, out.mcap, in that folder.
  LiveProgram(const std::filesystem::path& folder, const std::string& arguments);

  // Reads on until a line on standard error holds the text. False: the program ended without it.
  bool says(const std::string& text) { return running_.says(text); }
  // Reads to the end; the JSON object that is the last line of the output, null when there is none.
  nlohmann::json end();
  void signal(int number) const { running_.signal(number); }
  int exit_code() const noexcept { return exit_code_; }
  const std::string& heard() const noexcept { return running_.heard(); }
  std::size_t heard(const std::string& text) const;  // how often

  // Any thread. The process of the behaviors that is alive, other than `other`; waits for one. -1: the program ended.
  pid_t behavior_process(pid_t other = -1) const { return child(false, other); }
  pid_t decision_process(pid_t other = -1) const { return child(true, other); }
  void signal_behavior_process(int number) const { send(number, behavior_process()); }
  void signal_decision_process(int number) const { send(number, decision_process()); }

  // Of a signal in the record, between two times.
  struct Range {
    double min = 0, max = 0;
  };
  Range recorded(const std::string& signal, double from_s, double to_s) const;

 private:
  pid_t child(bool decides, pid_t other) const;
  // -1 would be all processes of the machine.
  static void send(int number, pid_t pid) {
    if (pid > 1) kill(pid, number);
  }

  std::filesystem::path folder_;
  program::Running running_;
  int exit_code_ = -1;
};

}  // namespace kadans::failures
