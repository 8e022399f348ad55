#include "supervised_host.h"

#include <exception>
#include <limits>
#include <string>

namespace kadans {

using Severity = BehaviorLog::Severity;

SupervisedHost::SupervisedHost(const SupervisorConfig& config, BehaviorHost& played, const Players& players,
                               SupervisorLink& link, BehaviorLog& log)
    : config_(config), played_(played), players_(players), link_(link), log_(log) {}

void SupervisedHost::say(std::int64_t time_ns, Severity severity, const std::string& text) noexcept {
  log_.message(time_ns, severity, "supervisor", text);
}

void SupervisedHost::before_tick(const Snapshot& snapshot) noexcept {
  const OdometryStatus& odometry = snapshot.status.odometry;
  link_.snapshot.publish(snapshot);
  (void)link_.poses.try_push(
      {snapshot.time_ns, odometry.path_x_m, odometry.path_y_m, odometry.path_heading_rad, odometry.breaks});
  while (link_.lines.pop(std::numeric_limits<std::int64_t>::max(), line_)) line_.say_to(log_);
  const bool leaving = link_.leaving.load(std::memory_order_relaxed);
  take_orders(snapshot.time_ns, leaving);
  if (!leaving) watch(snapshot.time_ns);
}

void SupervisedHost::tick(const Snapshot& snapshot, CommandSender& commands) noexcept {
  played_.tick(snapshot, commands);
  take_replies(snapshot.time_ns);
  if (players_.host != nullptr) {
    players_.host->report(report_);
  } else {
    players_.process->report(report_);
  }
  link_.report.publish(report_);
}

// What decides hears of an order when it was carried out: the process of behaviors says so later.
void SupervisedHost::carry_out(const PlayOrder& order, std::int64_t time_ns, bool of_decisions) noexcept {
  try {
    if (players_.process != nullptr) {
      asked_.push_back({players_.process->ask(order), of_decisions});
      return;
    }
    players_.host->order(order);
    report_.orders += of_decisions ? 1 : 0;
  } catch (const std::exception& error) {
    refuse(error.what(), time_ns, of_decisions);
  }
}

void SupervisedHost::refuse(const char* why, std::int64_t time_ns, bool of_decisions) noexcept {
  say(time_ns, Severity::warning,
      std::string(of_decisions ? "an order of the decisions was refused: " : "the answer to their loss was refused: ") +
          why);
  if (!of_decisions) return;
  ++report_.orders;
  ++report_.orders_refused;
  put_text(report_.refusal, why);
}

void SupervisedHost::take_replies(std::int64_t time_ns) noexcept {
  while (!asked_.empty()) {
    const std::optional<BehaviorReply> reply = players_.process->reply(asked_.front().number);
    if (!reply) return;
    const bool of_decisions = asked_.front().of_decisions;
    asked_.pop_front();
    if (!reply->error.empty()) {
      refuse(reply->error.c_str(), time_ns, of_decisions);
    } else {
      report_.orders += of_decisions ? 1 : 0;
    }
  }
}

void SupervisedHost::take_orders(std::int64_t time_ns, bool leaving) noexcept {
  while (const auto order = link_.orders.try_pop()) {
    if (!leaving) {
      carry_out(*order, time_ns, true);
      continue;
    }
    ++report_.orders;
    ++report_.orders_refused;
  }
}

void SupervisedHost::watch(std::int64_t time_ns) noexcept {
  const Heartbeat beat = link_.heartbeat.newest();
  if (beat.ticks != beat_ || since_ns_ < 0) since_ns_ = time_ns;
  beat_ = beat.ticks;
  const double silent_s = 1e-9 * static_cast<double>(time_ns - since_ns_);
  const bool lost = beat.failed != 0 || silent_s > config_.lost_after_s;
  if (lost == lost_) return;
  lost_ = lost;
  if (lost) return answer_loss(time_ns);
  say(time_ns, Severity::info, "decides again");
}

void SupervisedHost::answer_loss(std::int64_t time_ns) noexcept {
  using When = SupervisorConfig::WhenLost;
  constexpr const char* answers[] = {"what plays goes on", "what plays is stopped", "another list takes over"};
  say(time_ns, Severity::warning,
      std::string("nothing decides any more: ") + answers[static_cast<std::size_t>(config_.when_lost)]);
  if (config_.when_lost == When::go_on) return;
  ++report_.taken_over;
  PlayOrder order{.kind = PlayOrder::Kind::stop};
  if (config_.when_lost == When::play) order = {.kind = PlayOrder::Kind::replace, .list = config_.lost_list};
  carry_out(order, time_ns, false);
}

}  // namespace kadans
