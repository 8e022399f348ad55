#include "script_host.h"

#include <algorithm>
#include <optional>

#include "config/json/problems.h"
#include "config/scenario/event_text.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/state_hash.h"
#include "script/bindings/machine_sets.h"
#include "signal/byte_order.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::uint32_t kept_format = 3;

std::uint64_t chart_sign(const Chart& chart) noexcept {
  StateHash sign;
  for (const Chart::State& state : chart.states) {
    for (const char c : state.path) sign.add(c);
    sign.add(state.parent);
  }
  for (const Chart::Transition& transition : chart.transitions)
    sign.add(transition.source), sign.add(transition.target);
  return sign.value();
}

}  // namespace

void add_signal_states(const Chart& chart, const std::string& name, const SignalTable& signals,
                       std::vector<SignalState>& to) {
  const std::string prefix = "behavior." + name + ".";
  std::vector<std::optional<SignalId>> shown_by{signals.find(prefix + "state")};
  for (StateIndex i = 1; i < chart.size(); ++i) {
    const Chart::State& state = chart.states[i];
    const bool region = state.kind == Chart::Kind::region;
    shown_by.push_back(region ? signals.find(prefix + "region." + state.path) : shown_by[state.parent]);
    if (shown_by[i] && state.kind != Chart::Kind::history)
      to.push_back({state.path, name, *shown_by[i], static_cast<double>(i), static_cast<double>(state.end)});
  }
}

ScriptHost::ScriptHost(const Settings& settings, const Catalog& catalog, BehaviorLog& log)
    : settings_(settings),
      catalog_(catalog),
      log_(log),
      pause_(catalog),
      safe_(settings.safe, catalog),
      delivery_(log, settings.inputs, list_, pause_) {
  settings_.limits.inputs = &inputs_;
  settings_.limits.watch = &line_watch_;
  std::vector<InputProblem> problems;
  std::vector<PlayList::Entry> first =
      settings.kept.empty() ? load(settings.play, true, problems) : load_kept(problems);
  for (const Event& event : settings.events) {
    events_.push_back({event.at_ns, event.order, load(event.order.list, true, problems)});
  }
  if (settings.kept.empty()) check_ordered_later(problems);
  if (!problems.empty()) throw InputError(problems);
  std::ranges::stable_sort(events_, {}, &Due::at_ns);
  list_.append(first);
}

ScriptHost::~ScriptHost() = default;

// What plays goes on in another process, whatever has been saved of it meanwhile.
void ScriptHost::check_ordered_later(std::vector<InputProblem>& problems) {
  for (const PlayList::Entry& entry : load(settings_.ordered_later, true, problems))
    std::ranges::move(entry.behavior->files(), std::back_inserter(later_files_));
}

std::vector<PlayList::Entry> ScriptHost::load(const std::vector<PlayItem>& list, bool lasting,
                                              std::vector<InputProblem>& problems) {
  std::vector<PlayList::Entry> loaded;
  for (const PlayItem& item : list) {
    const Behavior::Settings settings{.root = settings_.root,
                                      .file = item.file.is_absolute() ? item.file : settings_.root / item.file,
                                      .seed = settings_.seed,
                                      .limits = settings_.limits,
                                      .arguments = item.arguments,
                                      .source = item.source};
    try {
      auto behavior = std::make_unique<Behavior>(settings, catalog_, log_);
      if (behavior->chart().decides)
        throw InputError({item.source, item.place.line, item.place.column,
                          "'" + behavior->name() + "' is a k.decisions, which plays behaviors: name it as " +
                              "supervisor.decisions, in the robot's configuration or the scenario"});
      loaded.push_back({std::move(behavior), item.lane, lasting});
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
  delivery_.collect(entry);
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

std::vector<const Behavior*> ScriptHost::loaded() const {
  std::vector<const Behavior*> all;
  for (const PlayList::Entry& entry : list_.entries()) all.push_back(entry.behavior.get());
  for (const Due& due : events_) {
    for (const PlayList::Entry& entry : due.loaded) all.push_back(entry.behavior.get());
  }
  return all;
}

std::vector<std::string> ScriptHost::names() const {
  std::vector<std::string> all;
  for (const Behavior* behavior : loaded()) all.push_back(behavior->name());
  return all;
}

WrongData ScriptHost::wrong_event(const PlayedEvent& event) const {
  std::vector<std::string> names;
  WrongData wrong;
  for (const Behavior* behavior : loaded()) {
    for (const ScriptEvent& declared : behavior->events()) names.push_back(declared.name);
    const ScriptEvent* declared = find_event(behavior->events(), event.name);
    if (declared == nullptr) continue;
    wrong = wrong_data(*declared, event);
    if (wrong.why.empty()) return wrong;
  }
  if (wrong.why.empty()) wrong = {unknown_name("event", event.name, names, "of the behaviors here"), event.place};
  return wrong;
}

void ScriptHost::declare_signals(SignalTable& signals) {
  list_.status().declare(signals);
  for (const Behavior* behavior : loaded()) {
    const std::string name = behavior->status().declare_numbered(signals, behavior->name());
    add_signal_states(behavior->chart(), name, signals, signal_states_);
  }
}

std::vector<std::filesystem::path> ScriptHost::files() const {
  std::vector<std::filesystem::path> all = later_files_;
  const auto add = [&all](const Behavior& behavior) {
    for (std::filesystem::path& file : behavior.files()) all.push_back(std::move(file));
  };
  for (const PlayList::Entry& entry : list_.entries()) add(*entry.behavior);
  BehaviorLog silence;
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

bool ScriptHost::repeat_question(std::span<const std::byte> bytes, const Snapshot& snapshot) {
  ByteReader reader(bytes);
  BehaviorQuestion question;
  if (!take_question(reader, question)) return false;
  try {
    (void)reply(question, snapshot);
  } catch (const InputError&) {  // refused, as it was then
  }
  return true;
}

void ScriptHost::order(const PlayOrder& order) {
  tell_asked(inputs_, BehaviorInputs::Asked::order, [&](ByteWriter& bytes) { put_order(order, bytes); });
  std::vector<InputProblem> problems;
  Due due{0, order, load(order.list, false, problems)};
  if (!problems.empty()) throw InputError(problems);
  if (order.kind == PlayOrder::Kind::play) {
    if (const std::string why = clash(due.loaded); !why.empty()) refuse(why);
  }
  if (order.kind == PlayOrder::Kind::emit) check_event(order);
  const std::vector<std::string> known = names();
  const std::string& named = order.behavior.name;
  if (order.kind == PlayOrder::Kind::reload && !named.empty() && std::ranges::find(known, named) == known.end())
    refuse(unknown_name("behavior", named, known));
  orders_.push_back(std::move(due));
}

void ScriptHost::check_event(const PlayOrder& order) {
  const auto waiting =
      std::ranges::count(orders_, PlayOrder::Kind::emit, [](const Due& due) { return due.order.kind; });
  std::string why = out_of_bounds(order.event.data);
  // What another process kept is in the list from the first tick on; the event is judged again when it is delivered.
  if (why.empty() && settings_.kept.empty()) why = delivery_.refusal(order.event, order.behavior.name);
  if (why.empty() && static_cast<std::size_t>(waiting) >= EventDelivery::ordered_max)
    why = std::to_string(EventDelivery::ordered_max) + " events wait for the next tick already";
  if (why.empty()) return;
  list_.count_event(false);
  refuse(why);
}

void ScriptHost::take_orders(const Snapshot& snapshot, CommandSender& commands) noexcept {
  delivery_.begin_tick();
  delivery_.deliver_sent(snapshot);
  delivery_.look_at_inputs(snapshot);
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
  if (kind == Kind::emit) return delivery_.deliver(due.order.event, due.order.behavior.name, snapshot);
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
    entry.behavior->sent_events().clear();
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
    const bool named = order.behavior.name.empty() || entry.behavior->name() == order.behavior.name;
    if (entry.over || !named) continue;
    entry.behavior->hold_clock(pause_.held_ns());
    (void)entry.behavior->reload(snapshot, commands, order.file, PlayList::sets_beside(entry.lane, list_.entries()));
  }
}

void ScriptHost::reload_saved(const Snapshot& snapshot, CommandSender& commands) noexcept {
  if (watch_ == nullptr || !watch_->poll()) return;
  reload({}, snapshot, commands);
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

BehaviorReply ScriptHost::reply(const BehaviorQuestion& question, const Snapshot& snapshot) {
  const bool tells =
      question.kind == BehaviorQuestion::Kind::report || question.kind == BehaviorQuestion::Kind::describe;
  if (!tells)
    tell_asked(inputs_, BehaviorInputs::Asked::question, [&](ByteWriter& bytes) { put_question(question, bytes); });
  switch (question.kind) {
    case BehaviorQuestion::Kind::report:
      return {.paused = paused(), .behaviors = reports()};
    case BehaviorQuestion::Kind::why:
      return {.reasons = why(question.text, snapshot)};
    case BehaviorQuestion::Kind::describe:
      if (settings_.describe == nullptr) refuse("nobody describes these behaviors");
      return {.text = settings_.describe(this)};
    case BehaviorQuestion::Kind::reload:
      refuse("behaviors are reloaded by an order");
    case BehaviorQuestion::Kind::set_parameter:
      break;
  }
  return set_parameter(question.text, question.value);
}

std::vector<BehaviorReport> ScriptHost::reports() const {
  std::vector<BehaviorReport> all;
  for (const PlayList::Entry& entry : list_.entries()) {
    const Behavior& behavior = *entry.behavior;
    all.push_back({.name = behavior.name(),
                   .outcome = behavior.outcome(),
                   .error = behavior.failed() ? behavior.error().text() : "",
                   .result = behavior.result(),
                   .active = behavior.active(),
                   .lane = entry.lane,
                   .over = entry.over,
                   .chart = chart_sign(behavior.chart()),
                   .parameters = behavior.parameters()});
    if (!entry.over) all.back().events = behavior.events();
  }
  return all;
}

void ScriptHost::report(PlayReport& report) const noexcept {
  const PlayStatus& status = list_.status();
  report.phase = status.phase.load(std::memory_order_relaxed);
  report.not_done = status.not_done.load(std::memory_order_relaxed);
  report.count = 0;
  const std::vector<PlayList::Entry>& entries = list_.entries();
  for (std::size_t i = 0; i < entries.size() && report.count < PlayReport::behaviors_max; ++i) {
    if (!list_.has_turn(i)) continue;
    PlayReport::Playing& one = report.playing[report.count++];
    put_text(one.name, entries[i].behavior->name());
    put_text(one.state, entries[i].behavior->state());
  }
}

BehaviorReply ScriptHost::set_parameter(const std::string& name, double value) {
  std::vector<std::string> names = catalog_.parameters.names();
  for (const PlayList::Entry& entry : list_.entries()) {
    for (const ScriptParameter& own : entry.behavior->parameters()) {
      names.push_back(entry.behavior->name() + "." + own.name);
      if (names.back() != name) continue;
      if (!entry.behavior->set_parameter(own.name, value))
        refuse(outside_range(name, value, own.min, own.max, own.unit));
      return {.before = own.value, .chunk = own.chunk};
    }
  }
  refuse(unknown_name("parameter", name, names));
}

std::vector<BehaviorReasons> ScriptHost::why(const std::string& name, const Snapshot& snapshot) const {
  std::vector<BehaviorReasons> all;
  std::vector<std::string> known;
  for (const PlayList::Entry& entry : list_.entries()) {
    if (entry.over) continue;
    known.push_back(entry.behavior->name());
    if (name.empty() || name == known.back()) all.push_back({known.back(), entry.behavior->why(snapshot)});
  }
  if (!name.empty() && all.empty()) refuse(unknown_name("behavior", name, known));
  return all;
}

// Writes what plays and its state as bytes. The host of another process continues from them: it loads the files when it
// is made, and takes over each behavior's state in its first tick.
std::string ScriptHost::keep(ByteWriter& bytes, std::int64_t time_ns) {
  bytes.put(kept_format);
  bytes.put(static_cast<std::uint32_t>(list_.entries().size()));
  for (const PlayList::Entry& entry : list_.entries()) {
    const Behavior::Settings& settings = entry.behavior->settings();
    put_item({.file = settings.file, .lane = entry.lane, .arguments = settings.arguments, .source = settings.source},
             bytes);
    bytes.put<std::uint8_t>(entry.lasting);
  }
  bytes.put(static_cast<std::uint32_t>(events_done_));
  list_.keep_counts(bytes);
  pause_.keep(bytes, time_ns);
  safe_.keep(bytes);
  delivery_.keep(bytes);
  std::string why;
  for (const PlayList::Entry& entry : list_.entries()) {
    bytes.put<std::uint8_t>(entry.over);
    const std::string its = entry.over ? "" : entry.behavior->keep(bytes);
    if (why.empty() && !its.empty()) why = entry.behavior->name() + ": " + its;
  }
  return why;
}

std::vector<PlayList::Entry> ScriptHost::load_kept(std::vector<InputProblem>& problems) {
  ByteReader bytes(settings_.kept);
  std::vector<PlayItem> items;
  std::vector<bool> lasting;
  const bool known = bytes.take<std::uint32_t>() == kept_format;
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && known && bytes.ok(); --left) {
    items.push_back(take_item(bytes));
    lasting.push_back(bytes.take<std::uint8_t>() != 0);
  }
  if (!known || !bytes.ok() || bytes.left() == 0)
    problems.push_back({.message = "what was kept of the behaviors cannot be read"});
  std::vector<PlayList::Entry> loaded;
  if (problems.empty()) loaded = load(items, true, problems);
  for (std::size_t i = 0; i < loaded.size(); ++i) loaded[i].lasting = lasting[i];
  settings_.kept = settings_.kept.last(bytes.left());
  return loaded;
}

void ScriptHost::go_on(const Snapshot& snapshot, CommandSender& commands) noexcept {
  ByteReader bytes(settings_.kept);
  settings_.kept = {};
  events_done_ = std::min<std::size_t>(bytes.take<std::uint32_t>(), events_.size());
  list_.restore_counts(bytes);
  pause_.restore(bytes);
  safe_.restore(bytes);
  delivery_.restore(bytes);
  for (PlayList::Entry& entry : list_.entries()) {
    entry.over = bytes.take<std::uint8_t>() != 0;
    if (entry.over) continue;
    entry.behavior->hold_clock(pause_.held_ns());
    if (!entry.behavior->go_on(bytes, snapshot, commands)) {
      lost_ = entry.behavior->name() + ": " + entry.behavior->error().text();
      return;
    }
  }
  if (!bytes.ok() || bytes.left() > 0) lost_ = "what was kept of the behaviors cannot be read";
}

}  // namespace kadans
