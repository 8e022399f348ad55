#include "match_summary.h"

#include <algorithm>
#include <numbers>

#include "match_report.h"

namespace kadans::football {
namespace {

constexpr std::uint64_t bootstrap_seed = 1;
constexpr std::size_t missing_told = 10;

// What each match gives one number of.
template <typename Of>
SampleStatistics statistics_of(const VariantResults& all, const char* name, Of&& of) {
  std::vector<double> values;
  for (const MatchResult& result : all.results) values.push_back(of(result));
  return sample_statistics(values, bootstrap_seed, name);
}

template <typename Is>
Share share_of(const VariantResults& all, Is&& is) {
  return {static_cast<std::size_t>(std::ranges::count_if(all.results, is)), all.results.size()};
}

template <typename Of>
double worst(const MatchResult& result, Of&& of) {
  double most = 0;
  for (const PlayedRobot& robot : result.robots) most = std::max(most, of(robot));
  return most;
}

double falls_per_minute(const MatchResult& result) {
  double falls = 0;
  for (const PlayedRobot& robot : result.robots) falls += static_cast<double>(robot.falls);
  return falls / (static_cast<double>(result.robots.size()) * result.simulated_s / 60);
}

// The team that said more.
double most_messages(const MatchResult& result) {
  std::array<double, 2> sent{};
  for (const PlayedRobot& robot : result.robots)
    sent.at(index_of(robot.id.side)) += static_cast<double>(robot.messages);
  return std::max(sent[0], sent[1]);
}

std::string printed(const char* what, const Share& share) {
  const double percent = share.of == 0 ? 0 : 100.0 * static_cast<double>(share.hits) / static_cast<double>(share.of);
  const Interval around = share.interval();
  return formatted("  %-34s %4zu of %-4zu %5.1f %%  (%.1f to %.1f)\n", what, share.hits, share.of, percent,
                   100 * around.low, 100 * around.high);
}

std::string printed(const char* what, const SampleStatistics& value, const char* unit, double scale = 1) {
  return formatted("  %-34s %8.3g %s  (%.3g to %.3g), median %.3g, most %.3g\n", what, scale * value.mean, unit,
                   scale * value.mean_interval.low, scale * value.mean_interval.high, scale * value.median,
                   scale * value.greatest);
}

std::string json_of(const Share& share) {
  const Interval around = share.interval();
  return formatted("{\"hits\": %zu, \"of\": %zu, \"low\": %.4f, \"high\": %.4f}", share.hits, share.of, around.low,
                   around.high);
}

std::string json_of(const SampleStatistics& value) {
  return formatted("{\"mean\": %.6g, \"low\": %.6g, \"high\": %.6g, \"median\": %.6g, \"most\": %.6g}", value.mean,
                   value.mean_interval.low, value.mean_interval.high, value.median, value.greatest);
}

std::string json_of(const MatchSummary& s) {
  std::string settings;
  for (const std::string& setting : s.variant.settings) settings += (settings.empty() ? "" : ", ") + json_text(setting);
  std::string text = "{\"file\": " + json_text(s.variant.file) + ", \"settings\": [" + settings + "]" +
                     formatted(", \"matches\": %zu, \"missing\": %zu, \"errors\": %llu", s.matches, s.missing.size(),
                               static_cast<unsigned long long>(s.errors));
  const std::pair<const char*, const Share*> shares[] = {{"ended_by_itself", &s.ended_by_itself},
                                                         {"home_won", &s.home_won},
                                                         {"drawn", &s.drawn},
                                                         {"away_won", &s.away_won},
                                                         {"with_goals", &s.with_goals},
                                                         {"still_below_20_s", &s.still_below_limit},
                                                         {"frozen_below_20_s", &s.frozen_below_limit},
                                                         {"within_budget", &s.within_budget}};
  for (const auto& [name, share] : shares) text += ",\n    \"" + std::string(name) + "\": " + json_of(*share);
  const std::pair<const char*, const SampleStatistics*> values[] = {{"goals", &s.goals},
                                                                    {"home_goals", &s.home_goals},
                                                                    {"away_goals", &s.away_goals},
                                                                    {"falls_per_robot_and_minute", &s.falls_per_minute},
                                                                    {"still_max_s", &s.still_max_s},
                                                                    {"frozen_max_s", &s.frozen_max_s},
                                                                    {"off_m", &s.off_m},
                                                                    {"off_rad", &s.off_rad},
                                                                    {"messages_of_a_team", &s.messages}};
  for (const auto& [name, value] : values) text += ",\n    \"" + std::string(name) + "\": " + json_of(*value);
  if (s.errors > 0) text += ",\n    \"first_error\": " + json_text(s.first_error);
  std::string missing;
  for (const std::string& one : s.missing) missing += (missing.empty() ? "" : ", ") + json_text(one);
  return text + ",\n    \"without_result\": [" + missing + "]}";
}

}  // namespace

MatchSummary summary_of(const VariantResults& played) {
  MatchSummary s;
  s.matches = played.results.size();
  s.variant = played.variant;
  s.missing = played.missing;
  s.ended_by_itself = share_of(played, ended_by_itself);
  VariantResults all;  // a match that broke off tells nothing of the teams
  for (const MatchResult& result : played.results) {
    if (ended_by_itself(result)) {
      all.results.push_back(result);
    } else {
      s.missing.push_back(command_of(played.variant, result.seed) + ": " + result.ended);
    }
  }
  s.home_won = share_of(all, [](const MatchResult& r) { return r.score[0] > r.score[1]; });
  s.drawn = share_of(all, [](const MatchResult& r) { return r.score[0] == r.score[1]; });
  s.away_won = share_of(all, [](const MatchResult& r) { return r.score[0] < r.score[1]; });
  s.with_goals = share_of(all, [](const MatchResult& r) { return r.score[0] + r.score[1] > 0; });
  s.within_budget = share_of(all, [](const MatchResult& r) { return r.over_budget[0] + r.over_budget[1] == 0; });
  const auto still_s = [](const MatchResult& r) {
    return worst(r, [](const PlayedRobot& p) { return p.still_max_s; });
  };
  const auto frozen_s = [](const MatchResult& r) {
    return worst(r, [](const PlayedRobot& p) { return p.frozen_max_s; });
  };
  s.still_below_limit = share_of(all, [&](const MatchResult& r) { return still_s(r) <= still_limit_s; });
  s.frozen_below_limit = share_of(all, [&](const MatchResult& r) { return frozen_s(r) <= still_limit_s; });
  s.goals = statistics_of(all, "goals", [](const MatchResult& r) { return double{0} + r.score[0] + r.score[1]; });
  s.home_goals = statistics_of(all, "home", [](const MatchResult& r) { return static_cast<double>(r.score[0]); });
  s.away_goals = statistics_of(all, "away", [](const MatchResult& r) { return static_cast<double>(r.score[1]); });
  s.falls_per_minute = statistics_of(all, "falls", falls_per_minute);
  s.still_max_s = statistics_of(all, "still", still_s);
  s.frozen_max_s = statistics_of(all, "frozen", frozen_s);
  s.off_m = statistics_of(
      all, "off_m", [](const MatchResult& r) { return worst(r, [](const PlayedRobot& p) { return p.off_median_m; }); });
  s.off_rad = statistics_of(all, "off_rad", [](const MatchResult& r) {
    return worst(r, [](const PlayedRobot& p) { return p.off_median_rad; });
  });
  s.messages = statistics_of(all, "messages", most_messages);
  for (const MatchResult& result : played.results) {
    for (const PlayedRobot& robot : result.robots) {
      if (robot.errors > 0 && s.errors == 0)
        s.first_error = command_of(played.variant, result.seed) + ": " + robot.first_error;
      s.errors += robot.errors;
    }
  }
  return s;
}

std::vector<MatchSummary> summaries_of(const std::vector<VariantResults>& all) {
  std::vector<MatchSummary> summaries;
  summaries.reserve(all.size());
  for (const VariantResults& one : all) summaries.push_back(summary_of(one));
  return summaries;
}

bool all_well(const std::vector<MatchSummary>& all) {
  return std::ranges::all_of(all, [](const MatchSummary& s) {
    return s.missing.empty() && s.errors == 0 && s.ended_by_itself.hits == s.matches &&
           s.within_budget.hits == s.matches;
  });
}

std::string summary_text(const std::vector<MatchSummary>& all) {
  std::string text;
  for (const MatchSummary& s : all) {
    text += s.variant.name() + formatted(": %zu matches\n", s.matches);
    if (s.matches > 0) {
      text += printed("ended by the rules or its file", s.ended_by_itself);
      text += printed("won by home", s.home_won) + printed("drawn", s.drawn) + printed("won by away", s.away_won);
      text += printed("with goals", s.with_goals);
      text += printed("goals a match", s.goals, "");
      text += printed("falls a robot and minute", s.falls_per_minute, "");
      text += printed("nobody still for 20 s of play", s.still_below_limit);
      text += printed("nobody frozen for 20 s of play", s.frozen_below_limit);
      text += printed("longest stand in play", s.still_max_s, "s");
      text += printed("longest time frozen", s.frozen_max_s, "s");
      text += printed("off in the median, worst robot", s.off_m, "m");
      text += printed("turned off, worst robot", s.off_rad, "deg", 180 / std::numbers::pi);
      text += printed("messages of the team that says more", s.messages, "");
      text += printed("within the messages' budget", s.within_budget);
    }
    if (s.errors > 0)
      text += formatted("  %llu errors of decisions or behaviors, the first:\n",
                        static_cast<unsigned long long>(s.errors)) +
              "    " + s.first_error + "\n";
    if (!s.missing.empty()) text += formatted("  %zu without a result:\n", s.missing.size());
    for (std::size_t i = 0; i < std::min(s.missing.size(), missing_told); ++i) text += "    " + s.missing[i] + "\n";
  }
  return text;
}

std::string summary_json(const std::vector<MatchSummary>& all) {
  std::string text;
  for (const MatchSummary& one : all) text += (text.empty() ? "" : ",\n  ") + json_of(one);
  return "{\"variants\": [" + text + "]}";
}

}  // namespace kadans::football
