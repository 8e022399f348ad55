#include "run_report.h"

#include <array>
#include <fstream>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "config/json/foreign_json.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

double resident_MB() {
  std::ifstream file("/proc/self/statm");
  double mapped = 0, resident = 0;
  file >> mapped >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

Json percentiles_of(const TickStatistics& statistics) {
  constexpr std::array told{p50, p99, p999, p9999, p99999};
  return tick_json(statistics, told);
}

double preparation_s(const TaskThread& thread) {
  const TickStatistics& s = thread.preparation();
  return 1e-9 * s.mean_ns() * static_cast<double>(s.count());
}

Json json_of(const TaskThread& thread) {
  const TaskStatistics& s = thread.statistics();
  return {{"beats", s.lateness.count()},
          {"overruns", s.overruns.get()},
          {"late_wakes", s.late_wakes.get()},
          {"missed", s.missed.get()},
          {"page_faults", thread.page_faults()},
          {"cpu_s", 1e-9 * static_cast<double>(thread.cpu_time_ns())},
          {"lateness_us", percentiles_of(s.lateness)},
          {"jitter_us", percentiles_of(s.jitter)},
          {"execution_us", percentiles_of(s.execution)},
          {"preparation_us", percentiles_of(thread.preparation())},
          {"preparation_s", preparation_s(thread)}};
}

std::string row(const char* name, const TickStatistics& s, const std::string& rest) {
  return printed("  %-20s %9.2f %9.2f %9.2f %9.2f  %s\n", name, in_us(s, p50), in_us(s, p99), in_us(s, p999),
                 in_us(s.max_ns()), rest.c_str());
}

unsigned long long whole(std::uint64_t value) { return value; }

std::string rows_of(const TaskThread& thread) {
  const TaskStatistics& s = thread.statistics();
  std::string rows = row((thread.settings().name + ", late").c_str(), s.lateness,
                         printed("%llu beats, %llu missed, %llu page faults", whole(s.lateness.count()),
                                 whole(s.missed.get()), whole(thread.page_faults())));
  if (thread.preparation().count() > 0)
    rows += row("  preparation", thread.preparation(),
                printed("before the tick, %.2f s of %.2f s CPU time", preparation_s(thread),
                        1e-9 * static_cast<double>(thread.cpu_time_ns())));
  return rows + row("  work", s.execution, "");
}

// A recorder may exist only for its flight recorder.
bool has_record(const WallClockResult& result) {
  return result.recorder != nullptr && (result.recorder->rows() > 0 || !result.recorder->error().empty());
}

std::uint64_t refused(const WallClockResult& result) {
  return result.behaviors.commands().refused() + result.engine.inbox().state().refused;
}

}  // namespace

std::string run_report_text(const WallClockResult& result) {
  std::string all = printed("%s after %.3f s, %.1f MB resident, first tick %.0f ms after the start\n\n",
                            result.ended.c_str(), result.duration_s, resident_MB(), result.start_ms);
  all += printed("  %-20s %9s %9s %9s %9s\n", "us", "p50", "p99", "p999", "max");
  for (const auto& thread : result.threads.all()) all += rows_of(*thread);
  all += row("control tick alone", result.control.tick_cost(), "");
  all += printed("\n  commands: %llu sent, %llu applied, %llu refused\n", whole(result.behaviors.commands().sent()),
                 whole(result.engine.inbox().state().applied), whole(refused(result)));
  for (const auto& [process, name] :
       {std::pair(result.process, "behavior process"), std::pair(result.decision_process, "decision process")}) {
    if (process == nullptr) continue;
    all += row(name, process->answer_cost(), "from the request to the answer");
    all += printed("  %s: died %llu times, replaced %llu times%s\n", name, whole(process->deaths()),
                   whole(process->takeovers()), process->down() ? ", is down" : "");
  }
  if (has_record(result))
    all += printed("  record: %llu rows, %u dropped, %llu lost, %.1f MB\n", whole(result.recorder->rows()),
                   result.recorder->dropped(), whole(result.recorder->lost()),
                   1e-6 * static_cast<double>(result.recorder->file_bytes()));
  if (result.plant != nullptr && result.plant->lost_periods() > 0)
    all += printed("  the model was too slow: %llu ms did not pass for it\n", whole(result.plant->lost_periods()));
  if (!result.link.empty()) all += "  link: " + link_text(result.link) + "\n";
  return all;
}

std::string run_report_json(const WallClockResult& result) {
  Json threads;
  for (const auto& thread : result.threads.all()) threads[thread->settings().name] = json_of(*thread);
  if (result.threads.keep_awake() != nullptr) {
    threads["keep_awake"] = {{"cpu_s", 1e-9 * static_cast<double>(result.threads.keep_awake()->cpu_time_ns())}};
  }
  Json json{{"ended", result.ended},
            {"passed", !result.failed},
            {"duration_s", result.duration_s},
            {"start_ms", result.start_ms},
            {"resident_MB", resident_MB()},
            {"control_ticks", result.control.ticks()},
            {"tick_us", percentiles_of(result.control.tick_cost())},
            {"safety_level", name(result.engine.state().status.safety.level)},
            {"faults", result.engine.state().status.safety.fault_count},
            {"commands",
             {{"sent", result.behaviors.commands().sent()},
              {"applied", result.engine.inbox().state().applied},
              {"refused", refused(result)}}},
            {"model_lost_periods", result.plant != nullptr ? result.plant->lost_periods() : 0},
            {"threads", threads}};
  for (const auto& [process, name] :
       {std::pair(result.process, "behavior_process"), std::pair(result.decision_process, "decision_process")}) {
    if (process == nullptr) continue;
    json[name] = {{"deaths", process->deaths()},
                  {"takeovers", process->takeovers()},
                  {"down", process->down()},
                  {"answer_us", percentiles_of(process->answer_cost())},
                  {"outage_us", percentiles_of(process->outage())}};
  }
  if (!result.link.empty()) json["link"] = link_json(result.link);
  if (has_record(result)) {
    json["record"] = {{"rows", result.recorder->rows()},
                      {"dropped", result.recorder->dropped()},
                      {"dropped_events", result.recorder->dropped_events()},
                      {"lost", result.recorder->lost()},
                      {"error", result.recorder->error()}};
  }
  return json_text(json);
}

nlohmann::ordered_json tick_json(const TickStatistics& statistics, std::span<const TickQuantile> quantiles) {
  nlohmann::ordered_json json{{"min", in_us(statistics.min_ns())}, {"mean", in_us(statistics.mean_ns())}};
  for (const TickQuantile& quantile : quantiles) json[quantile.name] = in_us(statistics, quantile);
  json["max"] = in_us(statistics.max_ns());
  return json;
}

std::string link_text(const std::vector<PlantCount>& counts) {
  return listed(counts,
                [](const PlantCount& count) { return std::to_string(count.value) + " " + std::string(count.name); });
}

nlohmann::ordered_json link_json(const std::vector<PlantCount>& counts) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const PlantCount& count : counts) json[count.name] = count.value;
  return json;
}

}  // namespace kadans
