#include "run_choices.h"

#include <cmath>
#include <sstream>

#include "kadans/signal/shell_word.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

std::string exact_text(double number) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, number);
  return error == std::errc{} ? std::string(text, end) : "";
}

NumberEntry parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string_view after = equals == std::string::npos ? "" : std::string_view(text).substr(equals + 1);
  const std::optional<double> value = number_of<double>(after);
  if (!value) refuse("--set", "'" + text + "' must be NAME=NUMBER, such as ground.friction=0.3");
  return {.key = text.substr(0, equals), .value = *value};
}

ScenarioPush parse_push(const std::string& text, double at_s) {
  const std::size_t equals = text.find('=');
  ScenarioPush push;
  push.link.name = text.substr(0, equals);
  push.at_s = at_s;
  std::istringstream numbers(equals == std::string::npos ? "" : text.substr(equals + 1));
  std::size_t count = 0;
  for (std::string number; std::getline(numbers, number, ',') && count < 4; ++count) {
    const std::optional<double> impulse_Ns = number_of<double>(number);
    if (count == 3 || !impulse_Ns || !(std::abs(*impulse_Ns) <= push_max_Ns))
      count = 9;
    else
      push.impulse_Ns[count] = *impulse_Ns;
  }
  if (count != 3) refuse("--push", "'" + text + "' must be LINK=X,Y,Z in Ns, at most 1e4 each, such as torso=0,2,0");
  return push;
}

ScenarioConfig read_scenario(const RunChoices& choices) {
  ScenarioConfig scenario = read_scenario_config(choices.scenario);
  scenario.plugins = choices.plugins;
  if (!choices.play.empty()) scenario.behaviors = read_play_items(choices.play, "--play", folders_of(scenario));
  for (const std::string& setting : choices.set) set_last(scenario, parse_setting(setting));
  return scenario;
}

std::string repeat_command(const RunChoices& choices, std::uint64_t seed) {
  std::string command = "kadans sim " + shell_word(choices.scenario) + " --seed " + std::to_string(seed);
  if (!choices.play.empty()) command += " --play " + shell_quoted(choices.play);
  for (const std::string& setting : choices.set) command += " --set " + shell_quoted(setting);
  if (choices.duration_s) command += " --duration " + number_text(*choices.duration_s);
  return command;
}

void put_facts(const RunChoices& choices, TextMap& facts) {
  if (choices.seed) facts["seed"] = std::to_string(*choices.seed);
  if (choices.duration_s) facts["duration_s"] = exact_text(*choices.duration_s);
  if (!choices.play.empty()) facts["play"] = choices.play;
  if (!choices.set.empty()) facts["set"] = joined(choices.set);
}

void put_facts(const RunBranch& branch, TextMap& facts) {
  if (!branch.name.empty()) facts["branch"] = branch.name;
  if (!branch.play.empty()) facts["branch_play"] = branch.play;
  if (!branch.set.empty()) facts["branch_set"] = joined(branch.set);
  if (!branch.push.empty()) facts["branch_push"] = joined(branch.push);
}

RunChoices choices_of(const TextMap& facts, const std::string& record) {
  RunChoices choices;
  choices.seed = number_of<std::uint64_t>(fact_in(facts, "seed"));
  choices.duration_s = number_of<double>(fact_in(facts, "duration_s"));
  if (!choices.seed || !choices.duration_s ||
      !(*choices.duration_s > 0 && *choices.duration_s <= scenario_duration_max_s))
    refuse(record, "does not say with which seed and for how long it was recorded");
  choices.play = fact_in(facts, "play");
  choices.set = split(fact_in(facts, "set"));
  return choices;
}

RunBranch branch_of(const TextMap& facts) {
  return {.name = fact_in(facts, "branch"),
          .set = split(fact_in(facts, "branch_set")),
          .play = fact_in(facts, "branch_play"),
          .push = split(fact_in(facts, "branch_push"))};
}

}  // namespace kadans
