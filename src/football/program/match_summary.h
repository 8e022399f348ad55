// What many matches come to: shares with their intervals (Wilson, 1927), means with theirs (bootstrap), 95 % both.
#pragma once

#include <string>
#include <vector>

#include "kadans/campaign/statistics.h"
#include "many_matches.h"

namespace kadans::football {

struct Share {
  std::size_t hits = 0, of = 0;
  Interval interval() const noexcept { return wilson_interval(hits, of); }
};

struct MatchSummary {
  MatchVariant variant;
  std::vector<std::string> missing;  // without a result, or broken off: why, and the command that plays it
  std::size_t matches = 0;
  Share ended_by_itself, home_won, drawn, away_won, with_goals;
  Share still_below_limit;                         // no robot stood still for longer in play, waiting or not
  Share frozen_below_limit;                        // nor did one that had to move
  Share within_budget;                             // no team sent a message that its budget did not have
  SampleStatistics goals, home_goals, away_goals;  // a match
  SampleStatistics falls_per_minute;               // a robot, and minute of the match
  SampleStatistics still_max_s, frozen_max_s;      // of the robot that stood still, or was frozen, for longest
  SampleStatistics off_m, off_rad;                 // median of where a robot thought to be; of the worst robot
  SampleStatistics messages;                       // a team
  std::uint64_t errors = 0;                        // of decisions and behaviors
  std::string first_error;                         // after the command that plays its match
};

inline constexpr double still_limit_s = 20;

MatchSummary summary_of(const VariantResults& results);
std::vector<MatchSummary> summaries_of(const std::vector<VariantResults>& all);
// Every match is there, ended by itself, kept to its budget, and nobody's decisions had an error.
bool all_well(const std::vector<MatchSummary>& all);
std::string summary_text(const std::vector<MatchSummary>& all);
// One JSON object: {"variants": [{"file":, "settings": [], "matches":, ...}]}.
std::string summary_json(const std::vector<MatchSummary>& all);

}  // namespace kadans::football
