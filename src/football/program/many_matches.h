// Many matches: each file, with each mix of what varies, with each seed. A process plays one of them, so that one that
// crashes disturbs no other; what they come to stands in match_summary.h.
//
// A folder keeps the results: a match that has one there is not played again, and a part of the matches may be played
// by another process or machine (Slurm's array). A plan beside them holds what was asked for and a hash of what played,
// so that results of two versions never come together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kadans/campaign/shard.h"
#include "played_match.h"

namespace kadans::football {

struct ManyMatches {
  std::vector<std::string> files;
  std::vector<std::string> settings;   // "rules.half_s=60", of all matches
  std::vector<std::string> varied;     // "network.lost=0,0.3,1": each value with each other
  std::uint64_t seed = 1, cases = 20;  // each variant is played with the seeds seed .. seed + cases - 1
};

// A file with its settings.
struct MatchVariant {
  std::string file;
  std::vector<std::string> settings;
  std::string name() const;  // "config/matches/a.json network.lost=0.3"
};

// "kadans-football match FILE --seed N --set ...": what plays it by itself.
std::string command_of(const MatchVariant& variant, std::uint64_t seed);

struct VariantResults {
  MatchVariant variant;
  std::vector<MatchResult> results;  // by seed
  std::vector<std::string> missing;  // without a result: why, and the command that plays it
};

// Throws InputError: a file or a setting is wrong, there are too many.
std::vector<MatchVariant> variants_of(const ManyMatches& plan);

struct ManyChoices {
  std::string out;  // the folder of results; "": none are kept
  Shard shard;
  std::size_t jobs = 0;   // at once; 0: one a core
  bool told = false;      // of progress, on stderr
  std::string program{};  // that plays a match; "": this one
};

// Plays this part. A match that ends without a result is among the missing ones. Throws InputError, and
// std::system_error when a process cannot be started. `stop`: no further match begins, running ones are ended.
std::vector<VariantResults> play_many(const ManyMatches& plan, const ManyChoices& choices, bool (*stop)());
// What the folders hold together, of the same plan; what none of them has is missing. Throws InputError.
std::vector<VariantResults> merge_many(const std::vector<std::string>& folders);

}  // namespace kadans::football
