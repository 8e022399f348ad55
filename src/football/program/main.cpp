// kadans-football: matches of robots on the SDK alone, as a program of anybody could be built.
#include <charconv>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>

#include "kadans/signal/input_error.h"
#include "kadans/signal/output_file.h"
#include "match_report.h"

namespace {

using namespace kadans;
using namespace kadans::football;

constexpr int exit_passed = 0, exit_failed = 1, exit_usage = 2, exit_internal = 3;

constexpr const char* usage =
    "usage: kadans-football match FILE [--seed N] [--json] [--report FOLDER] [--verbose]\n"
    "  FILE        a match, such as config/matches/striker_drill.json\n"
    "  --seed N    seed of all random numbers (default: the file's)\n"
    "  --json      print the result and all decisions of the referee as one JSON object\n"
    "  --report    write there the result (.json), all that was said (.txt) and where all were (.csv)\n"
    "  --verbose   tell on stderr what is decided and said while it goes on\n";

struct Options {
  std::string file, report;
  std::optional<std::uint64_t> seed;
  bool json = false, verbose = false;
};

int refuse_usage(const std::string& why) {
  std::fprintf(stderr, "error: %s\n%s", why.c_str(), usage);
  return exit_usage;
}

std::string read_options(int argc, char** argv, Options& options) {
  if (argc < 2) return "what shall it do? 'match'";
  if (std::strcmp(argv[1], "match") != 0)
    return "unknown command '" + std::string(argv[1]) + "', did you mean 'match'?";
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--json") {
      options.json = true;
    } else if (word == "--verbose" || word == "-v") {
      options.verbose = true;
    } else if (word == "--report") {
      if (i + 1 >= argc) return "--report needs a folder";
      options.report = argv[++i];
    } else if (word == "--seed") {
      const std::string number = i + 1 < argc ? argv[++i] : "";
      std::uint64_t seed = 0;
      const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), seed);
      if (number.empty() || error != std::errc{} || end != number.data() + number.size())
        return "--seed needs a whole number, not '" + number + "'";
      options.seed = seed;
    } else if (word.starts_with("-") && word != "-") {
      return "unknown option '" + word + "'";
    } else if (options.file.empty()) {
      options.file = word;
    } else {
      return "one match at a time: '" + options.file + "' and '" + word + "'";
    }
  }
  return options.file.empty() ? "which match? It is a file" : "";
}

int play(const Options& options) {
  const MatchConfig match = read_match(options.file);
  const std::uint64_t seed = options.seed.value_or(match.seed);
  PlayedMatch played(match, seed);
  std::string said;
  const std::clock_t began = std::clock();
  for (bool goes_on = true; goes_on;) {
    goes_on = played.step();
    for (const std::string& line : played.take_lines()) {
      if (options.verbose) std::fprintf(stderr, "%s\n", line.c_str());
      if (!options.report.empty()) said += line + "\n";
    }
  }
  const double cpu_s = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  const MatchResult& result = played.result();
  if (!options.report.empty()) {
    const std::string stem =
        (std::filesystem::path(options.report) / (match.name + "-" + std::to_string(seed))).string();
    write_output_file(stem + ".json", json_of(result, match) + "\n");
    write_output_file(stem + ".txt", said);
    write_output_file(stem + ".csv", played.track());
  }
  const std::string text = options.json ? json_of(result, match) : text_of(result, match);
  std::printf("%s\n", text.c_str());
  if (!options.json) std::printf("  %.1f times real time on a core\n", result.simulated_s / cpu_s);
  return ended_by_itself(result) ? exit_passed : exit_failed;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (argc == 2 && (std::strcmp(argv[1], "--help") == 0 || std::strcmp(argv[1], "-h") == 0))
    return std::fputs(usage, stdout) < 0 ? exit_failed : exit_passed;
  const std::string wrong = read_options(argc, argv, options);
  if (!wrong.empty()) return refuse_usage(wrong);
  try {
    const int code = play(options);
    return std::fflush(stdout) == 0 ? code : exit_failed;
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems()) std::fprintf(stderr, "error: %s\n", problem.text().c_str());
    return exit_usage;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return exit_internal;
  }
}
