#include <algorithm>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/assembly/assembly.h"
#include "app/commands.h"
#include "app/log/log_verbs.h"
#include "app/option_checks.h"
#include "app/run/observers.h"
#include "app/services.h"
#include "app/terminal.h"
#include "config/json/foreign_json.h"
#include "input_files.h"
#include "ordered_events.h"
#include "repeated_run.h"
#include "run_branches.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "telemetry/reading/record_comparison.h"
#include "telemetry/record/recorder.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t shown_differences = 12;

std::optional<std::uint64_t> number_in(const TextMap& facts, const char* name) {
  return number_of<std::uint64_t>(fact_in(facts, name));
}

ScenarioConfig repeated_scenario(const std::string& record, const RunInputs& inputs, const RunChoices& choices) {
  ScenarioConfig scenario = read_scenario(choices);
  add_ordered_events(inputs, record, scenario);
  return scenario;
}

// The repeated run; it is compared with the record while it goes.
class Replay final : public RunObserver {
 public:
  Replay(const std::string& record, const RunInputs& inputs, const RunChoices& choices)
      : reader_(record),
        scenario_(repeated_scenario(record, inputs, choices)),
        duration_s_(*choices.duration_s),
        assembly_(scenario_, *choices.seed, log_),
        comparison_(reader_, assembly_.catalog().signals),
        branch_(inputs.run, scenario_, assembly_) {}

  void go(bool progress_shown) {
    Checks none(assembly_.catalog().signals);
    ProgressBar progress(duration_s_, progress_shown);
    result_ = run_scenario(assembly_.parts(), duration_s_, none, {this, &progress});
  }

  void tick(double, std::span<const double> row) override {
    const RunParts parts = assembly_.parts();
    comparison_.compare(parts.control.ticks() - 1, parts.control.state().time_ns, row);
  }
  void between_ticks(const RunMark& mark) override {
    at_end_ = comparison_.ended() && mark.ticks == number_in(recorded_result(), "control_ticks");
    branch_.between_ticks(mark);
  }
  bool stop_asked() const override {
    return comparison_.parted() || at_end_ || (comparison_.ended() && !reader_.complete());
  }

  const RecordComparison& comparison() const noexcept { return comparison_; }
  const std::string& error() const noexcept { return result_.error; }
  std::vector<InputFile> files() const { return input_files(scenario_, assembly_); }
  // Where and why the record is cut short; "" when it is not.
  std::string problem() const { return comparison_.ended() && !reader_.complete() ? reader_.problem() : ""; }
  // True when the run ended, or had to end, before the end of the record.
  bool shorter() const { return !comparison_.over(); }
  // True when the state at the end differs in a part that is not recorded.
  bool other_end() const {
    const TextMap result = recorded_result();
    return at_end_ && result.contains("state_hash") && result.at("state_hash") != hash_text(result_.state_hash);
  }
  bool same() const {
    return !comparison_.parted() && comparison_.gone().empty() && !shorter() && !other_end() && comparison_.ticks() > 0;
  }

 private:
  TextMap recorded_result() const {
    const auto found = reader_.metadata().find("result");
    return found == reader_.metadata().end() ? TextMap{} : found->second;
  }

  McapReader reader_;
  RunLog log_;
  ScenarioConfig scenario_;
  double duration_s_;
  Assembly assembly_;
  RecordComparison comparison_;
  RecordedBranch branch_;
  RunResult result_;
  bool at_end_ = false;
};

// Everything that the report needs.
struct Findings {
  const ReplayOptions& options;
  const RecordComparison& comparison;
  std::uint64_t ticks;  // compared and equal
  bool same;
  std::vector<InputChange> files, program;
  std::vector<std::string> notes;
};

nlohmann::ordered_json change_json(const std::vector<InputChange>& changes) {
  auto list = nlohmann::ordered_json::array();
  for (const InputChange& change : changes) list.push_back({{"what", change.what}, {"how", change.how}});
  return list;
}

void print_json(const Findings& findings) {
  const RecordComparison& comparison = findings.comparison;
  nlohmann::ordered_json json{{"record", findings.options.record},
                              {"same", findings.same},
                              {"ticks", findings.ticks},
                              {"signals", comparison.signals()}};
  if (comparison.parted()) {
    auto list = nlohmann::ordered_json::array();
    for (const SignalDifference& d : comparison.differences()) {
      list.push_back({{"name", d.name},
                      {"unit", d.unit},
                      {"recorded", d.recorded},
                      {"replayed", d.replayed},
                      {"by", d.replayed - d.recorded}});
    }
    json["parted"] = {
        {"tick", comparison.tick()}, {"time_s", static_cast<double>(comparison.time_ns()) / 1e9}, {"signals", list}};
  }
  json["gone"] = comparison.gone();
  json["files"] = change_json(findings.files);
  json["program"] = change_json(findings.program);
  json["notes"] = findings.notes;
  std::puts(json_text(json).c_str());
}

void print_differences(const RecordComparison& comparison) {
  const std::vector<SignalDifference>& all = comparison.differences();
  std::printf("%s differ there:\n  %-44s %18s %18s %12s\n", plural(all.size(), "signal").c_str(), "", "recorded", "now",
              "by");
  for (std::size_t i = 0; i < std::min(all.size(), shown_differences); ++i) {
    const SignalDifference& d = all[i];
    std::printf("  %-44s %18.12g %18.12g %12.3g %s\n", d.name.c_str(), d.recorded, d.replayed, d.replayed - d.recorded,
                d.unit.c_str());
  }
  if (all.size() > shown_differences) std::printf("  ... and %zu more\n", all.size() - shown_differences);
}

void print_comparison(const Findings& findings) {
  const RecordComparison& comparison = findings.comparison;
  const std::string compared = plural(findings.ticks, "tick") + ", " + plural(comparison.signals(), "signal");
  const char* const record = findings.options.record.c_str();
  if (comparison.parted()) {
    std::printf("%s: parts in tick %llu, at %.3f s, after %s the same\n", record,
                static_cast<unsigned long long>(comparison.tick()), 1e-9 * static_cast<double>(comparison.time_ns()),
                plural(findings.ticks, "tick").c_str());
    print_differences(comparison);
  } else {
    std::printf("%s: %s, %s\n", record, findings.same ? "the same" : "not all the same", compared.c_str());
  }
  for (const std::string& note : findings.notes) std::printf("%s\n", note.c_str());
  const std::string files = change_text(findings.files), program = change_text(findings.program);
  if (!files.empty()) std::printf("since it was recorded: %s\n", files.c_str());
  if (!program.empty()) std::printf("since it was recorded: %s\n", program.c_str());
  if (!findings.same && files.empty() && program.empty() && findings.options.with.empty())
    std::puts("since it was recorded: nothing changed; this run does not repeat");
}

std::vector<std::string> notes_of(const Replay& replay, const RunInputs& inputs) {
  std::vector<std::string> notes;
  const std::vector<std::string>& gone = replay.comparison().gone();
  if (!gone.empty())
    notes.push_back(plural(gone.size(), "signal") + " of the record are no more, the first is " + gone.front());
  if (replay.other_end()) notes.push_back("what is not recorded ends in another state: its hash differs");
  if (replay.shorter())
    notes.push_back("this run ends before the record" + (replay.error().empty() ? "" : ": " + replay.error()));
  if (!replay.problem().empty()) notes.push_back("the record is not whole: " + replay.problem());
  if (replay.comparison().ticks() == 0 && !replay.comparison().parted())
    notes.emplace_back("it holds no tick to compare");
  if (!inputs.fact("watched").empty())
    notes.emplace_back("recorded with --watch: what was saved and reloaded meanwhile is not repeated");
  if (!inputs.fact("ctl").empty() && !replay.same())
    notes.emplace_back(
        "recorded while 'kadans ctl' could reach it: of what was ordered meanwhile only events are repeated");
  return notes;
}

std::vector<std::string> notes_of(const RepeatedRun& run, const RunInputs& inputs, bool with) {
  std::vector<std::string> notes;
  if (!run.parting().empty()) notes.push_back(run.parting());
  if (!run.comparison().gone().empty())
    notes.push_back(plural(run.comparison().gone().size(), "signal") + " of the record are no more, the first is " +
                    run.comparison().gone().front());
  if (!run.shortened().empty()) notes.push_back("the record is not whole: " + run.shortened());
  if (run.ticks() == 0) notes.emplace_back("it holds no tick to compare");
  if (run.repeats_flight()) {
    notes.push_back(printed("repeated from the state of its control engine at %.3f s: ",
                            1e-9 * static_cast<double>(run.begun_ns())) +
                    plural(run.commands(), "command") + "; " + plural(run.states(), "later state") +
                    " the same, bit for bit");
    notes.emplace_back("a flight record: behaviors and the high levels of control objects are not repeated");
    return notes;
  }
  notes.push_back("repeated from its inputs: " + plural(run.behavior_ticks(), "tick") + " of the behaviors, " +
                  plural(run.commands(), "command") + ", " + plural(run.events(), "event"));
  if (run.decisions() != nullptr && run.decisions()->ticks() > 0)
    notes.back() += ", " + plural(run.decisions()->ticks(), "tick") + " of the decisions";
  if (with && !run.decided_otherwise().empty())
    notes.push_back(run.decided_otherwise() + "; behaviors got the recorded orders nevertheless");
  if (with)
    notes.emplace_back(
        "with other files: what they command counts, the sensors are those of the record, so the robot does not "
        "answer");
  else if (played_elsewhere(inputs))
    notes.emplace_back("its behaviors played in a process of their own: their commands are taken from the record");
  return notes;
}

// A stage of the tick, in the order of the stages, and what it is made of.
struct Stage {
  const char* signals;  // how their names begin
  const char* fed;
};
constexpr Stage stages[] = {
    {"imu.", "the samples of the tick"},
    {"sensor.", "the samples of the tick"},
    {"joint.", "the estimate, of the samples of its sensors"},
    {"base.", "the estimate, of the IMU's samples"},
    {"foot.", "the estimate, of the samples of its sole"},
    {"support.", "the estimate, of feet and joints"},
    {"odometry.", "the estimate, of feet, joints and IMU"},
    {"safety.", "safety, of samples, estimate and what the control objects asked for in the tick before"},
    {"actuation.", "what the control objects asked for in the tick before, within safety's limits"},
    {"engine.", "the commands that came down"},
    {"control.", ""},
    {"composition.", "the control sets and their objects"},
};

// The control objects that have a share in the joint of an actuation's signal: "walk, posture".
std::string writers_of(const std::string& signal, const Catalog& catalog, std::span<const double> row) {
  const std::size_t first = signal.find('.') + 1;
  const std::string joint = signal.substr(first, signal.rfind('.') - first);
  const std::optional<SignalId> writers = catalog.signals.find("composition." + joint + ".writers");
  std::string names;
  for (std::size_t i = 0; writers && i < catalog.objects.size(); ++i) {
    if ((static_cast<std::uint32_t>(row[*writers]) >> i & 1U) != 0)
      names += (names.empty() ? "" : ", ") + catalog.objects[i].name;
  }
  return names.empty() ? "none" : names;
}

// The first one in the order of the tick, and what feeds it.
std::string first_of(const std::vector<SignalDifference>& differences, Assembly& assembly) {
  const Catalog& catalog = assembly.catalog();
  for (const Stage& stage : stages) {
    const auto found = std::ranges::find_if(
        differences, [&](const SignalDifference& difference) { return difference.name.starts_with(stage.signals); });
    if (found == differences.end()) continue;
    const auto object = std::ranges::find_if(
        catalog.objects, [&](const ObjectInfo& info) { return found->name.starts_with("control." + info.name + "."); });
    std::string fed = stage.fed;
    if (object != catalog.objects.end())
      fed = "control object " + object->name + " (" + object->type + "), of the estimate";
    if (found->name.starts_with("actuation."))
      fed += "; its control objects are " + writers_of(found->name, catalog, assembly.control().row());
    if (!fed.empty()) return "the first of them in the tick is " + found->name + ": from " + fed;
  }
  return "";
}

// All signals that a repetition computes, its faults and its lines, in a record.
class RepetitionRecord final : public RunObserver {
 public:
  // Throws InputError when the file cannot be made.
  RepetitionRecord(const std::string& file, RepeatedRun& run)
      : recorder_(run.assembly().catalog().signals,
                  {.subjects = viewer_subjects(run.assembly()), .parameters = &run.assembly().catalog().parameters}, {},
                  Recorder::Wait::in_place) {
    if (!recorder_.open(file)) refuse(recorder_.error());
    describe_robots(recorder_.file(), robot_texts(run.assembly()), 0);
    run.log().add(recorder_.events());
  }

  void tick(double, std::span<const double> row) override { row_ = row; }
  void fault(const Fault& fault) override { recorder_.fault(fault); }
  void between_ticks(const RunMark& mark) override {
    recorder_.record(mark.ticks - 1, mark.time_ns, row_);
    (void)recorder_.drain();
  }
  // Throws InputError when the file is not whole.
  void close() {
    if (!recorder_.close()) refuse(recorder_.error());
  }

 private:
  Recorder recorder_;
  std::span<const double> row_;
};

// A run on threads: its files come out of the record.
int repeat_run(const ReplayOptions& options, const RunInputs& inputs) {
  const bool flight = is_flight_record(options.record);
  if (flight && !options.with.empty())
    refuse("--with", "is for complete records; " + options.record +
                         " is a flight record: behaviors are not repeated, and its state is that of its files");
  const UnpackedInputs unpacked(inputs, options.record, options.allow_plugins, options.with);
  const ScenarioConfig scenario = unpacked_scenario(inputs, options.record, unpacked);
  RepeatedRun repeated(options.record, scenario, unpacked, inputs.fact("root"),
                       flight                     ? RepeatedRun::Behaviors::saved
                       : !options.with.empty()    ? RepeatedRun::Behaviors::leading
                       : played_elsewhere(inputs) ? RepeatedRun::Behaviors::none
                                                  : RepeatedRun::Behaviors::compared);
  std::optional<RepetitionRecord> written;
  std::vector<RunObserver*> observers;
  if (!options.written.empty()) observers.push_back(&written.emplace(options.written, repeated));
  catch_interrupts();
  repeated.go(interrupted, observers);
  if (written) written->close();
  if (interrupted()) return exit_interrupted;
  std::vector<std::string> notes = notes_of(repeated, inputs, !options.with.empty());
  const std::string first = first_of(repeated.comparison().differences(), repeated.assembly());
  if (!first.empty()) notes.insert(notes.begin(), first);
  const Findings findings{options, repeated.comparison(),   repeated.compared_ticks(), repeated.same(),
                          {},      changed_program(inputs), std::move(notes)};
  options.json ? print_json(findings) : print_comparison(findings);
  return findings.same ? exit_passed : exit_failed;
}

int run_replay(const ReplayOptions& options) {
  const RunInputs inputs = read_front(options.record);
  std::error_code none;
  if (fs::equivalent(options.record, options.written, none))
    refuse("--record", options.written + " is the record that is repeated");
  if (!options.then_simulate.empty()) return run_then_simulation(options);
  if (inputs.fact("clock") == clock_of_threads) return repeat_run(options, inputs);
  if (!options.with.empty())
    refuse("--with", "is for records of kadans run; " + options.record + " was simulated: change its files");
  if (!options.written.empty())
    refuse("--record", "is for records of kadans run; " + options.record +
                           " was simulated: kadans sim writes another record of it");
  std::unique_ptr<UnpackedInputs> unpacked;
  if (options.from_record) unpacked = std::make_unique<UnpackedInputs>(inputs, options.record, options.allow_plugins);
  RunChoices choices = choices_of(inputs.run, options.record);
  choices.scenario = unpacked ? unpacked->scenario().string() : find_scenario(inputs, options.record).string();
  choices.plugins = unpacked ? unpacked->plugins() : plugins_beside(choices.scenario, options.allow_plugins);
  const std::vector<InputChange> program = changed_program(inputs);
  try {
    Replay replay(options.record, inputs, choices);
    catch_interrupts();
    replay.go(stderr_is_terminal() && !options.json);
    if (interrupted()) return exit_interrupted;
    const Findings findings{options,
                            replay.comparison(),
                            replay.comparison().ticks(),
                            replay.same(),
                            changed_files(inputs, choices.scenario, replay.files()),
                            program,
                            notes_of(replay, inputs)};
    options.json ? print_json(findings) : print_comparison(findings);
    return replay.same() ? exit_passed : exit_failed;
  } catch (const InputError&) {
    const std::string changed = change_text(changed_files(inputs, choices.scenario, {}));
    if (!changed.empty()) print_error(options.record + " cannot be run again; since it was recorded: " + changed);
    throw;
  }
}

}  // namespace

void add_replay(CommandLine& line) {
  const auto [replay, options] =
      line.add<ReplayOptions>("replay", "Run a record again, and report where and why it differs", run_replay);
  replay->add_option("record", options.record, "Record of kadans sim or kadans run (MCAP)")
      ->required()
      ->type_name("FILE");
  replay->add_flag("--from-record", options.from_record, "Use the files inside the record, not those on the disk");
  replay->add_flag("--allow-plugins", options.allow_plugins,
                   "Load the project's plug-ins, even if they differ from the record's");
  replay
      ->add_option("--with", options.with,
                   "Of a run on threads: files of this project that take the place of the record's")
      ->type_name("FILE");
  CLI::Option* then =
      replay
          ->add_option("--then-simulate", options.then_simulate,
                       "Of a run on threads: from --at on, its engines go on in this scenario's world, with its checks")
          ->type_name("SCENARIO");
  CLI::Option* at = add_number(*replay, "--at", options.at_s, 0.001, scenario_duration_max_s, "S",
                               "Second of the record from which that is simulated")
                        ->needs(then);
  then->needs(at);
  replay
      ->add_option("--record", options.written,
                   "Of a run on threads: write all signals, as they are computed again, into this record")
      ->type_name("FILE")
      ->excludes(then);
  replay->add_flag("--json", options.json, "Print one JSON object instead of text");
}

}  // namespace kadans
