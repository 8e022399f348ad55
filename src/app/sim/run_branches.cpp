#include "run_branches.h"

#include <algorithm>

#include "kadans/signal/nearest_name.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr const char* control_prefix = "control.";
constexpr const char* scale_suffix = "_scale";

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' ');
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

std::vector<ScenarioPush> pushes_of(const RunBranch& branch, double at_s) {
  std::vector<ScenarioPush> pushes;
  for (const std::string& push : branch.push) pushes.push_back(parse_push(push, at_s));
  return pushes;
}

std::vector<std::string> names_of(const ParameterTable& parameters) {
  std::vector<std::string> names;
  for (const std::string& name : parameters.names()) names.push_back(control_prefix + name);
  return names;
}

}  // namespace

RunBranch parse_branch(const std::string& text) {
  const auto refuse_item = [&](const std::string& item) {
    refuse("--branch", "'" + item +
                           "' must be set NAME=NUMBER, push LINK=X,Y,Z or play LIST, as in "
                           "\"hard: push torso=0,3,0; set control.posture.*_scale=0.5\"");
  };
  const std::size_t colon = text.find(':');
  RunBranch branch{.name = trimmed(text.substr(0, colon)), .set = {}, .play = {}, .push = {}};
  if (branch.name.empty() || branch.name.find_first_of("/ ;") != std::string::npos)
    refuse("--branch", "'" + text + "' must begin with a name: \"hard: push torso=0,3,0\"");
  std::string rest = colon == std::string::npos ? "" : text.substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t end = rest.find(';');
    const std::string item = trimmed(rest.substr(0, end));
    rest = end == std::string::npos ? "" : rest.substr(end + 1);
    if (item.empty()) continue;
    const std::size_t blank = std::min(item.find(' '), item.size());
    const std::string word = item.substr(0, blank), what = trimmed(item.substr(blank));
    if (what.empty()) refuse_item(item);
    if (word == "set") {
      branch.set.push_back(what);
    } else if (word == "push") {
      branch.push.push_back(what);
    } else if (word == "play") {
      branch.play = what;
    } else {
      refuse_item(item);
    }
  }
  return branch;
}

std::string branch_text(const RunBranch& branch) {
  std::string text = branch.name + ":";
  const auto add = [&text](const char* word, const std::string& what) {
    text += (text.back() == ':' ? " " : "; ") + std::string(word) + " " + what;
  };
  for (const std::string& setting : branch.set) add("set", setting);
  for (const std::string& push : branch.push) add("push", push);
  if (!branch.play.empty()) add("play", branch.play);
  return text;
}

BranchActions::BranchActions(const RunBranch& branch, const ScenarioConfig& scenario, Assembly& assembly, double at_s)
    : assembly_(assembly), pushes_(pushes_of(branch, at_s), assembly.robot().model, "--push") {
  for (const std::string& setting : branch.set) read_setting(parse_setting(setting), assembly.catalog().parameters);
  if (settings_.size() >= max_transaction) {
    const std::string most = std::to_string(max_transaction - 1);
    refuse("--set", "sets more than " + most + " parameters at once");
  }
  if (!branch.play.empty()) play_ = read_play_items(branch.play, "--play", folders_of(scenario));
}

void BranchActions::read_setting(const NumberEntry& setting, const ParameterTable& parameters) {
  const std::vector<std::string> names = names_of(parameters);
  const bool scale = setting.key.ends_with(scale_suffix) && matching(setting.key, names).empty();
  const std::string key = scale ? setting.key.substr(0, setting.key.rfind(scale_suffix)) : setting.key;
  const std::vector<std::size_t> chosen = matching(key, names);
  if (!key.starts_with(control_prefix)) {
    refuse("--set", in_quotes(setting.key) +
                        " stays as it is: once a run is under way only control.* "
                        "can be set");
  }
  if (chosen.empty()) refuse("--set", unknown_name("parameter", setting.key, names));
  for (const std::size_t index : chosen) {
    const auto id = static_cast<ParameterId>(index);
    if (!scale && !parameters.accepts(id, setting.value)) {
      const Parameter& info = parameters.info(id);
      refuse("--set", names[index] + " is " + number_text(setting.value) + ", must be " + number_text(info.min) + ".." +
                          number_text(info.max));
    }
    settings_.push_back({id, setting.value, scale});
  }
}

void BranchActions::begin(const RunMark& mark) {
  const RunParts parts = assembly_.parts();
  if (!settings_.empty()) {
    const ParameterTable& parameters = assembly_.catalog().parameters;
    CommandSender& sender = parts.behaviors.sender();
    sender.begin(mark.time_ns);
    for (const Setting& setting : settings_) {
      const double value = setting.scale ? parameters.get(setting.parameter) * setting.number : setting.number;
      (void)sender.add({.kind = CommandKind::set_parameter, .index = setting.parameter, .value = value});
    }
    if (sender.commit() == 0) throw std::runtime_error("the command queue refused what the branch sets");
  }
  if (!play_.empty()) assembly_.host().order({.kind = PlayOrder::Kind::replace, .list = play_});
}

void BranchActions::between_ticks(const RunMark& mark) const {
  const RunParts parts = assembly_.parts();
  pushes_.apply(parts.robot, 1e-9 * static_cast<double>(mark.time_ns),
                1e-9 * static_cast<double>(parts.lockstep.control_period_ns()));
}

RecordedBranch::RecordedBranch(const TextMap& facts, const ScenarioConfig& scenario, Assembly& assembly)
    : facts_(facts),
      scenario_(scenario),
      assembly_(assembly),
      tick_(number_of<std::uint64_t>(fact_in(facts, "branch_tick"))) {}

void RecordedBranch::between_ticks(const RunMark& mark) {
  if (tick_ && mark.ticks == *tick_) {
    actions_.emplace(branch_of(facts_), scenario_, assembly_, 1e-9 * static_cast<double>(mark.time_ns));
    actions_->begin(mark);
  }
  if (actions_) actions_->between_ticks(mark);
}

}  // namespace kadans
