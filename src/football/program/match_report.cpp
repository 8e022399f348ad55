#include "match_report.h"

#include <array>
#include <charconv>
#include <cstdarg>
#include <cstdio>

#include "kadans/config/input_object.h"

namespace kadans::football {

std::string formatted(const char* pattern, ...) {
  std::array<char, 400> text{};
  std::va_list values;
  va_start(values, pattern);
  std::vsnprintf(text.data(), text.size(), pattern, values);
  va_end(values);
  return text.data();
}

namespace {

std::string json_of(const Decision& decision) {
  return formatted("{\"time_s\": %.3f, \"half\": %d, \"remaining_s\": %.1f, \"text\": ",
                   1e-9 * static_cast<double>(decision.time_ns), decision.first_half ? 1 : 2, decision.remaining_s) +
         json_text(decision.text) + ", \"rule\": " + json_text(decision.rule) + "}";
}

std::string json_of(const PlayedRobot& robot) {
  const std::string error = robot.errors > 0 ? ", \"first_error\": " + json_text(robot.first_error) : "";
  return "{\"name\": " + json_text(robot.name) +
         formatted(
             ", \"falls\": %llu, \"penalties\": %llu, \"messages\": %llu, \"errors\": %llu, \"upright_s\": %.2f, "
             "\"played_s\": %.2f, \"still_max_s\": %.2f, \"frozen_max_s\": %.2f, \"off_median_m\": %.3f, "
             "\"off_most_m\": %.3f, "
             "\"off_median_rad\": %.4f",
             static_cast<unsigned long long>(robot.falls), static_cast<unsigned long long>(robot.penalties),
             static_cast<unsigned long long>(robot.messages), static_cast<unsigned long long>(robot.errors),
             robot.upright_s, robot.played_s, robot.still_max_s, robot.frozen_max_s, robot.off_median_m,
             robot.off_most_m, robot.off_median_rad) +
         error + "}";
}

template <typename T>
std::string json_list(const std::vector<T>& all) {
  std::string text;
  for (const T& one : all) text += (text.empty() ? "\n    " : ",\n    ") + json_of(one);
  return "[" + text + "]";
}

}  // namespace

bool ended_by_itself(const MatchResult& result) { return result.ended.starts_with("by "); }

std::string text_of(const MatchResult& result, const MatchConfig& match) {
  std::string text = formatted("%s %u : %u %s, ended %s\n", match.teams[0].name.c_str(), result.score[0],
                               result.score[1], match.teams[1].name.c_str(), result.ended.c_str());
  for (const Decision& decision : result.decisions) text += "  " + decision.line() + "\n";
  for (const PlayedRobot& robot : result.robots)
    text += formatted(
        "  %s: %llu falls, %llu penalties, %llu messages, stood still for %.1f s at most, frozen for "
        "%.1f s, %.2f m off in the median\n",
        robot.name.c_str(), static_cast<unsigned long long>(robot.falls),
        static_cast<unsigned long long>(robot.penalties), static_cast<unsigned long long>(robot.messages),
        robot.still_max_s, robot.frozen_max_s, robot.off_median_m);
  for (const PlayedRobot& robot : result.robots) {
    if (robot.errors > 0)
      text += formatted("  %s: %llu errors of its decisions or behaviors, the first:\n", robot.name.c_str(),
                        static_cast<unsigned long long>(robot.errors)) +
              "    " + robot.first_error + "\n";
  }
  return text + formatted("  seed %llu, %.1f s, %.1f s of them in play, hash %016llx",
                          static_cast<unsigned long long>(result.seed), result.simulated_s, result.playing_s,
                          static_cast<unsigned long long>(result.state_hash));
}

std::string json_of(const MatchResult& result, const MatchConfig& match) {
  const auto team = [&](std::size_t side) {
    return "{\"name\": " + json_text(match.teams.at(side).name) +
           formatted(", \"goals\": %u, \"messages_left\": %u, \"over_budget\": %llu}", result.score.at(side),
                     result.messages_left.at(side), static_cast<unsigned long long>(result.over_budget.at(side)));
  };
  return "{\"match\": " + json_text(result.match) +
         formatted(", \"seed\": %llu, \"ended\": ", static_cast<unsigned long long>(result.seed)) +
         json_text(result.ended) + ", \"home\": " + team(0) + ", \"away\": " + team(1) +
         formatted(", \"simulated_s\": %.2f, \"playing_s\": %.2f, \"state_hash\": \"%016llx\",\n  \"decisions\": ",
                   result.simulated_s, result.playing_s, static_cast<unsigned long long>(result.state_hash)) +
         json_list(result.decisions) + ",\n  \"robots\": " + json_list(result.robots) + "}";
}

namespace {

constexpr double number_max = 1e12;
constexpr std::uint64_t count_max = 9'007'199'254'740'992;

void read_side(InputObject& f, MatchResult& result, std::size_t side) {
  std::string name;
  std::uint64_t goals = 0, left = 0;
  f.text("name", name, "");
  f.whole("goals", goals, 0, 10'000, "", true);
  f.whole("messages_left", left, 0, 65'535, "", true);
  f.whole("over_budget", result.over_budget.at(side), 0, count_max, "", true);
  result.score.at(side) = static_cast<unsigned>(goals);
  result.messages_left.at(side) = static_cast<unsigned>(left);
}

void read_robot(InputObject& f, MatchResult& result) {
  PlayedRobot robot;
  f.text("name", robot.name, "", true);
  robot.id.side = robot.name.starts_with("away") ? Side::away : Side::home;
  f.whole("falls", robot.falls, 0, count_max, "", true);
  f.whole("penalties", robot.penalties, 0, count_max, "", true);
  f.whole("messages", robot.messages, 0, count_max, "", true);
  f.whole("errors", robot.errors, 0, count_max, "", true);
  f.text("first_error", robot.first_error, "");
  for (const auto& [key, value] : {std::pair{"upright_s", &robot.upright_s},
                                   {"played_s", &robot.played_s},
                                   {"still_max_s", &robot.still_max_s},
                                   {"frozen_max_s", &robot.frozen_max_s},
                                   {"off_median_m", &robot.off_median_m},
                                   {"off_most_m", &robot.off_most_m},
                                   {"off_median_rad", &robot.off_median_rad}})
    f.number(key, *value, {0, number_max}, "", true);
  result.robots.push_back(std::move(robot));
}

void skip_decision(InputObject& f) {
  double number = 0;
  std::string text;
  for (const char* key : {"time_s", "half", "remaining_s"}) f.number(key, number, {-number_max, number_max}, "");
  for (const char* key : {"text", "rule"}) f.text(key, text, "");
}

}  // namespace

MatchResult read_result(const std::filesystem::path& file) {
  MatchResult result;
  read_input_object(file, [&](InputObject& f) {
    std::string hash;
    f.text("match", result.match, "", true);
    f.whole("seed", result.seed, 0, count_max, "", true);
    f.text("ended", result.ended, "", true);
    f.object(
        "home", "", [&](InputObject& e) { read_side(e, result, 0); }, true);
    f.object(
        "away", "", [&](InputObject& e) { read_side(e, result, 1); }, true);
    f.number("simulated_s", result.simulated_s, {0, number_max}, "", true);
    f.number("playing_s", result.playing_s, {0, number_max}, "", true);
    if (f.text("state_hash", hash, "", true))
      (void)std::from_chars(hash.data(), hash.data() + hash.size(), result.state_hash, 16);
    f.list("decisions", "", skip_decision, true);
    f.list(
        "robots", "", [&](InputObject& e) { read_robot(e, result); }, true);
  });
  return result;
}

}  // namespace kadans::football
