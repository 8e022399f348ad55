// A line on stderr about runs in parallel: how many are done and the estimated time left. On a terminal the line is
// drawn over. Elsewhere there is no line, or with Log::tenths one line for each tenth of the jobs.
#pragma once

#include <chrono>
#include <cstddef>

namespace kadans {

class JobProgress {
 public:
  enum class Log { terminal_only, tenths };
  JobProgress(std::size_t jobs, bool shown, Log log = Log::terminal_only);

  void ended() noexcept { ++done_; }
  void draw(std::size_t running);  // call it a few times a second
  void clear() const;              // call it before anything else is printed
  double elapsed_s() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count(); }

 private:
  std::size_t jobs_;
  bool on_terminal_, tenths_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::size_t done_ = 0, told_ = 0;
  double drawn_s_ = 0;
};

}  // namespace kadans
