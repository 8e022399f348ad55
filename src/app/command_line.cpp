#include "command_line.h"

#include <type_traits>

#include "app/new/new_options.h"
#include "commands.h"
#include "terminal.h"

namespace kadans {
namespace {

constexpr const char* about =
    "Kadans: a scriptable control runtime for robots.\n"
    "A 1 kHz core executes compiled control objects; behaviors in Lua tell them what to do.\n";

void add_commands(const CLI::App& app, const std::string& path, std::vector<CommandEntry>& all) {
  for (const CLI::App* command : visible_below(app)) {
    const std::string words = path + (path.empty() ? "" : " ") + command->get_name();
    if (!visible_below(*command).empty()) {
      add_commands(*command, words, all);
      continue;
    }
    CommandEntry entry{.words = words, .command = command, .options = {}};
    for (const CLI::App* at = command; at->get_parent() != nullptr; at = at->get_parent()) {
      if (at != command && !command->get_fallthrough()) break;
      for (const CLI::Option* option : at->get_options()) {
        if (option != at->get_help_ptr()) entry.options.push_back(option);
      }
    }
    all.push_back(std::move(entry));
  }
}

}  // namespace

std::vector<const CLI::App*> visible_below(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

template <typename Options, typename Run>
void CommandLine::offer(void (*add)(CLI::App&, Options&), Run does) {
  Options& options = options_.emplace_back().emplace<Options>();
  add(app, options);
  const CLI::App* const command = app.get_subcommands([](const CLI::App*) { return true; }).back();
  if constexpr (std::is_invocable_v<Run, const Options&>)
    runs_.emplace_back(command, [does, &options] { return does(options); });
  else
    runs_.emplace_back(command, [this, does, &options] { return does(app, options); });
}

CommandLine::CommandLine() : app(about, "kadans") {
  app.require_subcommand(1);
  offer(add_sim, run_sim);
  offer(add_test, run_test);
  offer(add_replay, run_replay);
  offer(add_debug, run_debug);
  offer(add_check, run_check);
  offer(add_sweep, run_sweep);
  offer(add_merge, run_merge);
  offer(add_margin, run_margin);
  offer(add_shrink, run_shrink);
  offer(add_tune, [this](const TuneOptions&) { return start_tune_program(arguments_.data()); });
  offer(add_behavior, run_behavior);
  offer(add_repl, run_repl);
  offer(add_stubs, run_stubs);
  offer(add_params, run_params);
  offer(add_run, run_live);
  offer(add_behavior_process, run_behavior_process);
  offer(add_plant, run_plant);
  offer(add_jog, run_jog);
  offer(add_commission, run_commission);
  offer(add_dynamixel, run_dynamixel);
  offer(add_jitter, run_jitter);
  offer(add_ctl, [this](const CtlOptions& options) {
    return run_ctl(app, options, {arguments_.begin() + 1, arguments_.end()});
  });
  offer(add_push, run_push);
  offer(add_receive, run_receive);
  offer(add_completion, run_completion);
  offer(add_view, run_view);
  offer(add_render, run_render);
  offer(add_log, run_log);
  offer(add_doctor, run_doctor);
  offer(add_new, run_new);
  offer(add_reference, run_reference);
  add_examples(app);
}

int CommandLine::run(std::span<char*> arguments) {
  arguments_ = arguments;
  for (const auto& [command, does] : runs_) {
    if (command->parsed()) return does();
  }
  return exit_usage;
}

std::vector<CommandEntry> commands_of(const CommandLine& line) {
  std::vector<CommandEntry> all;
  add_commands(line.app, "", all);
  return all;
}

}  // namespace kadans
