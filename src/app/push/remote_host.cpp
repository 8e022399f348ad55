#include "remote_host.h"

#include <system_error>

#include <unistd.h>

#include "app/terminal.h"
#include "config/json/problems.h"
#include "kadans/signal/shell_word.h"
#include "realtime/machine/child_process.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

constexpr int ssh_failed = 255;

}  // namespace

RemoteHost::RemoteHost(std::string name) : name_(std::move(name)) {
  // ssh would take a name that begins with a dash for an option.
  const bool whole = name_.find_first_not_of(
                         "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                         "-._@:%[]/") == std::string::npos;
  if (name_.empty() || name_.front() == '-' || !whole)
    refuse(in_quotes(name_) + " is no name of a computer, such as robot.local or kadans@10.0.0.2");
}

int RemoteHost::run(const std::vector<std::string>& words, int input, bool terminal) const {
  std::string command = "kadans";
  for (const std::string& word : words) command += " " + shell_word(word);
  std::vector<std::string> ssh{"ssh"};
  if (terminal && isatty(STDIN_FILENO) == 1 && isatty(STDOUT_FILENO) == 1) ssh.emplace_back("-t");
  ssh.insert(ssh.end(), {"--", name_, command});
  catch_interrupts();  // Ctrl-C is for ssh, which ends by it
  try {
    ChildProcess process({.words = ssh, .files = {input, STDOUT_FILENO, STDERR_FILENO}});
    process.wait();
    if (process.exit_code() == ssh_failed) return exit_usage;
    return process.signal() != 0 ? exit_interrupted : process.exit_code();
  } catch (const std::system_error& error) {
    refuse(std::string(error.what()) + "; install an ssh client, such as openssh-client");
  }
}

}  // namespace kadans
