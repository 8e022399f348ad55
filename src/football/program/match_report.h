// What is told of a match that was played: for people, and for programs.
#pragma once

#include <string>

#include "played_match.h"

namespace kadans::football {

// As std::printf prints; at most 399 characters. The compiler compares the values with the pattern.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* pattern, ...);

bool ended_by_itself(const MatchResult& result);  // by the rules, or as its file wants it
std::string text_of(const MatchResult& result, const MatchConfig& match);
// One JSON object: {"match":, "seed":, "ended":, "home": {"name":, "goals":}, ..., "decisions": [...], "robots":
// [...]}. The same match gives the same text.
std::string json_of(const MatchResult& result, const MatchConfig& match);
// And back: what json_of wrote into this file, but for the decisions. Throws InputError.
MatchResult read_result(const std::filesystem::path& file);

}  // namespace kadans::football
