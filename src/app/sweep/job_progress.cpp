#include "job_progress.h"

#include <cstdio>

#include "app/terminal.h"

namespace kadans {

JobProgress::JobProgress(std::size_t jobs, bool shown, Log log)
    : jobs_(jobs), on_terminal_(shown && stderr_is_terminal()), tenths_(shown && !on_terminal_ && log == Log::tenths) {}

void JobProgress::draw(std::size_t running) {
  if (!on_terminal_ && !tenths_) return;
  const double wall_s = elapsed_s();
  const bool due = on_terminal_ ? wall_s >= drawn_s_ + 0.1 : 10 * done_ / jobs_ > 10 * told_ / jobs_;
  if (!due) return;
  drawn_s_ = wall_s;
  told_ = done_;
  const double share = static_cast<double>(done_) / static_cast<double>(jobs_);
  std::fprintf(stderr, "%s  %zu of %zu, %zu running, %.0f s", on_terminal_ ? "\r\033[K" : "", done_, jobs_, running,
               wall_s);
  if (share > 0) std::fprintf(stderr, ", about %.0f s left", wall_s / share - wall_s);
  if (tenths_) std::fputc('\n', stderr);
  std::fflush(stderr);
}

void JobProgress::clear() const {
  if (on_terminal_ && drawn_s_ > 0) std::fputs("\r\033[K", stderr);
}

}  // namespace kadans
