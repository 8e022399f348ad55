// What the supervisor asks of what plays, and files that somebody saved: both between two ticks.
#include <algorithm>

#include "kadans/signal/input_error.h"
#include "script_host.h"
#include "silent_log.h"

namespace kadans {

std::vector<std::filesystem::path> ScriptHost::files() const {
  std::vector<std::filesystem::path> all;
  const auto add = [&all](const Behavior& behavior) {
    for (std::filesystem::path& file : behavior.files()) all.push_back(std::move(file));
  };
  for (const PlayList::Entry& entry : list_.entries()) add(*entry.behavior);
  SilentLog silence;
  for (const Due& due : events_) {
    for (const PlayList::Entry& entry : due.loaded) add(*entry.behavior);
    if (due.order.file.empty()) continue;
    all.push_back(due.order.file);
    try {
      const Behavior::Settings settings{
          .root = settings_.root, .file = due.order.file, .seed = settings_.seed, .limits = settings_.limits};
      add(Behavior(settings, catalog_, silence));
    } catch (const InputError&) {  // the reload will be refused
    }
  }
  return all;
}

void ScriptHost::order(const PlayOrder& order) {
  std::vector<InputProblem> problems;
  Due due{0, order, load(order.list, false, problems)};
  if (!problems.empty()) throw InputError(problems);
  if (order.kind == PlayOrder::Kind::play) {
    if (const std::string why = clash(due.loaded); !why.empty()) throw InputError({.message = why});
  }
  const std::vector<std::string> known = names();
  if (order.kind == PlayOrder::Kind::reload && std::ranges::find(known, order.behavior.name) == known.end())
    throw InputError({.message = unknown_name("behavior", order.behavior.name, known)});
  orders_.push_back(std::move(due));
}

void ScriptHost::take_orders(const Snapshot& snapshot, CommandSender& commands) noexcept {
  for (; events_done_ < events_.size() && events_[events_done_].at_ns <= snapshot.time_ns; ++events_done_) {
    carry_out(events_[events_done_], snapshot, commands);
  }
  for (Due& due : orders_) carry_out(due, snapshot, commands);
  orders_.clear();
}

void ScriptHost::carry_out(Due& due, const Snapshot& snapshot, CommandSender& commands) noexcept {
  using Kind = PlayOrder::Kind;
  const Kind kind = due.order.kind;
  if (kind == Kind::reload) return reload(due.order, snapshot, commands);
  std::string text = play_order_names[static_cast<std::size_t>(kind)];
  for (const PlayList::Entry& entry : due.loaded) text += " " + entry.behavior->name();
  log_.message(snapshot.time_ns, BehaviorLog::Severity::info, "supervisor", text);
  if (kind == Kind::pause) pause_.begin();
  if (kind == Kind::resume) pause_.end();
  if (kind == Kind::stop || kind == Kind::replace) leave_all(snapshot, commands);
  if (const std::string why = clash(due.loaded); !why.empty()) {
    log_.message(snapshot.time_ns, BehaviorLog::Severity::error, "supervisor", why);
    return;
  }
  begin(due.loaded);
}

// Motions come to rest first, so that what an `exit` moves does move.
void ScriptHost::leave_all(const Snapshot& snapshot, CommandSender& commands) noexcept {
  pause_.finish(snapshot, commands);
  for (PlayList::Entry& entry : list_.entries()) {
    if (entry.over) continue;
    entry.behavior->hold_clock(pause_.held_ns());
    entry.behavior->stop(snapshot, commands);
    pause_.note(snapshot, commands);
    if (entry.behavior->failed()) report_failure(*entry.behavior, snapshot.time_ns);
  }
  list_.end_all();
}

void ScriptHost::begin(std::vector<PlayList::Entry>& entries) {
  if (entries.empty()) return;
  list_.append(entries);
  if (watch_ != nullptr) watch_folders();
}

void ScriptHost::reload(const PlayOrder& order, const Snapshot& snapshot, CommandSender& commands) noexcept {
  for (PlayList::Entry& entry : list_.entries()) {
    if (entry.over || entry.behavior->name() != order.behavior.name) continue;
    entry.behavior->hold_clock(pause_.held_ns());
    (void)entry.behavior->reload(snapshot, commands, order.file, PlayList::sets_beside(entry.lane, list_.entries()));
  }
}

void ScriptHost::reload_saved(const Snapshot& snapshot, CommandSender& commands) noexcept {
  if (watch_ == nullptr || !watch_->poll()) return;
  for (PlayList::Entry& entry : list_.entries()) {
    if (entry.over) continue;
    entry.behavior->hold_clock(pause_.held_ns());
    (void)entry.behavior->reload(snapshot, commands, {}, PlayList::sets_beside(entry.lane, list_.entries()));
  }
  watch_folders();  // of modules that are new
}

void ScriptHost::watch() {
  watch_ = std::make_unique<FileWatch>();
  watch_folders();
}

void ScriptHost::watch_folders() {
  (void)watch_->add(settings_.root / "behaviors/lib");
  for (const PlayList::Entry& entry : list_.entries()) {
    for (const std::filesystem::path& file : entry.behavior->files()) (void)watch_->add(file.parent_path());
  }
}

}  // namespace kadans
