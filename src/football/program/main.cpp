// kadans-football: matches of robots on the SDK alone, as a program of anybody could be built.
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>

#include <sched.h>

#include "command_line.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/output_file.h"
#include "match_report.h"
#include "match_summary.h"
#include "served_match.h"

namespace {

using namespace kadans;
using namespace kadans::football;

constexpr int exit_passed = 0, exit_failed = 1, exit_usage = 2, exit_internal = 3, exit_interrupted = 130;

volatile std::sig_atomic_t told_to_stop = 0;

bool stopped() { return told_to_stop != 0; }

void stop_when_told() {
  struct sigaction action {};
  action.sa_handler = [](int) { told_to_stop = 1; };
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

// Goes on to the end. Returns what was said.
std::string play_out(PlayedMatch& played, const Options& options) {
  std::string said;
  for (bool goes_on = true; goes_on && !stopped();) {
    goes_on = played.step();
    for (const std::string& line : played.take_lines()) {
      if (options.verbose) std::fprintf(stderr, "%s\n", line.c_str());
      if (!options.report.empty()) said += line + "\n";
    }
  }
  return said;
}

int play(const Options& options) {
  const MatchConfig match = read_match(options.files[0], options.set);
  const std::uint64_t seed = options.seed.value_or(match.seed);
  PlayedMatch played(match, seed);
  if (!options.record.empty())
    played.record(options.record, options.signals, command_of({options.files[0], options.set}, seed));
  if (!options.live.empty()) played.show(static_cast<std::uint16_t>(std::stoul(options.live)));
  stop_when_told();
  const std::clock_t began = std::clock();
  const std::string said = play_out(played, options);
  const double cpu_s = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  if (!options.record.empty()) played.end_record();
  if (stopped()) return exit_interrupted;
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

// A thread of real time, where the system lets it be one: the robots wait for the world.
void take_priority() {
  sched_param priority{};
  priority.sched_priority = 40;
  if (sched_setscheduler(0, SCHED_FIFO, &priority) != 0)
    std::fprintf(stderr, "without the right to real time (docs/realtime.md): robots may find the world late\n");
}

int serve(const Options& options) {
  const MatchConfig match = read_match(options.files[0], options.set);
  const std::uint64_t seed = options.seed.value_or(match.seed);
  const ServedPlaces places = ServedPlaces::of(options.listen, options.referee);
  auto world = std::make_unique<ServedMatch>(match, seed, places);
  ServedMatch& served = *world;
  if (!options.robots.empty()) std::fprintf(stderr, "%s", write_robots(match, places, options.robots).c_str());
  std::fprintf(stderr, "serves %zu robots from %s on\n", match.robots().size(), options.listen.c_str());
  stop_when_told();
  while (!stopped() && !served.await(50)) {
  }
  if (stopped()) return exit_interrupted;
  std::fprintf(stderr, "all robots are driven\n");
  PlayedMatch played(match, seed, std::move(world), !options.referee.empty());
  take_priority();
  (void)play_out(played, options);
  const MatchResult& result = played.result();
  std::printf("%s\n", (options.json ? json_of(result, match) : text_of(result, match)).c_str());
  if (served.lost_periods() > 0)
    std::fprintf(stderr, "%llu periods of the world were lost: the machine is too slow or too busy\n",
                 static_cast<unsigned long long>(served.lost_periods()));
  if (stopped()) return exit_interrupted;
  return ended_by_itself(result) ? exit_passed : exit_failed;
}

int tell(const std::vector<VariantResults>& results, bool json) {
  const std::vector<MatchSummary> all = summaries_of(results);
  std::printf("%s", json ? (summary_json(all) + "\n").c_str() : summary_text(all).c_str());
  return all_well(all) ? exit_passed : exit_failed;
}

int play_all(const Options& options) {
  const ManyMatches plan{.files = options.files,
                         .settings = options.set,
                         .varied = options.vary,
                         .seed = options.seed.value_or(1),
                         .cases = options.cases.value_or(20)};
  const ManyChoices choices{
      .out = options.out,
      .shard = options.shard.empty() ? slurm_shard().value_or(Shard{}) : parse_shard(options.shard),
      .jobs = options.jobs.value_or(0),
      .told = options.verbose};
  stop_when_told();
  const int code = tell(play_many(plan, choices, stopped), options.json);
  return stopped() ? exit_interrupted : code;
}

int obey(const Options& options) {
  switch (options.command) {
    case Options::Command::match:
      return play(options);
    case Options::Command::matches:
      return play_all(options);
    case Options::Command::merge:
      return tell(merge_many(options.files), options.json);
    case Options::Command::serve:
      return serve(options);
  }
  return exit_usage;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (const std::optional<int> code = read_options(argc, argv, options)) return *code;
  try {
    const int code = obey(options);
    return std::fflush(stdout) == 0 ? code : exit_failed;
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems()) std::fprintf(stderr, "error: %s\n", problem.text().c_str());
    return exit_usage;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return exit_internal;
  }
}
