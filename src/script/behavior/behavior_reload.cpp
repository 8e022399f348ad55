#include <exception>

#include "behavior_parts.h"
#include "kadans/signal/input_error.h"
#include "script/bindings/machine_sets.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

constexpr std::int64_t probation_ns = 1'000'000'000;

// Whether the files hold these texts; the first is looked for at `first`.
bool holds(const std::filesystem::path& first, const std::vector<LuaState::Source>& sources) {
  try {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      if (read_input_file(i == 0 ? first : sources[i].path) != sources[i].text) return false;
    }
  } catch (const InputError&) {
    return false;
  }
  return !sources.empty() && first.parent_path() == sources.front().path.parent_path();
}

struct Leaving {
  Behavior::Parts& parts;
  const std::vector<bool>& marks;
};

int leave(lua_State* state) {
  const Leaving& leaving = *static_cast<const Leaving*>(lua_touserdata(state, 1));
  Behavior::Parts& parts = leaving.parts;
  parts.snapshot_tables.refill(state, *parts.bindings.snapshot, parts.bindings.now_ns);
  parts.runner->leave_marked(state, leaving.marks, parts.bindings.now_ns);
  return 0;
}

// Leaves the marked states in a transaction of its own. False: an `exit` raised.
bool leave_states(Behavior::Parts& parts, const std::vector<bool>& marks, const Snapshot& snapshot,
                  CommandSender& commands) noexcept {
  Leaving leaving{parts, marks};
  parts.bindings.begin(commands, snapshot, snapshot.time_ns);
  const Behavior::Settings& settings = parts.settings;
  if (parts.lua->call(leave, &leaving, settings.limits.tick_instructions, settings.limits.tick_wall_ns)) {
    (void)parts.bindings.commit();
    return true;
  }
  commands.discard();
  return false;
}

}  // namespace

std::vector<std::filesystem::path> Behavior::files() const {
  std::vector<std::filesystem::path> all;
  for (const LuaState::Source& source : parts_->lua->sources()) all.push_back(source.path);
  return all;
}

Behavior::Reload Behavior::refuse(std::int64_t time_ns, const std::string& why) noexcept {
  if (why == past_->complaint) return Reload::refused;
  past_->complaint = why;
  parts_->log.message(time_ns, BehaviorLog::Severity::warning, name(),
                      "reload refused, the old version goes on: " + why);
  return Reload::refused;
}

Behavior::Reload Behavior::reload(const Snapshot& snapshot, CommandSender& commands, const std::filesystem::path& file,
                                  SetMask elsewhere) noexcept {
  const std::filesystem::path wanted = file.empty() ? parts_->settings.file : file;
  if (failed() || finished() || holds(wanted, parts_->lua->sources())) return Reload::unchanged;
  if (file.empty() && holds(wanted, past_->taken_back)) return Reload::unchanged;
  Settings settings = parts_->settings;
  settings.file = wanted;
  std::unique_ptr<Parts> fresh;
  try {
    fresh = std::make_unique<Parts>(settings, parts_->catalog, parts_->log);
    fresh->bindings.held_ns = parts_->bindings.held_ns;
    fresh->bindings.now_ns = clock_ns(snapshot);
    load_behavior(*fresh, settings.limits.reload_instructions);
  } catch (const std::exception& error) {
    return refuse(snapshot.time_ns, error.what());
  }
  if (!holds(wanted, fresh->lua->sources())) return refuse(snapshot.time_ns, "the file changed while it was read");
  if (const std::string clash = clash_text(fresh->catalog, fresh->bindings.all_sets(), elsewhere); !clash.empty()) {
    return refuse(snapshot.time_ns, clash + ", and the other set's behavior plays at the same time");
  }
  ByteWriter kept;
  (void)keep_behavior(*parts_, kept);  // what could not be kept is told when the new version needs it
  ByteReader bytes(kept.bytes());
  if (!go_on_with(*fresh, bytes, snapshot, commands, settings.limits.reload_instructions, true))
    return refuse(snapshot.time_ns, fresh->error.text());
  swap(std::move(fresh), snapshot, commands);
  return Reload::taken;
}

void Behavior::swap(std::unique_ptr<Parts> fresh, const Snapshot& snapshot, CommandSender& commands) noexcept {
  Parts& old = *parts_;
  past_->complaint.clear();
  if (old.runner->started()) {
    past_->left = old.runner->gone_from(*fresh->runner);
    fresh->runner->report_gone(*old.runner, past_->left);
    if (!leave_states(old, past_->left, snapshot, commands)) {
      old.log.message(snapshot.time_ns, BehaviorLog::Severity::warning, name(),
                      "a state that is gone could not be left: " + old.lua->error().text());
    }
    past_->swapped_ns = clock_ns(snapshot);
    past_->parts = std::move(parts_);
  }
  parts_ = std::move(fresh);
  status_.reloads.fetch_add(1, std::memory_order_relaxed);
  parts_->log.message(snapshot.time_ns, BehaviorLog::Severity::info, name(),
                      "reloaded " + parts_->lua->sources().front().chunk);
}

bool Behavior::take_back(const Snapshot& snapshot, CommandSender& commands) noexcept {
  if (past_->parts == nullptr || clock_ns(snapshot) - past_->swapped_ns >= probation_ns) return false;
  Parts& failing = *parts_;
  Parts& old = *past_->parts;
  const ScriptError error = failing.lua->error();
  past_->taken_back = failing.lua->sources();
  if (error.breach == ScriptBreach::none) {  // what the new version entered itself
    (void)leave_states(failing, failing.runner->gone_from(*old.runner), snapshot, commands);
  }
  old.runner->enter_again(past_->left);
  old.want_sets(snapshot);
  parts_ = std::move(past_->parts);
  parts_->log.message(snapshot.time_ns, BehaviorLog::Severity::warning, name(),
                      "new version taken back, the old one goes on: " + error.text());
  return true;
}

void Behavior::forget_past(std::int64_t now_ns) noexcept {
  if (past_->parts != nullptr && now_ns - past_->swapped_ns >= probation_ns) past_->parts.reset();
}

}  // namespace kadans
