#include "kadans/script/script_host.h"

#include <algorithm>

#include "kadans/signal/input_error.h"

namespace kadans {

ScriptHost::ScriptHost(const Settings& settings, const Catalog& catalog, BehaviorLog& log)
    : log_(log), root_(settings.root), reloads_(settings.reloads), safe_(settings.safe, catalog) {
  std::vector<InputProblem> problems;
  for (const ScriptPlay& play : settings.play) {
    const std::filesystem::path file = play.file.is_absolute() ? play.file : settings.root / play.file;
    try {
      behaviors_.push_back({std::make_unique<Behavior>(Behavior::Settings{.root = settings.root,
                                                                          .file = file,
                                                                          .seed = settings.seed,
                                                                          .limits = settings.limits,
                                                                          .feet = settings.feet},
                                                       catalog, log),
                            play.lane});
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(problems);
  const auto earlier = [](const ScriptReload& a, const ScriptReload& b) { return a.at_ns < b.at_ns; };
  std::stable_sort(reloads_.begin(), reloads_.end(), earlier);
}

ScriptHost::~ScriptHost() = default;

void ScriptHost::tick(const Snapshot& snapshot, CommandSender& commands) noexcept {
  reload(snapshot, commands);
  for (std::size_t i = 0; i < behaviors_.size(); ++i) {
    Played& played = behaviors_[i];
    const auto earlier = behaviors_.begin() + static_cast<std::ptrdiff_t>(i);
    const bool waits = std::any_of(behaviors_.begin(), earlier,
                                   [&](const Played& other) { return other.lane == played.lane && !other.over; });
    if (!played.over && !waits) play(played, snapshot, commands);
  }
  if (!safe_.due(snapshot.time_ns)) return;
  safe_.move(snapshot, commands, [this](std::uint32_t object) { return plays_with(object); });
}

void ScriptHost::play(Played& played, const Snapshot& snapshot, CommandSender& commands) noexcept {
  if (played.behavior->tick(snapshot, commands)) return;
  played.over = true;
  if (played.behavior->failed()) {
    report_failure(*played.behavior, snapshot.time_ns);
    safe_.failed(snapshot.time_ns, played.behavior->control_set());
  }
  if (played.behavior->outcome() != "done") close_lane(played.lane);
}

void ScriptHost::report_failure(const Behavior& behavior, std::int64_t time_ns) noexcept {
  const ScriptError& error = behavior.error();
  std::string text = error.text();
  if (error.traceback[0] != '\0') text += std::string("\n") + error.traceback.data();
  log_.message(time_ns, BehaviorLog::Severity::error, behavior.name(), text);
}

void ScriptHost::close_lane(std::uint32_t lane) noexcept {
  for (Played& played : behaviors_) played.over = played.over || played.lane == lane;
}

void ScriptHost::stop(const Snapshot& snapshot, CommandSender& commands) noexcept {
  for (Played& played : behaviors_) {
    if (!played.over && !played.behavior->failed()) played.behavior->stop(snapshot, commands);
    played.over = true;
  }
}

bool ScriptHost::finished() const noexcept {
  return std::all_of(behaviors_.begin(), behaviors_.end(), [](const Played& played) { return played.over; });
}

}  // namespace kadans
