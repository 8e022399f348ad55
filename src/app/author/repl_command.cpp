#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "app/assembly/assembly.h"
#include "app/commands.h"
#include "app/line_editor.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "behavior_stage.h"
#include "config/robot/project_root.h"
#include "script/console/console.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// `kadans repl`: a console in a simulation. On a terminal the simulation runs at the pace of the wall clock meanwhile.
// From a pipe time passes only by `:run`, so the output is repeatable.
struct ReplOptions {
  std::string scenario;  // "": the project's only robot, and nothing plays
  std::string play;      // replaces the scenario's list
  std::optional<std::uint64_t> seed;
  double speed = 1;  // on a terminal: simulated seconds per second; 0: time passes only by :run
};

constexpr int frame_ms = 10;           // between checks of the keyboard
constexpr double behind_max_s = 0.25;  // on a slow machine the simulation falls behind, not the keyboard

ScenarioConfig read_scenario(const ReplOptions& options) {
  ScenarioConfig scenario;
  if (!options.scenario.empty()) {
    scenario = read_scenario_config(options.scenario);
  } else {
    scenario.file = (fs::current_path() / "console").string();
    scenario.robot = robot_of_behavior(scenario.file).string();
  }
  if (!options.play.empty()) scenario.behaviors = read_play_items(options.play, "--play", folders_of(scenario));
  return scenario;
}

// Keeps the messages of behaviors and the supervisor until the console shows them.
class Chatter final : public LineSink {
 public:
  void tell(const Line& line) override {
    if (line.transition != nullptr) return;
    said_.append(printed("%8.2f s  ", 1e-9 * static_cast<double>(line.time_ns))).append(line.behavior);
    said_.append(line.severity == BehaviorLog::Severity::error ? ": error: " : ": ").append(line.text).append("\n");
  }
  std::string take() {
    std::string said;
    said.swap(said_);
    return said;
  }

 private:
  std::string said_;
};

class Repl {
 public:
  explicit Repl(const ReplOptions& options)
      : scenario_(read_scenario(options)),
        assembly_(scenario_, options.seed.value_or(scenario_.seed), log_),
        parts_(assembly_.parts()),
        console_({.root = project_root(scenario_.file), .folders = folders_of(scenario_)}, assembly_.catalog(),
                 assembly_.host()),
        speed_(options.speed) {
    step();  // so that there is a first snapshot
  }

  // Reads line by line. Errors go to stderr and make the exit code 1.
  int from_pipe() {
    int code = exit_passed;
    bool unfinished = false;
    for (std::string line; std::getline(std::cin, line);) {
      const Console::Reply reply = evaluate(line);
      unfinished = reply.incomplete;
      if (reply.error) code = exit_failed;
      show(reply.text, reply.error);
      advance(reply.run_s);
      if (reply.quit || interrupted()) break;
    }
    if (unfinished) print_error("the last line is not complete");
    return unfinished ? static_cast<int>(exit_failed) : code;
  }

  int from_terminal() {
    std::printf("%s at %g times real time; :help tells what can be typed\n", assembly_.robot().model.name.c_str(),
                speed_);
    LineEditor editor(prompt(), [this](const std::string& text) {
      Console::Completion found = console_.complete(text);
      return LineEditor::Completion{found.begin, std::move(found.words)};
    });
    auto last = std::chrono::steady_clock::now();
    while (!editor.ended() && !interrupted()) {
      const std::optional<std::string> line = editor.poll(frame_ms);
      const auto now = std::chrono::steady_clock::now();
      due_s_ = std::min(due_s_ + speed_ * std::chrono::duration<double>(now - last).count(), time_s() + behind_max_s);
      last = now;
      if (line) {
        const Console::Reply reply = evaluate(*line);
        if (!reply.text.empty()) editor.print(reply.error ? "error: " + reply.text : reply.text);
        if (reply.quit) break;
        editor.prompt(reply.incomplete ? "   ... " : prompt());
        due_s_ = std::max(due_s_, time_s() + reply.run_s);
      }
      catch_up();
      if (std::string said = chatter_.take(); !said.empty()) editor.print(said.substr(0, said.size() - 1));
    }
    std::printf("\n");
    return exit_passed;
  }

 private:
  double time_s() const { return 1e-9 * static_cast<double>(parts_.lockstep.time_ns()); }
  std::string prompt() const { return console_.writes() ? "kadans! " : "kadans> "; }

  void step() {
    parts_.begin_step();
    parts_.lockstep.step();
    Fault fault;
    while (parts_.control.safety().log().try_pop(fault)) {
    }
  }
  void catch_up() {
    while (time_s() < due_s_ - 1e-9 && !interrupted()) step();
  }
  // Lets `seconds` pass. Lines that are evaluated afterwards see the newest tick.
  void advance(double seconds) {
    due_s_ += seconds;
    catch_up();
    show(chatter_.take(), false);
  }

  Console::Reply evaluate(const std::string& line) {
    const ParameterTable& table = assembly_.catalog().parameters;
    parameters_.resize(table.size());
    for (ParameterId id = 0; id < table.size(); ++id) parameters_[id] = table.get(id);
    return console_.evaluate(line,
                             {parts_.control.state(), parts_.control.row(), parameters_, parts_.behaviors.sender()});
  }

  static void show(const std::string& text, bool error) {
    if (text.empty()) return;
    if (error) return print_error(text);
    print_text(text.ends_with('\n') ? text : text + "\n");
    std::fflush(stdout);
  }

  ScenarioConfig scenario_;
  Chatter chatter_;
  RunLog log_{std::initializer_list<LineSink*>{&chatter_}};
  Assembly assembly_;
  RunParts parts_;
  Console console_;
  std::vector<double> parameters_;
  double speed_;
  double due_s_ = 0;
};

int run_repl(const ReplOptions& options) {
  Repl repl(options);
  catch_interrupts();
  return isatty(STDIN_FILENO) == 1 ? repl.from_terminal() : repl.from_pipe();
}

}  // namespace

void add_repl(CommandLine& line) {
  const auto [repl, options] = line.add<ReplOptions>(
      "repl", "Open a console in a simulation: read signals, command the robot, play behaviors", run_repl);
  repl->add_option("scenario", options.scenario, "Scenario file (default: the project's robot, nothing plays)")
      ->type_name("FILE");
  repl->add_option("--play", options.play, "Behaviors to play instead of the scenario's: \"squat, wave\"")
      ->type_name("LIST");
  add_seed(*repl, options.seed, "Seed of all random numbers (default: the scenario's)");
  add_number(*repl, "--speed", options.speed, 0.0, 1000.0, "X",
             "Speed on a terminal as a multiple of the wall clock's; 0: time passes by :run only (default: 1)");
  repl->footer("Type :help. With input from a pipe, time passes by :run only, and a wrong line makes the exit code 1.");
}

}  // namespace kadans
