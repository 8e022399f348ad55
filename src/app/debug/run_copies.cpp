#include "run_copies.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>

namespace kadans {
namespace {

constexpr std::size_t measured_every = 16, copies_least = 8, most_of_all = 300;
constexpr std::uint64_t beside_ticks = 4;

// Its share of the memory of all copies; 0: not known.
double memory_of(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/smaps_rollup");
  for (std::string word; file >> word;) {
    double kB = 0;
    if (word == "Pss:" && file >> kB) return 1024 * kB;
  }
  return 0;
}

std::uint64_t distance(const RunPosition& one, const RunPosition& other) {
  return one.tick > other.tick ? one.tick - other.tick : other.tick - one.tick;
}

}  // namespace

RunCopy copy_of(const RunCopy& copy) {
  RunCopy made;
  RunChannel end;
  const bool asked = copy.channel.send({{"order", "fork"}});
  const std::optional<Json> answer = asked ? copy.channel.receive(&end) : std::nullopt;
  if (!answer) throw std::runtime_error("the process of the run has ended");
  if (!take_copy(*answer, end, made)) throw std::runtime_error("the system makes no further copy of the run");
  return made;
}

bool take_copy(const Json& message, RunChannel& end, RunCopy& copy) {
  if (message.value("event", "") != "copy" || !end.open()) return false;
  copy.channel = std::move(end);
  copy.pid = message.at("pid");
  copy.where = message.at("where");
  copy.at = copy.where.at("at").get<RunPosition>();
  return true;
}

void RunCopies::add(RunCopy copy, const RunPosition& near) {
  const auto behind = std::ranges::upper_bound(all_, copy.at, {}, &RunCopy::at);
  const bool beside = (behind != all_.begin() && distance((behind - 1)->at, copy.at) < beside_ticks) ||
                      (behind != all_.end() && distance(behind->at, copy.at) < beside_ticks);
  if (beside && !copy.branch) return;
  all_.insert(behind, std::move(copy));
  if (++added_ % measured_every == 0) {
    double bytes = 0;
    for (const RunCopy& one : all_) bytes += memory_of(one.pid);
    const double each = bytes / static_cast<double>(all_.size());
    most_ = each > 0 ? static_cast<std::size_t>(memory_bytes_ / each) : most_of_all / 4;
    most_ = std::clamp(most_, copies_least, most_of_all);
  }
  while (all_.size() > most_) thin(near);
}

// Drops the one that is missed least: whose neighbours are near one another, and far from where somebody looks.
void RunCopies::thin(const RunPosition& near) {
  std::size_t least_missed = all_.size() - 1;
  double least_worth = -1;
  for (std::size_t i = 1; i < all_.size(); ++i) {
    if (all_[i].branch) continue;
    const RunPosition& next = i + 1 < all_.size() ? all_[i + 1].at : all_[i].at;
    const double worth =
        static_cast<double>(distance(all_[i - 1].at, next)) / static_cast<double>(1 + distance(all_[i].at, near));
    if (least_worth >= 0 && worth >= least_worth) continue;
    least_worth = worth;
    least_missed = i;
  }
  all_.erase(all_.begin() + static_cast<std::ptrdiff_t>(least_missed));
}

std::size_t RunCopies::last_before(const RunPosition& at, bool or_at) const noexcept {
  const auto behind = or_at ? std::ranges::upper_bound(all_, at, {}, &RunCopy::at)
                            : std::ranges::lower_bound(all_, at, {}, &RunCopy::at);
  return behind == all_.begin() ? all_.size() : static_cast<std::size_t>(behind - all_.begin() - 1);
}

const RunCopy* RunCopies::branch_behind(const RunPosition& at) const noexcept {
  for (const RunCopy& copy : all_) {
    if (copy.branch && copy.at > at) return &copy;
  }
  return nullptr;
}

void RunCopies::drop_behind(const RunPosition& at) {
  std::erase_if(all_, [&](const RunCopy& copy) { return copy.at > at; });
}

}  // namespace kadans
