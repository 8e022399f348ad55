#include "script_host.h"

#include <algorithm>

#include "kadans/signal/input_error.h"
#include "script/bindings/machine_sets.h"

namespace kadans {

ScriptHost::ScriptHost(const Settings& settings, const Catalog& catalog, BehaviorLog& log)
    : settings_(settings), catalog_(catalog), log_(log), pause_(catalog), safe_(settings.safe, catalog) {
  std::vector<InputProblem> problems;
  std::vector<PlayList::Entry> first =
      settings.kept.empty() ? load(settings.play, true, problems) : load_kept(problems);
  for (const Event& event : settings.events) {
    events_.push_back({event.at_ns, event.order, load(event.order.list, true, problems)});
  }
  if (!problems.empty()) throw InputError(problems);
  std::ranges::stable_sort(events_, {}, &Due::at_ns);
  list_.append(first);
}

ScriptHost::~ScriptHost() = default;

std::vector<PlayList::Entry> ScriptHost::load(const std::vector<PlayItem>& list, bool lasting,
                                              std::vector<InputProblem>& problems) {
  std::vector<PlayList::Entry> loaded;
  for (const PlayItem& item : list) {
    const Behavior::Settings settings{.root = settings_.root,
                                      .file = item.file.is_absolute() ? item.file : settings_.root / item.file,
                                      .seed = settings_.seed,
                                      .limits = settings_.limits,
                                      .feet = settings_.feet,
                                      .arguments = item.arguments,
                                      .source = item.source};
    try {
      loaded.push_back({std::make_unique<Behavior>(settings, catalog_, log_), item.lane, lasting});
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  for (std::size_t i = 0; problems.empty() && i < loaded.size(); ++i) {
    const SetMask beside = PlayList::sets_beside(loaded[i].lane, loaded);
    const std::string clash = clash_text(catalog_, loaded[i].behavior->control_sets(), beside);
    if (clash.empty()) continue;
    problems.push_back(
        {list[i].source, list[i].place.line, list[i].place.column, "behaviors that play at the same time: " + clash});
  }
  return loaded;
}

std::string ScriptHost::clash(const std::vector<PlayList::Entry>& loaded) const {
  for (const PlayList::Entry& entry : loaded) {
    const SetMask beside = PlayList::sets_beside(entry.lane, list_.entries());
    const std::string clash = clash_text(catalog_, entry.behavior->control_sets(), beside);
    if (!clash.empty()) return "'" + entry.behavior->name() + "' cannot play beside what plays: " + clash;
  }
  return "";
}

void ScriptHost::tick(const Snapshot& snapshot, CommandSender& commands) noexcept {
  if (!settings_.kept.empty()) go_on(snapshot, commands);
  take_orders(snapshot, commands);
  reload_saved(snapshot, commands);
  if (!pause_.holds(snapshot, commands)) {
    list_.each_in_turn([&](PlayList::Entry& entry) { step(entry, snapshot, commands); });
    if (safe_.due(snapshot.time_ns)) {
      safe_.move(snapshot, commands, objects_played_with());
      pause_.note(snapshot, commands);
    }
  }
  list_.publish(pause_.paused());
}

void ScriptHost::prepare(const Snapshot& newest) noexcept {
  list_.each_in_turn([&](PlayList::Entry& entry) { entry.behavior->prepare(newest); });
}

void ScriptHost::step(PlayList::Entry& entry, const Snapshot& snapshot, CommandSender& commands) noexcept {
  Behavior& behavior = *entry.behavior;
  behavior.hold_clock(pause_.held_ns());
  const bool goes_on = behavior.tick(snapshot, commands);
  pause_.note(snapshot, commands);
  if (goes_on) return;
  list_.end(entry);
  if (!behavior.failed()) return;
  report_failure(behavior, snapshot.time_ns);
  safe_.failed(snapshot.time_ns, behavior.objects());
}

void ScriptHost::report_failure(const Behavior& behavior, std::int64_t time_ns) noexcept {
  const ScriptError& error = behavior.error();
  std::string text = error.text();
  if (error.traceback[0] != '\0') text += std::string("\n") + error.traceback.data();
  log_.message(time_ns, BehaviorLog::Severity::error, behavior.name(), text);
}

ObjectMask ScriptHost::objects_played_with() const noexcept {
  ObjectMask all = 0;
  for (const PlayList::Entry& entry : list_.entries()) {
    if (!entry.over) all |= entry.behavior->objects();
  }
  return all;
}

std::vector<std::string> ScriptHost::names() const {
  std::vector<std::string> all;
  for (const PlayList::Entry& entry : list_.entries()) all.push_back(entry.behavior->name());
  for (const Due& due : events_) {
    for (const PlayList::Entry& entry : due.loaded) all.push_back(entry.behavior->name());
  }
  return all;
}

void ScriptHost::declare_signals(SignalTable& signals) const {
  list_.status().declare(signals);
  const auto declare = [&](const PlayList::Entry& entry) {
    entry.behavior->status().declare_numbered(signals, entry.behavior->name());
  };
  std::ranges::for_each(list_.entries(), declare);
  for (const Due& due : events_) std::ranges::for_each(due.loaded, declare);
}

}  // namespace kadans
