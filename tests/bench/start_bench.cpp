// The program as a whole: how long until it has simulated its first tick, a second, and how much memory it takes; what
// a second process on another core costs the first.
#include "child.h"
#include "report.h"

namespace kadans::bench {
namespace {

std::vector<std::string> simulation(double duration_s) {
  return {KADANS_PROGRAM,
          "sim",
          KADANS_SOURCE_DIR "/config/scenarios/squat.json",
          "--duration",
          std::to_string(duration_s),
          "--no-record",
          "--json"};
}

double startup_ms(double duration_s, int times) {
  std::vector<double> each;
  for (int i = 0; i < times; ++i) each.push_back(run_children(simulation(duration_s)).wall_ms);
  return median(each);
}

// How many times as much two processes simulate in the same time as one alone; in turns.
double scaling() {
  constexpr int rounds = 5;
  constexpr double simulated_s = 20;
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round) {
    const double one_ms = run_children(simulation(simulated_s)).wall_ms;
    ratios.push_back(2 * one_ms / run_children(simulation(simulated_s), 2).wall_ms);
  }
  return median(ratios);
}

}  // namespace

void bench_start(Report& report) {
  report.add("startup_ms", "kadans sim of one tick, start to exit", startup_ms(0.001, 21), "ms");
  report.add("sim_1s_ms", "kadans sim of 1 s, start to exit", startup_ms(1, 11), "ms");
  report.add("resident_mb", "memory of that, at most", run_children(simulation(1)).resident_mb, "MB");
  report.add("scaling.two_processes", "two processes simulate as much as one alone", scaling(), "x");
}

}  // namespace kadans::bench
