#include "decision_stage.h"

#include <algorithm>
#include <cmath>

#include "config/robot/project_root.h"
#include "kadans/signal/input_error.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

// As Lua reads it.
std::string as_lua(const std::string& text) {
  std::string all = "\"";
  for (const char c : text) {
    if (c == '\n') {
      all += "\\n";
    } else {
      if (c == '"' || c == '\\') all += '\\';
      all += c;
    }
  }
  return all + "\"";
}

std::string lua_of(const PlayValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return number_text(*number);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  return as_lua(std::get<std::string>(value));
}

std::string lua_of(const std::vector<PlayArgument>& arguments) {
  std::string all = "{";
  for (const PlayArgument& argument : arguments)
    all += "[" + as_lua(argument.name) + "]=" + lua_of(argument.value) + ",";
  return all + "}";
}

std::string played_name(const PlayItem& item) { return item.file.stem().string(); }

// "walk_to, kick | look"
std::string played_list(const std::vector<PlayItem>& list) {
  std::string all;
  for (std::size_t i = 0; i < list.size(); ++i)
    all += std::string(i == 0 ? "" : list[i].lane == list[i - 1].lane ? ", " : " | ") + played_name(list[i]);
  return all;
}

std::string lua_of(const PlayOrder& order, const std::string& refused) {
  using Kind = PlayOrder::Kind;
  std::string all = "{word=" + as_lua(play_order_names.at(static_cast<std::size_t>(order.kind)));
  if (order.kind == Kind::play || order.kind == Kind::replace) {
    all += ",list=" + as_lua(played_list(order.list));
    all += ",arguments=" + lua_of(order.list.empty() ? std::vector<PlayArgument>() : order.list.front().arguments);
  }
  if (order.kind == Kind::emit)
    all += ",event=" + as_lua(order.event.name) + ",data=" + lua_of(order.event.data) +
           ",to=" + as_lua(order.behavior.name.empty() ? "all" : order.behavior.name);
  if (!refused.empty()) all += ",refused=" + as_lua(refused);
  return all + "},";
}

}  // namespace

DecisionStage::DecisionStage(ScenarioConfig scenario, const std::filesystem::path& decisions)
    : RobotStage(std::move(scenario)),
      folders_(folders_of(scenario_)),
      decisions_({.root = project_root(decisions), .file = decisions, .seed = scenario_.seed, .folders = folders_},
                 assembly_.catalog(), log_),
      period_ns_(std::llround(1e9 / assembly_.supervising().rate_Hz)) {}

void DecisionStage::stepped(std::int64_t time_ns) {
  if (time_ns < next_ns_) return;
  next_ns_ += period_ns_;
  look();
  decide();
}

void DecisionStage::decide() {
  (void)decisions_.tick(seen_, report_);
  for (const PlayOrder& order : decisions_.decided().orders) {
    ++report_.given;
    ++report_.orders;
    const std::string refused = refusal(order);
    orders_ += lua_of(order, refused);
    if (refused.empty()) {
      play(order);
    } else {
      ++report_.orders_refused;
      put_text(report_.refusal, refused);
    }
  }
  for (const PlayedEvent& message : decisions_.decided().messages)
    messages_ += "{event=" + as_lua(message.name) + ",data=" + lua_of(message.data) + "},";
}

// As a host of behaviors would find it.
std::string DecisionStage::refusal(const PlayOrder& order) {
  BehaviorLog silence;
  try {
    for (const PlayItem& item : order.list) {
      const Behavior read({.root = decisions_.behavior().settings().root,
                           .file = item.file,
                           .arguments = item.arguments,
                           .source = item.source},
                          assembly_.catalog(), silence);
      if (read.chart().decides) return "'" + read.name() + "' is a k.decisions, which plays behaviors";
    }
  } catch (const InputError& error) {
    return error.problems().front().message;
  }
  return "";
}

void DecisionStage::play(const PlayOrder& order) {
  using Kind = PlayOrder::Kind;
  if (order.kind == Kind::stop) report_.phase = report_.count = 0;
  if (order.kind == Kind::pause && report_.phase == 1) report_.phase = 2;
  if (order.kind == Kind::resume && report_.phase == 2) report_.phase = 1;
  if (order.kind == Kind::play && report_.phase != 0) return;  // it waits for its turn
  if (order.kind != Kind::play && order.kind != Kind::replace) return;
  report_.phase = 1;
  report_.count = 0;
  for (std::size_t i = 0; i < order.list.size() && report_.count < PlayReport::behaviors_max; ++i) {
    if (i > 0 && order.list[i].lane == order.list[i - 1].lane) continue;
    report_.playing[report_.count] = {};
    put_text(report_.playing[report_.count++].name, played_name(order.list[i]));
  }
}

// With `from` as the name of the robot that sent it.
std::string DecisionStage::emit(const PlayedEvent& event) {
  PlayedEvent heard = event;
  for (const PlayArgument& field : event.data) {
    const auto* from = std::get_if<std::string>(&field.value);
    if (field.name == "from" && from != nullptr) heard.who = *from;
  }
  return decisions_.refusal(std::move(heard));
}

std::string DecisionStage::end_play(const std::string& outcome) {
  if (report_.phase == 0) return "play_ends: nothing plays";
  if (outcome != "done" && outcome != "failed") return "play_ends: what plays ends as \"done\" or \"failed\"";
  report_.phase = report_.count = 0;
  report_.not_done += outcome == "failed" ? 1 : 0;
  return "";
}

std::string DecisionStage::set_playing(const std::string& behavior, const std::string& state) {
  std::string names;
  for (std::uint32_t i = 0; i < report_.count; ++i) {
    PlayReport::Playing& one = report_.playing[i];
    names += (names.empty() ? "" : ", ") + std::string(one.name.data());
    if (behavior != one.name.data()) continue;
    put_text(one.state, state);
    return "";
  }
  return "plays: '" + behavior + "' does not play" + (names.empty() ? ": nothing does" : "; what does: " + names);
}

}  // namespace kadans
