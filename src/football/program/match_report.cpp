#include "match_report.h"

#include <cstdio>

namespace kadans::football {
namespace {

template <typename... Values>
std::string line_of(const char* pattern, Values... values) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

std::string json_of(const Decision& decision) {
  return line_of("{\"time_s\": %.3f, \"half\": %d, \"remaining_s\": %.1f, \"text\": ",
                 1e-9 * static_cast<double>(decision.time_ns), decision.first_half ? 1 : 2, decision.remaining_s) +
         json_text(decision.text) + ", \"rule\": " + json_text(decision.rule) + "}";
}

std::string json_of(const PlayedRobot& robot) {
  return "{\"name\": " + json_text(robot.name) +
         line_of(
             ", \"falls\": %llu, \"penalties\": %llu, \"messages\": %llu, \"errors\": %llu, \"upright_s\": %.2f, "
             "\"played_s\": %.2f, \"still_max_s\": %.2f, \"off_median_m\": %.3f, \"off_most_m\": %.3f}",
             static_cast<unsigned long long>(robot.falls), static_cast<unsigned long long>(robot.penalties),
             static_cast<unsigned long long>(robot.messages), static_cast<unsigned long long>(robot.errors),
             robot.upright_s, robot.played_s, robot.still_max_s, robot.off_median_m, robot.off_most_m);
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
  std::string text = line_of("%s %u : %u %s, ended %s\n", match.teams[0].name.c_str(), result.score[0], result.score[1],
                             match.teams[1].name.c_str(), result.ended.c_str());
  for (const Decision& decision : result.decisions) text += "  " + decision.line() + "\n";
  for (const PlayedRobot& robot : result.robots)
    text += line_of(
        "  %s: %llu falls, %llu penalties, %llu messages, stood still for %.1f s at most, %.2f m off in "
        "the median\n",
        robot.name.c_str(), static_cast<unsigned long long>(robot.falls),
        static_cast<unsigned long long>(robot.penalties), static_cast<unsigned long long>(robot.messages),
        robot.still_max_s, robot.off_median_m);
  return text + line_of("  seed %llu, %.1f s, %.1f s of them in play, hash %016llx",
                        static_cast<unsigned long long>(result.seed), result.simulated_s, result.playing_s,
                        static_cast<unsigned long long>(result.state_hash));
}

std::string json_of(const MatchResult& result, const MatchConfig& match) {
  const auto team = [&](std::size_t side) {
    return "{\"name\": " + json_text(match.teams.at(side).name) + line_of(", \"goals\": %u}", result.score.at(side));
  };
  return "{\"match\": " + json_text(result.match) +
         line_of(", \"seed\": %llu, \"ended\": ", static_cast<unsigned long long>(result.seed)) +
         json_text(result.ended) + ", \"home\": " + team(0) + ", \"away\": " + team(1) +
         line_of(", \"simulated_s\": %.2f, \"playing_s\": %.2f, \"state_hash\": \"%016llx\",\n  \"decisions\": ",
                 result.simulated_s, result.playing_s, static_cast<unsigned long long>(result.state_hash)) +
         json_list(result.decisions) + ",\n  \"robots\": " + json_list(result.robots) + "}";
}

}  // namespace kadans::football
