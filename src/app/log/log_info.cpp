#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "app/run/run_choices.h"
#include "app/sim/input_files.h"
#include "app/terminal.h"
#include "config/json/foreign_json.h"
#include "kadans/signal/shell_word.h"
#include "log_verbs.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

// The command that repeats the run; "" when there is none: a run on the wall clock, or a record of another program.
std::string again(const RecordOutline& record) {
  if (record.fact("run", "clock") == clock_of_programs) return record.fact("run", "repeat");
  if (record.fact("run", "clock") != "virtual") return "";
  if (!record.fact("run", "branch_tick").empty()) return "kadans replay " + shell_word(record.file);
  RunChoices choices = choices_of(record.metadata.at("run"), record.file);
  choices.scenario = record.fact("run", "scenario");
  return repeat_command(choices, *choices.seed);
}

std::size_t lines_of(const RecordOutline& record, BehaviorLog::Severity severity) {
  return static_cast<std::size_t>(std::ranges::count(record.log, severity, &Event::severity));
}

double ratio(const RecordOutline& record) {
  return record.packing.packed_bytes == 0
             ? 1
             : static_cast<double>(record.packing.unpacked_bytes) / static_cast<double>(record.packing.packed_bytes);
}

Json topics_json(const RecordOutline& record) {
  Json topics = Json::array();
  for (const TopicOutline& topic : record.topics) {
    topics.push_back({{"topic", topic.topic.name},
                      {"schema", topic.topic.schema},
                      {"encoding", topic.topic.encoding},
                      {"messages", topic.messages},
                      {"rate_hz", topic.rate_hz()},
                      {"bytes", topic.bytes},
                      {"signals", topic.topic.signals.size()},
                      {"first_s", seconds(topic.first_ns)},
                      {"last_s", seconds(topic.last_ns)}});
  }
  return topics;
}

void print_json(const RecordOutline& record) {
  Json attachments = Json::array();
  for (const McapAttachment& attachment : record.attachments)
    attachments.push_back({{"name", attachment.name}, {"bytes", attachment.data.size()}});
  const Json json{{"file", record.file},
                  {"complete", record.complete},
                  {"problem", record.complete ? "" : record.problem},
                  {"robot", record.robot()},
                  {"again", again(record)},
                  {"from_s", seconds(record.first_ns)},
                  {"to_s", seconds(record.last_ns)},
                  {"duration_s", seconds(record.last_ns - record.first_ns)},
                  {"rows", record.rows},
                  {"file_bytes", record.file_bytes},
                  {"chunks", record.packing.chunks},
                  {"compression", record.packing.compression},
                  {"unpacked_bytes", record.packing.unpacked_bytes},
                  {"transitions", record.transitions.size()},
                  {"faults", record.faults.size()},
                  {"log_lines", record.log.size()},
                  {"log_errors", lines_of(record, BehaviorLog::Severity::error)},
                  {"topics", topics_json(record)},
                  {"facts", record.metadata},
                  {"attachments", attachments}};
  std::puts(json_text(json).c_str());
}

void line(const char* name, const std::string& text) {
  if (!text.empty()) std::printf("  %-12s %s\n", name, text.c_str());
}

std::string run_text(const RecordOutline& record) {
  const std::string scenario = record.fact("run", "scenario"), seed = record.fact("run", "seed");
  if (scenario.empty()) return "";
  return scenario + (seed.empty() ? "" : ", seed " + seed);
}

std::string program_text(const RecordOutline& record) {
  std::string version = record.fact("run", "kadans");
  if (version.empty()) version = record.fact("program", "version");
  if (version.empty()) return "";
  const std::string machine = record.fact("program", "machine"), clock = record.fact("run", "clock");
  return "kadans " + version + (machine.empty() ? "" : ", " + machine) +
         (clock.empty()                ? ""
          : clock == clock_of_programs ? ", stepped by another program"
                                       : ", on the " + clock + " clock");
}

std::string verdict_text(const RecordOutline& record) {
  const std::string passed = record.fact("result", "passed"), checks = record.fact("result", "checks");
  if (passed.empty()) return "";
  const std::string failed = record.fact("result", "checks_failed");
  return (passed == "yes" ? "passed" : "failed") + (checks.empty() ? "" : ", " + checks + " checks") +
         (failed.empty() || failed == "0" ? "" : ", of which " + failed + " failed");
}

std::string drops_text(const RecordOutline& record) {
  const std::string rows = record.fact("recorder", "dropped_rows"), events = record.fact("recorder", "dropped_events");
  if (rows.empty()) return record.complete ? "" : "; what was dropped is told at the end only";
  return "; dropped: " + rows + " rows" + (events.empty() ? "" : ", " + events + " events");  // a dump has no count
}

std::string size_text(const RecordOutline& record) {
  return printed("%.2f MB in %llu chunks", 1e-6 * static_cast<double>(record.file_bytes),
                 static_cast<unsigned long long>(record.packing.chunks)) +
         (record.packing.compression.empty()
              ? ", not compressed"
              : printed(", %.1f times smaller by ", ratio(record)) + record.packing.compression);
}

void print_topics(const RecordOutline& record) {
  std::size_t name = 5, schema = 6;
  for (const TopicOutline& topic : record.topics) {
    name = std::max(name, topic.topic.name.size());
    schema = std::max(schema, topic.topic.schema.size());
  }
  const int name_width = static_cast<int>(name), schema_width = static_cast<int>(schema);
  std::printf("\n  %-*s  %-*s %9s %9s %8s %9s\n", name_width, "topic", schema_width, "schema", "messages", "Hz",
              "signals", "kB");
  for (const TopicOutline& topic : record.topics) {
    const std::string signals = topic.topic.signals.empty() ? "" : std::to_string(topic.topic.signals.size());
    const std::string rate = topic.rate_hz() > 0 ? printed("%.4g", topic.rate_hz()) : "";
    std::printf("  %-*s  %-*s %9llu %9s %8s %9.1f\n", name_width, topic.topic.name.c_str(), schema_width,
                topic.topic.schema.c_str(), static_cast<unsigned long long>(topic.messages), rate.c_str(),
                signals.c_str(), 1e-3 * static_cast<double>(topic.bytes));
  }
  std::printf("  sizes of topics are those before compression\n");
}

void print_outline(const RecordOutline& record) {
  std::printf("%s\n", record.file.c_str());
  line("run", run_text(record));
  line("robot", record.robot());
  line("recorded by", program_text(record));
  line("began", record.fact("run", "began"));
  line("verdict", verdict_text(record));
  line("again", again(record));
  line("time", printed("%.3f s to %.3f s: %.3f s", seconds(record.first_ns), seconds(record.last_ns),
                       seconds(record.last_ns - record.first_ns)));
  line("rows", std::to_string(record.rows) + drops_text(record));
  line("file", size_text(record) + (record.complete ? ", ends well" : ""));
  if (!record.complete) line("CUT SHORT", record.problem);
  line("part of", record.fact("cut", "of"));
  line("events", plural(record.transitions.size(), "transition") + ", " + plural(record.faults.size(), "fault") + ", " +
                     plural(record.log.size(), "log line") + " (" +
                     plural(lines_of(record, BehaviorLog::Severity::warning), "warning") + ", " +
                     plural(lines_of(record, BehaviorLog::Severity::error), "error") + ")");
  line("attached", plural(record.attachments.size(), "file"));
  print_topics(record);
}

}  // namespace

int log_info(const LogOptions& options) {
  const RecordOutline record = outline_of(options.file);
  options.json ? print_json(record) : print_outline(record);
  return exit_passed;
}

}  // namespace kadans
