#include <algorithm>
#include <cstdio>

#include "bench/report.h"
#include "switch_pairs.h"

namespace kadans::bench {

void bench_switch(Report& report) {
  const std::vector<std::string> sets = switch_sets();
  SwitchStep worst;
  double worst_ns = 0;
  std::string dearest;
  std::size_t pairs = 0;
  for (const std::string& from : sets) {
    for (const std::string& to : sets) {
      if (from == to) continue;
      ++pairs;
      if (const double cost_ns = switch_cost_ns(from, to); cost_ns > worst_ns) {
        worst_ns = cost_ns;
        dearest = from + " -> " + to;
      }
      std::string text = "step at the switch " + from + " -> " + to + ":";
      double largest = 0;
      for (const Situation situation : situations) {
        const SwitchStep step = measure_switch(from, to, situation);
        char figure[64];
        std::snprintf(figure, sizeof figure, " %s %.2f,", name(situation), 100 * step.share);
        text += figure;
        largest = std::max(largest, step.share);
        if (step.share > worst.share) worst = step;
      }
      text.back() = ' ';
      report.add("switch.steps." + from + "_" + to, text + "worst", 100 * largest, "% of the limit");
    }
  }
  report.add("switch.pairs", "pairs, in 4 situations each", static_cast<double>(pairs), "");
  report.add("switch.worst_step_percent",
             "largest step: " + worst.from + " -> " + worst.to + ", " + name(worst.situation) + ", " + worst.joint,
             100 * worst.share, "% of the limit");
  report.add("switch.worst_ns", "what a switch adds to the tick, largest of the pairs' medians: " + dearest, worst_ns,
             "ns");
}

}  // namespace kadans::bench
