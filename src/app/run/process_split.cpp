#include "process_split.h"

#include <algorithm>
#include <cstdio>

#include <unistd.h>

#include "app/terminal.h"

namespace kadans {

bool ProcessSplit::split(std::size_t at_once) {
  wait_until_run(std::max<std::size_t>(at_once, 1) - 1);
  MemoryFile said;
  std::fflush(nullptr);
  if (std::optional<ChildProcess> process = ChildProcess::copy()) {
    children_.push_back({std::move(*process), std::move(said)});
    return false;
  }
  (void)dup2(said.descriptor(), STDOUT_FILENO);
  return true;
}

void ProcessSplit::wait_until_run(std::size_t most) {
  for (;;) {
    std::vector<const ChildProcess*> running;
    for (Child& child : children_) {
      if (!child.process.ended()) running.push_back(&child.process);
    }
    if (running.size() <= most) return;
    ChildProcess::wait_for_one(running, -1);  // a signal that ends it was theirs, too
  }
}

int ProcessSplit::finish() {
  wait_until_run(0);
  int worst = exit_passed;
  for (const Child& child : children_) {
    const int code = child.process.exit_code();
    worst = std::max(worst, code < 0 ? exit_internal : code);
    const std::string said = child.said.text();
    std::fwrite(said.data(), 1, said.size(), stdout);
  }
  children_.clear();
  std::fflush(stdout);
  return worst;
}

}  // namespace kadans
